//! Directions in which a vertex can move, with steps and derivatives along them.

use crate::elementary::Elementary;
use crate::geometry::{Jet, Point, Tensor, Vector};

/// Step of the differences that derivatives are taken by, as a share of the neighbours' mean distance.
const STEP: f64 = 0.03;
/// Longest move, in the same unit.
const LONGEST: f64 = 0.5;
/// A second derivative is at least this share of the greatest.
const LEAST_CURVATURE: f64 = 1e-3;

/// One or two directions, of the length of a typical edge that way.
pub(super) struct Frame {
    /// The ends of the segment that a vertex slides along, and where between them it is: steps do not add up their rounding.
    pub(super) segment: Option<([Point; 2], f64)>,
    pub(super) first: Vector,
    pub(super) second: Option<Vector>,
}

impl Frame {
    /// Both directions.
    pub(super) fn axes(&self) -> [Vector; 2] {
        [self.first, self.second.unwrap_or_default()]
    }

    /// Derivatives by differences of values.
    pub(super) fn differences(&self, now: f64, error: impl Fn([f64; 2]) -> f64) -> Jet {
        let h = STEP;
        let both = |two: [f64; 2]| ((two[0] - two[1]) / (2.0 * h), (two[0] - 2.0 * now + two[1]) / (h * h));
        let (right, left) = (error([h, 0.0]), error([-h, 0.0]));
        let (x, xx) = both([right, left]);
        if self.second.is_none() {
            return Jet { value: now, gradient: Vector::new(x, 0.0), hessian: Tensor::new(xx, 0.0, 0.0) };
        }
        let (up, down) = (error([0.0, h]), error([0.0, -h]));
        let (y, yy) = both([up, down]);
        let corners = error([h, h]) + error([-h, -h]);
        let xy = (corners - right - left - up - down + 2.0 * now) / (2.0 * h * h);
        Jet { value: now, gradient: Vector::new(x, y), hessian: Tensor::new(xx, xy, yy) }
    }

    /// The step to the minimum of a quadratic, made convex where it is not.
    pub(super) fn newton(&self, Jet { gradient, hessian, .. }: Jet) -> Option<[f64; 2]> {
        let step = match self.second {
            Some(_) => descent(gradient, hessian)?,
            None => [-gradient.x / hessian.xx.abs(), 0.0],
        };
        let length = step[0].hypotenuse(step[1]);
        let share = (LONGEST / length).min(1.0);
        length.is_finite().then(|| step.map(|s| s * share))
    }
}

/// Minus the inverse of a symmetric matrix, of which eigenvalues count by their size, times a gradient. `None` where that is
/// not finite.
fn descent(Vector { x: gx, y: gy }: Vector, Tensor { xx, xy, yy }: Tensor) -> Option<[f64; 2]> {
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let radius = half.hypotenuse(xy);
    let (sine, cosine) = (0.5 * xy.arctangent_over(half)).sine_and_cosine();
    let [large, small] = [mean + radius, mean - radius].map(f64::abs);
    let least = LEAST_CURVATURE * large.max(small);
    let along = -(gx * cosine + gy * sine) / large.max(least);
    let across = -(gy * cosine - gx * sine) / small.max(least);
    let step = [along * cosine - across * sine, along * sine + across * cosine];
    step.iter().all(|s| s.is_finite()).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_minimum_of_a_quadratic_is_found_at_once() {
        let (first, second) = (Vector::new(1.0, 0.0), Some(Vector::new(0.0, 1.0)));
        let frame = Frame { segment: None, first, second };
        let error = |[x, y]: [f64; 2]| 3.0 * (x - 0.1).powi(2) + 2.0 * (x - 0.1) * (y + 0.2) + (y + 0.2).powi(2);
        let [x, y] = frame.newton(frame.differences(error([0.0, 0.0]), error)).unwrap();
        assert!((x - 0.1).abs() < 1e-9 && (y + 0.2).abs() < 1e-9, "{x} {y}");
    }

    #[test]
    fn where_it_is_not_convex_the_step_goes_downhill() {
        let [x, y] = descent(Vector::new(1.0, -2.0), Tensor::new(-3.0, 0.5, -1.0)).unwrap();
        assert!(x - 2.0 * y < 0.0, "{x} {y}");
        assert_eq!(descent(Vector::new(1.0, f64::NAN), Tensor::IDENTITY), None);
        assert_eq!(descent(Vector::default(), Tensor::default()), None);
    }
}
