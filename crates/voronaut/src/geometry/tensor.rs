//! Symmetric 2 x 2 tensors: the metric M of a plane or of a tangent plane.
//!
//! The squared length of a vector e is e' M e; an eigenvalue 1/h^2 asks for edges of Euclidean length h along its
//! eigenvector.

use super::linear::linear;
use super::{Point, Vector, signed_area};
use crate::elementary::Elementary;

/// The symmetric matrix ((xx, xy), (xy, yy)); a metric when positive definite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tensor {
    /// First diagonal entry.
    pub xx: f64,
    /// Off-diagonal entry.
    pub xy: f64,
    /// Second diagonal entry.
    pub yy: f64,
}

/// Eigenvalues of a symmetric tensor, with the unit eigenvector of the larger one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eigen {
    /// The larger eigenvalue.
    pub large: f64,
    /// The smaller eigenvalue.
    pub small: f64,
    /// Unit eigenvector of `large`; that of `small` is [`Vector::perpendicular`] to it.
    pub axis: Vector,
}

/// Numbers whose squares neither overflow nor lose digits.
const SQUARES: std::ops::Range<f64> = 1e-140..1e140;

/// Eigenvalues as their mean and half their difference; of the axis of the larger one the squares of the coordinates, and their
/// product: all rational in the tensor's entries and this radius, so that functions of a tensor need no angle.
#[derive(Clone, Copy)]
struct Spectrum {
    mean: f64,
    radius: f64,
    squares: [f64; 2],
    product: f64,
}

impl Spectrum {
    /// The tensor with these axes and other eigenvalues, the one of the axis first.
    fn with(&self, [along, across]: [f64; 2]) -> Tensor {
        let [x, y] = self.squares;
        Tensor::new(along * x + across * y, (along - across) * self.product, along * y + across * x)
    }
}

linear!(Tensor: xx, xy, yy);

impl Tensor {
    /// The identity: Euclidean length.
    pub const IDENTITY: Tensor = Tensor::new(1.0, 0.0, 1.0);

    /// The tensor with entries m11, m12, m22 (the order of Medit's `.sol` files).
    pub const fn new(xx: f64, xy: f64, yy: f64) -> Self {
        Self { xx, xy, yy }
    }

    /// The tensor that asks for Euclidean size `h` in every direction: identity / h^2.
    pub fn isotropic(h: f64) -> Self {
        Self::new(1.0 / (h * h), 0.0, 1.0 / (h * h))
    }

    /// The tensor with eigenvalue `along` for the unit vector `axis` and `across` for the one perpendicular to it.
    pub(crate) fn from_axis(axis: Vector, along: f64, across: f64) -> Self {
        let (x, y, d) = (axis.x, axis.y, along - across);
        Self::new(across + d * x * x, d * x * y, across + d * y * y)
    }

    /// M v.
    pub(crate) fn apply(self, v: Vector) -> Vector {
        Vector::new(self.xx * v.x + self.xy * v.y, self.xy * v.x + self.yy * v.y)
    }

    /// u' M v.
    pub(crate) fn dot(self, u: Vector, v: Vector) -> f64 {
        u.dot(self.apply(v))
    }

    /// What the tensor says of combinations of two vectors: P' M P with P = (p, q).
    pub(crate) fn along(self, [p, q]: [Vector; 2]) -> Tensor {
        Tensor::new(self.dot(p, p), self.dot(p, q), self.dot(q, q))
    }

    /// v v'.
    pub(crate) fn square(v: Vector) -> Tensor {
        Tensor::new(v.x * v.x, v.x * v.y, v.y * v.y)
    }

    /// u v' + v u'.
    pub(crate) fn symmetric_product(u: Vector, v: Vector) -> Tensor {
        Tensor::new(2.0 * u.x * v.x, u.x * v.y + u.y * v.x, 2.0 * u.y * v.y)
    }

    /// Metric length of a vector: sqrt(v' M v).
    pub fn length(self, v: Vector) -> f64 {
        self.dot(v, v).max(0.0).sqrt()
    }

    /// Determinant, without the cancellation of `xx yy - xy^2` where one eigenvalue is tiny.
    pub(crate) fn determinant(self) -> f64 {
        let product = self.xy * self.xy;
        let rounding = self.xy.mul_add(self.xy, -product);
        self.xx.mul_add(self.yy, -product) - rounding
    }

