//! Small dense least squares that say how well they are determined.

/// What rows and values determine.
pub(super) struct Solved<const N: usize> {
    /// One per column; zero of a column that the columns before it leave next to nothing of.
    pub(super) coefficients: [f64; N],
    /// The least share of a column that the columns before it do not explain: 1 of orthogonal columns, 0 of dependent ones.
    pub(super) independence: f64,
}

/// Less of a column is rounding, or points that happen to lie on a curve of second order.
const DEPENDENT: f64 = 1e-3;

/// The coefficients c that make the sum of the squares of (row . c - value) least, by modified Gram-Schmidt (Björck 1967).
/// Columns come in the order of their importance: what the first explain is not left to the later ones.
pub(super) fn solve<const N: usize>(rows: &mut [[f64; N]], values: &mut [f64]) -> Solved<N> {
    let (mut upper, mut along) = ([[0.0; N]; N], [0.0; N]);
    let mut independence = 1.0_f64;
    let mut before = [0.0; N];
    for (k, norm) in before.iter_mut().enumerate() {
        *norm = rows.iter().map(|row| row[k] * row[k]).sum::<f64>().sqrt();
    }
    for k in 0..N {
        let norm = rows.iter().map(|row| row[k] * row[k]).sum::<f64>().sqrt();
        let share = if before[k] > 0.0 { norm / before[k] } else { 0.0 };
        independence = independence.min(share);
        if share <= DEPENDENT {
            continue;
        }
        upper[k][k] = norm;
        for row in rows.iter_mut() {
            row[k] /= norm;
        }
        for j in k + 1..N {
            upper[k][j] = rows.iter().map(|row| row[k] * row[j]).sum();
            for row in rows.iter_mut() {
                row[j] -= upper[k][j] * row[k];
            }
        }
        along[k] = rows.iter().zip(values.iter()).map(|(row, value)| row[k] * value).sum();
        for (row, value) in rows.iter().zip(values.iter_mut()) {
            *value -= along[k] * row[k];
        }
    }
    Solved { coefficients: back_substituted(&upper, &along), independence }
}

fn back_substituted<const N: usize>(upper: &[[f64; N]; N], along: &[f64; N]) -> [f64; N] {
    let mut found = [0.0; N];
    for k in (0..N).rev().filter(|&k| upper[k][k] > 0.0) {
        let rest: f64 = (k + 1..N).map(|j| upper[k][j] * found[j]).sum();
        found[k] = (along[k] - rest) / upper[k][k];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_through_four_points() {
        // y = 1 + 2 x with residuals (1, -1, -1, 1), which are orthogonal to both columns.
        let mut rows = [[1.0, 0.0], [1.0, 1.0], [1.0, 2.0], [1.0, 3.0]];
        let found = solve(&mut rows, &mut [2.0, 2.0, 4.0, 8.0]);
        assert!((found.coefficients[0] - 1.0).abs() < 1e-14 && (found.coefficients[1] - 2.0).abs() < 1e-14);
        // Of the second column the first explains its mean.
        assert!((found.independence - (5.0_f64 / 14.0).sqrt()).abs() < 1e-14);
    }

    #[test]
    fn what_depends_is_left_to_the_first_columns() {
        let mut rows = [[1.0, 2.0, 0.0], [2.0, 4.0, 1.0], [3.0, 6.0, -1.0], [0.5, 1.0, 0.3]];
        let mut values = rows.map(|row| 3.0 * row[0] - row[2]);
        let found = solve(&mut rows, &mut values);
        let [a, b, c] = found.coefficients;
        assert!((a - 3.0).abs() < 1e-13 && b.abs() < 1e-13 && (c + 1.0).abs() < 1e-13);
        assert!(found.independence < 1e-13);
    }
}
