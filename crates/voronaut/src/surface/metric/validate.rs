//! Whether a tensor of space is a metric.

use crate::error::{Error, Result};
use crate::geometry::{Readable, Tensor3};

/// Whether `tensor` is finite and positive definite; the error names the place and the entries.
///
/// # Errors
/// [`Error::Metric`].
pub(crate) fn check_tensor3(tensor: Tensor3, place: impl FnOnce() -> String) -> Result<()> {
    if tensor.is_positive_definite() {
        return Ok(());
    }
    let (fault, help) = if tensor.is_finite() {
        (
            "not positive definite",
            "a metric needs positive eigenvalues everywhere on the surface; the order is m11 m12 m22 m13 m23 m33",
        )
    } else {
        ("not finite", "check the metric for a division by zero, a root or logarithm of a negative number, an overflow")
    };
    let names = ["m11", "m12", "m22", "m13", "m23", "m33"];
    let entries = names.iter().zip(tensor.to_disk()).map(|(name, entry)| format!("{name} = {}", Readable(entry)));
    let what = format!("the tensor {} is {fault}", entries.collect::<Vec<_>>().join(", "));
    Err(Error::metric(what, place(), help))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_names_entries_and_place() {
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
