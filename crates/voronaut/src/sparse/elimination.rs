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
    parents: Vec<u32>,
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
        let mut elimination = Self { order, place, parents: Vec::new(), starts: Vec::new() };
        elimination.parents = elimination.tree(matrix);
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

    /// The parent of each unknown. Rows are added one by one: the roots that were reached from an entry of row k become children
    /// of k. Ways up are shortened as they are walked.
    fn tree(&self, matrix: &Symmetric) -> Vec<u32> {
        let n = self.order.len();
        let (mut parents, mut ancestors) = (vec![NONE; n], vec![NONE; n]);
        for k in 0..n {
            for (j, _) in self.row(matrix, k) {
                let mut i = j;
                while i != k {
                    let above = std::mem::replace(&mut ancestors[i], k as u32);
                    if above == NONE {
                        parents[i] = k as u32;
                        break;
                    }
                    i = above as usize;
                }
            }
        }
        parents
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

/// Where rows of the factor have entries, with memory for all of them in turn.
pub(super) struct Reach {
    /// The last row whose ways passed.
    seen: Vec<u32>,
    path: Vec<u32>,
    found: Vec<u32>,
}

impl Reach {
    pub(super) fn new(size: usize) -> Self {
        Self { seen: vec![NONE; size], path: Vec::new(), found: vec![0; size] }
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
                i = elimination.parents[i] as usize;
            }
            let end = start;
            start -= self.path.len();
            self.found[start..end].copy_from_slice(&self.path);
        }
        &self.found[start..]
    }
}
