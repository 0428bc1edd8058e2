//! Terms of the energy of a curved mesh: of triangles, and of sides, in a metric; with their derivatives by what may move.

use super::bezier::MOST;
use super::density::{Density, Matrix, dirichlet, inner};
use super::rules::{GAUSS, Rule, on_curve};
use crate::elementary::Elementary;
use crate::geometry::{Point, Tensor, Vector, to_frame};
use crate::metric::{MetricField, Near};

/// Unknowns of a term, at most: two for each point.
pub(super) const UNKNOWNS: usize = 2 * MOST;
/// The metric is differentiated over steps of such a metric length: their square is the relative error, and the fourth root of rounding
/// would be the step that balances both.
const STEP: f64 = 1e-3;

/// An unknown: how far a point of a term goes along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Freedom {
    /// The number of the point in the term.
    pub(super) point: usize,
    pub(super) axis: Vector,
    /// The number of the unknown in the whole.
    pub(super) row: u32,
}

/// The value of a term, its derivatives by the unknowns, and a matrix of second derivatives that is positive semidefinite, by the
/// rows of its lower half.
#[derive(Clone)]
pub(super) struct Expansion {
    pub(super) value: f64,
    pub(super) slope: [f64; UNKNOWNS],
    pub(super) curvature: [f64; UNKNOWNS * (UNKNOWNS + 1) / 2],
}

impl Expansion {
    fn new() -> Self {
        Self { value: 0.0, slope: [0.0; UNKNOWNS], curvature: [0.0; UNKNOWNS * (UNKNOWNS + 1) / 2] }
    }

    /// Adds the square of a linear form, times a factor.
    fn add_square(&mut self, form: &[f64], factor: f64) {
        let mut at = 0;
        for (a, &one) in form.iter().enumerate() {
            let scaled = factor * one;
            for (entry, other) in self.curvature[at..=at + a].iter_mut().zip(form) {
                *entry += scaled * other;
            }
            at += a + 1;
        }
    }
}

/// The derivatives of a metric along x and y, by differences along its own axes, where it may change at very different rates.
fn derivatives(metric: &dyn MetricField, p: Point, m: Tensor, near: &mut Near) -> [Tensor; 2] {
    let [columns, axes] = m.frames();
    let along = axes.map(|axis| {
        let step = axis * STEP;
        (metric.at_near(p + step, near) - metric.at_near(p - step, near)) * (0.5 / STEP)
    });
    columns.map(|c| along[0] * c.x + along[1] * c.y)
}

/// F'^-1 w for the upper triangular F with these entries.
fn from_transposed([a, b, c]: [f64; 3], w: Vector) -> Vector {
    let x = w.x / a;
    Vector::new(x, (w.y - b * x) / c)
}

/// F' w.
fn transposed([a, b, c]: [f64; 3], w: Vector) -> Vector {
    Vector::new(a * w.x, b * w.x + c * w.y)
}

/// The energy of a triangle, and no more.
pub(super) fn triangle_energy(rule: &Rule, points: &[Point], metric: &dyn MetricField) -> f64 {
    let mut near = Near::default();
    let at = |place: &super::rules::Place| {
        let frame = metric.at_near(place.image(points), &mut near).cholesky();
        place.weight * dirichlet(place.derivative(points).map(|side| to_frame(frame, side)))
    };
    rule.places.iter().map(at).sum()
}

