//! Stars brought to agree by moves and flips of an embedded triangulation, where they are enough: they cost no vertex.
//!
//! The stars of an embedded triangulation are its triangles if every triangle's circle, in the metric of each of its corners,
//! is empty. So the triangulation is changed until they are, as far as vertices next to a triangle, or behind those, tell:
//! what is lowered is the sum, over triangles, their sides, metrics and vertices beyond, of the squares by which the two
//! angles that face a side exceed a straight angle less a margin; and of those by which triangles are too large or edges
//! too short. Each move and each flip lowers it.

use super::star::circle;
use super::steiner::Steiner;
use crate::error::Result;
use crate::geometry::{Point, Tensor, Vector};
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use std::f64::consts::PI;

/// Angles that face an edge should be so much (radians) below a straight angle, together.
const MARGIN: f64 = 0.1;
/// A vertex is tried so far from its place, in units of the metric.
const STEPS: [f64; 3] = [0.2, 0.06, 0.015];
/// In so many directions.
const DIRECTIONS: u32 = 8;
/// Edges should be as long as this, in units of the metric.
const SHORTEST: f64 = 0.15;
/// Passes over all vertices at most.
const SWEEPS: usize = 60;
/// A pass that lowers the sum by less than this share of it is the last.
const STALL: f64 = 1e-3;

/// Moves free vertices, and flips edges, until every star agrees or it helps no more; no triangle's circumradius passes
/// `largest` for that. Says how many moves it took.
///
/// # Errors
/// The metric is not positive definite where a vertex was moved.
pub(super) fn relocate(steiner: &mut Steiner, largest: f64) -> Result<u64> {
    let is_quiet = vec![false; steiner.planar.topology.vertex_slots()];
    let mut work = Relocation { steiner, largest, is_quiet, moves: 0 };
    let mut before = work.total().0;
    for _ in 0..SWEEPS {
        work.flips();
        work.sweep()?;
        let (energy, violated) = work.total();
        if violated == 0 || before - energy < STALL * before {
            break;
        }
        before = energy;
    }
    Ok(work.moves)
}

struct Relocation<'a, 'f> {
    steiner: &'a mut Steiner<'f>,
    largest: f64,
    /// Vertices that no move helps, until something moves near them.
    is_quiet: Vec<bool>,
    moves: u64,
}

impl Relocation<'_, '_> {
    /// The sum over all faces, and the number of circles, each in one metric, that hold a vertex.
    fn total(&self) -> (f64, usize) {
        let faces = self.steiner.planar.topology.faces();
        faces.map(|f| self.of_face(f)).fold((0.0, 0), |sum, face| (sum.0 + face.0, sum.1 + face.1))
    }

    /// What a face adds.
    fn of_face(&self, f: FaceId) -> (f64, usize) {
        let topology = &self.steiner.planar.topology;
        let (mut sum, mut violated) = (0.0, 0);
        for e in f.half_edges() {
            let [v, across] = [topology.apex(e), topology.origin(e)];
            sum += self.of_size(f, v) + self.of_length(e, across) + self.of_length(e, topology.target(e));
            let Some(t) = self.free_twin(e) else { continue };
            let metrics = [v, across, topology.target(e)];
            let facing = metrics.map(|u| self.facing(e, topology.apex(t), u));
            let beyond = [t.next(), t.prev()].map(|g| self.free_twin(g));
            let far = beyond.into_iter().flatten().map(|g| self.facing(e, topology.apex(g), v));
            for excess in facing.into_iter().chain(far) {
                sum += excess * excess;
                violated += usize::from(excess > MARGIN);
            }
        }
        (sum, violated)
    }

    fn free_twin(&self, h: HalfEdge) -> Option<HalfEdge> {
        let topology = &self.steiner.planar.topology;
        topology.twin(h).filter(|_| !topology.is_fixed(h))
    }

    /// The two angles under which the apex of a half-edge and a vertex beyond it see it, in the metric of `at`: by how much
    /// they exceed a straight angle less the margin, together.
    fn facing(&self, h: HalfEdge, beyond: VertexId, at: VertexId) -> f64 {
        let planar = &self.steiner.planar;
        let [a, b] = planar.ends(h);
        let [c, d] = [planar.topology.apex(h), beyond].map(|v| planar.position(v));
        excess(self.steiner.tensors[at.index()], [a - c, b - c], [b - d, a - d])
    }

    fn of_size(&self, f: FaceId, v: VertexId) -> f64 {
        let circle = circle(self.steiner.tensors[v.index()], self.steiner.planar.triangle(f));
        let radius = circle.map_or(f64::INFINITY, |(_, radius)| radius);
        (radius / self.largest - 1.0).max(0.0).powi(2)
    }

