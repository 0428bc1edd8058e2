//! A surface around a place, seen from above as a part of the plane.

use super::metric::SurfaceMetric;
use super::{Input, Place};
use crate::geometry::{Point, Point3, TangentPlane, Tensor, Vector3};
use crate::metric::MetricField;

/// The parallel projection of a surface and its metric along the normal at a place to the plane there, with the place as origin:
/// a metric field of the plane whose geodesics are the projections of the surface's. What works in the plane works in a
/// chart (RR-9103, section 12).
///
/// It is good as far as the surface does not turn away: where its normal has a lesser cosine with the chart's than [`STEEPEST`], it
/// counts as so steep, so that the field is a metric everywhere (at the tip of a spike, in a fold). A coordinate is lifted to the closest place, not straight up: they differ by third order in its size.
pub(crate) struct Chart<'a> {
    input: &'a Input,
    metric: &'a dyn SurfaceMetric,
    at: Place,
    plane: TangentPlane,
}

/// The least cosine of the angle between the normals of a chart and of the surface in it.
pub(crate) const STEEPEST: f64 = 0.2;

impl<'a> Chart<'a> {
    /// The chart at a place, along a unit vector.
    pub(crate) fn new(input: &'a Input, metric: &'a dyn SurfaceMetric, at: Place, normal: Vector3) -> Self {
        Self::in_plane(input, metric, at, TangentPlane::new(normal))
    }

    /// The chart at a place in the coordinates of a plane.
    pub(crate) fn in_plane(input: &'a Input, metric: &'a dyn SurfaceMetric, at: Place, plane: TangentPlane) -> Self {
        Self { input, metric, at, plane }
    }

    /// The coordinates of a point.
    pub(crate) fn flatten(&self, p: Point3) -> Point {
        Point::default() + self.plane.flatten(p - self.at.position)
    }

    /// The place with these coordinates; `None` where the surface cannot be reached.
    pub(crate) fn place(&self, u: Point) -> Option<Place> {
        self.input.lift(&self.at, self.at.position + self.plane.lift(u - Point::default()))
    }

    /// The tensor of a place in the coordinates of the chart.
    pub(crate) fn tensor(&self, place: &Place) -> Tensor {
        let upright = place.normal.dot(self.plane.normal).max(STEEPEST);
        // The tangents of the surface over the two axes.
        let tangent = |axis: Vector3| axis - self.plane.normal * (axis.dot(place.normal) / upright);
        let [u, v] = [self.plane.u, self.plane.v].map(tangent);
        let m = self.metric.at(place);
        Tensor::new(m.dot(u, u), m.dot(u, v), m.dot(v, v))
    }
}

impl MetricField for Chart<'_> {
    fn at(&self, u: Point) -> Tensor {
        self.place(u).map_or(Tensor::new(f64::NAN, f64::NAN, f64::NAN), |place| self.tensor(&place))
    }
}
