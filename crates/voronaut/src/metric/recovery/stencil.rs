//! The vertices around one, coordinates in which they lie evenly around it, and small dense least squares there that say how well
//! they are determined.

use super::super::neighbours::Neighbours;
use crate::geometry::{Tensor, Vector};

/// Vertices by their rings around one: ring k are those k edges away.
pub(super) struct Rings<'a> {
    around: &'a Neighbours,
    found: Vec<u32>,
    /// Where the last ring begins.
    last: usize,
}

impl<'a> Rings<'a> {
    pub(super) fn new(around: &'a Neighbours, v: usize) -> Self {
        Self { around, found: vec![v as u32], last: 0 }
    }

    /// Adds a ring; false where nothing is left to add.
    pub(super) fn grow(&mut self) -> bool {
        let (start, end) = (self.last, self.found.len());
        let next: Vec<u32> = self.found[start..].iter().flat_map(|&v| self.around.at(v as usize)).copied().collect();
        for v in next {
            // Few enough that looking through them beats a set.
            if !self.found.contains(&v) {
                self.found.push(v);
            }
        }
        self.last = end;
        self.found.len() > end
    }

    /// All but the vertex itself, nearer rings first.
    pub(super) fn vertices(&self) -> &[u32] {
        &self.found[1..]
    }
}

/// Less than this share of its square is the rounding of a covariance's determinant.
const FLAT: f64 = 1e-24;

/// Linear coordinates in which vertices around a centre have the identity as their covariance: on meshes of any anisotropy they
/// see each other at distances of about one.
pub(super) struct Frame {
    factor: [f64; 3],
}

impl Frame {
    /// From the ways there from the centre; `None` where all lie on one line with it, or on it.
    pub(super) fn of(offsets: &[Vector]) -> Option<Self> {
        let longest = offsets.iter().map(|d| d.norm()).fold(0.0, f64::max);
        if longest == 0.0 {
            return None;
        }
        // Scaled first: squares of small lengths underflow, and so do their determinants.
        let covariance = offsets
            .iter()
            .map(|&d| d * (1.0 / longest))
            .fold(Tensor::default(), |sum, d| sum + Tensor::square(d) * (1.0 / offsets.len() as f64));
        let trace = covariance.xx + covariance.yy;
        if covariance.determinant() <= FLAT * trace * trace {
            return None;
        }
        let factor = covariance.inverse().cholesky().map(|entry| entry / longest);
        Some(Self { factor })
    }

    /// The way to a vertex in these coordinates.
    pub(super) fn place(&self, d: Vector) -> Vector {
        let [a, b, c] = self.factor;
        Vector::new(a * d.x + b * d.y, c * d.y)
    }

    /// Second derivatives by x and y from those by these coordinates: F' H F.
    pub(super) fn back(&self, h: Tensor) -> Tensor {
        let [a, b, c] = self.factor;
        h.along([Vector::new(a, 0.0), Vector::new(b, c)])
    }
}

/// What rows and values determine.
pub(crate) struct Solved<const N: usize> {
    /// One per column; zero of a column that the columns before it leave next to nothing of.
    pub(crate) coefficients: [f64; N],
    /// The least share of a column that the columns before it do not explain: 1 of orthogonal columns, 0 of dependent ones.
    pub(crate) independence: f64,
}

/// Less of a column is rounding, or points that happen to lie on a curve of second order.
const DEPENDENT: f64 = 1e-3;

/// The coefficients c that make the sum of the squares of (row . c - value) least, by modified Gram-Schmidt (Björck 1967).
/// Columns come in the order of their importance: what the first explain is not left to the later ones.
pub(crate) fn least_squares<const N: usize>(rows: &mut [[f64; N]], values: &mut [f64]) -> Solved<N> {
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
        let found = least_squares(&mut rows, &mut [2.0, 2.0, 4.0, 8.0]);
        assert!((found.coefficients[0] - 1.0).abs() < 1e-14 && (found.coefficients[1] - 2.0).abs() < 1e-14);
        // Of the second column the first explains its mean.
        assert!((found.independence - (5.0_f64 / 14.0).sqrt()).abs() < 1e-14);
    }

    #[test]
    fn what_depends_is_left_to_the_first_columns() {
        let mut rows = [[1.0, 2.0, 0.0], [2.0, 4.0, 1.0], [3.0, 6.0, -1.0], [0.5, 1.0, 0.3]];
        let mut values = rows.map(|row| 3.0 * row[0] - row[2]);
        let found = least_squares(&mut rows, &mut values);
        let [a, b, c] = found.coefficients;
        assert!((a - 3.0).abs() < 1e-13 && b.abs() < 1e-13 && (c + 1.0).abs() < 1e-13);
        assert!(found.independence < 1e-13);
    }
}
