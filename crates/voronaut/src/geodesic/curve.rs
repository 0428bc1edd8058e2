//! A geodesic between two points as a curve: polynomials that can be evaluated anywhere, and drawn.

use super::jet::Frame;
use super::length::reached;
use super::rule::modes_at;
use crate::geometry::{Point, Tensor, Vector};
use crate::metric::MetricField;

/// Segments of a drawn curve at least, and how often each is halved at most.
const FEWEST: usize = 4;
const HALVINGS: u32 = 6;

/// The length of a geodesic, and the curvature that its surroundings have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PathLength {
    /// Metric length: of a local minimum, which need not be the shortest path, and which knows no domain.
    pub value: f64,
    /// Estimated relative error (not a bound).
    pub error: f64,
    /// The Gauss curvature of the field along the path: least and greatest at its quadrature points.
    pub curvature: [f64; 2],
}

/// A geodesic, found by `Paths::curve`.
#[derive(Clone, Debug)]
pub struct Curve {
    ends: [Point; 2],
    frame: Frame,
    modes: Vec<Vector>,
    length: PathLength,
}

impl Curve {
    pub(super) fn new(ends: [Point; 2], frame: Frame, modes: Vec<Vector>, length: PathLength) -> Self {
        Self { ends, frame, modes, length }
    }

    /// Its length, with the error of that.
    pub(crate) fn length(&self) -> PathLength {
        self.length
    }

    /// The point at a share t of its length, from 0 to 1. Where it lies is known less well than how long the curve is, to
    /// about 1e-6 of the chord (1e-5 where the field turns around over it), since the field's derivatives are differences.
    pub(crate) fn at(&self, t: f64) -> Point {
        if t <= 0.0 || t >= 1.0 {
            return self.ends[usize::from(t > 0.5)];
        }
        let values = modes_at(self.modes.len(), t);
        let place = self.modes.iter().zip(values).fold(Vector::new(t, 0.0), |sum, (&c, b)| sum + c * b);
        self.frame.place(place)
    }

    /// The curve as a polyline, end points included. Its sagittas, measured with the tensor at the place, are at most this
    /// share of its length, unless that took more than 256 segments.
    pub(crate) fn polyline(&self, field: &dyn MetricField, tolerance: f64) -> Vec<Point> {
        let mut points = vec![self.ends[0]];
        for i in 0..FEWEST {
            let [from, to] = [i, i + 1].map(|k| k as f64 / FEWEST as f64);
            self.draw(field, tolerance * self.length.value, [from, to], HALVINGS, &mut points);
        }
        points.dedup();
        points
    }

    fn draw(&self, field: &dyn MetricField, sagitta: f64, [from, to]: [f64; 2], depth: u32, points: &mut Vec<Point>) {
        let middle = 0.5 * (from + to);
        let [p, m, q] = [from, middle, to].map(|t| self.at(t));
        if depth > 0 && field.at(m).length(across(p, m, q)) > sagitta {
            self.draw(field, sagitta, [from, middle], depth - 1, points);
            self.draw(field, sagitta, [middle, to], depth - 1, points);
        } else {
            points.push(q);
        }
    }
}

/// From the chord to the point, without its part along the chord.
fn across(p: Point, m: Point, q: Point) -> Vector {
    let (chord, d) = (q - p, m - p);
    let t = d.dot(chord) / chord.dot(chord);
    if t.is_finite() { d - chord * t } else { d }
}

/// The best approximation (in the energy of a frame) by so many modes of a polyline from the frame's (0, 0) to (1, 0), taken at
/// shares of its metric length; the chord where that is none.
pub(super) fn modes_near(at: &dyn Fn(Point) -> Tensor, frame: &Frame, path: &[Point], count: usize) -> Vec<Vector> {
    let reached = reached(at, path);
    let total = reached[reached.len() - 1];
    let shares: Vec<f64> = reached.iter().map(|r| r / total).collect();
    let places: Vec<Vector> = path.iter().map(|&p| frame.vector(p - path[0])).collect();
    let values: Vec<Vec<f64>> = shares.iter().map(|&t| modes_at(count, t)).collect();
    let mut modes = vec![Vector::default(); count];
    for i in 1..places.len() {
        let span = shares[i] - shares[i - 1];
        if span <= 0.0 {
            continue;
        }
        // Modes have orthonormal slopes: the integral of the path's slope with theirs.
        let slope = (places[i] - places[i - 1]) * (1.0 / span);
        for (mode, (b, a)) in modes.iter_mut().zip(values[i].iter().zip(&values[i - 1])) {
            *mode = *mode + slope * (b - a);
        }
    }
    let is_told = modes.iter().all(|c| c.x.is_finite() && c.y.is_finite());
    if is_told { modes } else { vec![Vector::default(); count] }
}

#[cfg(test)]
mod tests {
    use super::super::path::{Fineness, Paths};
    use super::*;
    use crate::geometry::Tensor;

    #[test]
    fn half_plane_curves_lie_on_circles() {
        let field = |p: Point| Tensor::isotropic(p.y);
        let (p, q) = (Point::new(-0.6, 0.8), Point::new(0.6, 0.8));
        let curve = Paths::default().curve(&field, [p, q], None, Fineness::FINEST).unwrap();
        for i in 0..=20 {
            let at = curve.at(f64::from(i) / 20.0);
            assert!((at.x.hypot(at.y) - 1.0).abs() < 1e-5, "{i} {at}");
        }
        let line = curve.polyline(&field, 1e-4);
        assert!(line.len() > 8 && line.len() < 200 && line[0] == p && line[line.len() - 1] == q, "{}", line.len());
    }

    #[test]
    fn a_path_that_is_given_decides_on_which_way() {
        // A bump, with a way around it on either side.
        let field = |p: Point| Tensor::isotropic(1.0) * (1.0 + 30.0 * (-8.0 * (p.x * p.x + p.y * p.y)).exp());
        let (p, q) = (Point::new(-1.0, -0.05), Point::new(1.0, -0.05));
        let near = |y: f64| [p, Point::new(-0.5, y), Point::new(0.5, y), q];
        let paths = Paths::default();
        let [over, under] = [0.8, -0.8].map(|y| paths.curve(&field, [p, q], Some(&near(y)), Fineness::FINEST).unwrap());
        assert!(over.at(0.5).y > 0.3 && under.at(0.5).y < -0.3, "{} {}", over.at(0.5), under.at(0.5));
        assert!(under.length().value < over.length().value);
    }
}
