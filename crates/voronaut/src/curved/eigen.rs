//! Eigenvalues and eigenvectors of small symmetric matrices.

/// Sweeps of rotations, at most: convergence is quadratic in the end, and six sweeps are plenty for rounding.
const SWEEPS: usize = 8;
/// Entries off the diagonal that are smaller, beside the greatest on it, count as none: eigenvalues are for a model of an energy.
const SMALL: f64 = 1e-4;

/// Factors and vectors: those with positive factors have squares, as matrices, that sum to the part of a symmetric matrix which is positive
/// semidefinite, all of it but negative eigenvalues with their eigenvectors.
pub(super) fn positive_part<const N: usize>(a: [[f64; N]; N]) -> [(f64, [f64; N]); N] {
    triangular(&a).unwrap_or_else(|| eigen(a))
}

/// The columns of L with the entries of D where the matrix is L D L' and positive definite; its eigenvalues need not be known then.
fn triangular<const N: usize>(a: &[[f64; N]; N]) -> Option<[(f64, [f64; N]); N]> {
    let mut rest = *a;
    let mut columns = [(0.0, [0.0; N]); N];
    for k in 0..N {
        let pivot = rest[k][k];
        if pivot.is_nan() || pivot <= SMALL * a[k][k] {
            return None;
        }
        let column: [f64; N] = std::array::from_fn(|i| if i < k { 0.0 } else { rest[i][k] / pivot });
        for i in k + 1..N {
            (k + 1..N).for_each(|j| rest[i][j] -= pivot * column[i] * column[j]);
        }
        columns[k] = (pivot, column);
    }
    Some(columns)
}

/// Eigenvalues with their eigenvectors, by Jacobi's rotations.
pub(super) fn eigen<const N: usize>(mut a: [[f64; N]; N]) -> [(f64, [f64; N]); N] {
    let mut vectors = [[0.0; N]; N];
    (0..N).for_each(|i| vectors[i][i] = 1.0);
    for _ in 0..SWEEPS {
        let greatest = (0..N).map(|i| a[i][i].abs()).fold(0.0, f64::max);
        let mut is_done = true;
        for p in 0..N {
            for q in p + 1..N {
                if a[p][q].abs() > SMALL * greatest {
                    is_done = false;
                    rotate(&mut a, &mut vectors, p, q);
                }
            }
        }
        if is_done {
            break;
        }
    }
    std::array::from_fn(|i| (a[i][i], vectors[i]))
}

/// Makes the entry (p, q) zero (Golub and Van Loan 2013, section 8.5).
fn rotate<const N: usize>(a: &mut [[f64; N]; N], vectors: &mut [[f64; N]; N], p: usize, q: usize) {
    let tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = tau.signum() / (tau.abs() + (1.0 + tau * tau).sqrt());
    let c = 1.0 / (1.0 + t * t).sqrt();
    let s = t * c;
    let turned = |x: &[f64; N], y: &[f64; N]| -> [[f64; N]; 2] {
        [std::array::from_fn(|k| c * x[k] - s * y[k]), std::array::from_fn(|k| s * x[k] + c * y[k])]
    };
    let [mut to_p, mut to_q] = turned(&a[p], &a[q]);
    (to_p[p], to_q[q]) = (a[p][p] - t * a[p][q], a[q][q] + t * a[p][q]);
    (to_p[q], to_q[p]) = (0.0, 0.0);
    (a[p], a[q]) = (to_p, to_q);
    for k in (0..N).filter(|&k| k != p && k != q) {
        (a[k][p], a[k][q]) = (to_p[k], to_q[k]);
    }
    [vectors[p], vectors[q]] = turned(&vectors[p], &vectors[q]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_matrix_is_the_sum_of_its_parts(entries in prop::collection::vec(-3.0..3.0, 36)) {
            let a: [[f64; 6]; 6] = std::array::from_fn(|i| std::array::from_fn(|j| entries[6 * i.max(j) + i.min(j)]));
            let parts = eigen(a);
            for i in 0..6 {
                for j in 0..6 {
                    let sum: f64 = parts.iter().map(|(value, v)| value * v[i] * v[j]).sum();
                    let product: f64 = parts[i].1.iter().zip(&parts[j].1).map(|(x, y)| x * y).sum();
                    // What is left of 6 x 6 entries, each below SMALL times the greatest eigenvalue, 18 at most.
                    prop_assert!((sum - a[i][j]).abs() < 6.0 * 18.0 * SMALL, "{} {}", sum, a[i][j]);
                    prop_assert!((product - f64::from(u8::from(i == j))).abs() < 1e-12);
                }
            }
        }

        #[test]
        fn the_positive_part_is_all_of_what_is_positive(entries in prop::collection::vec(-3.0..3.0, 42), more in prop::bool::ANY) {
            // Rows sum to less than 18: with that on the diagonal there are no negative eigenvalues.
            let added = if more { 18.0 } else { 0.0 };
            let a: [[f64; 6]; 6] = std::array::from_fn(|i| {
                std::array::from_fn(|j| entries[6 * i.max(j) + i.min(j)] + if i == j { added } else { 0.0 })
            });
            let x = &entries[36..];
            let dot = |v: &[f64]| -> f64 { v.iter().zip(x).map(|(v, x)| v * x).sum() };
            let whole: f64 = a.iter().zip(x).map(|(row, x)| dot(row) * x).sum();
            let part: f64 = positive_part(a).iter().map(|(factor, v)| factor.max(0.0) * dot(v).powi(2)).sum();
            let tolerance = 1e-2 * dot(x);
            prop_assert!(part >= whole - tolerance, "{} {}", part, whole);
            prop_assert!(!more || part <= whole + tolerance, "{} {}", part, whole);
        }
    }
}
