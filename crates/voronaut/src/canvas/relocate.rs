//! Stars brought to agree by moves and flips of an embedded triangulation, where they are enough: they cost no vertex.
//!
//! The stars of an embedded triangulation are its triangles if every triangle's circle, in the metric of each of its corners,
//! is empty. So the triangulation is changed until they are, as far as vertices next to a triangle, or behind those, tell:
//! what is lowered is the sum, over triangles, their sides, metrics and vertices beyond, of the squares by which the two
//! angles that face a side exceed a straight angle less a margin; and of those by which triangles are too large or edges
//! too short. Each move and each flip lowers it.

use super::star::circle;
use super::steiner::Steiner;
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geometry::{Tensor, Vector};
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use std::f64::consts::PI;

/// Angles that face an edge should be so much (radians) below a straight angle, together.
const MARGIN: f64 = 0.1;
/// The tangent of the margin, or a little more: most sums are told to be below it without an arc.
const TANGENT: f64 = 0.1004;
/// A vertex is tried so far from its place, in units of the metric.
const STEPS: [f64; 3] = [0.2, 0.06, 0.015];
/// In so many directions.
const DIRECTIONS: u32 = 8;
/// Edges should be as long as this, in units of the metric.
const SHORTEST: f64 = 0.15;
/// Passes over all vertices at most.
const SWEEPS: usize = 30;
/// A pass that lowers the sum by less than this share of it is the last.
const STALL: f64 = 1e-2;

/// Which vertices no move helps, until something changes near them: from one relocation to the next.
#[derive(Default)]
pub(super) struct Quiet(Vec<bool>);

impl Quiet {
    /// Some vertices are to be tried again.
    pub(super) fn wake(&mut self, vertices: impl IntoIterator<Item = VertexId>) {
        for v in vertices {
            if let Some(is_quiet) = self.0.get_mut(v.index()) {
                *is_quiet = false;
            }
        }
    }
}