    /// The inverse; the caller knows that the tensor is not singular.
    #[must_use]
    pub(crate) fn inverse(self) -> Tensor {
        let d = self.determinant();
        Tensor::new(self.yy / d, -self.xy / d, self.xx / d)
    }

    /// The vector that the tensor maps to w; the caller knows that it is not singular.
    pub(crate) fn solve(self, w: Vector) -> Vector {
        Vector::new(self.yy * w.x - self.xy * w.y, self.xx * w.y - self.xy * w.x) * (1.0 / self.determinant())
    }

    /// Whether all entries are finite and both eigenvalues positive.
    pub fn is_positive_definite(self) -> bool {
        self.xx.is_finite()
            && self.xy.is_finite()
            && self.yy.is_finite()
            && self.xx > 0.0
            && self.yy > 0.0
            && self.determinant() > 0.0
    }

    /// Eigenvalues and the axis of the larger one (the x axis where both are equal).
    pub fn eigen(self) -> Eigen {
        let Spectrum { mean, radius, squares: [x, y], product } = self.spectrum();
        let [large, small] = self.eigenvalues(mean, radius);
        // The greater coordinate divides.
        let axis =
            if x >= y { Vector::new(x.sqrt(), product / x.sqrt()) } else { Vector::new(product / y.sqrt(), y.sqrt()) };
        Eigen { large, small, axis }
    }

    fn eigenvalues(self, mean: f64, radius: f64) -> [f64; 2] {
        let large = mean + radius;
        [large, if mean > 0.0 { self.determinant() / large } else { mean - radius }]
    }

    fn spectrum(self) -> Spectrum {
        let (mean, half) = (0.5 * (self.xx + self.yy), 0.5 * (self.xx - self.yy));
        let plain = (half * half + self.xy * self.xy).sqrt();
        let radius = if SQUARES.contains(&plain) { plain } else { half.hypotenuse(self.xy) };
        if radius == 0.0 {
            return Spectrum { mean, radius, squares: [1.0, 0.0], product: 0.0 };
        }
        let product = 0.5 * (self.xy / radius);
        // The squares are (1 +- half / radius) / 2: the smaller one so that nothing cancels.
        let less = product * (self.xy / (radius + half.abs()));
        Spectrum { mean, radius, squares: if half >= 0.0 { [1.0 - less, less] } else { [less, 1.0 - less] }, product }
    }

    /// The symmetric tensor with the same axes and each eigenvalue mapped by `f`.
    #[must_use]
    pub(crate) fn map_eigenvalues(self, f: impl Fn(f64) -> f64) -> Tensor {
        self.map_both_eigenvalues(|both| both.map(f))
    }

    /// The symmetric tensor with the same axes and both eigenvalues, the greater one first, mapped by `f`.
    #[must_use]
    pub(crate) fn map_both_eigenvalues(self, f: impl FnOnce([f64; 2]) -> [f64; 2]) -> Tensor {
        let spectrum = self.spectrum();
        spectrum.with(f(self.eigenvalues(spectrum.mean, spectrum.radius)))
    }

    /// Matrix logarithm of a positive definite tensor.
    #[must_use]
    pub(crate) fn log(self) -> Tensor {
        self.map_eigenvalues(Elementary::logarithm)
    }

    /// Matrix exponential of a symmetric tensor; positive definite.
    #[must_use]
    pub(crate) fn exp(self) -> Tensor {
        if self.xy == 0.0 && self.xx - self.yy == 0.0 {
            let value = self.xx.exponential();
            return Self::new(value, 0.0, value);
        }
        // Not through `map_eigenvalues`: a logarithm is no metric, and its smaller eigenvalue may be negative.
        let spectrum = self.spectrum();
        spectrum.with([spectrum.mean + spectrum.radius, spectrum.mean - spectrum.radius].map(Elementary::exponential))
    }

    /// Log-Euclidean mean: exp of the weighted sum of logarithms. Weights sum to one.
    pub(crate) fn log_mean(weighted: impl IntoIterator<Item = (Tensor, f64)>) -> Tensor {
        weighted.into_iter().fold(Tensor::default(), |sum, (tensor, weight)| sum + tensor.log() * weight).exp()
    }

