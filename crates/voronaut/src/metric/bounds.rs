//! Limits on the sizes and the anisotropy that a metric asks for.

use super::validate::require;
use super::{MetricField, Near};
use crate::error::{Error, Result};
use crate::geometry::{Point, Tensor};
use crate::mesh::Mesh;

/// Limits on a metric; `None` for no limit. A size is the Euclidean length 1 / sqrt(eigenvalue).
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Bounds {
    /// No size is smaller.
    pub h_min: Option<f64>,
    /// No size is larger.
    pub h_max: Option<f64>,
    /// The longer size is at most so many times the shorter one; at least 1.
    pub a_max: Option<f64>,
}

impl Bounds {
    /// Whether the limits make sense, alone and together.
    ///
    /// # Errors
    /// [`Error::Parse`] that names the parameter.
    pub fn check(&self) -> Result<()> {
        for (name, limit, least) in [("h_min", self.h_min, 0.0), ("h_max", self.h_max, 0.0), ("a_max", self.a_max, 1.0)]
        {
            let Some(value) = limit else { continue };
            let needed = if least == 0.0 { "positive" } else { "at least 1" };
            let needed = format!("finite and {needed}; leave it out for no limit");
            require(value.is_finite() && value >= least && value != 0.0, "metric bounds", name, value, &needed)?;
        }
        if let (Some(low), Some(high)) = (self.h_min, self.h_max)
            && low > high
        {
            let what = format!("h_min = {low} is larger than h_max = {high}");
            return Err(Error::parse("metric bounds", what, "choose h_min <= h_max"));
        }
        Ok(())
    }

    /// The same limits in a multiple of the metric.
    #[must_use]
    pub(crate) fn times(&self, scale: f64) -> Self {
        let size = |h: f64| h * scale.sqrt();
        Self { h_min: self.h_min.map(size), h_max: self.h_max.map(size), a_max: self.a_max }
    }

    /// The tensor with the same axes and its sizes first clamped to `h_min ..= h_max`; then the longer one shrinks
    /// to at most `a_max` times the shorter one (and so stays in range).
    ///
    /// A tensor within the limits comes back bit for bit, and so does one that is not positive definite: limits must
    /// not hide an invalid metric from `check_tensor`.
    #[must_use]
    pub(crate) fn clamp(&self, tensor: Tensor) -> Tensor {
        if !tensor.is_positive_definite() || self.are_met(tensor) {
            return tensor;
        }
        let e = tensor.eigen();
        let large = self.clamp_sizes(e.large);
        let mut small = self.clamp_sizes(e.small);
        if let Some(ratio) = self.a_max {
            small = small.max(large / (ratio * ratio));
        }
        // Bit for bit, so that any change is the limits' doing and never that of rebuilding the tensor.
        #[expect(clippy::float_cmp)]
        let unchanged = large == e.large && small == e.small;
        if unchanged { tensor } else { Tensor::from_axis(e.axis, large, small) }
    }

    /// Whether limits on sizes alone are met for sure, without eigenvalues: by how much a tensor exceeds them is positive definite.
    fn are_met(&self, tensor: Tensor) -> bool {
        let least = self.h_max.map_or(0.0, |h| SURE / (h * h));
        let is_above = |Tensor { xx, xy, yy }: Tensor| xx > 0.0 && yy > 0.0 && xx * yy > xy * xy * SURE;
        self.a_max.is_none() && self.h_min.is_none() && is_above(tensor + Tensor::IDENTITY * -least)
    }

    fn clamp_sizes(&self, eigenvalue: f64) -> f64 {
        let most = self.h_min.map_or(f64::INFINITY, |h| 1.0 / (h * h));
        let least = self.h_max.map_or(0.0, |h| 1.0 / (h * h));
        eigenvalue.min(most).max(least)
    }
}

/// Limits are met for sure where they are by this factor, which is more than rounding makes up.
const SURE: f64 = 1.0 + 1e-6;

/// A field within [`Bounds`]; one on a surface in the tangent planes.
#[derive(Clone, Debug)]
pub struct Bounded<F> {
    pub(crate) field: F,
    pub(crate) bounds: Bounds,
}

impl<F> Bounded<F> {
    /// The field with its tensors clamped.
    ///
    /// # Errors
    /// As [`Bounds::check`].
    pub fn new(field: F, bounds: Bounds) -> Result<Self> {
        bounds.check()?;
        Ok(Self { field, bounds })
    }
}

