//! Whether a tensor, and a field at given points, is a metric.

use super::MetricField;
use crate::error::{Error, Result};
use crate::geometry::{Point, Readable, Tensor};

/// Whether `tensor`, the value of a field at `p`, is finite and positive definite; the error names the point and
/// the entries.
///
/// # Errors
/// [`Error::Metric`].
pub(crate) fn check_tensor(tensor: Tensor, p: Point) -> Result<()> {
    check_tensor_at(tensor, || p.to_string())
}

/// [`check_tensor`] at each of the points; the first error.
///
/// # Errors
/// [`Error::Metric`].
pub(crate) fn check_field(field: &dyn MetricField, mut points: impl Iterator<Item = Point>) -> Result<()> {
    points.try_for_each(|p| check_tensor(field.at(p), p))
}

/// [`check_tensor`] with the place in the caller's words.
pub(crate) fn check_tensor_at(tensor: Tensor, place: impl FnOnce() -> String) -> Result<()> {
    if tensor.is_positive_definite() {
        return Ok(());
    }
    let entries = [tensor.xx, tensor.xy, tensor.yy];
    let (fault, help) = if entries.iter().all(|entry| entry.is_finite()) {
        (
            "not positive definite",
            "a metric needs m11 > 0, m22 > 0 and m11 m22 > m12^2, everywhere on the domain and a little outside it",
        )
    } else {
        ("not finite", "check the metric for a division by zero, a root or logarithm of a negative number, an overflow")
    };
    let [xx, xy, yy] = entries.map(Readable);
    Err(Error::metric(format!("the tensor m11 = {xx}, m12 = {xy}, m22 = {yy} is {fault}"), place(), help))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_metric_passes() {
        let p = Point::new(1.0, 2.0);
        assert!(check_tensor(Tensor::new(4.0, 1.0, 1.0), p).is_ok());
        assert!(check_tensor(Tensor::new(1e12, 0.0, 1e-12), p).is_ok());
    }

    #[test]
    fn a_message_names_entries_and_place() {
        let error = check_tensor(Tensor::new(1.0, 2.0, 3.0), Point::new(0.5, -2.0)).unwrap_err();
        assert_eq!(
            error.to_string(),
            "invalid metric: the tensor m11 = 1, m12 = 2, m22 = 3 is not positive definite at (0.5, -2)"
        );
        assert!(error.help().contains("m11 m22 > m12^2"));
        let error = check_tensor(Tensor::new(1.0, f64::NAN, 3.0), Point::default()).unwrap_err();
        assert!(error.to_string().contains("m12 = NaN, m22 = 3 is not finite at (0, 0)"), "{error}");
        assert!(error.help().contains("division by zero"));
    }

    #[test]
    fn singular_and_negative_tensors_fail() {
        for t in [Tensor::default(), Tensor::new(1.0, 1.0, 1.0), Tensor::new(-1.0, 0.0, -1.0)] {
            assert!(check_tensor(t, Point::default()).is_err(), "{t:?}");
        }
    }

    #[test]
    fn a_field_fails_at_its_first_bad_point() {
        let field = |p: Point| Tensor::new(p.x, 0.0, 1.0);
        let points = [2.0, 1.0, 0.0, -1.0].map(|x| Point::new(x, 7.0));
        let error = check_field(&field, points.into_iter()).unwrap_err();
        assert!(error.to_string().ends_with("at (0, 7)"), "{error}");
        assert!(check_field(&field, points[..2].iter().copied()).is_ok());
    }
}
