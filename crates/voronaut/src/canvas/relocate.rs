//! Stars brought to agree by moves and flips of an embedded triangulation, where they are enough: they cost no vertex.
//!
//! The stars of an embedded triangulation are those of its vertices if every edge is Delaunay in the metrics of all four
//! vertices of the two triangles at it. So the triangulation is changed until they are: what is lowered is the sum, over
//! edges and their four metrics, of the squares by which the two angles that face the edge exceed a straight angle less a
//! margin; and of those by which circumradii exceed the largest.

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
    let mut work = Relocation { steiner, largest, moves: 0 };
    let mut before = work.total().0;
    for sweep in 0..SWEEPS {
        work.flips();
        work.sweep()?;
        let (energy, violated) = work.total();
        if std::env::var("TRACE").is_ok() { eprintln!("sweep {sweep} energy {energy} violated {violated} moves {}", work.moves); }
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
    moves: u64,
}

impl Relocation<'_, '_> {
    /// The sum over all edges and triangles, and the number of edges and metrics that are not Delaunay.
    fn total(&self) -> (f64, usize) {
        let topology = &self.steiner.planar.topology;
        let mut sum: f64 = topology.faces().map(|f| self.of_face(f)).sum();
        let mut violated = 0;
        for h in topology.edges() {
            sum += self.of_edge(h);
            violated += self.angles(h).map_or(0, |angles| angles.iter().filter(|&&angle| angle > PI).count());
        }
        (sum, violated)
    }

    /// The two angles that face an edge together, in the metrics of its ends and of its apexes; `None` of a fixed edge.
    fn angles(&self, h: HalfEdge) -> Option<[f64; 4]> {
        let topology = &self.steiner.planar.topology;
        let t = topology.twin(h).filter(|_| !topology.is_fixed(h))?;
        let quad = [topology.origin(h), topology.target(h), topology.apex(h), topology.apex(t)];
        let [a, b, c, d] = quad.map(|v| self.steiner.planar.position(v));
        let angle = |tensor| angle(tensor, a - c, b - c) + angle(tensor, b - d, a - d);
        Some(quad.map(|v| angle(self.steiner.tensors[v.index()])))
    }

    fn of_edge(&self, h: HalfEdge) -> f64 {
        let excess = |angle: f64| (angle - (PI - MARGIN)).max(0.0).powi(2);
        self.angles(h).map_or(0.0, |angles| angles.into_iter().map(excess).sum())
    }

    fn of_face(&self, f: FaceId) -> f64 {
        let corners = self.steiner.planar.topology.corners(f);
        let triangle = self.steiner.planar.triangle(f);
        let excess = |v: VertexId| {
            let radius = circle(self.steiner.tensors[v.index()], triangle).map_or(f64::INFINITY, |(_, radius)| radius);
            (radius / self.largest - 1.0).max(0.0).powi(2)
        };
        corners.into_iter().map(excess).sum()
    }

    /// The part of the sum that a vertex has to do with.
    fn around(&self, v: VertexId) -> f64 {
        let edges = |h: HalfEdge| self.of_edge(h) + self.of_edge(h.next()) + self.of_face(h.face());
        self.steiner.planar.topology.star(v).map(edges).sum()
    }

    /// Tries to move each vertex once.
    fn sweep(&mut self) -> Result<()> {
        let all: Vec<VertexId> = self.steiner.planar.topology.vertices().collect();
        for v in all {
            let topology = &self.steiner.planar.topology;
            if topology.is_border_vertex(v) || topology.star(v).any(|h| topology.is_fixed(h)) {
                continue;
            }
            let energy = self.around(v);
            if energy > 0.0 {
                self.improve(v, energy)?;
            }
        }
        Ok(())
    }

    /// Moves a vertex to the best of the places tried, of the longest step with which any is better than its own.
    fn improve(&mut self, v: VertexId, energy: f64) -> Result<()> {
        let from = self.steiner.planar.position(v);
        let [a, b, c] = self.steiner.tensors[v.index()].cholesky();
        for step in STEPS {
            let mut best: (f64, Option<Point>) = (energy, None);
            for i in 0..DIRECTIONS {
                let (y, x) = (2.0 * PI * f64::from(i) / f64::from(DIRECTIONS)).sin_cos();
                let to = from + Vector::new((x - b * y / c) / a, y / c) * step;
                if self.steiner.shift(v, to)? {
                    let there = self.around(v);
                    if there < best.0 {
                        best = (there, Some(to));
                    }
                    self.steiner.shift(v, from)?;
                }
            }
            if let Some(to) = best.1 {
                self.moves += 1;
                self.steiner.shift(v, to)?;
                return Ok(());
            }
        }
        Ok(())
    }

    /// Flips edges where that lowers the sum.
    fn flips(&mut self) {
        let all: Vec<HalfEdge> = self.steiner.planar.topology.edges().collect();
        for h in all {
            let topology = &self.steiner.planar.topology;
            if topology.is_fixed(h) || self.of_edge(h) == 0.0 || !self.steiner.planar.is_convex(h) {
                continue;
            }
            let before = self.around_edge(h);
            self.steiner.planar.topology.flip(h);
            if self.around_edge(h) >= before {
                // Three more turns are back where it was.
                for _ in 0..3 {
                    self.steiner.planar.topology.flip(h);
                }
            }
        }
    }

    fn around_edge(&self, h: HalfEdge) -> f64 {
        let Some(t) = self.steiner.planar.topology.twin(h) else { return 0.0 };
        let edges = [h, h.next(), h.prev(), t.next(), t.prev()];
        let faces = [h.face(), t.face()];
        edges.iter().map(|&e| self.of_edge(e)).sum::<f64>() + faces.iter().map(|&f| self.of_face(f)).sum::<f64>()
    }
}

/// The angle from one vector to another in a metric.
fn angle(tensor: Tensor, u: Vector, v: Vector) -> f64 {
    (tensor.determinant().sqrt() * u.cross(v)).atan2(tensor.dot(u, v))
}
