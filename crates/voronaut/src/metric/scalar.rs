//! Functions on the plane: what solutions are, and what metrics are made for.

use super::Expression;
use crate::geometry::{Point, Point3, Tensor};

/// A function on the plane.
///
/// The contract: `value` is a pure function of the point, defined on the whole domain; where it is not finite, whoever uses
/// it says so.
pub trait ScalarField: Sync {
    /// The value at a point.
    fn value(&self, p: Point) -> f64;
}

/// An expression in x, y and t at one time.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// The expression, of [`Variables::Motion`](super::Variables::Motion) or of the plane.
    pub expression: Expression,
    /// The value of t.
    pub time: f64,
}

impl Snapshot {
    /// Exact second derivatives by x and y.
    pub fn second_derivatives(&self, p: Point) -> Tensor {
        let hessian = self.expression.jet(Point3::new(p.x, p.y, self.time)).hessian;
        Tensor::new(hessian.xx, hessian.xy, hessian.yy)
    }
}

impl From<Expression> for Snapshot {
    fn from(expression: Expression) -> Self {
        Self { expression, time: 0.0 }
    }
}

impl ScalarField for Snapshot {
    fn value(&self, p: Point) -> f64 {
        self.expression.at(p.x, p.y, self.time)
    }
}

impl<F: Fn(Point) -> f64 + Sync> ScalarField for F {
    fn value(&self, p: Point) -> f64 {
        self(p)
    }
}
