//! The error of linear interpolation on a triangle.

use crate::geometry::{Node, Point, combine, radon, signed_area};
use crate::metric::{Norm, ScalarField};

/// A greater exponent counts as this one: powers of errors would differ by too much to be added.
const LARGEST_EXPONENT: f64 = 8.0;

/// The norm that polishing goes by where this one is asked for: L^8 for all above.
pub(crate) fn polishing_norm(norm: Norm) -> Norm {
    Norm::new(norm.exponent().min(LARGEST_EXPONENT)).unwrap_or(norm)
}

/// What is to be made small: the integral of |f - its linear interpolation|^p, in a unit of its own for f.
#[derive(Clone, Copy)]
pub(super) struct Objective<'a> {
    function: &'a dyn ScalarField,
    exponent: f64,
    unit: f64,
    nodes: [Node; 7],
}

/// A vertex, as errors see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) at: Point,
    pub(super) value: f64,
}

impl<'a> Objective<'a> {
    /// Errors are measured in shares of `unit`, which is positive.
    pub(super) fn new(function: &'a dyn ScalarField, norm: Norm, unit: f64) -> Self {
        Self { function, exponent: polishing_norm(norm).exponent(), unit, nodes: radon() }
    }

    /// A point with the function's value there.
    pub(super) fn place(&self, at: Point) -> Place {
        Place { at, value: self.function.value(at) }
    }

    /// The triangle's share, by seven values of the function; infinite of a triangle that is not counter-clockwise.
    ///
    /// Three values in the middles of the edges would not do: minimised, they find places where the function meets its
    /// interpolation there and nowhere else.
    pub(super) fn of(&self, [a, b, c]: [Place; 3]) -> f64 {
        let area = 0.5 * signed_area(a.at, b.at, c.at);
        if area <= 0.0 {
            return f64::INFINITY;
        }
        let share = |&([u, v, w], weight): &Node| {
            let p = combine([u, v, w], [a.at, b.at, c.at]);
            let error = (self.function.value(p) - (u * a.value + v * b.value + w * c.value)) / self.unit;
            weight * self.power(error)
        };
        area * self.nodes.iter().map(share).sum::<f64>()
    }

    fn power(&self, error: f64) -> f64 {
        // Exact on purpose: the default, and the fast one.
        #[expect(clippy::float_cmp)]
        let is_square = self.exponent == 2.0;
        if is_square { error * error } else { error.abs().powf(self.exponent) }
    }

    /// The norm of the error from the sum of all shares.
    pub(super) fn norm(&self, sum: f64) -> f64 {
        self.unit * sum.powf(1.0 / self.exponent)
    }
}