/// The energy of a triangle: the mean over the reference triangle of the symmetric Dirichlet energy of the map from the equilateral
/// triangle with sides of length one, seen in an orthonormal frame of the metric at the image.
///
/// The second derivatives are those of the density along what the map does to first order. (Frames turn with the place so that
/// their change is symmetric, F' dF = dM / 2: others differ by a rotation, which the density does not see.)
pub(super) fn triangle(rule: &Rule, points: &[Point], freedoms: &[Freedom], metric: &dyn MetricField) -> Expansion {
    let mut found = Expansion::new();
    let mut near = Near::default();
    for place in &rule.places {
        let at = place.image(points);
        let m = metric.at_near(at, &mut near);
        let (frame, sides) = (m.cholesky(), place.derivative(points));
        let density = Density::dirichlet(sides.map(|side| to_frame(frame, side)));
        // What the map in the frame gains where the place moves along x and along y.
        let gains = derivatives(metric, at, m, &mut near)
            .map(|dm| sides.map(|side| from_transposed(frame, dm.apply(side)) * 0.5));
        found.value += place.weight * density.value;
        let form = |matrix: &Matrix| {
            let (pulled, moved) =
                (matrix.map(|c| transposed(frame, c)), gains.each_ref().map(|gain| inner(matrix, gain)));
            let mut form = [0.0; UNKNOWNS];
            for (entry, freedom) in form.iter_mut().zip(freedoms) {
                let (value, slope) = (place.values[freedom.point], place.slopes[freedom.point]);
                let by_point = pulled[0] * slope.x + pulled[1] * slope.y + Vector::new(moved[0], moved[1]) * value;
                *entry = by_point.dot(freedom.axis);
            }
            form
        };
        for (entry, slope) in found.slope.iter_mut().zip(form(&density.slope)) {
            *entry += place.weight * slope;
        }
        for (curvature, matrix) in &density.curvatures {
            found.add_square(&form(matrix)[..freedoms.len()], place.weight * curvature);
        }
    }
    found
}

/// The metric length of a curve by its Bezier points.
pub(super) fn curve_length(points: &[Point], metric: &dyn MetricField) -> f64 {
    let mut near = Near::default();
    let at = |&(t, weight): &(f64, f64)| {
        let (p, slope) = curve_at(points, t);
        weight * metric.at_near(p, &mut near).length(slope)
    };
    GAUSS.iter().map(at).sum()
}

/// The place on a curve, and its derivative.
pub(crate) fn curve_at(points: &[Point], t: f64) -> (Point, Vector) {
    let basis = on_curve(points.len() - 1, t);
    let sum = |which: usize| {
        points.iter().zip(basis).fold(Vector::default(), |sum, (p, b)| sum + Vector::new(p.x, p.y) * b[which])
    };
    let place = sum(0);
    (Point::new(place.x, place.y), sum(1))
}

/// What a length costs: its first derivative and a bound of the second from below that is not negative come after the value, by the
/// logarithm of the length.
fn cost(length: f64, weight: f64) -> [f64; 3] {
    let y = length.logarithm();
    [0.5 * weight * y * y, weight * y, weight]
}

/// The cost of the length of a side, and no more.
pub(super) fn side_energy(points: &[Point], metric: &dyn MetricField, weight: f64) -> f64 {
    cost(curve_length(points, metric), weight)[0]
}

/// The cost of the length of a side.
pub(super) fn side(points: &[Point], freedoms: &[Freedom], metric: &dyn MetricField, weight: f64) -> Expansion {
    let mut near = Near::default();
    let (mut length, mut form) = (0.0, [0.0; UNKNOWNS]);
    for (t, share) in GAUSS {
        let (p, slope) = curve_at(points, t);
        let basis = on_curve(points.len() - 1, t);
        let m = metric.at_near(p, &mut near);
        let speed = m.length(slope);
        let [x, y] = derivatives(metric, p, m, &mut near).map(|dm| dm.dot(slope, slope));
        let (pulled, moved) = (m.apply(slope) * (1.0 / speed), Vector::new(x, y) * (0.5 / speed));
        length += share * speed;
        for (entry, freedom) in form.iter_mut().zip(freedoms) {
            let [value, by_t] = basis[freedom.point];
            *entry += share * (pulled * by_t + moved * value).dot(freedom.axis);
        }
    }
    let [value, first, second] = cost(length, weight);
    let mut found = Expansion { value, ..Expansion::new() };
    let form = form.map(|entry| entry / length);
    for (entry, form) in found.slope.iter_mut().zip(form) {
        *entry = first * form;
    }
    found.add_square(&form[..freedoms.len()], second);
    found
}
