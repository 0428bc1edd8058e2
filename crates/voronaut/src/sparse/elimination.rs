//! What is known of a Cholesky factor before any number is: its order, its tree, the length of its columns.

use super::{Symmetric, nested_dissection};

/// In place of a vertex of the tree where there is none.
const NONE: u32 = u32::MAX;

/// In which order unknowns are eliminated, and how large each column of the factor is then. It serves for all matrices with
/// entries in the same places.
///
/// Unknowns are numbered in that order. The parent of one, in the *elimination tree*, is the first entry of its column below the
/// diagonal. Everything else follows from the tree: row k of the factor has entries where ways up the tree, from the entries of
/// row k of the matrix, pass before k (Davis 2006, chapter 4).
#[derive(Clone, Debug)]
pub(crate) struct Elimination {
    /// The row of the matrix that is eliminated k-th.
    pub(super) order: Vec<u32>,
    /// When a row of the matrix is eliminated.
    place: Vec<u32>,
    /// Column k of the factor, without the diagonal, is from `starts[k]` to `starts[k + 1]`.
    pub(super) starts: Vec<usize>,
}

impl Elimination {
    /// By nested dissection.
    pub(crate) fn of(matrix: &Symmetric) -> Self {
        Self::in_order(matrix, nested_dissection(matrix))
    }

    /// In any order of the rows.
    ///
    /// # Panics
    /// Unless the order has every row once.
    pub(crate) fn in_order(matrix: &Symmetric, order: Vec<u32>) -> Self {
        let n = matrix.size();
        let mut place = vec![NONE; n];
        for (k, &v) in order.iter().enumerate() {
            place[v as usize] = k as u32;
        }
        assert!(order.len() == n && !place.contains(&NONE), "every row once");
        let mut elimination = Self { order, place, starts: Vec::new() };
        elimination.starts = elimination.columns(matrix);
        elimination
    }

    /// The number of entries of the factor.
    #[cfg(test)]
    pub(super) fn entries(&self) -> usize {
        self.starts[self.order.len()] + self.order.len()
    }

    /// The entries of row k left of the diagonal, in no order of columns.
    pub(super) fn row(&self, matrix: &Symmetric, k: usize) -> impl Iterator<Item = (usize, f64)> {
        let row = matrix.row(self.order[k] as usize);
        row.map(|(j, value)| (self.place[j] as usize, value)).filter(move |&(j, _)| j < k)
    }

    fn columns(&self, matrix: &Symmetric) -> Vec<usize> {
        let n = self.order.len();
        let (mut starts, mut reach) = (vec![0; n + 1], Reach::new(n));
        for k in 0..n {
            for &i in reach.of_row(k, self, matrix) {
                starts[i as usize + 1] += 1;
            }
        }
        for k in 0..n {
            starts[k + 1] += starts[k];
        }
        starts
    }
}

/// Where rows of the factor have entries, one after the other. The tree grows with them: a root that a row comes to is its
/// child from then on.
pub(super) struct Reach {
    /// The parent of each unknown, as far as rows before tell.
    parents: Vec<u32>,
    /// The last row whose ways passed.
    seen: Vec<u32>,
    path: Vec<u32>,
    found: Vec<u32>,
}

impl Reach {
    pub(super) fn new(size: usize) -> Self {
        Self { parents: vec![NONE; size], seen: vec![NONE; size], path: Vec::new(), found: vec![0; size] }
    }

    /// The columns of row k, left of the diagonal: each before its parent.
    pub(super) fn of_row(&mut self, k: usize, elimination: &Elimination, matrix: &Symmetric) -> &[u32] {
        // A way ends where one found before went on, and is put in front of it.
        let mut start = self.found.len();
        self.seen[k] = k as u32;
        for (mut i, _) in elimination.row(matrix, k) {
            self.path.clear();
            while self.seen[i] != k as u32 {
                self.seen[i] = k as u32;
                self.path.push(i as u32);
                if self.parents[i] == NONE {
                    self.parents[i] = k as u32;
                }
                i = self.parents[i] as usize;
            }
            let end = start;
            start -= self.path.len();
            self.found[start..end].copy_from_slice(&self.path);
        }
        &self.found[start..]
    }
}
