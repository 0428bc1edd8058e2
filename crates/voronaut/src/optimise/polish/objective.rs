//! The error of linear interpolation on a triangle, and how it changes where a corner moves.

use super::Sheet;
use super::frame::Frame;
use crate::elementary::Elementary;
use crate::geometry::{Jet, Node, Vector, radon};
use crate::metric::{Near, Norm};

/// A vertex, as errors see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<At> {
    pub(super) at: At,
    pub(super) value: f64,
}

/// A greater exponent counts as this one: powers of errors would differ by too much to be added.
const LARGEST_EXPONENT: f64 = 8.0;

/// The norm that polishing goes by where this one is asked for: L^8 for all above.
pub(crate) fn polishing_norm(norm: Norm) -> Norm {
    Norm::new(norm.exponent().min(LARGEST_EXPONENT)).unwrap_or(norm)
}

/// What is to be made small: the integral of |f - its linear interpolation|^p, in a unit of its own for f.
#[derive(Clone, Copy)]
pub(super) struct Objective {
    norm: Norm,
    unit: f64,
    nodes: [Node; 7],
}

impl Objective {
    /// Errors are measured in shares of `unit`, which is positive.
    pub(super) fn new(norm: Norm, unit: f64) -> Self {
        Self { norm: polishing_norm(norm), unit, nodes: radon() }
    }

    /// The triangle's share, by seven values of the function; infinite of a triangle that is turned over.
    ///
    /// Three values in the middles of the edges would not do: minimised, they find places where the function meets its
    /// interpolation there and nowhere else.
    pub(super) fn of<S: Sheet>(&self, sheet: &S, corners: [Place<S::At>; 3]) -> f64 {
        let [a, b, c] = corners;
        let places = corners.map(|corner| corner.at);
        let area = sheet.area(places);
        if area <= 0.0 {
            return f64::INFINITY;
        }
        let mut near = Near::default();
        let share = |&([u, v, w], weight): &Node| {
            let error = (sheet.value_within(places, [u, v, w], &mut near) - (u * a.value + v * b.value + w * c.value))
                * (1.0 / self.unit);
            weight * self.norm.power(error)
        };
        area * self.nodes.iter().map(share).sum::<f64>()
    }

    /// The same, with derivatives by where the first corner is, in the directions of a frame. Known are those of the function there, and
    /// where a step of each direction leads. `None` where the function's are not known within the triangle.
    pub(super) fn expansion<S: Sheet>(
        &self,
        sheet: &S,
        corners: [Place<S::At>; 3],
        frame: &Frame,
        known: Jet,
        moved: [Option<S::At>; 2],
    ) -> Option<Jet> {
        let [a, b, c] = corners;
        let places = corners.map(|corner| corner.at);
        // Linear in each direction.
        let area = sheet.area(places);
        let grown = |to: Option<S::At>| to.map_or(0.0, |at| sheet.area([at, places[1], places[2]]) - area);
        let [by_first, by_second] = moved.map(grown);
        let (mut sum, mut near) = (Jet::default(), Near::default());
        for &([u, v, w], weight) in &self.nodes {
            let there = sheet.jet_within(places, [u, v, w], frame, &mut near)?;
            let between = known * u;
            let value = there.value - (u * a.value + v * b.value + w * c.value);
            let error = Jet { value, ..there.slowed(u) - between } * (1.0 / self.unit);
            sum = sum + self.power_of(error) * weight;
        }
        let area = Jet { value: area, gradient: Vector::new(by_first, by_second), ..Jet::default() };
        Some(area * sum)
    }

    fn power_of(&self, error: Jet) -> Jet {
        let (p, value) = (self.norm.exponent(), self.norm.power(error.value));
        if error.value == 0.0 {
            // Of a square there is a second derivative to keep; of lesser powers it is infinite, of greater ones zero.
            return error.chain(0.0, [0.0, if self.norm.is_square() { 2.0 } else { 0.0 }]);
        }
        let first = p * value / error.value;
        error.chain(value, [first, (p - 1.0) * first / error.value])
    }

    /// The norm of the error from the sum of all shares.
    pub(super) fn norm(&self, sum: f64) -> f64 {
        self.unit * sum.raised_to(1.0 / self.norm.exponent())
    }
}
