//! Metrics in solution files, in whichever order a program writes the entries of a tensor.

use crate::error::{Error, Result};
use crate::formats::{Solution, SolutionValues, TensorOrder, read_solution};
use crate::geometry::{Tensor, Tensor3};
use std::path::Path;

/// Reads the sizes or tensors of a `.sol` or `.solb` file, whose tensors are in the order given, as a solution in the order on disk.
///
/// # Errors
/// As of [`read_solution`]. [`Error::Metric`] of tensors that are not positive definite, where all are in another order: the file is
/// then surely in that. Other tensors that are no metric are left to who samples them.
pub fn read_metric(path: &Path, order: TensorOrder) -> Result<Solution> {
    let Solution { dimension, values } = read_solution(path)?;
    let values = values.from_order(order);
    demand_order(&values, order, &path.display().to_string())?;
    Ok(Solution { dimension, values })
}

/// Looks for another order if tensors, read in the order given, are no metric.
fn demand_order(values: &SolutionValues, order: TensorOrder, place: &str) -> Result<()> {
    let Some(bad) = first_indefinite(values) else { return Ok(()) };
    let raw = values.clone().to_order(order);
    let mut others = TensorOrder::ALL.into_iter().filter(|&other| other != order);
    let Some(fitting) = others.find(|&other| first_indefinite(&raw.clone().from_order(other)).is_none()) else {
        return Ok(());
    };
    let entries = |order: TensorOrder| order.entries(matches!(values, SolutionValues::Tensor3(_)));
    let (read, meant) = (entries(order), entries(fitting));
    let what = format!("the tensor is not positive definite in the order {read}, and all are in the order {meant}");
    let help = format!("the file seems to be in that order: say so (--tensor-order {fitting}), or write it as {read}");
    Err(Error::metric(what, format!("{place}, entry {}", bad + 1), help))
}

fn first_indefinite(values: &SolutionValues) -> Option<usize> {
    match values {
        SolutionValues::Tensor(entries) => {
            entries.iter().position(|&[xx, xy, yy]| !Tensor::new(xx, xy, yy).is_positive_definite())
        }
        SolutionValues::Tensor3(entries) => {
            entries.iter().position(|&entry| !Tensor3::from_disk(entry).is_positive_definite())
        }
        SolutionValues::Scalar(_) | SolutionValues::Vector { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn tensors() -> impl Strategy<Value = Vec<Tensor3>> {
        let factor = prop::array::uniform9(-1.0..1.0_f64);
        // G' G + 1/10: definite, of any direction.
        let tensor = factor.prop_map(|g| {
            let dot = |i: usize, j: usize| (0..3).map(|k| g[3 * k + i] * g[3 * k + j]).sum::<f64>();
            let [xx, xy, yy, xz, yz, zz] = [dot(0, 0), dot(0, 1), dot(1, 1), dot(0, 2), dot(1, 2), dot(2, 2)];
            Tensor3::from_disk([xx + 0.1, xy, yy + 0.1, xz, yz, zz + 0.1])
        });
        prop::collection::vec(tensor, 40)
    }

    proptest! {
        /// Forty tensors of any directions are never definite in a wrong order as well.
        #[test]
        fn a_wrong_order_is_found_out(tensors in tensors()) {
            let disk = SolutionValues::Tensor3(tensors.iter().map(|t| t.to_disk()).collect());
            for order in TensorOrder::ALL {
                let written = disk.clone().to_order(order);
                prop_assert_eq!(&written.clone().from_order(order), &disk);
                for read in TensorOrder::ALL {
                    let found = demand_order(&written.clone().from_order(read), read, "a.sol");
                    prop_assert_eq!(found.is_ok(), read == order, "{} as {}", order, read);
                }
            }
        }
    }

    #[test]
    fn messages_name_entry_and_order() {
        let diagonal = SolutionValues::Tensor(vec![[1.0, 0.5, 0.6], [4.0, 9.0, 0.5]]);
        let error = demand_order(&diagonal, TensorOrder::Disk, "a.sol").unwrap_err();
        assert_eq!(
            error.to_string(),
            "invalid metric: the tensor is not positive definite in the order m11 m12 m22, and all are in the order \
             m11 m22 m12 at a.sol, entry 2"
        );
        assert!(error.help().contains("--tensor-order diagonal"), "{}", error.help());
        let never = SolutionValues::Tensor(vec![[1.0, -2.0, 1.0]]);
        assert!(demand_order(&never, TensorOrder::Disk, "a.sol").is_ok(), "left to who samples it");
    }
}
