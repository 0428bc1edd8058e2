//! Functions on the plane: what solutions are, and what metrics are made for.

use super::Expression;
use crate::geometry::Point;

/// A function on the plane.
///
/// The contract: `value` is a pure function of the point, defined on the whole domain; where it is not finite, whoever uses
/// it says so.
pub trait ScalarField: Sync {
    /// The value at a point.
    fn value(&self, p: Point) -> f64;
}

impl ScalarField for Expression {
    fn value(&self, p: Point) -> f64 {
        self.at(p.x, p.y, 0.0)
    }
}

impl<F: Fn(Point) -> f64 + Sync> ScalarField for F {
    fn value(&self, p: Point) -> f64 {
        self(p)
    }
}
