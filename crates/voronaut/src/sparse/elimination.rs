//! What is known of a Cholesky factor before any number is: its order, and which columns are eliminated together.

use super::{Symmetric, nested_dissection};
use std::sync::Arc;

/// In place of a row where there is none.
const NONE: u32 = u32::MAX;

/// In which order unknowns are eliminated, and where the factor has entries then. It serves for all matrices with entries in the
/// same places.
///
/// Unknowns are numbered in that order. The parent of one, in the *elimination tree*, is the first entry of its column below the
/// diagonal, and the column has entries where the matrix does or one of its children (Davis 2006, chapter 4).
#[derive(Clone, Debug)]
pub(crate) struct Elimination {
    /// The row of the matrix that is eliminated k-th.
    pub(super) order: Arc<[u32]>,
    /// When a row of the matrix is eliminated.
    place: Vec<u32>,
    /// In the order of their columns: each after its children.
    pub(super) fronts: Arc<[Front]>,
    /// Fronts that need nothing of each other; each after the fronts that are above it in the list.
    pub(super) levels: Vec<Vec<u32>>,
}

/// Columns that follow each other and have entries in the same rows below them (a *fundamental supernode*): they are eliminated
/// together, as columns of a dense matrix.
#[derive(Clone, Debug)]
pub(super) struct Front {
    /// The rows with entries, rising: first those of its own columns.
    pub(super) rows: Vec<u32>,
    /// The number of its columns.
    pub(super) width: usize,
    /// Fronts whose first row below their columns is one of its columns.
    pub(super) children: Vec<u32>,
}

impl Front {
    /// The rows below its columns.
    pub(super) fn below(&self) -> &[u32] {
        &self.rows[self.width..]
    }

    fn parent(&self) -> Option<u32> {
        self.below().first().copied()
    }
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
        let mut elimination = Self { order: order.into(), place, fronts: Arc::default(), levels: Vec::new() };
        let fronts = elimination.fronts_of(matrix);
        elimination.levels = levels(&fronts);
        elimination.fronts = fronts.into();
        elimination
    }

    /// The number of entries of the factor.
    #[cfg(test)]
    pub(super) fn entries(&self) -> usize {
        let column = |front: &Front, k: usize| front.rows.len() - k;
        self.fronts.iter().map(|front| (0..front.width).map(|k| column(front, k)).sum::<usize>()).sum()
    }

    /// The entries of the matrix below the diagonal in the column that is eliminated k-th, in no order of rows.
    pub(super) fn column(&self, matrix: &Symmetric, k: u32) -> impl Iterator<Item = (u32, f64)> {
        let row = matrix.row(self.order[k as usize] as usize);
        row.map(|(j, value)| (self.place[j], value)).filter(move |&(j, _)| j > k)
    }

    fn fronts_of(&self, matrix: &Symmetric) -> Vec<Front> {
        let n = self.order.len();
        let mut fronts: Vec<Front> = Vec::new();
        // Fronts that ended, at their parents.
        let mut ended: Vec<Vec<u32>> = vec![Vec::new(); n];
        let (mut seen, mut rows) = (vec![NONE; n], Vec::new());
        for k in 0..n as u32 {
            rows.clear();
            let mut add = |row: u32| {
                if row > k && seen[row as usize] != k {
                    seen[row as usize] = k;
                    rows.push(row);
                }
            };
            self.column(matrix, k).for_each(|(row, _)| add(row));
            let mut children = std::mem::take(&mut ended[k as usize]);
            let last = fronts.last().filter(|last| last.parent() == Some(k));
            let of_children = children.iter().map(|&child| &fronts[child as usize]).chain(last);
            of_children.flat_map(Front::below).for_each(|&row| add(row));
            let goes_on = last.is_some_and(|last| last.below().len() == rows.len() + 1);
            let number = fronts.len().saturating_sub(1);
            match fronts.last_mut() {
                Some(last) if goes_on => {
                    last.width += 1;
                    last.children.append(&mut children);
                    continue;
                }
                Some(last) => match last.parent() {
                    Some(parent) if parent == k => children.push(number as u32),
                    Some(parent) => ended[parent as usize].push(number as u32),
                    None => {}
                },
                None => {}
            }
            rows.push(k);
            rows.sort_unstable();
            fronts.push(Front { rows: rows.clone(), width: 1, children });
        }
        fronts
    }
}

/// Fronts by how many are below them in the tree, one under the other.
fn levels(fronts: &[Front]) -> Vec<Vec<u32>> {
    let (mut level, mut levels) = (vec![0; fronts.len()], Vec::<Vec<u32>>::new());
    for (number, front) in fronts.iter().enumerate() {
        level[number] = front.children.iter().map(|&child| level[child as usize] + 1).max().unwrap_or(0);
        if level[number] == levels.len() {
            levels.push(Vec::new());
        }
        levels[level[number]].push(number as u32);
    }
    levels
}
