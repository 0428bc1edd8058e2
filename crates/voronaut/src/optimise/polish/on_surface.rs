//! What polishing works on on a surface: the mesh in the making there, with the metric where its seeds were at first.

use super::Sheet;
use super::frame::Frame;
use crate::dual::{Kind, Moving, SurfaceDual};
use crate::geometry::{Point3, Seen, Vector, Vector3};
use crate::manifold::Place;
use crate::metric::{Expression, Near};
use crate::triangulation::{HalfEdge, Triangulation, VertexId};

/// Flips make no triangle whose normal has a lesser cosine with those of the surface at its corners, unless one had before.
const UPRIGHT: f64 = 0.5;

/// See the [module](self).
pub(super) struct OnSurface<'a, 'b> {
    dual: &'a mut SurfaceDual<'b>,
    function: &'a Expression,
    /// The metric at seeds, by id.
    seen: Vec<Seen>,
}

/// Where a seed is, or comes to be by a move from where it is.
#[derive(Clone, Copy)]
pub(super) struct Spot {
    position: Point3,
    normal: Vector3,
    by: Vector,
}

impl<'a, 'b> OnSurface<'a, 'b> {
    pub(super) fn new(dual: &'a mut SurfaceDual<'b>, function: &'a Expression) -> Self {
        let seen = |place: &Place| Seen { tensor: dual.metric().at(place), normal: dual.manifold().normal(place) };
        let seen = dual.places().iter().map(seen).collect();
        Self { dual, function, seen }
    }

    fn spot(&self, place: &Place, by: Vector) -> Spot {
        Spot { position: place.position, normal: self.dual.manifold().normal(place), by }
    }

    fn at(&self, p: Point3) -> f64 {
        self.function.at(p.x, p.y, p.z)
    }
}

impl Sheet for OnSurface<'_, '_> {
    type At = Spot;

    fn topology(&self) -> &Triangulation {
        self.dual.topology()
    }

    fn kind(&self, v: VertexId) -> Kind {
        self.dual.kind(v)
    }

    fn places(&self) -> Vec<Spot> {
        self.dual.places().iter().map(|place| self.spot(place, Vector::default())).collect()
    }

    fn describe(&self, v: VertexId) -> String {
        self.dual.places()[v.index()].position.to_string()
    }

    /// Seeds of features stay.
    fn on_segment(&self, _v: VertexId) -> Option<Frame> {
        None
    }

    fn offset(&self, from: VertexId, to: VertexId) -> Vector {
        self.dual.offset(from, to)
    }

    fn stepped(&self, v: VertexId, frame: &Frame, [x, y]: [f64; 2]) -> Option<Spot> {
        let by = frame.first * x + frame.second.unwrap_or_default() * y;
        Some(self.spot(&self.dual.place_after(v, by)?, by))
    }

    fn area(&self, corners: [Spot; 3]) -> f64 {
        let [a, b, c] = corners.map(|corner| corner.position);
        let normal = (b - a).cross(c - a);
        let is_upright = corners.iter().all(|corner| corner.normal.dot(normal) > 0.0);
        if is_upright { 0.5 * normal.norm() } else { 0.0 }
    }

    fn value(&self, at: Spot) -> f64 {
        self.at(at.position)
    }

    /// Where the surface is over the triangle, to second order: over an edge e between normals m and n it is (n - m) . e / 8 away from
    /// the middle. To walk there takes many times as long, and differs by the third order.
    fn value_within(&self, corners: [Spot; 3], weights: [f64; 3], _: &mut Near) -> f64 {
        let flat = Point3::weighted(corners.map(|corner| corner.position), weights);
        let over = |i: usize, j: usize| {
            let (from, to) = (corners[i], corners[j]);
            0.5 * weights[i] * weights[j] * (to.normal - from.normal).dot(to.position - from.position)
        };
        let height = over(0, 1) + over(1, 2) + over(2, 0);
        let normal = corners.iter().zip(weights).fold(Vector3::default(), |sum, (at, weight)| sum + at.normal * weight);
        self.at(flat + normal.unit().unwrap_or_default() * height)
    }

    fn shape(&self, vertices: [VertexId; 3], corners: [Spot; 3]) -> f64 {
        let seen = vertices.map(|v| self.seen[v.index()]);
        let flat = Seen::flattened(corners.map(|corner| corner.position), seen);
        flat.map_or(0.0, |(metric, corners)| metric.shape(corners))
    }

    fn may_flip(&self, h: HalfEdge) -> bool {
        let topology = self.dual.topology();
        let Some([a, b, c, d]) = topology.quad(h).filter(|_| topology.can_flip(h)) else { return false };
        let least = |pair: [[VertexId; 3]; 2]| pair.map(|t| self.dual.upright(t)).into_iter().fold(1.0, f64::min);
        let after = least([[d, b, c], [c, a, d]]);
        after >= UPRIGHT || after >= least([[a, b, c], [b, a, d]])
    }

    fn flip(&mut self, h: HalfEdge) -> bool {
        // Another flip of the round may have joined the same two seeds.
        self.dual.flip_edge(h)
    }

    fn move_vertex(&mut self, v: VertexId, to: Spot) -> bool {
        self.dual.shift_by(v, to.by)
    }
}
