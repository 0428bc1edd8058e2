//! Symmetric matrices, by compressed rows.

use crate::lists::{Rows, distinct};
use crate::parallel::prelude::*;
use std::ops::Range;

/// A symmetric matrix of which only some entries are kept, by compressed rows: both halves, columns rising, and the whole
/// diagonal, zeros too.
#[derive(Clone, Debug)]
pub(crate) struct Symmetric {
    /// Row i is from `starts[i]` to `starts[i + 1]`.
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Symmetric {
    /// The matrix of `size` rows with these entries: row, column, value. Entries of one place are summed, in order. The upper
    /// half is the mirror image of the lower one: entries there (row < column) are not read.
    ///
    /// # Panics
    /// Of an entry in the lower half beyond the last row.
    pub(crate) fn from_triplets(size: usize, entries: &[(u32, u32, f64)]) -> Self {
        let diagonal = (0..size as u32).map(|i| (i, i, 0.0));
        let lower = entries.iter().copied().filter(|&(i, j, _)| i >= j);
        let all = diagonal.chain(lower.flat_map(with_mirror_image));
        let rows = Rows::new(size, all.map(|(i, j, value)| (i, (j, value))));
        let mut matrix = Self { starts: vec![0], columns: Vec::new(), values: Vec::new() };
        let mut row: Vec<(u32, f64)> = Vec::new();
        for i in 0..size {
            row.clear();
            row.extend(rows.row(i));
            row.sort_by_key(|&(column, _)| column);
            for same in row.chunk_by(|a, b| a.0 == b.0) {
                matrix.columns.push(same[0].0);
                matrix.values.push(same.iter().map(|&(_, value)| value).sum());
            }
            matrix.starts.push(matrix.columns.len());
        }
        matrix
    }

    /// The matrix of `size` rows, all zeros, with an entry for any two rows of a group, and the whole diagonal.
    ///
    /// # Panics
    /// Of a row beyond the last one.
    pub(crate) fn of_groups(size: usize, groups: &[Vec<u32>]) -> Self {
        let members = (0..).zip(groups).flat_map(|(g, rows)| rows.iter().map(move |&row| (row, g)));
        let groups_of = Rows::<u32>::new(size, members);
        let of_row = |i: usize| {
            let others = groups_of.row(i).iter().flat_map(|&g| groups[g as usize].iter().copied());
            distinct(others.chain(std::iter::once(i as u32)))
        };
        let rows: Vec<Vec<u32>> = (0..size).into_par_iter().map(of_row).collect();
        let mut starts = vec![0];
        starts.extend(rows.iter().scan(0, |end, row| {
            *end += row.len();
            Some(*end)
        }));
        let columns = rows.concat();
        Self { starts, values: vec![0.0; columns.len()], columns }
    }

    /// The matrix with something added to its diagonal.
    ///
    /// # Panics
    /// Unless there is a number for each row.
    #[must_use]
    pub(crate) fn plus_diagonal(mut self, added: &[f64]) -> Self {
        assert_eq!(added.len(), self.size(), "a number for each row");
        for (i, value) in added.iter().enumerate() {
            self.add(self.place(i, i), *value);
        }
        self
    }

    /// The number of rows.
    pub(crate) fn size(&self) -> usize {
        self.starts.len() - 1
    }

    /// The diagonal.
    #[cfg(test)]
    pub(super) fn diagonal(&self) -> Vec<f64> {
        (0..self.size()).map(|i| self.diagonal_at(i)).collect()
    }

    /// Sets all entries to zero.
    pub(crate) fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Adds to the entry at a place, and to that alone: the caller adds to its mirror image as much.
    pub(crate) fn add(&mut self, place: u32, value: f64) {
        self.values[place as usize] += value;
    }

    /// The place of an entry that the matrix has.
    pub(crate) fn place(&self, i: usize, j: usize) -> u32 {
        (self.starts[i] + self.neighbours(i).partition_point(|&k| (k as usize) < j)) as u32
    }

    /// The entry on the diagonal.
    pub(crate) fn diagonal_at(&self, i: usize) -> f64 {
        self.values[self.place(i, i) as usize]
    }

    /// Columns and values of a row, columns rising.
    pub(crate) fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        self.neighbours(i).iter().zip(&self.values[self.range(i)]).map(|(&j, &value)| (j as usize, value))
    }

    /// The columns of a row, rising; its own among them.
    pub(crate) fn neighbours(&self, i: usize) -> &[u32] {
        &self.columns[self.range(i)]
    }

    /// The matrix times a vector.
    #[cfg(test)]
    pub(super) fn times(&self, vector: &[f64]) -> Vec<f64> {
        (0..self.size()).map(|i| self.row(i).map(|(j, value)| value * vector[j]).sum()).collect()
    }

    fn range(&self, i: usize) -> Range<usize> {
        self.starts[i]..self.starts[i + 1]
    }
}

/// One after the other, so that both halves are sums in the same order.
fn with_mirror_image((i, j, value): (u32, u32, f64)) -> impl Iterator<Item = (u32, u32, f64)> + Clone {
    std::iter::once((i, j, value)).chain((i != j).then_some((j, i, value)))
}
