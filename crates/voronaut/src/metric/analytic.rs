//! Metric fields in closed form: uniform, and the planar fields of RR-9103, section 15.

use super::MetricField;
use super::validate::{check_tensor_at, require};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geometry::{Point, Tensor, Vector};

/// The same tensor everywhere; the identity by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uniform(pub Tensor);

/// The swirl (RR-9103, 15.3): long cells along a spiral around the origin.
///
/// With r the distance to the origin, p the point turned by the angle `nu` and t = (1 - r^2)^2, cells are long along
/// v1 = unit(t p + p turned by 90 degrees). Sizes along v1 are given by [`SwirlField`]; across they are 1. At the
/// origin, where v1 has no limit, both fields tend to the identity, which is their value there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swirl {
    /// The angle by which the point is turned, in radians: the same everywhere; 3 in the report.
    pub nu: f64,
    /// Which of the two published fields.
    pub field: SwirlField,
}

/// The report's swirl as its authors compute it, or as it is printed: the two differ (erratum 15.3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SwirlField {
    /// The authors' code: M = v1 v1' / (a + 1) + v2 v2', a = |50 (1 - (f - 1)^2)|, f = (cbrt(r) + r) / 2. Sizes along
    /// v1 reach sqrt(51) at r = 1.
    #[default]
    Authors,
    /// The report, made finite: M = l^2 v1 v1' + v2 v2', l = 1 / |50 (1 - (f - 1)^2)| clamped to 1/50 ..= 1,
    /// f = (cbrt(r) + sqrt(r)) / 2. Sizes along v1 reach 50 at r = 1.
    Printed,
}

/// The hyperbolic shock (RR-9103, 15.2, corrected: as printed, cells are long along the gradient): cells are thin along
/// the gradient of E(x, y) = tanh((2 x - sin 5 y) / lambda) + x^3 + x y^2.
///
/// M = F' F with F = U diag(1 + phi |grad E|, 1) U' and grad E along U's first column; the identity where grad E = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shock {
    /// How strongly the gradient thins cells; 0 gives the identity.
    pub phi: f64,
    /// The width of the shock.
    pub lambda: f64,
}

impl Default for Uniform {
    fn default() -> Self {
        Self(Tensor::IDENTITY)
    }
}

impl Default for Swirl {
    fn default() -> Self {
        Self { nu: 3.0, field: SwirlField::Authors }
    }
}

impl Default for Shock {
    fn default() -> Self {
        Self { phi: 10.0, lambda: 0.6 }
    }
}

impl Uniform {
    /// Whether the tensor is a metric.
    ///
    /// # Errors
    /// [`Error::Metric`](crate::Error::Metric).
    pub(crate) fn check(&self) -> Result<()> {
        check_tensor_at(self.0, || "every point".into())
    }
}

impl Swirl {
    /// Whether the angle is finite.
    ///
    /// # Errors
    /// [`Error::Parse`](crate::Error::Parse).
    pub(crate) fn check(&self) -> Result<()> {
        require(self.nu.is_finite(), "metric swirl", "nu", self.nu, "finite")
    }
}

impl Shock {
    /// Whether `phi` is not negative, `lambda` positive, and both finite.
    ///
    /// # Errors
    /// [`Error::Parse`](crate::Error::Parse) that names the parameter.
    pub(crate) fn check(&self) -> Result<()> {
        let place = "metric shock";
        require(self.phi.is_finite() && self.phi >= 0.0, place, "phi", self.phi, "finite and at least 0")?;
        require(self.lambda.is_finite() && self.lambda > 0.0, place, "lambda", self.lambda, "finite and positive")
    }

    /// The gradient of E.
    fn gradient(&self, p: Point) -> Vector {
        let (sin, cos) = (5.0 * p.y).sine_and_cosine();
        // 1 / cosh^2, which keeps its digits where 1 - tanh^2 has lost them.
        let decay = (-2.0 * ((2.0 * p.x - sin) / self.lambda).abs()).exponential();
        let slope = 4.0 * decay / ((1.0 + decay).powi(2) * self.lambda);
        Vector::new(2.0 * slope + 3.0 * p.x * p.x + p.y * p.y, -5.0 * cos * slope + 2.0 * p.x * p.y)
    }
}

