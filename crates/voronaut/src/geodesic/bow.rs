//! The length of a short geodesic by its one leading mode of bending.

use super::length::GAUSS;
use super::path_energy;
use crate::geometry::{Point, Vector};
use crate::metric::MetricField;

/// Bows are tried at this share of the chord's length to either side of it.
const TRIAL: f64 = 0.1;
/// Beyond this bow the one mode does not tell the path.
const FAR: f64 = 0.3;
/// Segments of the path that serves then.
const SEGMENTS: usize = 8;

/// Length of the geodesic p-q: the least length of the parabolas through p and q, by quadrature on three of them and on
/// the best of the parabola through their lengths. It is the length of some path, never more than the chord's, and asks
/// nothing of the field's derivatives: kinks do no harm. 20 evaluations of the field.
///
/// To second order in the length geodesics are parabolas; where the best one bows out far, [`path_energy`] answers
/// instead.
pub fn bowed_chord(field: &dyn MetricField, p: Point, q: Point) -> f64 {
    let d = q - p;
    let tensor = field.at(p.midpoint(q));
    // Orthogonal to the chord in the metric at its middle, and of its length there.
    let conjugate = tensor.apply(d).perpendicular();
    let across = conjugate * (tensor.length(d) / tensor.length(conjugate).max(f64::MIN_POSITIVE));
    let length = |bow: f64| parabola(field, p, d, across * bow);
    let [straight, left, right] = [0.0, TRIAL, -TRIAL].map(length);
    let (slope, curvature) = ((left - right) / (2.0 * TRIAL), (left + right - 2.0 * straight) / (TRIAL * TRIAL));
    let best = -slope / curvature;
    if curvature > 0.0 && best.abs() <= FAR {
        return length(best).min(straight);
    }
    let path = path_energy(field, p, q, SEGMENTS).value;
    if path.is_finite() { path.min(straight) } else { straight }
}

/// Length of the path p + t d + 4 t (1 - t) sagitta for t from 0 to 1.
fn parabola(field: &dyn MetricField, p: Point, d: Vector, sagitta: Vector) -> f64 {
    let speed = |&(t, weight): &(f64, f64)| {
        let at = p + (d * t + sagitta * (4.0 * t * (1.0 - t)));
        weight * field.at(at).length(d + sagitta * (4.0 - 8.0 * t))
    };
    GAUSS.iter().map(speed).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodesic::chord;
    use crate::geometry::Tensor;

    #[test]
    fn uniform_metrics_have_straight_geodesics() {
        let field = |_: Point| Tensor::new(7.0, 2.0, 1.5);
        let (p, q) = (Point::new(0.1, 0.2), Point::new(-0.4, 0.9));
        assert!((bowed_chord(&field, p, q) - field(p).length(q - p)).abs() < 1e-15);
    }

    #[test]
    fn half_plane_lengths_are_of_fourth_order() {
        let field = |p: Point| Tensor::isotropic(p.y);
        let error = |h: f64, measure: &dyn Fn(Point, Point) -> f64| {
            let (p, q) = (Point::new(0.0, 1.0), Point::new(h, 1.0 + 0.1 * h));
            let d2 = (q - p).dot(q - p);
            measure(p, q) / (1.0 + d2 / (2.0 * p.y * q.y)).acosh() - 1.0
        };
        let bowed = |p: Point, q: Point| bowed_chord(&field, p, q);
        let [coarse, fine] = [0.8, 0.4].map(|h| error(h, &bowed));
        assert!(fine >= 0.0 && (coarse / fine).log2() > 3.5, "{coarse} {fine}");
        assert!(fine < 0.02 * error(0.4, &|p, q| chord(&field, p, q)));
    }

    #[test]
    fn nonsense_has_a_length_all_the_same() {
        let nan = |_: Point| Tensor::new(f64::NAN, 0.0, 1.0);
        let _ = bowed_chord(&nan, Point::new(0.0, 0.0), Point::new(1.0, 0.0));
        let kinked = |p: Point| Tensor::isotropic(1e-3 + p.x.abs());
        let (p, q) = (Point::new(-1.0, 0.0), Point::new(1.0, 1e-9));
        assert!(bowed_chord(&kinked, p, q) <= chord(&kinked, p, q) * (1.0 + 1e-14));
    }
}