/// Moves free vertices, and flips edges, until every star agrees or it helps no more; no triangle's circumradius passes
/// `largest` for that. Says how many moves it took.
///
/// # Errors
/// The metric is not positive definite where a vertex was moved.
pub(super) fn relocate(steiner: &mut Steiner, largest: f64, quiet: &mut Quiet) -> Result<u64> {
    quiet.0.resize(steiner.planar.topology.vertex_slots(), false);
    let mut work = Relocation { steiner, largest, quiet, terms: Vec::new(), moves: 0 };
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

/// What is added for one circle, edge or triangle.
#[derive(Clone, Copy)]
enum Term {
    /// Of an edge's ends, an apex on its left and a vertex on its right: by how much the two angles that face the edge, in
    /// the metric of the vertex that comes last, exceed a straight angle less the margin, together.
    Facing([VertexId; 4], VertexId),
    /// By how much a triangle is too large, in the metric of its first corner.
    Size([VertexId; 3]),
    /// By how much an edge is too short, in the metric of its first end.
    Length([VertexId; 2]),
}

impl Term {
    fn touches(&self, v: VertexId) -> bool {
        match self {
            Self::Facing(quad, _) => quad.contains(&v),
            Self::Size(corners) => corners.contains(&v),
            Self::Length(ends) => ends.contains(&v),
        }
    }
}

struct Relocation<'a, 'f> {
    steiner: &'a mut Steiner<'f>,
    largest: f64,
    quiet: &'a mut Quiet,
    /// Those of the last vertex that was tried, with what they add where it was, the greatest first.
    terms: Vec<(f64, Term)>,
    moves: u64,
}

impl Relocation<'_, '_> {
    /// The sum over all faces, and the number of circles, each in one metric, that hold a vertex.
    fn total(&self) -> (f64, usize) {
        let (mut sum, mut violated) = (0.0, 0);
        for f in self.steiner.planar.topology.faces() {
            self.of_face(f, |term| {
                let value = self.value(term);
                sum += value;
                violated += usize::from(matches!(term, Term::Facing(..)) && value > MARGIN * MARGIN);
            });
        }
        (sum, violated)
    }

    /// What a face adds, term by term.
    fn of_face(&self, f: FaceId, mut add: impl FnMut(Term)) {
        let topology = &self.steiner.planar.topology;
        for e in f.half_edges() {
            let [v, a, b] = [topology.apex(e), topology.origin(e), topology.target(e)];
            add(Term::Size([v, a, b]));
            add(Term::Length([a, b]));
            add(Term::Length([b, a]));
            let Some(t) = self.free_twin(e) else { continue };
            for at in [v, a, b] {
                add(Term::Facing([a, b, v, topology.apex(t)], at));
            }
            for g in [t.next(), t.prev()].into_iter().filter_map(|g| self.free_twin(g)) {
                add(Term::Facing([a, b, v, topology.apex(g)], v));
            }
        }
    }

    fn value(&self, term: Term) -> f64 {
        let (planar, tensors) = (&self.steiner.planar, &self.steiner.tensors);
        let excess = match term {
            Term::Facing(quad, at) => {
                let [a, b, c, d] = quad.map(|v| planar.position(v));
                excess(tensors[at.index()], [a - c, b - c], [b - d, a - d])
            }
            Term::Size(corners) => {
                let circle = circle(tensors[corners[0].index()], corners.map(|v| planar.position(v)));
                circle.map_or(f64::INFINITY, |(_, radius)| radius) / self.largest - 1.0
            }
            Term::Length([a, b]) => 1.0 - tensors[a.index()].length(planar.position(b) - planar.position(a)) / SHORTEST,
        };
        excess.max(0.0).powi(2)
    }

    fn free_twin(&self, h: HalfEdge) -> Option<HalfEdge> {
        let topology = &self.steiner.planar.topology;
        topology.twin(h).filter(|_| !topology.is_fixed(h))
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

    /// What some faces add.
    fn sum(&self, faces: &[FaceId]) -> f64 {
        let mut sum = 0.0;
        for &f in faces {
            self.of_face(f, |term| sum += self.value(term));
        }
        sum
    }

    /// Tries to move each vertex once.
    fn sweep(&mut self) -> Result<()> {
        let all: Vec<VertexId> = self.steiner.planar.topology.vertices().collect();
        for v in all {
            let topology = &self.steiner.planar.topology;
            let is_free = || !topology.is_border_vertex(v) && !topology.star(v).any(|h| topology.is_fixed(h));
            if !self.quiet.0[v.index()] && is_free() {
                self.improve(v)?;
            }
        }
        Ok(())
    }

    /// Moves a vertex to the best of the places tried, of the longest step with which any is better than its own.
    fn improve(&mut self, v: VertexId) -> Result<()> {
        let near = self.near(self.steiner.planar.topology.star(v).map(HalfEdge::face).collect());
        let energy = self.gather(v, &near);
        let from = self.steiner.planar.position(v);
        let tensor = self.steiner.tensors[v.index()];
        let [a, b, c] = tensor.cholesky();
        for step in STEPS.into_iter().filter(|_| energy > 0.0) {
            let mut best = (energy, from, tensor);
            for i in 0..DIRECTIONS {
                let (y, x) = (2.0 * PI * f64::from(i) / f64::from(DIRECTIONS)).sine_and_cosine();
                let to = from + Vector::new((x - b * y / c) / a, y / c) * step;
                if self.steiner.shift(v, to)? {
                    let there = self.there(best.0);
                    if there < best.0 {
                        best = (there, to, self.steiner.tensors[v.index()]);
                    }
                }
            }
            self.steiner.put(v, best.1, best.2);
            if best.0 < energy {
                self.moves += 1;
                self.wake(&near);
                return Ok(());
            }
        }
        self.quiet.0[v.index()] = true;
        Ok(())
    }

    /// Finds the terms that depend on where a vertex is; their sum.
    fn gather(&mut self, v: VertexId, near: &[FaceId]) -> f64 {
        let mut terms = std::mem::take(&mut self.terms);
        terms.clear();
        for &f in near {
            self.of_face(f, |term| {
                if term.touches(v) {
                    terms.push((self.value(term), term));
                }
            });
        }
        terms.sort_by(|a, b| b.0.total_cmp(&a.0));
        self.terms = terms;
        self.terms.iter().map(|term| term.0).sum()
    }

    /// The sum of the gathered terms as things are now; some number that is not less than `most` if it is not less.
    fn there(&self, most: f64) -> f64 {
        let mut sum = 0.0;
        for &(_, term) in &self.terms {
            sum += self.value(term);
            if sum >= most {
                break;
            }
        }
        sum
    }

    fn wake(&mut self, near: &[FaceId]) {
        let topology = &self.steiner.planar.topology;
        self.quiet.wake(near.iter().flat_map(|&f| topology.corners(f)));
    }

    /// Flips edges where that lowers the sum.
    fn flips(&mut self) {
        let all: Vec<HalfEdge> = self.steiner.planar.topology.edges().collect();
        for h in all {
            let Some(t) = self.free_twin(h) else { continue };
            if self.sum(&[h.face(), t.face()]) == 0.0 || !self.steiner.planar.is_convex(h) {
                continue;
            }
            let near = self.near(vec![h.face(), t.face()]);
            let before = self.sum(&near);
            self.steiner.planar.topology.flip(h);
            if self.sum(&near) < before {
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
    // The sum's sine and cosine, both times the same.
    let across = sine * other_cosine + cosine * other_sine;
    let along = cosine * other_cosine - sine * other_sine;
    let is_below = across > 0.0 && (along >= 0.0 || across > TANGENT * -along);
    if is_below || other_sine <= 0.0 {
        return 0.0;
    }
    let angle = across.arctangent_over(along);
    let angle = if angle < 0.0 { angle + 2.0 * PI } else { angle };
    (angle - (PI - MARGIN)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::star_set::Stars;
    use crate::canvas::{COARSE, CanvasCounters, refine};
    use crate::geometry::Point;
    use crate::manifold::domain::Domain;
    use crate::metric::MetricField;
    use crate::planar::Planar;

    /// Cells that are three times as long as wide, along a direction that turns by 1.2 radians for each unit of x.
    fn turning(p: Point) -> Tensor {
        let angle = 1.2 * p.x;
        Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), 100.0, 900.0)
    }

    fn refined(field: &dyn MetricField) -> Planar {
        let square = Domain::shape("rect:0,0,1,1").unwrap();
        let planar =
            refine::refine(square.planar().clone(), field, COARSE, 400, &mut CanvasCounters::default()).unwrap();
        crate::canvas::renumbered(&planar)
    }

    fn inconsistencies(planar: &Planar, field: &dyn MetricField) -> usize {
        Stars::new(Steiner::metric(planar.clone(), field).unwrap()).figures().inconsistencies
    }

    #[test]
    fn moves_leave_fewer_inconsistencies_and_keep_the_boundary() {
        let before = refined(&turning);
        let mut steiner = Steiner::metric(before.clone(), &turning).unwrap();
        let moves = relocate(&mut steiner, 2.0, &mut Quiet::default()).unwrap();
        let after = steiner.planar;
        let counts = [&before, &after].map(|planar| inconsistencies(planar, &turning));
        assert!(moves > 0 && 2 * counts[1] < counts[0], "{moves} moves: {counts:?}");
        assert_eq!(after.topology.vertex_count(), before.topology.vertex_count());
        after.topology.check().unwrap();
        for v in after.topology.vertices() {
            let is_kept = after.position(v) == before.position(v);
            assert!(is_kept || !after.topology.is_border_vertex(v), "{v:?}");
            assert_eq!(steiner.tensors[v.index()], turning(after.position(v)), "{v:?}");
        }
        for f in after.topology.faces() {
            let [a, b, c] = after.triangle(f);
            assert!((b - a).cross(c - a) > 0.0, "{a} {b} {c}");
        }
    }

    #[test]
    fn what_is_quiet_is_not_tried_again_until_it_is_woken() {
        let mut steiner = Steiner::metric(refined(&turning), &turning).unwrap();
        let mut quiet = Quiet(vec![true; steiner.planar.topology.vertex_slots()]);
        let all: Vec<VertexId> = steiner.planar.topology.vertices().collect();
        let mut work =
            Relocation { steiner: &mut steiner, largest: 2.0, quiet: &mut quiet, terms: Vec::new(), moves: 0 };
        work.sweep().unwrap();
        assert_eq!(work.moves, 0);
        work.quiet.wake(all);
        work.sweep().unwrap();
        assert!(work.moves > 0);
    }

    #[test]
    fn angles_are_told_with_and_without_an_arc() {
        let tensor = Tensor::new(2.0, 0.3, 1.0);
        let angle = |u: Vector, v: Vector| (tensor.dot(u, v) / (tensor.length(u) * tensor.length(v))).acos();
        let (a, b, c) = (Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(0.4, 0.5));
        let mut positive = 0;
        for i in 1..400 {
            let d = Point::new(0.6, -0.005 * f64::from(i));
            let sum = angle(a - c, b - c) + angle(b - d, a - d);
            let (expected, got) = ((sum - (PI - MARGIN)).max(0.0), excess(tensor, [a - c, b - c], [b - d, a - d]));
            assert!((got - expected).abs() < 1e-9, "{d}: {got} {expected}");
            positive += usize::from(got > 0.0);
        }
        assert!((50..350).contains(&positive), "{positive}");
    }
}
