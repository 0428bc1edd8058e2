//! A surface around a place, seen from above as a part of the plane; and over a chord, how long what lies there is.

use super::surface::metric::SurfaceMetric;
use super::{Manifold, Place};
use crate::geometry::{Point, Point3, TangentPlane, Tensor, Tensor3, Vector, Vector3};
use crate::metric::{MetricField, Near};
use crate::triangulation::FaceId;

/// The parallel projection of a surface and its metric along the normal at a place to the plane there, with the place as origin:
/// a metric field of the plane whose geodesics are the projections of the surface's. What works in the plane works in a
/// chart (RR-9103, section 12).
///
/// It is good as far as the surface does not turn away: where its normal has a lesser cosine with the chart's than [`STEEPEST`], it
/// counts as so steep, so that the field is a metric everywhere (at the tip of a spike, in a fold).
pub(crate) struct Chart<'a> {
    manifold: &'a Manifold,
    metric: &'a dyn SurfaceMetric,
    at: Place,
    plane: TangentPlane,
}

/// Where [`Manifold::lift_along`] finds nothing: steps in which the place straight above a coordinate is found, at most, and how far aside
/// (share) it may be: each is nearer by the square of the slope.
const STEPS: usize = 6;
const STRAIGHT: f64 = 1e-9;

/// The least cosine of the angle between the normals of a chart and of the surface in it.
pub(crate) const STEEPEST: f64 = 0.2;

impl<'a> Chart<'a> {
    /// The chart at a place, along a unit vector.
    pub(crate) fn new(manifold: &'a Manifold, metric: &'a dyn SurfaceMetric, at: Place, normal: Vector3) -> Self {
        Self::in_plane(manifold, metric, at, TangentPlane::new(normal))
    }

    /// The chart at a place in the coordinates of a plane.
    pub(crate) fn in_plane(
        manifold: &'a Manifold,
        metric: &'a dyn SurfaceMetric,
        at: Place,
        plane: TangentPlane,
    ) -> Self {
        Self { manifold, metric, at, plane }
    }

    /// The unit vector that it looks along.
    pub(crate) fn normal(&self) -> Vector3 {
        self.plane.normal
    }

    /// The coordinates of a point.
    pub(crate) fn flatten(&self, p: Point3) -> Point {
        Point::default() + self.plane.flatten(p - self.at.position)
    }

    /// The place with these coordinates; `None` where the surface cannot be reached.
    pub(crate) fn place(&self, u: Point) -> Option<Place> {
        self.place_near(u, self.at.face)
    }

    /// The same, looked for from a triangle on.
    fn place_near(&self, u: Point, face: FaceId) -> Option<Place> {
        let wanted = u - Point::default();
        let above = |from: Vector| self.at.position + self.plane.lift(from);
        let straight = self.manifold.lift_along(&Place { face, ..self.at }, above(wanted), self.plane.normal, STEEPEST);
        if straight.is_some() {
            return straight;
        }
        let closest = |from: Vector| self.manifold.lift(&self.at, above(from));
        let (mut from, mut place) = (wanted, closest(wanted)?);
        for _ in 0..STEPS {
            let off = wanted - self.plane.flatten(place.position - self.at.position);
            if off.norm() <= STRAIGHT * wanted.norm() {
                break;
            }
            from = from + off;
            place = closest(from)?;
        }
        Some(place)
    }

    /// The tangents of the surface over the two axes.
    fn tangents(&self, place: &Place) -> [Vector3; 2] {
        let upright = place.normal.dot(self.plane.normal).max(STEEPEST);
        [self.plane.u, self.plane.v].map(|axis| axis - self.plane.normal * (axis.dot(place.normal) / upright))
    }

    /// The tangent of the surface over a vector of the chart.
    pub(crate) fn tangent(&self, place: &Place, v: Vector) -> Vector3 {
        let [x, y] = self.tangents(place);
        x * v.x + y * v.y
    }

    /// The tensor of a place in the coordinates of the chart.
    pub(crate) fn tensor(&self, place: &Place) -> Tensor {
        self.seen(place, self.metric.at(place))
    }

    /// A tensor of a place in the coordinates of the chart.
    pub(crate) fn seen(&self, place: &Place, m: Tensor3) -> Tensor {
        let [u, v] = self.tangents(place);
        Tensor::new(m.dot(u, u), m.dot(u, v), m.dot(v, v))
    }
}

impl MetricField for Chart<'_> {
    fn at(&self, u: Point) -> Tensor {
        self.at_near(u, &mut Near::default())
    }

    fn at_near(&self, u: Point, near: &mut Near) -> Tensor {
        let place = self.place_near(u, near.place.map_or(self.at.face, FaceId));
        near.place = place.map(|place| place.face.0);
        place.map_or(Tensor::new(f64::NAN, f64::NAN, f64::NAN), |place| self.tensor(&place))
    }
}

/// A chord of the surface, and what lies over it.
pub(crate) struct Chord {
    /// The direction of the surface over the middle.
    pub along: Vector3,
    /// The direction across the chord that the surface bulges in, as long as the chord.
    pub up: Vector3,
    /// The length by the metric and the direction at each end.
    pub at: [f64; 2],
    /// How much the ends differ in what they say of the directions along and aside.
    pub spread: f64,
}

impl Chord {
    /// The metric length of the way over the chord by Simpson's rule, with the mean of two tensors in the middle: on an
    /// equation's surface along the cubic that the tangent planes at both ends make, of fourth order in the chord's length.
    pub(crate) fn simpson(&self, middle: [Tensor3; 2]) -> f64 {
        let [m, n] = middle.map(|tensor| tensor.length(self.along));
        (self.at[0] + 2.0 * (m + n) + self.at[1]) / 6.0
    }
}

impl Manifold {
    /// The chord between two different places, with the metric there; on a surface of triangles it is the way itself.
    pub(crate) fn chord(&self, [p, q]: [&Place; 2], [m, n]: [Tensor3; 2]) -> Chord {
        let e = q.position - p.position;
        let (up, [slope_p, slope_q]) = self.slopes(p, q, e);
        let at = [m.length(e + up * slope_p), n.length(e + up * slope_q)];
        let aside = e.cross(up);
        let spread = relative(at[0], at[1]).max(relative(m.length(aside), n.length(aside)));
        Chord { along: e + up * (-0.25 * (slope_p + slope_q)), up, at, spread }
    }

    /// The direction across a chord that the surface bulges in, as long as the chord, and the slopes of the surface over it at
    /// both ends; none in the plane of a triangle.
    fn slopes(&self, p: &Place, q: &Place, e: Vector3) -> (Vector3, [f64; 2]) {
        let mean = p.normal + q.normal;
        let square = e.dot(e);
        let across = mean - e * (mean.dot(e) / square);
        let Some(unit) = across.unit() else { return (Vector3::default(), [0.0; 2]) };
        if self.implicit.is_none() {
            return (unit * square.sqrt(), [0.0; 2]);
        }
        let up = unit * square.sqrt();
        (up, [p, q].map(|place| -place.normal.dot(e) / place.normal.dot(up)))
    }
}

fn relative(a: f64, b: f64) -> f64 {
    (a - b).abs() / a.min(b)
}
