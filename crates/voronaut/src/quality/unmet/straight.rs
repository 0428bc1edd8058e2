//! Whether straight edges can have unit length where a metric turns.

use super::super::metric_quality::edge_length;
use super::{Around, is_unit};
use crate::geodesic::bowed_chord;
use crate::geometry::{Point, Vector};
use crate::metric::MetricField;
use std::f64::consts::FRAC_PI_3;

/// From the middle of a unit triangle to its corners.
const FRAC_1_SQRT_3: f64 = 0.577_350_269_189_625_8;

/// So many ways to lay a triangle around a point are tried, evenly turned against each other.
const TURNS: u32 = 6;

/// Whether no unit triangle of the metric at the origin, laid around it in any of [`TURNS`] ways, has straight edges that are
/// unit edges of the metric as it varies. Edges along which there is no metric do not count as failures: it may end with the domain.
pub(super) fn fails(field: &dyn MetricField) -> bool {
    let frame = field.at(Point::default()).cholesky();
    let is_unit = |p: Point, q: Point| edge_length([p, q], field).map_or(true, is_unit);
    let third = 2.0 * FRAC_PI_3;
    let fits = |turn: u32| {
        let first = third * f64::from(turn) / f64::from(TURNS);
        let [a, b, c] = [0.0, 1.0, 2.0].map(|i| tip(frame, FRAC_1_SQRT_3, first + third * i));
        is_unit(a, b) && is_unit(b, c) && is_unit(c, a)
    };
    !(0..TURNS).any(fits)
}

/// Whether an edge is long, and its geodesic is shorter by the greater part of that, by logarithms.
pub(super) fn bends(around: &Around, length: f64) -> bool {
    let [p, q] = [Point::default() - around.half, Point::default() + around.half];
    let geodesic = bowed_chord(around.field.as_ref(), p, q);
    length > 1.0 && length > geodesic * length.sqrt()
}

/// The tip of a vector from the origin whose length is given in the metric of a tensor, by its Cholesky factor.
fn tip([a, b, c]: [f64; 3], length: f64, angle: f64) -> Point {
    let (sin, cos) = angle.sin_cos();
    Point::default() + (Vector::new(1.0 / a, 0.0) * cos + Vector::new(-b / (a * c), 1.0 / c) * sin) * length
}
