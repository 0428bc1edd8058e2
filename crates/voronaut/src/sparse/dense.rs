//! A dense symmetric matrix of which some columns are eliminated.

use crate::parallel::prelude::*;

/// So many columns are taken off the others at once: as many as registers hold beside what they are taken off.
const AT_ONCE: usize = 4;
/// Multiplications that are worth a thread's while.
const SHARED: usize = 1 << 16;

/// The lower half of a symmetric matrix, by columns of which the upper part is not used.
pub(super) struct Dense {
    height: usize,
    width: usize,
    /// Those that are to be eliminated, which come first, or the factor's: `height` numbers each.
    pub(super) columns: Vec<f64>,
    /// The others, in the rows below: `height - width` numbers each.
    pub(super) rest: Vec<f64>,
}

impl Dense {
    /// Zeros; the first `width` columns are to be eliminated.
    pub(super) fn zero(height: usize, width: usize) -> Self {
        let below = height - width;
        Self { height, width, columns: vec![0.0; height * width], rest: vec![0.0; below * below] }
    }

    /// Adds to an entry of the lower half.
    pub(super) fn add(&mut self, row: usize, column: usize, value: f64) {
        match column.checked_sub(self.width) {
            None => self.columns[column * self.height + row] += value,
            Some(column) => self.rest[column * (self.height - self.width) + row - self.width] += value,
        }
    }

    /// The factor's columns in place of its own, which are taken off the others; `None` where a pivot is not positive and finite.
    pub(super) fn eliminated(mut self) -> Option<Self> {
        let (height, width) = (self.height, self.width);
        for start in (0..width).step_by(AT_ONCE) {
            let end = width.min(start + AT_ONCE);
            let (done, others) = self.columns.split_at_mut(end * height);
            for k in start..end {
                let (before, column) = done.split_at_mut(k * height);
                take_off(&mut column[k..height], &before[start * height..], height, k);
                let pivot = column[k];
                if !(pivot > 0.0 && pivot.is_finite()) {
                    return None;
                }
                let root = pivot.sqrt();
                column[k] = root;
                column[k + 1..height].iter_mut().for_each(|value| *value /= root);
            }
            let done = &done[start * height..];
            shared(others, height, done.len(), |j, column| take_off(&mut column[end + j..], done, height, end + j));
        }
        let (columns, below) = (&self.columns, height - width);
        if below > 0 {
            shared(&mut self.rest, below, columns.len(), |j, column| {
                take_off(&mut column[j..], columns, height, width + j);
            });
        }
        Some(self)
    }
}

/// Does something to every column that takes so many multiplications, by all cores where it is worth while.
fn shared(columns: &mut [f64], height: usize, times: usize, work: impl Fn(usize, &mut [f64]) + Sync + Send) {
    let all = columns.par_chunks_mut(height).enumerate().with_min_len(SHARED.div_ceil(times));
    all.for_each(|(j, column)| work(j, column));
}

/// Takes columns of the factor off another from its diagonal on, which is in this row: of each as many times as its entry in that row.
fn take_off(column: &mut [f64], others: &[f64], height: usize, row: usize) {
    let mut several = others.chunks_exact(AT_ONCE * height);
    for four in &mut several {
        let of = |k: usize| &four[k * height + row..][..column.len()];
        let [a, b, c, d] = [of(0), of(1), of(2), of(3)];
        let [p, q, r, s] = [a[0], b[0], c[0], d[0]];
        for i in 0..column.len() {
            column[i] -= p * a[i] + q * b[i] + r * c[i] + s * d[i];
        }
    }
    for one in several.remainder().chunks_exact(height) {
        let one = &one[row..][..column.len()];
        let times = one[0];
        for (value, other) in column.iter_mut().zip(one) {
            *value -= times * other;
        }
    }
}