impl SwirlField {
    /// The eigenvalue along v1 at distance `r` from the origin.
    fn along(self, r: f64) -> f64 {
        match self {
            SwirlField::Authors => 1.0 / (stretch(r.cube_root().midpoint(r)) + 1.0),
            SwirlField::Printed => (1.0 / stretch(r.cube_root().midpoint(r.sqrt()))).clamp(1.0 / 50.0, 1.0).powi(2),
        }
    }
}

impl MetricField for Uniform {
    fn at(&self, _p: Point) -> Tensor {
        self.0
    }
}

impl MetricField for Swirl {
    fn at(&self, p: Point) -> Tensor {
        let r = p.x.hypotenuse(p.y);
        if r == 0.0 {
            return Tensor::IDENTITY;
        }
        let (s, c) = self.nu.sine_and_cosine();
        let (x, y) = (p.x / r, p.y / r);
        let turned = Vector::new(x * c - y * s, x * s + y * c);
        let t = (1.0 - r * r).powi(2);
        let v1 = (turned * t + turned.perpendicular()) * (1.0 / t.hypotenuse(1.0));
        Tensor::from_axis(v1, self.field.along(r), 1.0)
    }
}

impl MetricField for Shock {
    fn at(&self, p: Point) -> Tensor {
        let gradient = self.gradient(p);
        let norm = gradient.norm();
        if norm == 0.0 {
            return Tensor::IDENTITY;
        }
        Tensor::from_axis(gradient * (1.0 / norm), (1.0 + self.phi * norm).powi(2), 1.0)
    }
}

