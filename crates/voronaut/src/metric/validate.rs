//! Whether a tensor, a field at given points, and values at the vertices of a mesh are a metric, and parameters what they should be.

use super::MetricField;
use crate::error::{Error, Result};
use crate::geometry::{Point, Readable, Tensor, Tensor3};
use crate::mesh::{Locator, Mesh};

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
    let help = "a metric needs m11 > 0, m22 > 0 and m11 m22 > m12^2, everywhere on the domain and a little outside it";
    Err(no_metric(&[tensor.xx, tensor.xy, tensor.yy], help, place()))
}

/// The same of a tensor of space.
pub(crate) fn check_tensor3(tensor: Tensor3, place: impl FnOnce() -> String) -> Result<()> {
    if tensor.is_positive_definite() {
        return Ok(());
    }
    let help = "a metric needs positive eigenvalues everywhere on the surface; the order is m11 m12 m22 m13 m23 m33";
    Err(no_metric(&tensor.to_disk(), help, place()))
}

/// The error of entries in the order on disk that are not finite, or else not positive definite.
fn no_metric(entries: &[f64], needed: &str, place: String) -> Error {
    let (fault, help) = if entries.iter().all(|entry| entry.is_finite()) {
        ("not positive definite", needed)
    } else {
        ("not finite", "check the metric for a division by zero, a root or logarithm of a negative number, an overflow")
    };
    let names = ["m11", "m12", "m22", "m13", "m23", "m33"];
    let entries = names.iter().zip(entries).map(|(name, &entry)| format!("{name} = {}", Readable(entry)));
    Error::metric(format!("the tensor {} is {fault}", entries.collect::<Vec<_>>().join(", ")), place, help)
}

/// Whether sizes are positive and finite; the error calls the place of one as the caller does.
pub(crate) fn check_sizes(sizes: &[f64], place: impl FnOnce(usize) -> String) -> Result<()> {
    let Some(i) = sizes.iter().position(|h| !h.is_finite() || *h <= 0.0) else { return Ok(()) };
    let what = format!("the size h = {} is not positive and finite", sizes[i]);
    Err(Error::metric(what, place(i), "a size is the length of edges there"))
}

/// An error that names a parameter unless it is as `needed`.
pub(crate) fn require(holds: bool, place: &str, name: &str, value: f64, needed: &str) -> Result<()> {
    if holds {
        return Ok(());
    }
    Err(Error::parse(place, format!("{name} = {value}"), format!("{name} must be {needed}")))
}

/// Whether values at the vertices of a mesh can make a field.
pub(super) fn check_background(background: &Mesh) -> Result<()> {
    Locator::check(background, BACKGROUND)
}

/// What messages call the mesh of a metric.
pub(super) const BACKGROUND: &str = "the background mesh of the metric";

/// Whether there is one value for each vertex of a mesh that can make a field; `what` is what they are.
pub(super) fn check_count(background: &Mesh, what: &str, found: usize) -> Result<()> {
    check_background(background)?;
    let needed = background.points.len();
    if found == needed {
        return Ok(());
    }
    let what = format!("{found} {what} for {needed} vertices");
    let help = "the metric must have one value for each vertex of the background mesh, in the same order";
    Err(Error::metric(what, "the background mesh", help))
}

/// Whether these are a metric at the vertices of a planar mesh: errors as of [`Sampled::new`](super::Sampled::new).
pub(crate) fn check_at_vertices(mesh: &Mesh, tensors: &[Tensor]) -> Result<()> {
    check_count(mesh, "tensors", tensors.len())?;
    tensors.iter().enumerate().try_for_each(|(v, &tensor)| check_tensor_at(tensor, || mesh.describe(v)))
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

    #[test]
    fn a_message_names_all_entries_of_space() {
        let check = |entries| check_tensor3(Tensor3::from_disk(entries), || "vertex 3".into());
        check([1.0, 0.0, 1.0, 0.0, 0.5, 1.0]).unwrap();
        let error = check([1.0, 0.0, 1.0, 0.0, 2.0, 1.0]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "invalid metric: the tensor m11 = 1, m12 = 0, m22 = 1, m13 = 0, m23 = 2, m33 = 1 is not positive definite \
             at vertex 3"
        );
        assert!(check([f64::NAN, 0.0, 1.0, 0.0, 0.0, 1.0]).unwrap_err().to_string().contains("is not finite at"));
    }
}
