//! Circles and powers by expansions of the metric, for seeds that come, go and move.

use super::Terrain;
use crate::dual::{Dual, Moving};
use crate::geodesic::{LocalMetric, chord, equalising_step, flat_centre, hermite};
use crate::geometry::{Point, Tensor};
use crate::lists::distinct;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};

/// Newton steps at most to a circumcentre, and the residue (share of the squared radius) at which they end.
const STEPS: usize = 6;
const RESIDUE: f64 = 1e-3;

/// A circle whose centre is known with the metric around it.
#[derive(Clone, Copy, Debug)]
struct Around {
    centre: Point,
    local: LocalMetric,
    square: f64,
}

/// Power protection of a triangulation's simplices, estimated: a few dozen evaluations of the field a triangle.
#[derive(Clone, Copy)]
pub(crate) struct Estimate<'a> {
    /// The field, in units of about an edge, and the domain.
    pub terrain: &'a dyn Terrain,
    /// The triangulation.
    pub topology: &'a Triangulation,
    /// Where seeds are, by id.
    pub positions: &'a [Point],
    /// The metric around each.
    pub locals: &'a [LocalMetric],
}

impl<'a> Estimate<'a> {
    /// Of a dual's own triangulation.
    pub(crate) fn of(dual: &'a Dual) -> Self {
        Self { terrain: dual, topology: dual.topology(), positions: &dual.planar().positions, locals: dual.locals() }
    }

    /// By how much simplices miss a power `asked` of all seeds near them, each as a share of it (above one where the
    /// triangle is not Delaunay), summed over interior triangles and border edges among faces.
    pub(crate) fn shortfall(&self, faces: &[FaceId], asked: impl Fn(VertexId) -> f64) -> f64 {
        faces.iter().map(|&f| self.of_face(f, None, &asked)).sum()
    }

    /// By how much the seed's own triangles miss a power `asked`, and those others among faces that have too little of it
    /// because of this seed.
    pub(crate) fn shortfall_of(&self, v: VertexId, faces: &[FaceId], asked: f64) -> f64 {
        faces.iter().map(|&f| self.of_face(f, Some(v), &|_| asked)).sum()
    }

    /// The faces at a seed and at its neighbours, each once, in order.
    pub(crate) fn around(&self, v: VertexId) -> Vec<FaceId> {
        let star = |u| self.topology.star(u).map(HalfEdge::face);
        distinct(self.neighbours(&[v]).into_iter().chain([v]).flat_map(star))
    }

    /// The interior triangles and border edges, by a face that has them, that miss a power `asked`.
    pub(crate) fn short_faces(&self, asked: f64) -> Vec<FaceId> {
        let is_short = |&f: &FaceId| self.of_face(f, None, &|_| asked) > 0.0;
        self.topology.faces().filter(is_short).collect()
    }

    /// The circumcentre of a face, and the squared radius.
    pub(crate) fn circle(&self, f: FaceId) -> Option<(Point, f64)> {
        self.of_triangle(self.topology.corners(f)).map(|circle| (circle.centre, circle.square))
    }

    /// Of a face's triangle and those of its sides that lie on the border.
    fn of_face(&self, f: FaceId, only: Option<VertexId>, asked: &impl Fn(VertexId) -> f64) -> f64 {
        let topology = self.topology;
        let corners = topology.corners(f);
        let of_border = |h: HalfEdge| {
            let ends = topology.ends(h);
            self.middle(ends).map_or(0.0, |circle| self.missing(&circle, &ends, only, asked))
        };
        let is_border = |h: &HalfEdge| self.terrain.is_whole() && topology.twin(*h).is_none();
        let sides = f.half_edges().into_iter().filter(is_border);
        let border: f64 = sides.map(of_border).sum();
        border
            + match self.of_triangle(corners) {
                Some(circle) if !self.terrain.is_inside(corners[0].0, circle.centre) => 0.0,
                Some(circle) => self.missing(&circle, &corners, only, asked),
                None => f64::from(u8::from(self.seems_interior(corners))),
            }
    }

