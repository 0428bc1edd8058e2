//! Riemannian centres of mass, and with them Riemannian simplices (Rouxel-Labbé et al. 2017, section 10.1).

use super::path::{Fineness, Paths};
use crate::geometry::{Point, Tensor, Vector};
use crate::metric::MetricField;

/// Steps at most; ten are many.
const STEPS: usize = 40;
/// A step shorter than this share of the corners' root mean square distance is the last.
const SETTLED: f64 = 1e-8;
/// A step that does not lower the energy is halved so often.
const HALVINGS: usize = 12;
/// What the energy may seem to rise by its rounding, as a share.
const ROUNDING: f64 = 1e-9;

/// The point of a Riemannian triangle with these barycentric coordinates: the Karcher mean (Karcher 1977), where the sum of
/// the squared distances to the corners, times the weights, is least.
///
/// Weights must not be negative; their sum does not matter, but for being positive (the report asks that they be at least
/// 1: they are to be at least 0). Distances are lengths of geodesics found from their chords ([`Paths::length`]),
/// which know no domain. Since the field's derivatives are differences, the mean is good to about 1e-6 of the triangle's size,
/// or 1e-5 where the field turns around over that size. By quasi-Newton steps from the affine mean, each with three
/// geodesics; it is found where the corners are within a convex ball (for curvature K > 0 of radius less than pi / (4 sqrt K)), and often
/// beyond.
///
/// `None` where the weights are none, the field is no metric on the way, or the steps lead nowhere.
pub(crate) fn karcher_mean(
    paths: &Paths,
    field: &dyn MetricField,
    corners: [Point; 3],
    weights: [f64; 3],
    fineness: Fineness,
) -> Option<Point> {
    let sum: f64 = weights.iter().sum();
    let is_weight = |w: &f64| *w >= 0.0;
    if !(weights.iter().all(is_weight) && sum > 0.0 && sum.is_finite()) {
        return None;
    }
    if let [only] = *(0..3).filter(|&i| weights[i] > 0.0).collect::<Vec<_>>() {
        return Some(corners[only]);
    }
    let mass = Mass { paths, field, corners, weights: weights.map(|w| w / sum), fineness };
    mass.centre()
}

/// Weighted points.
struct Mass<'a> {
    paths: &'a Paths,
    field: &'a dyn MetricField,
    corners: [Point; 3],
    weights: [f64; 3],
    fineness: Fineness,
}

impl Mass<'_> {
    fn centre(&self) -> Option<Point> {
        let [a, b, c] = self.corners;
        let mut at = a + ((b - a) * self.weights[1] + (c - a) * self.weights[2]);
        let (mut energy, mut slope) = self.energy(at)?;
        // Where the slope vanishes the second derivative is the tensor, up to curvature.
        let mut inverse = self.field.at(at).inverse();
        for _ in 0..STEPS {
            let step = -inverse.apply(slope);
            if self.field.at(at).length(step) <= SETTLED * (2.0 * energy).sqrt() {
                return Some(at + step);
            }
            let (share, next) = self.lower(at, step, energy)?;
            let (s, y) = (step * share, next.1 - slope);
            inverse = updated(inverse, s, y);
            at = at + s;
            (energy, slope) = next;
        }
        None
    }

    /// Half the mean squared distance, and its derivative.
    fn energy(&self, x: Point) -> Option<(f64, Vector)> {
        let (mut energy, mut slope) = (0.0, Vector::default());
        for (&corner, &weight) in self.corners.iter().zip(&self.weights) {
            if corner != x && weight > 0.0 {
                let spoke = self.paths.solve(self.field, x, corner, self.fineness)?;
                energy += 0.5 * weight * spoke.length.value.powi(2);
                slope = slope + spoke.pull * weight;
            }
        }
        Some((energy, slope))
    }

    /// As much of a step as lowers the energy, and what it leads to.
    fn lower(&self, from: Point, step: Vector, energy: f64) -> Option<(f64, (f64, Vector))> {
        let shares = std::iter::successors(Some(1.0), |share| Some(0.5 * share)).take(HALVINGS);
        let tried = shares.map(|share| (share, self.energy(from + step * share)));
        tried.filter_map(|(share, found)| Some((share, found?))).find(|(_, found)| found.0 <= energy * (1.0 + ROUNDING))
    }
}

/// The inverse of a second derivative after a step s along which the slope changed by y (the update of Broyden, Fletcher,
/// Goldfarb and Shanno); as before where the slope fell.
fn updated(inverse: Tensor, s: Vector, y: Vector) -> Tensor {
    let sy = s.dot(y);
    let hy = inverse.apply(y);
    let outer = |u: Vector, v: Vector| Tensor::new(u.x * v.x, 0.5 * (u.x * v.y + u.y * v.x), u.y * v.y);
    let next = inverse + outer(s, s) * ((sy + y.dot(hy)) / (sy * sy)) + outer(hy, s) * (-2.0 / sy);
    if sy > 0.0 && next.is_positive_definite() { next } else { inverse }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(field: &dyn MetricField, corners: [Point; 3], weights: [f64; 3]) -> Point {
        karcher_mean(&Paths::default(), field, corners, weights, Fineness::FINEST).unwrap()
    }

    #[test]
    fn flat_space_has_affine_means() {
        let pi = std::f64::consts::PI;
        let phi = |p: Point| Point::new(0.2 * p.x, p.y + 0.25 * (pi * p.x).sin());
        let field = |p: Point| {
            let a = 0.25 * pi * (pi * p.x).cos();
            Tensor::new(0.04 + a * a, a, 1.0)
        };
        let corners = [(-0.4, 0.0), (0.7, 0.1), (0.1, 0.3)].map(|(x, y)| Point::new(x, y));
        for weights in [[1.0, 1.0, 1.0], [0.2, 0.5, 0.3], [3.0, 1.0, 0.0], [0.0, 0.05, 0.95]] {
            let sum: f64 = weights.iter().sum();
            let image = corners.map(phi);
            let exact =
                image[0] + ((image[1] - image[0]) * weights[1] + (image[2] - image[0]) * weights[2]) * (1.0 / sum);
            let found = phi(mean(&field, corners, weights));
            assert!(found.distance(exact) < 2e-5, "{weights:?} {found} {exact}");
        }
    }

    #[test]
    fn nonsense_has_no_mean_and_corners_are_their_own() {
        let corners = [(0.0, 1.0), (1.0, 1.0), (0.5, 2.0)].map(|(x, y)| Point::new(x, y));
        let field = |p: Point| Tensor::isotropic(p.y);
        assert_eq!(mean(&field, corners, [0.0, 2.0, 0.0]), corners[1]);
        let nan = |_: Point| Tensor::new(f64::NAN, 0.0, 1.0);
        let paths = Paths::default();
        assert!(karcher_mean(&paths, &nan, corners, [1.0; 3], Fineness::MIDDLE).is_none());
        for weights in [[-0.1, 0.6, 0.5], [0.0; 3], [f64::NAN, 1.0, 1.0], [f64::INFINITY, 1.0, 0.0]] {
            assert!(karcher_mean(&paths, &field, corners, weights, Fineness::MIDDLE).is_none(), "{weights:?}");
        }
    }
}
