//! Metric fields: a symmetric positive definite tensor at every point of the domain.

use crate::geometry::{Point, Tensor};

/// A Riemannian metric field on the plane.
///
/// The contract: `at` is a pure function of the point, defined on the whole domain and finite a little outside it
/// (derivatives are taken by differences), and returns a positive definite tensor in units of 1 / length^2.
pub trait MetricField: Sync {
    /// The tensor at a point.
    fn at(&self, p: Point) -> Tensor;
}

impl<F: Fn(Point) -> Tensor + Sync> MetricField for F {
    fn at(&self, p: Point) -> Tensor {
        self(p)
    }
}