    /// The share of the power asked for that a circle misses; with `only`, of circles that do not touch that seed only the
    /// power of it counts.
    fn missing(
        &self,
        circle: &Around,
        corners: &[VertexId],
        only: Option<VertexId>,
        asked: &impl Fn(VertexId) -> f64,
    ) -> f64 {
        let asked = corners.iter().map(|&v| asked(v)).fold(0.0, f64::max);
        let miss = |v: VertexId| (1.0 - self.power(circle, v) / asked).max(0.0);
        match only.filter(|v| !corners.contains(v)) {
            Some(v) => miss(v),
            None => self.neighbours(corners).into_iter().map(miss).fold(0.0, f64::max),
        }
    }

    /// The seeds that share an edge with one of these, without these.
    fn neighbours(&self, corners: &[VertexId]) -> Vec<VertexId> {
        let topology = self.topology;
        // At the border the last neighbour is the apex of the last face.
        let around = |&v: &VertexId| topology.around(v);
        distinct(corners.iter().flat_map(around).filter(|v| !corners.contains(v)))
    }

    fn power(&self, circle: &Around, v: VertexId) -> f64 {
        self.square(circle.centre, &circle.local, v) - circle.square
    }

    /// The squared distance of a seed; by quadrature along the chord where the metric is rough.
    fn square(&self, p: Point, local: &LocalMetric, v: VertexId) -> f64 {
        let (q, at_q) = (self.position(v), self.local(v));
        let length = if local.is_rough || at_q.is_rough {
            chord(self.terrain.field(), p, q)
        } else {
            hermite(p, local, q, at_q).value
        };
        length * length
    }

    fn position(&self, v: VertexId) -> Point {
        self.positions[v.index()]
    }

    fn local(&self, v: VertexId) -> &LocalMetric {
        &self.locals[v.index()]
    }

    fn tensor(&self, corners: [VertexId; 3]) -> Tensor {
        corners.iter().fold(Tensor::default(), |sum, &v| sum + self.local(v).tensor) * (1.0 / 3.0)
    }

    fn of_triangle(&self, corners: [VertexId; 3]) -> Option<Around> {
        let mut centre = flat_centre(self.tensor(corners), corners.map(|v| self.position(v)))?;
        for _ in 0..STEPS {
            let local = LocalMetric::at(self.terrain.field(), centre);
            if !local.tensor.is_positive_definite() {
                return None;
            }
            let squares = corners.map(|v| self.square(centre, &local, v));
            let [least, most] = squares.iter().fold([f64::INFINITY, 0.0], |[a, b], &s| [a.min(s), b.max(s)]);
            if most - least < RESIDUE * most {
                return Some(Around { centre, local, square: squares.iter().sum::<f64>() / 3.0 });
            }
            let pulls = corners.map(|v| -local.tensor.apply(local.log(self.position(v) - centre)));
            centre = centre + equalising_step(local.tensor, pulls, squares)?;
        }
        None
    }

    /// Whether the circumcentre with one tensor is in the domain.
    fn seems_interior(&self, corners: [VertexId; 3]) -> bool {
        let flat = flat_centre(self.tensor(corners), corners.map(|v| self.position(v)));
        flat.is_some_and(|centre| self.terrain.is_inside(corners[0].0, centre))
    }

    /// The circle around the point of a border edge that is equally far from its ends, by two secant steps.
    fn middle(&self, ends: [VertexId; 2]) -> Option<Around> {
        let [a, b] = ends.map(|v| self.position(v));
        let at = |t: f64| {
            let centre = a.lerp(b, t);
            let local = LocalMetric::at(self.terrain.field(), centre);
            let [to_a, to_b] = ends.map(|v| self.square(centre, &local, v));
            (Around { centre, local, square: 0.5 * (to_a + to_b) }, to_a - to_b)
        };
        let (half, at_half) = at(0.5);
        // The difference of two squared distances is nearly linear, and the distances at the middle tell its slope.
        let t = 0.5 - at_half / (8.0 * half.square);
        let (circle, left) = at(t.clamp(0.05, 0.95));
        (left.abs() < circle.square).then_some(circle)
    }
}
