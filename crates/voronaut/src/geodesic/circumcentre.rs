//! The in-circle test by its definition: a point equally far from three seeds, and how far the fourth is from it.

use super::in_circle::{Margin, opposite};
use super::path::{Fineness, Paths};
use crate::geometry::{Point, Tensor, Vector};
use crate::metric::MetricField;

/// Newton steps at most with coarse geodesics, and then with those asked for.
const STEPS: [usize; 2] = [8, 4];
/// The residue (share of the squared radius) at which they end.
const RESIDUE: [f64; 2] = [1e-6, 1e-12];
/// Errors of spokes, times this: estimates three times too small were seen.
const SAFETY: f64 = 4.0;
/// Spokes that are known no better than this (share of their length) lead nowhere.
const VAGUE: f64 = 0.02;
/// Damped steps at most, and how often one is halved at most; and the residue that may be left where none leads nearer.
const DAMPED_STEPS: usize = 20;
const HALVINGS: i32 = 6;
const RESIDUE_LEFT: f64 = 1e-5;

/// The margin of the edge a-b between the triangles a b c and b a d: the power of d with respect to the circle around
/// a, b and c, whose centre is found by Newton steps on three geodesic distances, normalised as [`Margin`] says. `lengths` are
/// those of a-b, a-c, b-c, a-d and b-d.
///
/// This is the definition, on any surface; no curvature enters. [`Margin::UNKNOWN`] where no centre is found, as may be
/// for triangles that are nearly straight: of the two, a b c should be the larger.
pub(crate) fn margin_by_power(
    paths: &Paths,
    field: &dyn MetricField,
    [a, b, c, d]: [Point; 4],
    lengths: [f64; 5],
    fineness: Fineness,
) -> Margin {
    let Some(circle) = Circle::around(paths, field, [a, b, c], fineness) else { return Margin::UNKNOWN };
    let Some(to_d) = paths.solve(field, circle.centre, d, fineness) else { return Margin::UNKNOWN };
    let [ab, ac, bc, ad, bd] = lengths;
    let (area_c, area_d) = (opposite(ab, ac, bc).1, opposite(ab, ad, bd).1);
    let scale = 2.0 * area_c / (ac * bc * ad * bd);
    let square = to_d.length.value.powi(2);
    let value = scale * (square - circle.square);
    // The power is linear in the squared distances of a, b and c, with the weights that have d as their mean.
    let weights = 1.0 + 2.0 * area_d / area_c;
    let error = scale * (2.0 * SAFETY * to_d.length.error * square + weights * circle.error);
    if value.is_finite() && error.is_finite() { Margin { value, error } } else { Margin::UNKNOWN }
}

/// A circle of the metric: all points at one geodesic distance from its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Circle {
    /// The centre; it may lie outside any domain.
    pub centre: Point,
    /// The squared radius.
    pub square: f64,
    /// Estimated absolute error of the squared radius (not a bound).
    pub error: f64,
}

impl Circle {
    /// The circle through three points, its centre found by Newton steps on three geodesic distances. `None` where
    /// there is none to be found: the points are nearly on a geodesic, or paths to them are not resolved.
    pub(crate) fn around(
        paths: &Paths,
        field: &dyn MetricField,
        corners: [Point; 3],
        fineness: Fineness,
    ) -> Option<Self> {
        // Coarse geodesics lead near the centre.
        let coarse = Search { paths, field, corners, fineness: Fineness::COARSEST };
        let start = coarse.straight(coarse.flat()?, 0)?.centre;
        Search { fineness, ..coarse }.straight(start, 1)
    }

    /// [`Circle::around`] with the finest paths from the first step on: finds some circles that coarse paths lead away from.
    pub(crate) fn around_carefully(paths: &Paths, field: &dyn MetricField, corners: [Point; 3]) -> Option<Self> {
        let search = Search { paths, field, corners, fineness: Fineness::FINEST };
        search.straight(search.flat()?, 0)
    }

    /// The circle through three points whose centre damped Newton steps reach from a place: of the points where three
    /// lengths of geodesics are equal, one near that place. `None` where there is none, or paths are not resolved. Unless the
    /// field is smooth, no finer ones are tried where the first lead nowhere: across creases geodesics are no polynomials.
    pub(crate) fn near(
        paths: &Paths,
        field: &dyn MetricField,
        corners: [Point; 3],
        start: Point,
        is_smooth: bool,
    ) -> Option<Self> {
        let (mut fineness, mut now) = (Fineness::MIDDLE, None);
        let mut from = start;
        loop {
            let found = Search { paths, field, corners, fineness }.damped(from);
            now = found.or(now);
            from = found.map_or(start, |circle: Self| circle.centre);
            match (now, fineness.next()) {
                (Some(circle), _) if circle.error < 1e-4 * circle.square => return Some(circle),
                (None, _) if !is_smooth => return None,
                (_, Some(finer)) => fineness = finer,
                (known, None) => return known.filter(|circle| circle.error < 1e-2 * circle.square),
            }
        }
    }

    /// The power of a point: its squared geodesic distance from the centre, less the squared radius; negative inside.
    /// `None` where no path to the point is found.
    pub(crate) fn power(&self, paths: &Paths, field: &dyn MetricField, p: Point, fineness: Fineness) -> Option<f64> {
        paths.length(field, self.centre, p, fineness).map(|length| length.value.powi(2) - self.square)
    }
}

