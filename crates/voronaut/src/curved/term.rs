//! Terms of the energy of a curved mesh: of triangles, and of sides, in a metric; with their derivatives by what may move.

use super::bezier::MOST;
use super::density::{Density, Matrix, dirichlet, inner, times};
use super::eigen::positive_part;
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
    pub(super) fn new() -> Self {
        Self { value: 0.0, slope: [0.0; UNKNOWNS], curvature: [0.0; UNKNOWNS * (UNKNOWNS + 1) / 2] }
    }

    /// Adds the square of a linear form, times a factor.
    pub(super) fn add_square(&mut self, form: &[f64], factor: f64) {
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

/// A metric around a point, in coordinates in which it is the identity there: its first derivatives along both axes, and its second
/// ones along the first, the second, and both.
pub(super) struct Around {
    pub(super) first: [Tensor; 2],
    second: [Tensor; 3],
}

impl Around {
    /// By differences along the metric's own axes.
    pub(super) fn of(metric: &dyn MetricField, p: Point, m: Tensor, near: &mut Near) -> Self {
        let [_, axes] = m.frames();
        let [u, v] = axes.map(|axis| axis * STEP);
        let mut at = |step: Vector| metric.at_near(p + step, near).along(axes);
        let [[a, b], [c, d], [e, f]] = [u, v, u + v].map(|step| [at(step), at(-step)]);
        let first = |after: Tensor, before: Tensor| (after - before) * (0.5 / STEP);
        let second = |after: Tensor, before: Tensor| (after + before - Tensor::IDENTITY * 2.0) * (1.0 / (STEP * STEP));
        let (uu, vv, both) = (second(a, b), second(c, d), second(e, f));
        Self { first: [first(a, b), first(c, d)], second: [uu, vv, (both - uu - vv) * 0.5] }
    }
}

/// F' w.
pub(super) fn transposed([a, b, c]: [f64; 3], w: Vector) -> Vector {
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
/// Second derivatives are exact at each place, where those directions count as flat along which the energy is concave.
pub(super) fn triangle(rule: &Rule, points: &[Point], freedoms: &[Freedom], metric: &dyn MetricField) -> Expansion {
    let mut found = Expansion::new();
    let mut near = Near::default();
    for place in &rule.places {
        let at = place.image(points);
        let m = metric.at_near(at, &mut near);
        let frame = m.cholesky();
        let model = Model::of(
            place.derivative(points).map(|side| to_frame(frame, side)),
            &Around::of(metric, at, m, &mut near),
        );
        found.value += place.weight * model.value;
        let form = |d: &[f64; 6]| {
            let pulled = [[d[0], d[1]], [d[2], d[3]], [d[4], d[5]]].map(|[x, y]| transposed(frame, Vector::new(x, y)));
            let mut form = [0.0; UNKNOWNS];
            for (entry, freedom) in form.iter_mut().zip(freedoms) {
                let (value, slope) = (place.values[freedom.point], place.slopes[freedom.point]);
                *entry = (pulled[0] * slope.x + pulled[1] * slope.y + pulled[2] * value).dot(freedom.axis);
            }
            form
        };
        for (entry, slope) in found.slope.iter_mut().zip(form(&model.slope)) {
            *entry += place.weight * slope;
        }
        for (curvature, direction) in positive_part(model.curvature).iter().filter(|(curvature, _)| *curvature > 0.0) {
            found.add_square(&form(direction)[..freedoms.len()], place.weight * curvature);
        }
    }
    found
}

/// The density to second order where the derivative of the map and the place change: the four entries of the one, then both of the
/// other, in the metric's frame.
struct Model {
    value: f64,
    slope: [f64; 6],
    curvature: [[f64; 6]; 6],
}

impl Model {
    /// At a place d away, in the frame, the metric is I + E with E = E1(d) + E2(d, d) / 2, its root is I + E / 2 - E E / 8 to second
    /// order, and that times the derivative is what the density sees. (Other roots differ by a rotation, which it does not see.)
    fn of(a: Matrix, around: &Around) -> Self {
        let density = Density::dirichlet(a);
        let p = &density.slope;
        let by = |t: &Tensor, m: &Matrix| m.map(|column| t.apply(column));
        let gains = around.first.map(|e| times(by(&e, &a), 0.5));
        let lift = |m: &Matrix| [m[0].x, m[0].y, m[1].x, m[1].y, inner(m, &gains[0]), inner(m, &gains[1])];
        let mut curvature = [[0.0; 6]; 6];
        for (value, matrix) in &density.curvatures {
            let form = lift(matrix);
            for (row, one) in curvature.iter_mut().zip(form) {
                for (entry, other) in row.iter_mut().zip(form) {
                    *entry += value * one * other;
                }
            }
        }
        for (k, e) in around.first.iter().enumerate() {
            let mixed = times(by(e, p), 0.5);
            for (i, value) in [mixed[0].x, mixed[0].y, mixed[1].x, mixed[1].y].into_iter().enumerate() {
                curvature[i][4 + k] += value;
                curvature[4 + k][i] += value;
            }
        }
        for (k, l) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let second = by(&around.second[if k == l { k } else { 2 }], &a);
            // The product of both, in one order and the other: its trace with what is symmetric is the mean.
            let square = by(&around.first[k], &by(&around.first[l], &a));
            let other = by(&around.first[l], &by(&around.first[k], &a));
            curvature[4 + k][4 + l] += 0.5 * inner(p, &second) - 0.125 * (inner(p, &square) + inner(p, &other));
        }
        Self { value: density.value, slope: lift(p), curvature }
    }
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

/// What a length costs, half the square of its logarithm by weight, with both derivatives by that.
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
        let frame = m.cholesky();
        let around = Around::of(metric, p, m, &mut near);
        let [x, y] = around.first.map(|e| e.dot(to_frame(frame, slope), to_frame(frame, slope)));
        let (pulled, moved) = (m.apply(slope) * (1.0 / speed), transposed(frame, Vector::new(x, y)) * (0.5 / speed));
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Long along a direction that turns, faster along one axis than along the other.
    fn turning(p: Point) -> Tensor {
        let angle = 0.9 * p.x + 0.4 * p.y * p.y;
        Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), 4.0 + p.y, 0.6)
    }

    const POINTS: [(f64, f64); 10] = [
        (0.0, 0.1),
        (1.0, 0.0),
        (0.4, 0.9),
        (0.3, -0.1),
        (0.7, 0.0),
        (0.8, 0.3),
        (0.6, 0.6),
        (0.3, 0.6),
        (0.1, 0.4),
        (0.45, 0.3),
    ];

    fn points(count: usize) -> Vec<Point> {
        POINTS[..count].iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    fn freedoms(count: usize) -> Vec<Freedom> {
        let axes = [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)];
        (0..2 * count).map(|i| Freedom { point: i / 2, axis: axes[i % 2], row: i as u32 }).collect()
    }

    fn agree(value: impl Fn(&[Point]) -> f64, expansion: &Expansion, points: &[Point]) {
        assert!((value(points) - expansion.value).abs() < 1e-12);
        for f in freedoms(points.len()) {
            let moved = |h: f64| {
                let mut moved = points.to_vec();
                moved[f.point] = moved[f.point] + f.axis * h;
                value(&moved)
            };
            let slope = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            let found = expansion.slope[f.row as usize];
            assert!((slope - found).abs() < 1e-4 * (1.0 + slope.abs()), "{f:?}: {slope} {found}");
        }
    }

    #[test]
    fn slopes_are_those_of_the_values() {
        let (rule, points) = (Rule::of(3), points(10));
        agree(|p| triangle_energy(&rule, p, &turning), &triangle(&rule, &points, &freedoms(10), &turning), &points);
        let curve = &points[..4];
        agree(|p| side_energy(p, &turning, 0.7), &side(curve, &freedoms(4), &turning, 0.7), curve);
    }

    #[test]
    fn second_derivatives_at_a_place_are_exact() {
        let a = [Vector::new(0.9, 0.2), Vector::new(-0.3, 1.2)];
        let p = Point::new(0.2, 0.5);
        let m = turning(p);
        let model = Model::of(a, &Around::of(&turning, p, m, &mut Near::default()));
        let ([_, axes], frame) = (m.frames(), m.cholesky());
        // A map whose derivative in the frame at p is a.
        let back = |v: Vector| axes[0] * v.x + axes[1] * v.y;
        let value = |d: [f64; 6]| {
            let moved = [Vector::new(d[0], d[1]), Vector::new(d[2], d[3])];
            let sides = [0, 1].map(|i| back(a[i] + moved[i]));
            let at = turning(p + back(Vector::new(d[4], d[5]))).cholesky();
            dirichlet(sides.map(|side| to_frame(at, side)))
        };
        assert!((to_frame(frame, back(a[0])) - a[0]).norm() < 1e-14);
        let h = 1e-4;
        for i in 0..6 {
            for j in 0..6 {
                let at = |s: f64, t: f64| {
                    let mut d = [0.0; 6];
                    d[i] += s * h;
                    d[j] += t * h;
                    value(d)
                };
                let second = (at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)) / (4.0 * h * h);
                assert!(
                    (second - model.curvature[i][j]).abs() < 2e-3 * (1.0 + second.abs()),
                    "{i} {j}: {second} {}",
                    model.curvature[i][j]
                );
            }
        }
    }
}