    fn of_length(&self, h: HalfEdge, at: VertexId) -> f64 {
        let [a, b] = self.steiner.planar.ends(h);
        (1.0 - self.steiner.tensors[at.index()].length(b - a) / SHORTEST).max(0.0).powi(2)
    }

    /// Some faces, and those that can see into them.
    fn near(&self, mut near: Vec<FaceId>) -> Vec<FaceId> {
        let mut begin = 0;
        for _ in 0..2 {
            let end = near.len();
            for i in begin..end {
                for t in near[i].half_edges().into_iter().filter_map(|h| self.free_twin(h)) {
                    if !near.contains(&t.face()) {
                        near.push(t.face());
                    }
                }
            }
            begin = end;
        }
        near
    }

    /// What some faces add; some number that is not less than `most` if it is not less.
    fn sum(&self, faces: &[FaceId], most: f64) -> f64 {
        let mut sum = 0.0;
        for &f in faces {
            sum += self.of_face(f).0;
            if sum >= most {
                break;
            }
        }
        sum
    }

    /// Tries to move each vertex once.
    fn sweep(&mut self) -> Result<()> {
        let all: Vec<VertexId> = self.steiner.planar.topology.vertices().collect();
        for v in all {
            let topology = &self.steiner.planar.topology;
            let is_free = !topology.is_border_vertex(v) && !topology.star(v).any(|h| topology.is_fixed(h));
            if is_free && !self.is_quiet[v.index()] {
                self.improve(v)?;
            }
        }
        Ok(())
    }

    /// Moves a vertex to the best of the places tried, of the longest step with which any is better than its own.
    fn improve(&mut self, v: VertexId) -> Result<()> {
        let near = self.near(self.steiner.planar.topology.star(v).map(HalfEdge::face).collect());
        let energy = self.sum(&near, f64::INFINITY);
        let from = self.steiner.planar.position(v);
        let [a, b, c] = self.steiner.tensors[v.index()].cholesky();
        for step in STEPS.into_iter().filter(|_| energy > 0.0) {
            let mut best: (f64, Option<Point>) = (energy, None);
            for i in 0..DIRECTIONS {
                let (y, x) = (2.0 * PI * f64::from(i) / f64::from(DIRECTIONS)).sin_cos();
                let to = from + Vector::new((x - b * y / c) / a, y / c) * step;
                if self.steiner.shift(v, to)? {
                    let there = self.sum(&near, best.0);
                    if there < best.0 {
                        best = (there, Some(to));
                    }
                    self.steiner.shift(v, from)?;
                }
            }
            if let Some(to) = best.1 {
                self.moves += 1;
                self.steiner.shift(v, to)?;
                self.wake(&near);
                return Ok(());
            }
        }
        self.is_quiet[v.index()] = true;
        Ok(())
    }

    fn wake(&mut self, near: &[FaceId]) {
        for v in near.iter().flat_map(|&f| self.steiner.planar.topology.corners(f)) {
            self.is_quiet[v.index()] = false;
        }
    }

    /// Flips edges where that lowers the sum.
    fn flips(&mut self) {
        let all: Vec<HalfEdge> = self.steiner.planar.topology.edges().collect();
        for h in all {
            let Some(t) = self.free_twin(h) else { continue };
            let is_bad = self.of_face(h.face()).0 + self.of_face(t.face()).0 > 0.0;
            if !is_bad || !self.steiner.planar.is_convex(h) {
                continue;
            }
            let near = self.near(vec![h.face(), t.face()]);
            let before = self.sum(&near, f64::INFINITY);
            self.steiner.planar.topology.flip(h);
            let after = self.sum(&near, before);
            if after < before {
                self.wake(&near);
                continue;
            }
            // Three more turns are back where it was.
            for _ in 0..3 {
                self.steiner.planar.topology.flip(h);
            }
        }
    }
}

/// By how much two angles, each from one vector to another in a metric, exceed a straight angle less the margin, together.
fn excess(tensor: Tensor, [a, b]: [Vector; 2], [c, d]: [Vector; 2]) -> f64 {
    let root = tensor.determinant().sqrt();
    let (sine, other_sine) = (root * a.cross(b), root * c.cross(d));
    let (cosine, other_cosine) = (tensor.dot(a, b), tensor.dot(c, d));
    let across = sine * other_cosine + cosine * other_sine;
    let along = cosine * other_cosine - sine * other_sine;
    // The sum's sine and cosine, both times the same: most sums are small, and need no arc.
    if along >= 0.0 && across >= 0.0 || other_sine <= 0.0 {
        return 0.0;
    }
    let angle = across.atan2(along);
    let angle = if angle < 0.0 { angle + 2.0 * PI } else { angle };
    (angle - (PI - MARGIN)).max(0.0)
}