impl<F: MetricField> MetricField for Bounded<F> {
    fn at(&self, p: Point) -> Tensor {
        self.bounds.clamp(self.field.at(p))
    }

    fn at_near(&self, p: Point, near: &mut Near) -> Tensor {
        self.bounds.clamp(self.field.at_near(p, near))
    }

    /// With its tensors within the limits: so are those between them.
    fn excerpt(&self, domain: &Mesh) -> Option<(Mesh, Vec<Tensor>)> {
        let (mesh, tensors) = self.field.excerpt(domain)?;
        Some((mesh, tensors.into_iter().map(|tensor| self.bounds.clamp(tensor)).collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;
    use crate::metric::Uniform;

    const ALL: Bounds = Bounds { h_min: Some(0.1), h_max: Some(2.0), a_max: Some(5.0) };

    /// A tensor with these sizes, the first along a tilted axis.
    fn sized(h: f64, k: f64) -> Tensor {
        Tensor::from_axis(Vector::new(0.6, 0.8), 1.0 / (h * h), 1.0 / (k * k))
    }

    fn assert_close(a: Tensor, b: Tensor) {
        let difference = a + b * -1.0;
        let size = b.xx + b.yy;
        assert!(difference.xx.abs() + difference.xy.abs() + difference.yy.abs() < 1e-11 * size, "{a:?} {b:?}");
    }

    #[test]
    fn sizes_then_anisotropy() {
        assert_close(ALL.clamp(sized(0.01, 0.2)), sized(0.1, 0.2));
        assert_close(ALL.clamp(sized(1.0, 50.0)), sized(1.0, 2.0));
        assert_close(ALL.clamp(sized(0.2, 1.5)), sized(0.2, 1.0));
        assert_close(ALL.clamp(sized(0.001, 100.0)), sized(0.1, 0.5));
        assert_close(ALL.clamp(sized(9.0, 7.0)), Tensor::isotropic(2.0));
        assert_close(ALL.clamp(sized(1e-3, 1e-4)), Tensor::isotropic(0.1));
    }

    #[test]
    fn clamping_again_changes_nothing() {
        for tensor in [sized(0.01, 0.2), sized(1.0, 50.0), sized(0.001, 100.0)] {
            let once = ALL.clamp(tensor);
            assert_close(ALL.clamp(once), once);
        }
    }

    #[test]
    fn tensors_in_range_come_back_bit_for_bit() {
        let tensor = sized(0.3, 0.7);
        assert_eq!(ALL.clamp(tensor), tensor);
        assert_eq!(Bounds::default().clamp(sized(1e-5, 1e5)), sized(1e-5, 1e5));
    }

    #[test]
    fn invalid_tensors_stay_visible() {
        let indefinite = Tensor::new(1.0, 2.0, 1.0);
        assert_eq!(ALL.clamp(indefinite), indefinite);
        assert!(ALL.clamp(Tensor::new(f64::NAN, 0.0, 1.0)).xx.is_nan());
    }

    #[test]
    fn a_bounded_field_clamps() {
        let field = Bounded::new(Uniform(sized(0.01, 0.2)), ALL).unwrap();
        assert_close(field.at(Point::default()), sized(0.1, 0.2));
    }

    #[test]
    fn senseless_limits_are_named() {
        let none = Bounds::default();
        for (bounds, message, help) in [
            (Bounds { h_min: Some(0.0), ..none }, "metric bounds: h_min = 0", "h_min must be finite and positive"),
            (Bounds { h_max: Some(-1.0), ..none }, "metric bounds: h_max = -1", "h_max must be finite and positive"),
            (Bounds { h_max: Some(f64::NAN), ..none }, "metric bounds: h_max = NaN", "leave it out for no limit"),
            (Bounds { a_max: Some(0.5), ..none }, "metric bounds: a_max = 0.5", "a_max must be finite and at least 1"),
            (
                Bounds { h_min: Some(2.0), h_max: Some(1.0), a_max: None },
                "metric bounds: h_min = 2 is larger than h_max = 1",
                "h_min <= h_max",
            ),
        ] {
            let error = Bounded::new(Uniform::default(), bounds).unwrap_err();
            assert_eq!(error.to_string(), message);
            assert!(error.help().contains(help), "{}", error.help());
        }
    }
}
