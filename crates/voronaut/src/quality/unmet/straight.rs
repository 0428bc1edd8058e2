//! Whether straight edges can have unit length where a metric turns.

use super::{Around, is_unit};
use crate::geodesic::{bowed_chord, chord};
use crate::geometry::{Point, Vector};
use crate::metric::MetricField;
use std::f64::consts::FRAC_PI_3;

/// So many ways to lay six triangles around a point are tried, evenly turned against each other.
const TURNS: u32 = 6;

/// Whether no six unit triangles of the metric at the origin, laid around it in any of [`TURNS`] ways, have straight edges
/// that are unit edges of the metric as it varies. Lengths that are not finite do not count as failures: the metric may end
/// there.
pub(super) fn fails(field: &dyn MetricField) -> bool {
    let frame = field.at(Point::default()).cholesky();
    let is_unit = |p: Point, q: Point| {
        let length = chord(field, p, q);
        is_unit(length) || !length.is_finite()
    };
    let fits = |turn: u32| {
        let first = FRAC_PI_3 * f64::from(turn) / f64::from(TURNS);
        let tip = |i: u32| unit(frame, first + FRAC_PI_3 * f64::from(i));
        (0..6).all(|i| is_unit(Point::default(), tip(i)) && is_unit(tip(i), tip(i + 1)))
    };
    !(0..TURNS).any(fits)
}

/// Whether an edge is long, and its geodesic is shorter by the greater part of that, by logarithms.
pub(super) fn bends(around: &Around, length: f64) -> bool {
    let [p, q] = [Point::default() - around.half, Point::default() + around.half];
    let geodesic = bowed_chord(around.field.as_ref(), p, q);
    length > 1.0 && length > geodesic * length.sqrt()
}

/// The tip of a unit vector of a tensor with this Cholesky factor.
fn unit([a, b, c]: [f64; 3], angle: f64) -> Point {
    let (sin, cos) = angle.sin_cos();
    Point::default() + Vector::new(1.0 / a, 0.0) * cos + Vector::new(-b / (a * c), 1.0 / c) * sin
}

pub(super) fn fails1(field: &dyn MetricField) -> bool {
    let frame = field.at(Point::default()).cholesky();
    let fits = |turn: u32| {
        let first = 2.0 * FRAC_PI_3 * f64::from(turn) / f64::from(TURNS);
        let tip = |i: u32| {
            let p = unit(frame, first + 2.0 * FRAC_PI_3 * f64::from(i));
            Point::default() + (p - Point::default()) * (1.0 / 3f64.sqrt())
        };
        (0..3).all(|i| {let l = chord(field, tip(i), tip(i + 1)); is_unit(l) || !l.is_finite()})
    };
    !(0..TURNS).any(fits)
}
