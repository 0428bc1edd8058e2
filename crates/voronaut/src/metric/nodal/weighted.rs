//! Hessians at vertices made metrics.

use crate::error::{Error, Result};
use crate::geometry::Tensor;
use crate::metric::{Norm, Optimal};

/// The floor of absolute eigenvalues, as a share of the greatest one.
pub(crate) const LEAST_SHARE: f64 = 1e-6;

/// The metric that is [`Optimal`] for linear interpolation in an L^p norm, of given Hessians and up to a factor.
///
/// Every tensor is a metric: the floor of absolute eigenvalues is [`LEAST_SHARE`] of the greatest one
/// of all, so that no size is more than a thousand times another and no anisotropy is more than that. Where a function is
/// linear nothing is asked for, and a floor that goes along with the function's units is the least that one can do; limits
/// on sizes do more. Of Hessians that are all zero any metric is optimal: that of an identity.
///
/// # Errors
/// [`Error::Metric`] with the number of a Hessian that is not finite.
pub(crate) fn weighted(hessians: &[Tensor], norm: Norm) -> Result<Vec<Tensor>> {
    let is_finite = |h: &Tensor| h.xx.is_finite() && h.xy.is_finite() && h.yy.is_finite();
    if let Some(v) = hessians.iter().position(|h| !is_finite(h)) {
        let Tensor { xx, xy, yy } = hessians[v];
        let what = format!("the Hessian ({xx}, {xy}, {yy}) is not finite");
        let help = "the solution has no second derivatives there, or they overflow";
        return Err(Error::metric(what, format!("vertex {}", v + 1), help));
    }
    let greatest = hessians.iter().map(|&h| size(h)).fold(0.0, f64::max);
    // Below these numbers determinants underflow, and a tensor is no metric.
    let floor = if greatest > 0.0 { (LEAST_SHARE * greatest).max(f64::MIN_POSITIVE.sqrt()) } else { 1.0 };
    let optimal = Optimal::new(norm);
    Ok(hessians.iter().map(|&h| optimal.of(h, floor)).collect())
}

/// The greater absolute eigenvalue.
pub(crate) fn size(h: Tensor) -> f64 {
    let e = h.eigen();
    e.large.abs().max(e.small.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;

    /// In the greatest error the metric is the absolute value itself.
    fn absolute(hessians: &[Tensor]) -> Result<Vec<Tensor>> {
        weighted(hessians, Norm::GREATEST)
    }

    fn close(a: Tensor, b: Tensor) -> bool {
        let d = a + b * -1.0;
        d.xx.abs() + d.xy.abs() + d.yy.abs() < 1e-13 * (b.xx + b.yy)
    }

    #[test]
    fn signs_of_eigenvalues_go_and_axes_stay() {
        let axis = Vector::new(0.6, 0.8);
        for (along, across) in [(5.0, 2.0), (5.0, -2.0), (-5.0, 2.0), (-5.0, -2.0)] {
            let found = absolute(&[Tensor::from_axis(axis, along, across)]).unwrap()[0];
            assert!(close(found, Tensor::from_axis(axis, 5.0, 2.0)), "{found:?}");
        }
    }

    #[test]
    fn what_says_nothing_gets_the_floor() {
        let axis = Vector::new(0.6, 0.8);
        let found = absolute(&[Tensor::from_axis(axis, -50.0, 0.0), Tensor::default()]).unwrap();
        let floor = 50.0 * LEAST_SHARE;
        assert!(close(found[0], Tensor::from_axis(axis, 50.0, floor)) && found[0].is_positive_definite());
        assert!(close(found[1], Tensor::IDENTITY * floor));
        assert_eq!(absolute(&[Tensor::default(); 3]).unwrap(), [Tensor::IDENTITY; 3]);
    }

    #[test]
    fn units_of_the_function_change_units_of_the_metric() {
        let hessians = [Tensor::new(3.0, 1.0, -2.0), Tensor::new(1e-12, 0.0, 0.0)];
        for scale in [1e-9, 1e9] {
            let (plain, scaled) = (absolute(&hessians).unwrap(), absolute(&hessians.map(|h| h * scale)).unwrap());
            assert!(plain.iter().zip(scaled).all(|(&m, s)| close(s * (1.0 / scale), m)));
        }
    }

    #[test]
    fn what_is_not_finite_is_named() {
        let error = absolute(&[Tensor::IDENTITY, Tensor::new(f64::NAN, 0.0, 1.0)]).unwrap_err();
        assert_eq!(error.to_string(), "invalid metric: the Hessian (NaN, 0, 1) is not finite at vertex 2");
    }
}
