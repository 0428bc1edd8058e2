//! The error of interpolating a function by polynomials of the order of curved triangles, in place of their shape in a metric.

use super::bezier::{MOST, bernstein, blend, exponents, points_of_nodes};
use super::rules::{AREA, Rule};
use super::term::{Expansion, Freedom, UNKNOWNS};
use crate::elementary::Elementary;
use crate::geometry::{Point, Vector};
use crate::metric::{Norm, ScalarField};

/// Errors this small beside their mean count as this, so that powers below the square have second derivatives.
const LEAST: f64 = 1e-3;

/// A function to be interpolated: its values at the nodes of a triangle give the polynomial, the integral of a power of what is between them is the
/// energy of the triangle, in a unit in which that of all triangles has a mean of one.
pub(super) struct Target<'a> {
    function: &'a dyn ScalarField,
    order: usize,
    exponent: f64,
    /// The error that counts as one.
    unit: f64,
    /// What the power of such an error counts over a unit of area.
    weight: f64,
    rule: Rule,
    /// The polynomials of the nodes at the places of the rule,
    at_places: Vec<[f64; MOST]>,
    /// and those of the Bezier points at the nodes.
    at_nodes: Vec<[f64; MOST]>,
}

impl<'a> Target<'a> {
    /// For triangles of an order.
    pub(super) fn new(function: &'a dyn ScalarField, norm: Norm, order: usize) -> Self {
        let (rule, count) = (Rule::fine_of(order), exponents(order).len());
        let ordinates = |node: usize| {
            let mut values = [Point::default(); MOST];
            values[node].x = 1.0;
            points_of_nodes(&values, order)
        };
        let of_nodes: Vec<[Point; MOST]> = (0..count).map(ordinates).collect();
        let at_places = rule.places.iter().map(|place| {
            let at = |node: usize| blend(&of_nodes[node][..count], &place.values).x;
            std::array::from_fn(|node| if node < count { at(node) } else { 0.0 })
        });
        let at_places = at_places.collect();
        let at_nodes = exponents(order).iter().map(|e| bernstein(order, e.map(|i| f64::from(i) / order as f64)));
        let at_nodes = at_nodes.collect();
        Self { function, order, exponent: norm.exponent(), unit: 1.0, weight: 1.0, rule, at_places, at_nodes }
    }

    /// In the unit in which these triangles have a mean energy of one; with it the L^p norm of the error on them.
    pub(super) fn in_unit_of(mut self, triangles: &[[Point; MOST]]) -> (Self, f64) {
        let errors: Vec<Vec<(f64, f64)>> = triangles.iter().map(|points| self.errors(points)).collect();
        let all = || errors.iter().flatten();
        let greatest = all().fold(0.0, |most: f64, (error, _)| most.max(error.abs()));
        let area: f64 = all().map(|(_, area)| area).sum();
        if greatest > 0.0 {
            let sum: f64 = all().map(|(error, area)| area * (error.abs() / greatest).raised_to(self.exponent)).sum();
            self.unit = greatest * (sum / area).raised_to(1.0 / self.exponent);
        }
        self.weight = triangles.len() as f64 / area;
        let norm = self.unit * area.raised_to(1.0 / self.exponent);
        (self, norm)
    }

    /// The errors at the places of a triangle, and what area is theirs.
    fn errors(&self, points: &[Point; MOST]) -> Vec<(f64, f64)> {
        let points = &points[..exponents(self.order).len()];
        let at_nodes: Vec<f64> = self.at_nodes.iter().map(|b| self.function.value(blend(points, b))).collect();
        let at = |(place, shares): (&super::rules::Place, &[f64; MOST])| {
            let between: f64 = shares.iter().zip(&at_nodes).map(|(share, value)| share * value).sum();
            let [a, b] = place.derivative(points);
            (self.function.value(place.image(points)) - between, AREA * place.weight * a.cross(b))
        };
        self.rule.places.iter().zip(&self.at_places).map(at).collect()
    }

    /// What an error costs, and both derivatives by it; the second one is never negative.
    fn cost(&self, error: f64) -> [f64; 3] {
        let (e, p) = (error / self.unit, self.exponent);
        let square = e * e + LEAST * LEAST;
        let power = if p.total_cmp(&2.0).is_eq() { 1.0 } else { square.raised_to(0.5 * p - 1.0) };
        [power * square, p * power * e / self.unit, p * (p - 1.0).max(1.0) * power / (self.unit * self.unit)]
            .map(|x| x * self.weight)
    }

    /// The energy of a triangle; infinite where the function is not.
    pub(super) fn energy(&self, points: &[Point]) -> f64 {
        let mut all = [Point::default(); MOST];
        all[..points.len()].copy_from_slice(points);
        let sum: f64 = self.errors(&all).into_iter().map(|(error, area)| area * self.cost(error)[0]).sum();
        if sum.is_finite() { sum } else { f64::INFINITY }
    }

