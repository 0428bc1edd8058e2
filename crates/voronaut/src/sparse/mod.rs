//! Sparse symmetric systems of equations, solved by a factor or by conjugate gradients.
//!
//! | | for |
//! |---|---|
//! | `Cholesky` | a matrix that serves for several right-hand sides, and solutions that are accurate however small |
//! | `conjugate_gradients` | a matrix near its diagonal, known by what it makes of a vector |
//!
//! Conjugate gradients find a solution to rounding of its greatest value. Heat falls to 1e-280 of that far away, and its
//! gradient is followed there too: only a factor keeps the relative accuracy of every value. (Where nothing off the diagonal
//! is positive, nor anything on the right negative, solving with a factor only adds what has one sign.)
//!
//! Matrices are those of triangulations, of up to some 250,000 rows. Their graphs are planar or nearly so: a short line of
//! vertices cuts them in halves, so that a factor in a good order, `nested_dissection`, has a few n log2 n entries, where
//! any order along the rows has n^1.5.

mod cholesky;
mod conjugate;
mod dense;
mod elimination;
mod matrix;
mod ordering;
#[cfg(test)]
mod tests;

pub(crate) use cholesky::Cholesky;
pub(crate) use conjugate::{conjugate_gradients, dot};
pub(crate) use elimination::Elimination;
pub(crate) use matrix::Symmetric;
pub(crate) use ordering::nested_dissection;
