//! What polishing works on in the plane: a triangulation and the dual that it was made of, with the metric where vertices were.

use super::Sheet;
use super::frame::Frame;
use crate::dual::{Dual, Kind, Moving};
use crate::geometry::{Jet, Point, Vector, combine, signed_area};
use crate::metric::{Near, ScalarField};
use crate::planar::Planar;
use crate::triangulation::{HalfEdge, Triangulation, VertexId};

/// See the [module](self).
pub(super) struct Flat<'a> {
    dual: &'a Dual<'a>,
    pub(super) planar: Planar,
    function: &'a dyn ScalarField,
}

impl<'a> Flat<'a> {
    pub(super) fn new(dual: &'a Dual<'a>, function: &'a dyn ScalarField) -> Self {
        Self { dual, planar: dual.planar().clone(), function }
    }
}

impl Sheet for Flat<'_> {
    type At = Point;

    fn topology(&self) -> &Triangulation {
        &self.planar.topology
    }

    fn kind(&self, v: VertexId) -> Kind {
        self.dual.kind(v)
    }

    fn places(&self) -> Vec<Point> {
        self.planar.positions.clone()
    }

    fn describe(&self, v: VertexId) -> String {
        self.planar.position(v).to_string()
    }

    fn on_segment(&self, v: VertexId) -> Option<Frame> {
        let here = self.planar.position(v);
        let [a, b] = self.planar.neighbours_on_segment(v)?;
        let share = (here - a).dot(b - a) / (b - a).dot(b - a);
        Some(Frame { segment: Some(([a, b], share)), first: (b - a) * 0.5, second: None })
    }

    fn offset(&self, from: VertexId, to: VertexId) -> Vector {
        self.planar.position(to) - self.planar.position(from)
    }

    fn stepped(&self, v: VertexId, frame: &Frame, [x, y]: [f64; 2]) -> Option<Point> {
        Some(match frame.segment {
            Some(([a, b], share)) => a.lerp(b, share + 0.5 * x),
            None => self.planar.position(v) + frame.first * x + frame.second.unwrap_or_default() * y,
        })
    }

    fn area(&self, [a, b, c]: [Point; 3]) -> f64 {
        0.5 * signed_area(a, b, c)
    }

    fn value(&self, at: Point) -> f64 {
        self.function.value(at)
    }

    fn value_within(&self, corners: [Point; 3], weights: [f64; 3], near: &mut Near) -> f64 {
        self.function.value_near(combine(weights, corners), near)
    }

    fn jet_within(&self, corners: [Point; 3], weights: [f64; 3], frame: &Frame, near: &mut Near) -> Option<Jet> {
        Some(self.function.jet_near(combine(weights, corners), near)?.along(frame.axes()))
    }

    fn shape(&self, vertices: [VertexId; 3], corners: [Point; 3]) -> f64 {
        self.dual.mean_tensor(vertices).shape(corners)
    }

    fn may_flip(&self, h: HalfEdge) -> bool {
        !self.planar.topology.is_fixed(h) && self.planar.is_convex(h)
    }

    fn flip(&mut self, h: HalfEdge) -> bool {
        self.planar.topology.flip(h);
        true
    }

    fn move_vertex(&mut self, v: VertexId, to: Point) -> bool {
        self.planar.move_vertex(v, to)
    }
}