/// |50 (1 - (f - 1)^2)|
fn stretch(f: f64) -> f64 {
    (50.0 * (1.0 - (f - 1.0).powi(2))).abs()
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact results are the point")]
mod tests {
    use super::*;

    fn points() -> impl Iterator<Item = Point> {
        (0..400).map(|i| {
            let i = f64::from(i);
            Point::new(2.0 * (1.7 * i).sin(), 2.0 * (2.3 * i + 1.0).cos())
        })
    }

    fn distance(a: Tensor, b: Tensor) -> f64 {
        (a.xx - b.xx).abs().max((a.xy - b.xy).abs()).max((a.yy - b.yy).abs())
    }

    /// The field written out once more, entry by entry, from the contract's line.
    fn swirl_by_the_letter(nu: f64, printed: bool, x: f64, y: f64) -> Tensor {
        let (c, s) = (nu.cos(), nu.sin());
        let (px, py) = (x * c - y * s, x * s + y * c);
        let r = (x * x + y * y).sqrt();
        let t = (1.0 - r * r) * (1.0 - r * r);
        let (vx, vy) = (-py + t * px, px + t * py);
        let n2 = vx * vx + vy * vy;
        let f = 0.5 * r.powf(1.0 / 3.0) + 0.5 * if printed { r.sqrt() } else { r };
        let a = (50.0 * (1.0 - (f - 1.0) * (f - 1.0))).abs();
        let e = if printed { (1.0 / a).clamp(0.02, 1.0).powi(2) } else { 1.0 / (a + 1.0) };
        Tensor::new((e * vx * vx + vy * vy) / n2, (e * vx * vy - vx * vy) / n2, (e * vy * vy + vx * vx) / n2)
    }

    #[test]
    fn swirl_is_the_contract_s_formula() {
        for p in points() {
            for (field, printed) in [(SwirlField::Authors, false), (SwirlField::Printed, true)] {
                for nu in [3.0, 0.4] {
                    let truth = swirl_by_the_letter(nu, printed, p.x, p.y);
                    assert!(distance(Swirl { nu, field }.at(p), truth) < 1e-12, "{field:?} {nu} {p}");
                }
            }
        }
    }

    #[test]
    fn swirl_stretches_as_published_at_radius_one() {
        let p = Point::new(0.6, 0.8);
        let [authors, printed] =
            [SwirlField::Authors, SwirlField::Printed].map(|field| Swirl { nu: 3.0, field }.at(p).anisotropy());
        assert!((authors - 51f64.sqrt()).abs() < 1e-9, "{authors}");
        assert!((printed - 50.0).abs() < 1e-7, "{printed}");
    }

    #[test]
    fn swirl_is_continuous_at_the_origin() {
        for field in [SwirlField::Authors, SwirlField::Printed] {
            let swirl = Swirl { nu: 3.0, field };
            assert_eq!(swirl.at(Point::default()), Tensor::IDENTITY);
            for r in [1e-300, 1e-40, 1e-18] {
                let near = swirl.at(Point::new(-0.6 * r, 0.8 * r));
                assert!(distance(near, Tensor::IDENTITY) < 1e2 * r.cbrt() + 1e-12, "{field:?} {r} {near:?}");
            }
        }
    }

    #[test]
    fn swirl_turns_with_the_point() {
        // The field commutes with rotations: M(R p) = R M(p) R'.
        let swirl = Swirl::default();
        let (c, s) = (0.8, 0.6);
        for p in points() {
            let m = swirl.at(p);
            let turned = swirl.at(Point::new(c * p.x - s * p.y, s * p.x + c * p.y));
            let v = Vector::new(0.3, -0.9);
            let w = Vector::new(c * v.x - s * v.y, s * v.x + c * v.y);
            assert!((m.length(v) - turned.length(w)).abs() < 1e-12, "{p}");
        }
    }

    #[test]
    fn shock_is_thin_along_the_finite_difference_gradient() {
        let shock = Shock { phi: 10.0, lambda: 0.6 };
        let e = |x: f64, y: f64| ((2.0 * x - (5.0 * y).sin()) / 0.6).tanh() + x.powi(3) + x * y * y;
        let h = 1e-5;
        for p in points() {
            let gradient = Vector::new(
                (e(p.x + h, p.y) - e(p.x - h, p.y)) / (2.0 * h),
                (e(p.x, p.y + h) - e(p.x, p.y - h)) / (2.0 * h),
            );
            let norm = gradient.norm();
            let unit = gradient * (1.0 / norm);
            let m = shock.at(p);
            let truth = 1.0 + 10.0 * norm;
            assert!((m.length(unit) / truth - 1.0).abs() < 1e-6, "{p}");
            assert!((m.determinant().sqrt() / truth - 1.0).abs() < 1e-6, "{p}");
            assert!(m.dot(unit, unit.perpendicular()).abs() < 1e-4 * truth * truth, "{p}");
        }
    }

    #[test]
    fn shock_is_symmetric_under_the_half_turn_and_plain_without_phi() {
        // E is odd under (x, y) -> (-x, -y), so its gradient is even.
        for p in points() {
            let shock = Shock::default();
            assert!(distance(shock.at(p), shock.at(Point::new(-p.x, -p.y))) < 1e-9 * shock.at(p).xx);
            assert!(distance(Shock { phi: 0.0, ..shock }.at(p), Tensor::IDENTITY) < 1e-15);
        }
    }

    #[test]
    fn shock_far_out_is_finite() {
        let shock = Shock { phi: 1.0, lambda: 1e-3 };
        assert!(shock.at(Point::new(50.0, -3.0)).is_positive_definite());
        assert_eq!(Shock { phi: 1.0, lambda: 1e-9 }.at(Point::new(0.0, 1.0)).xy, 0.0);
    }

    #[test]
    fn bad_parameters_are_named() {
        let shock = Shock::default();
        for (result, message) in [
            (Swirl { nu: f64::NAN, ..Swirl::default() }.check(), "metric swirl: nu = NaN"),
            (Shock { phi: -1.0, ..shock }.check(), "metric shock: phi = -1"),
            (Shock { lambda: 0.0, ..shock }.check(), "metric shock: lambda = 0"),
            (
                Uniform(Tensor::new(1.0, 2.0, 1.0)).check(),
                "invalid metric: the tensor m11 = 1, m12 = 2, m22 = 1 is not positive definite at every point",
            ),
        ] {
            assert_eq!(result.unwrap_err().to_string(), message);
        }
        assert_eq!(Shock { lambda: 0.0, ..shock }.check().unwrap_err().help(), "lambda must be finite and positive");
    }
}
