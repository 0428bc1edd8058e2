//! The factor L of A = L L', front by front.

use super::dense::Dense;
use super::elimination::{Elimination, Front};
use super::matrix::Symmetric;
use crate::parallel::prelude::*;
use std::sync::Arc;

/// A Cholesky factor of a symmetric positive definite matrix.
#[derive(Clone, Debug)]
pub(crate) struct Cholesky {
    /// The row of the matrix that is eliminated k-th.
    order: Arc<[u32]>,
    fronts: Arc<[Front]>,
    /// Of each front its columns, one after the other, in its rows.
    columns: Vec<Vec<f64>>,
}

impl Cholesky {
    /// Factors a matrix; `None` where a pivot is not positive, or not finite: the matrix is not positive definite, or so near to
    /// that, that rounding decides.
    ///
    /// Each front is a dense matrix: its columns of A, and what its children leave to the rows below theirs. Its own columns are
    /// eliminated, and what that leaves goes to its parent: the *multifrontal* method of Duff and Reid 1983. Fronts that are not
    /// above each other are made at the same time.
    ///
    /// # Panics
    /// Where the elimination is that of a matrix with entries in other places.
    pub(crate) fn of(matrix: &Symmetric, elimination: &Elimination) -> Option<Self> {
        assert_eq!(matrix.size(), elimination.order.len(), "the elimination of another matrix");
        let fronts = &elimination.fronts;
        let (mut columns, mut left) = (vec![Vec::new(); fronts.len()], vec![Vec::new(); fronts.len()]);
        for level in &elimination.levels {
            let made: Vec<Option<Dense>> =
                level.par_iter().map(|&front| assembled(matrix, elimination, front, &left).eliminated()).collect();
            for (&number, made) in level.iter().zip(made) {
                let made = made?;
                fronts[number as usize].children.iter().for_each(|&child| left[child as usize] = Vec::new());
                (columns[number as usize], left[number as usize]) = (made.columns, made.rest);
            }
        }
        Some(Self { order: elimination.order.clone(), fronts: fronts.clone(), columns })
    }

    /// The solution for a right-hand side.
    ///
    /// # Panics
    /// Unless that has a number for each row.
    pub(crate) fn solve(&self, right: &[f64]) -> Vec<f64> {
        assert_eq!(right.len(), self.order.len(), "a number for each row");
        let mut values: Vec<f64> = self.order.iter().map(|&v| right[v as usize]).collect();
        for (front, columns) in self.fronts.iter().zip(&self.columns) {
            for (rows, column) in by_columns(front, columns) {
                let value = values[rows[0] as usize] / column[0];
                values[rows[0] as usize] = value;
                for (&row, l) in rows[1..].iter().zip(&column[1..]) {
                    values[row as usize] -= l * value;
                }
            }
        }
        for (front, columns) in self.fronts.iter().zip(&self.columns).rev() {
            for (rows, column) in by_columns(front, columns).rev() {
                let below = rows[1..].iter().zip(&column[1..]);
                let sum: f64 = below.map(|(&row, l)| l * values[row as usize]).sum();
                values[rows[0] as usize] = (values[rows[0] as usize] - sum) / column[0];
            }
        }
        let mut found = vec![0.0; values.len()];
        for (&v, value) in self.order.iter().zip(values) {
            found[v as usize] = value;
        }
        found
    }
}

/// The columns of a front from the diagonal on, with their rows.
fn by_columns<'a>(front: &'a Front, columns: &'a [f64]) -> impl DoubleEndedIterator<Item = (&'a [u32], &'a [f64])> {
    let height = front.rows.len();
    (0..front.width).map(move |k| (&front.rows[k..], &columns[k * height + k..(k + 1) * height]))
}

/// A front before it is eliminated, from the matrix and from what its children left.
fn assembled(matrix: &Symmetric, elimination: &Elimination, front: u32, left: &[Vec<f64>]) -> Dense {
    let front = &elimination.fronts[front as usize];
    let mut dense = Dense::zero(front.rows.len(), front.width);
    for (k, &row) in front.rows[..front.width].iter().enumerate() {
        dense.add(k, k, matrix.diagonal_at(elimination.order[row as usize] as usize));
        for (below, value) in elimination.column(matrix, row) {
            let at = front.rows.binary_search(&below).expect("the elimination of another matrix");
            dense.add(at, k, value);
        }
    }
    for &child in &front.children {
        let below = elimination.fronts[child as usize].below();
        let places = places(below, &front.rows);
        for (j, column) in left[child as usize].chunks_exact(below.len()).enumerate() {
            for (&i, &value) in places[j..].iter().zip(&column[j..]) {
                dense.add(i, places[j], value);
            }
        }
    }
    dense
}

/// Where some rows are among others; both rise.
fn places(some: &[u32], others: &[u32]) -> Vec<usize> {
    let mut at = 0;
    let place = |row: &u32| {
        at += others[at..].iter().take_while(|&other| other < row).count();
        at
    };
    some.iter().map(place).collect()
}