/// Newton steps to the circumcentre of three points.
struct Search<'a> {
    paths: &'a Paths,
    field: &'a dyn MetricField,
    corners: [Point; 3],
    fineness: Fineness,
}

/// Three paths from one place.
struct Spokes {
    circle: Circle,
    pulls: [Vector; 3],
    squares: [f64; 3],
    most: f64,
    spread: f64,
}

impl Search<'_> {
    /// The circumcentre with the tensor at the centroid.
    fn flat(&self) -> Option<Point> {
        flat_centre(self.field.at(Point::centroid(self.corners)), self.corners)
    }

    /// By whole steps.
    fn straight(&self, mut centre: Point, pass: usize) -> Option<Circle> {
        let mut known: Option<Circle> = None;
        for _ in 0..STEPS[pass] {
            let now = self.spokes(centre)?;
            let stalls = known.is_some_and(|k| k.error <= now.circle.error);
            if now.spread < RESIDUE[pass] * now.most || (stalls && now.spread < 0.1 * now.circle.error) {
                return Some(now.circle);
            }
            centre = centre + self.step(&now)?;
            known = Some(now.circle);
        }
        known.filter(|circle| circle.error < 1e-3 * circle.square)
    }

    /// By steps that are shortened until they lead nearer.
    fn damped(&self, start: Point) -> Option<Circle> {
        let mut now = self.spokes(start)?;
        for _ in 0..DAMPED_STEPS {
            if now.spread < RESIDUE[1].max(0.01 * now.circle.error / now.circle.square) * now.circle.square {
                break;
            }
            let step = self.step(&now)?;
            let shares = (0..HALVINGS).map(|k| 0.5_f64.powi(k));
            let mut trials = shares.filter_map(|share| self.spokes(now.circle.centre + step * share));
            let Some(better) = trials.find(|trial| trial.spread < now.spread) else { break };
            now = better;
        }
        (now.spread < RESIDUE_LEFT * now.circle.square).then_some(now.circle)
    }

    fn step(&self, now: &Spokes) -> Option<Vector> {
        equalising_step(self.field.at(now.circle.centre), now.pulls, now.squares)
    }

    /// `None` where paths are not resolved.
    fn spokes(&self, centre: Point) -> Option<Spokes> {
        // One that leads nowhere is enough.
        let spoke =
            |p| self.paths.solve(self.field, centre, p, self.fineness).filter(|spoke| spoke.length.error < VAGUE);
        let [a, b, c] = self.corners;
        let [a, b, c] = [spoke(a)?, spoke(b)?, spoke(c)?];
        let squares = [a, b, c].map(|s| s.length.value.powi(2));
        let [least, most] = squares.iter().fold([f64::INFINITY, 0.0], |[a, b], &s: &f64| [a.min(s), b.max(s)]);
        let relative = [a, b, c].map(|s| s.length.error).into_iter().fold(0.0, f64::max);
        let spread = most - least;
        let circle = Circle { centre, square: squares[0], error: 2.0 * SAFETY * relative * most + spread };
        let pulls = [a, b, c].map(|s| s.pull);
        spread.is_finite().then_some(Spokes { circle, pulls, squares, most, spread })
    }
}

/// The Newton step to where three squared distances are equal, given half their derivatives by their common end; at most a
/// half of the radius long.
pub(crate) fn equalising_step(tensor: Tensor, [a, b, c]: [Vector; 3], squares: [f64; 3]) -> Option<Vector> {
    let (u, v) = ((b - a) * 2.0, (c - a) * 2.0);
    let step = cramer(u, v, squares[0] - squares[1], squares[0] - squares[2])?;
    let (size, limit) = (tensor.length(step), 0.5 * squares[0].sqrt());
    Some(step * (limit / size).min(1.0))
}

/// The circumcentre with one tensor.
pub(crate) fn flat_centre(tensor: Tensor, [a, b, c]: [Point; 3]) -> Option<Point> {
    let (u, v) = (b - a, c - a);
    let x = cramer(tensor.apply(u), tensor.apply(v), 0.5 * tensor.dot(u, u), 0.5 * tensor.dot(v, v))?;
    Some(a + x)
}

/// The vector with the dot products r with u and s with v.
fn cramer(u: Vector, v: Vector, r: f64, s: f64) -> Option<Vector> {
    let x = Vector::new(r * v.y - s * u.y, s * u.x - r * v.x) * (1.0 / u.cross(v));
    (x.x.is_finite() && x.y.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_of_the_half_plane_are_circles() {
        let field = |p: Point| Tensor::isotropic(p.y);
        let distance = |p: Point, q: Point| 2.0 * (0.5 * (q - p).norm() / (p.y * q.y).sqrt()).asinh();
        let on = |angle: f64| Point::new(0.3 + 0.4 * angle.cos(), 1.2 + 0.4 * angle.sin());
        let [a, b, c] = [3.5, 6.0, 1.5].map(on);
        let paths = Paths::default();
        for (shift, sign) in [(1e-8, 1.0), (-1e-8, -1.0), (0.1, 1.0), (-0.1, -1.0)] {
            let d = on(4.7) + Vector::new(0.0, -shift);
            let lengths = [(a, b), (a, c), (b, c), (a, d), (b, d)].map(|(p, q)| distance(p, q));
            let margin = margin_by_power(&paths, &field, [a, b, c, d], lengths, Fineness::FINEST);
            assert!(margin.is_certain() && margin.value * sign > 0.0, "{shift} {margin:?}");
        }
    }
}
