//! From a path that is nearly shortest to a geodesic: its energy is minimised, and obstacles hold it back.

use super::length::{chord, place_at, reached};
use super::tension::{self, Expansion, energy};
use crate::geometry::Point;
use crate::metric::{MetricField, nearby};

/// What a path may not cross: the border of its domain.
pub(crate) trait Obstacles: Sync {
    /// Whether the straight segment p-q leaves the domain by more than rounding.
    fn bars(&self, p: Point, q: Point) -> bool;

    /// A corner around which a path can bend that a segment sweeps over on its way from one place to another: the one
    /// nearest to where it was.
    fn corner_between(&self, from: [Point; 2], to: [Point; 2]) -> Option<Point>;
}

/// A polyline near a geodesic.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polyline {
    /// Its points, from one end to the other.
    pub points: Vec<Point>,
    /// The sum of its segments' metric lengths, by quadrature: never less than the distance of its ends.
    pub length: f64,
}

impl Polyline {
    /// The metric length of a path of straight segments, by five-point Gauss quadrature on each.
    pub(crate) fn length_of(field: &dyn MetricField, path: &[Point]) -> f64 {
        path.windows(2).map(|w| chord(field, w[0], w[1])).sum()
    }
}

/// Segments to begin with, and how often their number is doubled at most.
const FEWEST: usize = 16;
const DOUBLINGS: usize = 5;
/// The number of segments is doubled until the length changes by less than this share.
const SETTLED: f64 = 1e-4;
/// Steps for one number of segments; most paths need less than ten.
const STEPS: usize = 40;
/// A step that gains less than this share of the energy is the last.
const GAIN: f64 = 1e-9;
/// Vertices that obstacles hold back go a half, a quarter and so on of their way.
const HALVINGS: usize = 6;

/// Shortens a path that stays in its domain to a geodesic between its ends: *a* geodesic, the one that the path contracts
/// to without crossing obstacles. Points at corners that bar the way stay there.
///
/// The path is taken at equal metric lengths, the energy (sum of squared segment lengths) minimised by damped Newton steps,
/// and the number of segments doubled until the length has settled: its relative error is then about 1e-4, less where
/// the metric is smooth. Where obstacles leave no room for a step the path stays as it is. The result is never longer than
/// the path given.
pub(crate) fn straighten(field: &dyn MetricField, path: &[Point], obstacles: &dyn Obstacles) -> Polyline {
    let given = Polyline { points: path.to_vec(), length: Polyline::length_of(field, path) };
    if path.len() < 2 || !energy(field, path).is_finite() {
        return given;
    }
    let points = resample(field, path, obstacles);
    if points.len() < 2 {
        return given;
    }
    let mut band = Band {
        field,
        obstacles,
        pinned: (0..points.len()).map(|i| i == 0 || i + 1 == points.len()).collect(),
        points,
        damping: 0.0,
    };
    let mut best = given;
    for level in 0..DOUBLINGS {
        band.relax();
        let length = Polyline::length_of(field, &band.points);
        let gain = best.length - length;
        let is_settled = gain.abs() <= SETTLED * length && level > 0;
        if gain >= 0.0 {
            best = Polyline { points: band.points.clone(), length };
        }
        if is_settled || !length.is_finite() {
            return best;
        }
        band.refine();
    }
    best
}

/// [`FEWEST`] segments of equal metric length along the path; where one would be barred, with the points of the path
/// between its ends.
fn resample(field: &dyn MetricField, path: &[Point], obstacles: &dyn Obstacles) -> Vec<Point> {
    let reached = reached(nearby(field), path);
    let (total, last) = (reached[path.len() - 1], path[path.len() - 1]);
    let (mut points, mut passed) = (vec![path[0]], 1);
    for k in 1..=FEWEST {
        let (place, i) = place_at(path, &reached, total * k as f64 / FEWEST as f64);
        let next = if k == FEWEST { last } else { place };
        if obstacles.bars(points[points.len() - 1], next) {
            points.extend(&path[passed..i]);
        }
        points.push(next);
        passed = i;
    }
    points.dedup();
    points
}

/// A path under tension.
struct Band<'a> {
    field: &'a dyn MetricField,
    obstacles: &'a dyn Obstacles,
    points: Vec<Point>,
    /// Ends, and points at corners.
    pinned: Vec<bool>,
    /// See [`Expansion::step`].
    damping: f64,
}

