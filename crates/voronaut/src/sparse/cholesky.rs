//! The factor L of A = L L', row by row.

use super::elimination::{Elimination, Reach};
use super::matrix::Symmetric;
use std::ops::Range;

/// A Cholesky factor of a symmetric positive definite matrix, by compressed columns.
#[derive(Clone, Debug)]
pub(crate) struct Cholesky {
    /// The row of the matrix that is eliminated k-th.
    order: Vec<u32>,
    /// Column k, without the diagonal, is from `starts[k]` to `starts[k + 1]`.
    starts: Vec<usize>,
    rows: Vec<u32>,
    values: Vec<f64>,
    diagonal: Vec<f64>,
}

/// A factor in the making: its first rows are there.
struct Rows<'a> {
    matrix: &'a Symmetric,
    elimination: &'a Elimination,
    reach: Reach,
    /// Where columns end so far.
    ends: Vec<usize>,
    /// The row in the making; zero elsewhere.
    row: Vec<f64>,
}

impl Cholesky {
    /// Factors a matrix; `None` where a pivot is not positive, or not finite: the matrix is not positive definite, or so near to
    /// that, that rounding decides.
    ///
    /// Rows come one after the other, each from a triangular system with those before: the *up-looking* factorisation of Davis
    /// 2006, section 4.7.
    ///
    /// # Panics
    /// Where the elimination is that of a matrix with entries in other places.
    pub(crate) fn of(matrix: &Symmetric, elimination: &Elimination) -> Option<Self> {
        let (n, starts) = (matrix.size(), elimination.starts.clone());
        assert_eq!(n, elimination.order.len(), "the elimination of another matrix");
        let (rows, values) = (vec![0; starts[n]], vec![0.0; starts[n]]);
        let mut made =
            Rows { matrix, elimination, reach: Reach::new(n), ends: starts[..n].to_vec(), row: vec![0.0; n] };
        let mut factor =
            Self { order: elimination.order.clone(), starts, rows, values, diagonal: Vec::with_capacity(n) };
        for k in 0..n {
            factor.add_row(k, &mut made)?;
        }
        Some(factor)
    }

    fn add_row(&mut self, k: usize, made: &mut Rows<'_>) -> Option<()> {
        for (j, value) in made.elimination.row(made.matrix, k) {
            made.row[j] = value;
        }
        let mut pivot = made.matrix.diagonal_at(self.order[k] as usize);
        for &i in made.reach.of_row(k, made.elimination, made.matrix) {
            let (i, end) = (i as usize, made.ends[i as usize]);
            assert!(end < self.starts[i + 1], "the elimination of another matrix");
            let value = std::mem::take(&mut made.row[i]) / self.diagonal[i];
            for (j, l) in self.entries(self.starts[i]..end) {
                made.row[j] -= l * value;
            }
            pivot -= value * value;
            (self.rows[end], self.values[end]) = (k as u32, value);
            made.ends[i] += 1;
        }
        self.diagonal.push((pivot > 0.0 && pivot.is_finite()).then(|| pivot.sqrt())?);
        Some(())
    }

    /// The solution for a right-hand side.
    ///
    /// # Panics
    /// Unless that has a number for each row.
    pub(crate) fn solve(&self, right: &[f64]) -> Vec<f64> {
        assert_eq!(right.len(), self.order.len(), "a number for each row");
        let mut values: Vec<f64> = self.order.iter().map(|&v| right[v as usize]).collect();
        for k in 0..values.len() {
            let value = values[k] / self.diagonal[k];
            values[k] = value;
            for (j, l) in self.entries(self.column(k)) {
                values[j] -= l * value;
            }
        }
        for k in (0..values.len()).rev() {
            let sum: f64 = self.entries(self.column(k)).map(|(j, l)| l * values[j]).sum();
            values[k] = (values[k] - sum) / self.diagonal[k];
        }
        let mut found = vec![0.0; values.len()];
        for (&v, value) in self.order.iter().zip(values) {
            found[v as usize] = value;
        }
        found
    }

    fn column(&self, k: usize) -> Range<usize> {
        self.starts[k]..self.starts[k + 1]
    }

    fn entries(&self, places: Range<usize>) -> impl Iterator<Item = (usize, f64)> {
        self.rows[places.clone()].iter().zip(&self.values[places]).map(|(&j, &value)| (j as usize, value))
    }
}