    /// The rows (a, b), (0, c) of the upper triangular F with F' F = M: F v is v in an orthonormal frame.
    pub(crate) fn cholesky(self) -> [f64; 3] {
        let a = self.xx.sqrt();
        let b = self.xy / a;
        [a, b, (self.determinant() / self.xx).max(0.0).sqrt()]
    }

    /// The columns of F with F' F = M ([`Tensor::cholesky`]), and those of its inverse, in whose coordinates M is the identity.
    pub(crate) fn frames(self) -> [[Vector; 2]; 2] {
        let [a, b, c] = self.cholesky();
        let inverse = [Vector::new(1.0 / a, 0.0), Vector::new(-b / (a * c), 1.0 / c)];
        [[Vector::new(a, 0.0), Vector::new(b, c)], inverse]
    }

    /// 4 sqrt(3) times the area of a straight triangle over the sum of its squared edges, all in this metric: 1 of an equilateral
    /// one, negative of one that is clockwise.
    pub(crate) fn shape(self, [a, b, c]: [Point; 3]) -> f64 {
        let squares: f64 = [b - a, c - b, a - c].iter().map(|&e| self.dot(e, e)).sum();
        2.0 * 3.0_f64.sqrt() * signed_area(a, b, c) * self.determinant().max(0.0).sqrt() / squares
    }

    /// Ratio of the longer to the shorter Euclidean size the tensor asks for: sqrt(large / small), at least 1.
    pub fn anisotropy(self) -> f64 {
        let e = self.eigen();
        (e.large / e.small).sqrt()
    }
}

/// A tangent vector in the orthonormal frame that a tensor's Cholesky factor makes.
pub(crate) fn to_frame([a, b, c]: [f64; 3], v: Vector) -> Vector {
    Vector::new(a * v.x + b * v.y, c * v.y)
}

/// The inverse of [`to_frame`].
pub(crate) fn from_frame([a, b, c]: [f64; 3], w: Vector) -> Vector {
    let y = w.y / c;
    Vector::new((w.x - b * y) / a, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: Tensor, b: Tensor) -> bool {
        let scale = a.xx.abs() + a.yy.abs();
        (a.xx - b.xx).abs() + (a.xy - b.xy).abs() + (a.yy - b.yy).abs() < 1e-12 * scale
    }

    #[test]
    fn exp_undoes_log_at_any_anisotropy() {
        for ratio in [1.0, 10.0, 1e3, 1e6] {
            for step in 0..12 {
                let angle = f64::from(step) * 0.27;
                let m = Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), ratio, 1.0 / ratio);
                assert!(close(m.log().exp(), m), "ratio {ratio}, angle {angle}");
            }
        }
    }

    #[test]
    fn axes_are_those_of_any_angle_and_scale() {
        for scale in [1e-145, 1e-9, 1.0, 1e9, 1e145] {
            for step in 0..40 {
                let angle = f64::from(step) * 0.0786 - std::f64::consts::FRAC_PI_2;
                let axis = Vector::new(angle.cos(), angle.sin());
                let e = Tensor::from_axis(axis, 3.0 * scale, 2.0 * scale).eigen();
                assert!(
                    (e.large / scale - 3.0).abs() < 1e-14 && (e.small / scale - 2.0).abs() < 1e-14,
                    "{scale} {e:?}"
                );
                assert!(e.axis.cross(axis).abs() < 1e-14 && (e.axis.norm() - 1.0).abs() < 1e-15, "{angle} {e:?}");
            }
            assert_eq!((Tensor::IDENTITY * scale).eigen().axis, Vector::new(1.0, 0.0));
        }
    }

    #[test]
    fn cholesky_factor_measures_lengths() {
        let m = Tensor::new(5.0, -2.0, 3.0);
        let [a, b, c] = m.cholesky();
        let v = Vector::new(0.3, -1.7);
        let image = Vector::new(a * v.x + b * v.y, c * v.y);
        assert!((image.norm() - m.length(v)).abs() < 1e-14);
    }

    #[test]
    fn eigenvalues_survive_cancellation() {
        let m = Tensor::from_axis(Vector::new(0.6, 0.8), 1e8, 1e-2);
        let e = m.eigen();
        assert!((e.large / 1e8 - 1.0).abs() < 1e-12);
        assert!((e.small / 1e-2 - 1.0).abs() < 1e-4, "{}", e.small);
    }
}