    /// The energy of a triangle; second derivatives are those of Gauss and Newton: as if errors were linear in what moves.
    pub(super) fn expansion(&self, points: &[Point], freedoms: &[Freedom]) -> Expansion {
        let mut found = Expansion::new();
        let slope = |p: Point| self.function.jet(p).map_or_else(Default::default, |jet| (jet.value, jet.gradient));
        let at_nodes: Vec<(f64, Vector)> = self.at_nodes.iter().map(|b| slope(blend(points, b))).collect();
        for (place, shares) in self.rule.places.iter().zip(&self.at_places) {
            let (value, here) = slope(place.image(points));
            let between: f64 = shares.iter().zip(&at_nodes).map(|(share, node)| share * node.0).sum();
            let [a, b] = place.derivative(points);
            let weight = AREA * place.weight;
            let (area, [cost, first, second]) = (weight * a.cross(b), self.cost(value - between));
            // How the error follows each point.
            let mut by_point = [Vector::default(); MOST];
            for (j, by) in by_point[..points.len()].iter_mut().enumerate() {
                let of_nodes = shares.iter().zip(&at_nodes).zip(&self.at_nodes);
                *by = of_nodes.fold(here * place.values[j], |sum, ((share, node), b)| sum - node.1 * (share * b[j]));
            }
            let mut form = [0.0; UNKNOWNS];
            for ((entry, sum), freedom) in form.iter_mut().zip(&mut found.slope).zip(freedoms) {
                let (axis, by_side) = (freedom.axis, place.slopes[freedom.point]);
                *entry = by_point[freedom.point].dot(axis);
                *sum += area * first * *entry + weight * cost * (by_side.x * axis.cross(b) + by_side.y * a.cross(axis));
            }
            found.value += area * cost;
            found.add_square(&form[..freedoms.len()], area * second);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::{Expression, Snapshot, Variables};

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

    fn function(text: &str) -> Snapshot {
        Expression::parse(text, Variables::Plane).unwrap().into()
    }

    #[test]
    fn polynomials_of_the_order_have_no_error_on_straight_triangles() {
        let straight = POINTS.map(|(x, y)| Point::new(x, y));
        let mut nodes = straight;
        nodes[3..9].copy_from_slice(&[1, 2, 4, 5, 7, 8].map(|i| {
            let (a, b) = (straight[i / 3], straight[(i / 3 + 1) % 3]);
            a.lerp(b, f64::from(i as u32 % 3) / 3.0)
        }));
        nodes[9] = crate::geometry::centroid([nodes[0], nodes[1], nodes[2]]);
        let cubic = function("x^3 - 2*x*y^2 + y - 3");
        let greatest = |order: usize, points: &[Point; MOST]| {
            let errors = Target::new(&cubic, Norm::default(), order).errors(points);
            errors.iter().map(|(error, _)| error.abs()).fold(0.0, f64::max)
        };
        assert!(greatest(3, &nodes) < 1e-14);
        let [a, b, c, ..] = nodes;
        let mut quadratic = nodes;
        quadratic[3..6].copy_from_slice(&[a.midpoint(b), b.midpoint(c), c.midpoint(a)]);
        assert!(greatest(2, &quadratic) > 1e-3);
    }

    #[test]
    fn slopes_are_those_of_the_values() {
        let wave = function("sin(3*x + y*y) + exp(x*y)");
        for (order, p) in [(2, 2.0), (3, 2.0), (2, 1.0), (3, 5.0)] {
            let count = exponents(order).len();
            let mut points = [Point::default(); MOST];
            for (to, (x, y)) in points[..count].iter_mut().zip(POINTS) {
                *to = Point::new(x, y);
            }
            if order == 2 {
                points[3..6].copy_from_slice(&[Point::new(0.5, -0.1), Point::new(0.8, 0.5), Point::new(0.1, 0.5)]);
            }
            let (target, error) = Target::new(&wave, Norm::new(p).unwrap(), order).in_unit_of(&[points]);
            assert!((target.energy(&points[..count]) - 1.0).abs() < 1e-4 && error > 1e-4);
            let axes = [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)];
            let freedoms: Vec<Freedom> =
                (0..2 * count).map(|i| Freedom { point: i / 2, axis: axes[i % 2], row: i as u32 }).collect();
            let found = target.expansion(&points[..count], &freedoms);
            for f in freedoms {
                let moved = |h: f64| {
                    let mut moved = points;
                    moved[f.point] = moved[f.point] + f.axis * h;
                    target.energy(&moved[..count])
                };
                let slope = (moved(1e-6) - moved(-1e-6)) / 2e-6;
                let own = found.slope[f.row as usize];
                assert!((slope - own).abs() < 1e-3 * (1.0 + slope.abs()), "{order} {p} {f:?}: {slope} {own}");
            }
        }
    }
}