impl Band<'_> {
    fn relax(&mut self) {
        let mut held = self.pinned.clone();
        for _ in 0..STEPS {
            self.release();
            let before = self.points.len();
            let (gain, blocked) = self.advance(&self.pinned.clone());
            // What is blocked stays in the next step, so that the rest settles around it.
            held.clone_from(&self.pinned);
            if blocked.len() == held.len() {
                held.iter_mut().zip(&blocked).for_each(|(h, b)| *h |= *b);
            }
            let more = if held == self.pinned { 0.0 } else { self.advance(&held).0 };
            if gain.max(more) <= GAIN && self.points.len() == before {
                return;
            }
        }
    }

    /// Moves all points that are not held along a Newton step, as far as that lowers the energy and obstacles let them;
    /// puts points at the corners that are in the way. Returns the share of the energy gained, and which points were
    /// blocked.
    fn advance(&mut self, held: &[bool]) -> (f64, Vec<bool>) {
        let expansion = Expansion::of(self.field, &self.points);
        let energy = energy(self.field, &self.points);
        while self.damping < 1e6 {
            if let Some(step) = expansion.step(held, self.damping) {
                let goal: Vec<Point> = self.points.iter().zip(&step).map(|(&x, &s)| x + s).collect();
                let (trial, blocked, corners) = self.as_far_as_free(goal);
                let lower = tension::energy(self.field, &trial);
                if lower < energy {
                    self.points = trial;
                }
                if lower < energy || !corners.is_empty() {
                    self.damping = if self.damping > 1e-3 { 0.1 * self.damping } else { 0.0 };
                    self.pin(corners);
                    return (1.0 - lower / energy, blocked);
                }
                // At the bottom there is nothing left to gain, however small the step.
                let reach = step.iter().zip(self.points.windows(2)).map(|(s, w)| s.norm() / w[0].distance(w[1]));
                if reach.fold(0.0, f64::max) < 1e-6 {
                    break;
                }
            }
            self.damping = (4.0 * self.damping).max(0.05);
        }
        self.damping = self.damping.min(1.0);
        (0.0, Vec::new())
    }

    /// Points on their way to their goals, each as far as its segments stay free; those that were blocked; and corners in
    /// the way, each with the number of the segment that it bars.
    fn as_far_as_free(&self, goal: Vec<Point>) -> (Vec<Point>, Vec<bool>, Vec<(usize, Point)>) {
        let n = self.points.len();
        let (mut trial, mut blocked, mut corners) = (goal, vec![false; n], Vec::new());
        for round in 0..=HALVINGS {
            let bars = |i: &usize| {
                let (i, j) = (*i, *i + 1);
                self.obstacles.bars(trial[i], trial[j])
                    || [i, j]
                        .iter()
                        .any(|&k| trial[k] != self.points[k] && self.obstacles.bars(self.points[k], trial[k]))
            };
            let barred: Vec<usize> = (0..n - 1).filter(bars).collect();
            if barred.is_empty() {
                break;
            }
            for i in barred {
                let (from, to) = ([self.points[i], self.points[i + 1]], [trial[i], trial[i + 1]]);
                if round == 0 {
                    corners.extend(self.obstacles.corner_between(from, to).map(|corner| (i, corner)));
                }
                for k in [i, i + 1] {
                    blocked[k] = true;
                    let rest = if round < HALVINGS { 0.5 } else { 0.0 };
                    trial[k] = self.points[k].lerp(trial[k], rest);
                }
            }
        }
        if (0..n - 1).any(|i| self.obstacles.bars(trial[i], trial[i + 1])) {
            trial.clone_from(&self.points);
        }
        (trial, blocked, corners)
    }

    /// Adds points at corners where the path can be led through them.
    fn pin(&mut self, corners: Vec<(usize, Point)>) {
        for (i, corner) in corners.into_iter().rev() {
            let [p, q] = [self.points[i], self.points[i + 1]];
            if p == corner || q == corner || self.obstacles.bars(p, corner) || self.obstacles.bars(corner, q) {
                continue;
            }
            self.points.insert(i + 1, corner);
            self.pinned.insert(i + 1, true);
        }
    }

    /// Lets go of corners that the path is drawn away from.
    fn release(&mut self) {
        for i in 1..self.points.len() - 1 {
            if self.pinned[i] {
                let (u, v) = (self.points[i] - self.points[i - 1], self.points[i + 1] - self.points[i]);
                let tensor = self.field.at(self.points[i]);
                let drawn = v * (1.0 / tensor.length(v)) - u * (1.0 / tensor.length(u));
                let reach = 1e-3 * u.norm().min(v.norm()) / drawn.norm();
                let is_slack = !reach.is_finite() || tensor.length(drawn) < 1e-9;
                self.pinned[i] = !is_slack && self.obstacles.bars(self.points[i], self.points[i] + drawn * reach);
            }
        }
    }

    /// Halves every segment.
    fn refine(&mut self) {
        let mut points = vec![self.points[0]];
        let mut pinned = vec![true];
        for (w, &pin) in self.points.windows(2).zip(&self.pinned[1..]) {
            points.extend([w[0].midpoint(w[1]), w[1]]);
            pinned.extend([false, pin]);
        }
        (self.points, self.pinned) = (points, pinned);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Tensor;

    /// No obstacles.
    struct Open;

    impl Obstacles for Open {
        fn bars(&self, _: Point, _: Point) -> bool {
            false
        }

        fn corner_between(&self, _: [Point; 2], _: [Point; 2]) -> Option<Point> {
            None
        }
    }

    fn zigzag(p: Point, q: Point, width: f64) -> Vec<Point> {
        let across = (q - p).perpendicular() * width;
        let at = |i: usize| {
            let t = i as f64 / 40.0;
            p.lerp(q, t) + across * (4.0 * t * (1.0 - t) * if i.is_multiple_of(2) { 1.0 } else { 0.7 })
        };
        (0..=40).map(at).collect()
    }

    #[test]
    fn half_plane_arcs_have_their_length() {
        let field = |p: Point| Tensor::isotropic(p.y);
        for (p, q) in [((0.0, 1.0), (1.0, 1.2)), ((-2.0, 0.5), (1.5, 0.4)), ((0.0, 0.2), (0.1, 3.0))] {
            let (p, q) = (Point::new(p.0, p.1), Point::new(q.0, q.1));
            let exact = (1.0 + (q - p).dot(q - p) / (2.0 * p.y * q.y)).acosh();
            let path = straighten(&field, &zigzag(p, q, 0.1), &Open);
            assert!(path.length >= exact * (1.0 - 1e-9) && path.length < exact * 1.001, "{} {exact}", path.length);
            assert_eq!((path.points[0], path.points[path.points.len() - 1]), (p, q));
        }
    }

    #[test]
    fn pulled_back_lines_have_their_length() {
        // Flat space through phi(x, y) = (x / 5, y + sin(pi x) / 4), cells five times as long as wide that turn.
        let pi = std::f64::consts::PI;
        let phi = |p: Point| Point::new(0.2 * p.x, p.y + 0.25 * (pi * p.x).sin());
        let field = |p: Point| {
            let a = 0.25 * pi * (pi * p.x).cos();
            Tensor::new(0.04 + a * a, a, 1.0)
        };
        for (p, q) in [((-1.0, 0.0), (1.2, 0.1)), ((0.0, -0.5), (0.4, 0.6)), ((-0.7, 0.3), (0.9, -0.8))] {
            let (p, q) = (Point::new(p.0, p.1), Point::new(q.0, q.1));
            let exact = phi(p).distance(phi(q));
            let path = straighten(&field, &zigzag(p, q, 0.05), &Open);
            assert!(path.length >= exact * (1.0 - 1e-9) && path.length < exact * 1.001, "{} {exact}", path.length);
        }
    }

    #[test]
    fn nonsense_is_given_back() {
        let nan = |_: Point| Tensor::new(f64::NAN, 0.0, 1.0);
        let path = zigzag(Point::new(0.0, 0.0), Point::new(1.0, 0.0), 0.1);
        assert_eq!(straighten(&nan, &path, &Open).points, path);
        let point = [Point::new(0.5, 0.5); 3];
        assert!(straighten(&|_: Point| Tensor::IDENTITY, &point, &Open).length.abs() < 1e-300);
    }
}
