//! Geodesics between two points as polynomials: energy minimised by Newton steps, degree raised until lengths agree.
//!
//! In coordinates where the end points are (0, 0) and (1, 0) the path is (t, 0) plus [`Rule`]'s modes, each times a
//! vector. For a smooth field the error falls exponentially with their number, and the change of the length from one
//! number to its double, with the change before, tells how large it still is.

use super::curve::{Curve, PathLength, modes_near};
use super::jet::{Frame, Jet};
use super::rule::Rule;
use crate::geometry::{Point, Tensor, Vector};
use crate::metric::{MetricField, nearby};

/// Modes and quadrature points of the paths, from coarse to fine.
const STAGES: [(usize, usize); 4] = [(2, 5), (4, 8), (8, 14), (16, 28)];
/// Newton steps on one stage at most; a step halved so often does not lower the energy.
const STEPS: usize = 12;
const HALVINGS: usize = 6;
/// Energy that further steps would still gain, as a share: at the first stage, which is only a start, and after.
const RESIDUE: [f64; 2] = [1e-7, 1e-13];
/// Rounding of a length, and what the differences in the derivatives leave.
const ROUNDING: f64 = 2e-11;
/// A change that is not at least this much smaller than the one before says that the path is not resolved; one that
/// is more than this much smaller may be so by chance.
const RATIOS: (f64, f64) = (0.02, 0.7);

/// Where curvatures along a chord differ by more than this over its square, in-circle tests by lengths would err by 0.4 or more
/// (`margin_from_lengths`): the field has kinks. With 0.2, 0.5, 2 and 8 about 240, 250, 350 and 400 tests were left open of 10,000 vertices for
/// a kinked Hessian, 1,330, 1,180, 1,150 and 1,080 of 4,000 for a hard shock.
const KINKED: f64 = 0.5;

/// How fine a path is, from `Fineness::COARSEST` to [`Fineness::FINEST`]: each has twice the modes of the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Fineness(u8);

impl Fineness {
    /// Four modes: polynomials of degree five.
    pub(crate) const COARSEST: Self = Self(1);
    /// Eight modes.
    pub(crate) const MIDDLE: Self = Self(2);
    /// Sixteen modes.
    pub(crate) const FINEST: Self = Self(STAGES.len() as u8 - 1);

    /// Twice the modes; `None` of the finest.
    pub(crate) fn next(self) -> Option<Self> {
        (self < Self::FINEST).then_some(Self(self.0 + 1))
    }
}

/// Solves for geodesics; keeps tables only, so that threads can share it.
#[derive(Clone, Debug)]
pub(crate) struct Paths {
    rules: Vec<Rule>,
}

/// A path that was solved for: its length, and half the derivative of its squared length by its first end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solved {
    pub(super) length: PathLength,
    pub(super) pull: Vector,
}

/// The logarithm map of a metric field, which way a geodesic sets out: see [`Paths::logarithm`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Logarithm {
    /// The velocity at p of the geodesic that arrives at q after the time 1: in the tensor at p it is as long as the geodesic,
    /// up to errors.
    pub velocity: Vector,
    /// The length of the geodesic, with its error.
    pub length: PathLength,
}

impl Default for Paths {
    fn default() -> Self {
        Self { rules: STAGES.iter().map(|&(modes, points)| Rule::new(points, modes)).collect() }
    }
}

impl Paths {
    /// The length of a geodesic from p to q, found from the chord on. `None` where the field is no metric along it.
    ///
    /// Two to four Newton steps a stage, 7 evaluations of the field at each of its quadrature points: at the coarsest
    /// about 150 evaluations in all.
    pub(crate) fn length(&self, field: &dyn MetricField, p: Point, q: Point, fineness: Fineness) -> Option<PathLength> {
        self.solve(field, p, q, fineness).map(|solved| solved.length)
    }

    /// [`Paths::length`], unless the field has kinks along the chord, as 36 evaluations of it tell.
    pub(crate) fn length_without_kinks(
        &self,
        field: &dyn MetricField,
        p: Point,
        q: Point,
        fineness: Fineness,
    ) -> Option<PathLength> {
        let at = nearby(field);
        let frame = Frame::along(&at, p, q)?;
        let mut path = Path { at: &at, frame, modes: vec![Vector::default(); STAGES[0].0] };
        let samples = path.sample(&self.rules[0], &path.modes);
        let length = samples.length(&self.rules[0]);
        let [least, most] = System::new(&path, &self.rules[0], &samples).curvature;
        if length * length * (most - least) > KINKED {
            return None;
        }
        self.climb(&mut path, fineness, None).map(|solved| solved.length)
    }

    /// The geodesic itself, with [`Paths::length`]'s length. With a path given it is the one that this path contracts to,
    /// as far as so many modes can follow it.
    pub(crate) fn curve(
        &self,
        field: &dyn MetricField,
        [p, q]: [Point; 2],
        near: Option<&[Point]>,
        fineness: Fineness,
    ) -> Option<Curve> {
        let at = nearby(field);
        let frame = Frame::along(&at, p, q)?;
        let mut path = Path { at: &at, frame, modes: Vec::new() };
        let solved = self.climb(&mut path, fineness, near)?;
        Some(Curve::new([p, q], frame, path.modes, solved.length))
    }

    /// The logarithm of q at p, of the geodesic that [`Paths::length`] finds. `None` where that finds none or where p is q.
    pub(crate) fn logarithm(
        &self,
        field: &dyn MetricField,
        p: Point,
        q: Point,
        fineness: Fineness,
    ) -> Option<Logarithm> {
        let solved = self.solve(field, p, q, fineness)?;
        // Half the squared length falls fastest, in the tensor at p, where p moves along the geodesic (Gauss's lemma).
        let velocity = -field.at(p).inverse().apply(solved.pull);
        (velocity.x.is_finite() && velocity.y.is_finite()).then_some(Logarithm { velocity, length: solved.length })
    }

    pub(super) fn solve(&self, field: &dyn MetricField, p: Point, q: Point, fineness: Fineness) -> Option<Solved> {
        let at = nearby(field);
        let frame = Frame::along(&at, p, q)?;
        self.climb(&mut Path { at: &at, frame, modes: Vec::new() }, fineness, None)
    }

    /// Relaxes a path, with more modes from stage to stage.
    fn climb(&self, path: &mut Path, fineness: Fineness, near: Option<&[Point]>) -> Option<Solved> {
        let frame = path.frame;
        let mut before = f64::NAN;
        let mut change = f64::NAN;
        let mut error = f64::NAN;
        let mut last = None;
        // Few modes would lose what is particular to a path that is given.
        let first = usize::from(near.is_some());
        for (stage, rule) in self.rules[..=fineness.0 as usize].iter().enumerate().skip(first) {
            path.modes.resize(STAGES[stage].0, Vector::default());
            if let Some(near) = near.filter(|_| stage == first) {
                path.modes = modes_near(path.at, &frame, near, path.modes.len());
            }
            let relaxed = path.relax(rule, RESIDUE[stage.min(1)])?;
            // The first stage is held against the chord, or the path given.
            let previous = if stage == first { relaxed.chord } else { before };
            let now = (relaxed.length - previous).abs() / relaxed.length;
            let ratio = if change > 0.0 { now / change } else { 0.0 };
            let unresolved = ratio > RATIOS.1;
            error = if unresolved { 2.0 * now } else { now * (ratio / (1.0 - ratio)).max(RATIOS.0) };
            error += relaxed.system.residue + ROUNDING;
            (before, change) = (relaxed.length, now);
            last = Some(relaxed);
        }
        let last = last?;
        let length = PathLength { value: last.length, error, curvature: last.system.curvature };
        (error.is_finite() && last.length > 0.0).then(|| Solved { length, pull: frame.covector(last.system.pull) })
    }
}

struct Path<'a> {
    at: &'a dyn Fn(Point) -> Tensor,
    frame: Frame,
    modes: Vec<Vector>,
}

struct Relaxed {
    length: f64,
    /// Length of the path that the relaxation began with.
    chord: f64,
    /// As it ended.
    system: System,
}

/// A path at the points of a rule.
struct Samples {
    places: Vec<Vector>,
    velocities: Vec<Vector>,
    tensors: Vec<Tensor>,
    energy: f64,
}

impl Path<'_> {
    fn sample(&self, rule: &Rule, modes: &[Vector]) -> Samples {
        let along = |i: usize, table: &[Vec<f64>], start: Vector| {
            modes.iter().zip(&table[i]).fold(start, |sum, (&c, &b)| sum + c * b)
        };
        let points = 0..rule.len();
        let places: Vec<Vector> =
            points.clone().map(|i| along(i, &rule.values, Vector::new(rule.points[i], 0.0))).collect();
        let velocities: Vec<Vector> = points.map(|i| along(i, &rule.slopes, Vector::new(1.0, 0.0))).collect();
        let tensors: Vec<Tensor> = places.iter().map(|&x| self.frame.tensor(self.at, x)).collect();
        let speeds = rule.weights.iter().zip(tensors.iter().zip(&velocities)).map(|(w, (t, &v))| w * t.dot(v, v));
        let is_metric = tensors.iter().all(|t| t.is_positive_definite());
        let energy = if is_metric { speeds.sum() } else { f64::INFINITY };
        Samples { places, velocities, tensors, energy }
    }

    /// Newton steps on the energy until no more is to be gained; `None` where the field is no metric on the chord.
    fn relax(&mut self, rule: &Rule, tolerance: f64) -> Option<Relaxed> {
        let mut samples = self.sample(rule, &self.modes);
        if !samples.energy.is_finite() {
            return None;
        }
        let chord = samples.length(rule);
        let mut system = System::new(self, rule, &samples);
        for _ in 0..STEPS {
            let Some((step, gain)) = system.newton_step(self.modes.len()) else { break };
            system.residue = 0.5 * gain / samples.energy;
            let better = self.descend(rule, &samples, &step, gain);
            let Some((modes, lower)) = better else { break };
            // A step whose gain was foreseen exactly leaves next to nothing for another one.
            let surprise = (samples.energy - lower.energy) / (0.5 * gain) - 1.0;
            (self.modes, samples) = (modes, lower);
            let left = 0.5 * gain * surprise * surprise / samples.energy;
            if system.residue < tolerance || left < tolerance {
                system.residue = left.min(system.residue);
                break;
            }
            system = System::new(self, rule, &samples);
        }
        Some(Relaxed { length: samples.length(rule), chord, system })
    }

    /// The path a share of the step further whose energy is lower.
    fn descend(&self, rule: &Rule, from: &Samples, step: &[Vector], gain: f64) -> Option<(Vec<Vector>, Samples)> {
        if gain <= 1e-15 * from.energy {
            return None;
        }
        let mut share = 1.0;
        for _ in 0..HALVINGS {
            let modes: Vec<Vector> = self.modes.iter().zip(step).map(|(&c, &s)| c + s * share).collect();
            let samples = self.sample(rule, &modes);
            if samples.energy < from.energy {
                return Some((modes, samples));
            }
            share *= 0.5;
        }
        None
    }
}

impl Samples {
    fn length(&self, rule: &Rule) -> f64 {
        let pieces = self.tensors.iter().zip(&self.velocities).zip(&rule.weights);
        pieces.map(|((t, &v), w)| w * t.length(v)).sum()
    }
}

/// Gradient and Hessians of the energy by the modes, two unknowns each.
struct System {
    gradient: Vec<f64>,
    hessian: Vec<f64>,
    /// As if tensors did not depend on the place: always positive definite.
    frozen: Vec<f64>,
    curvature: [f64; 2],
    pull: Vector,
    /// Relative error of the length that further steps would remove.
    residue: f64,
}

impl System {
    fn new(path: &Path, rule: &Rule, samples: &Samples) -> Self {
        let n = 2 * path.modes.len();
        let mut system = Self {
            gradient: vec![0.0; n],
            hessian: vec![0.0; n * n],
            frozen: vec![0.0; n * n],
            curvature: [f64::INFINITY, f64::NEG_INFINITY],
            pull: Vector::default(),
            residue: 0.0,
        };
        for i in 0..rule.len() {
            let jet = Jet::of(path.at, &path.frame, samples.places[i], samples.tensors[i]);
            system.add(&jet, samples.velocities[i], rule, i);
        }
        system
    }

    /// Adds one quadrature point.
    fn add(&mut self, jet: &Jet, velocity: Vector, rule: &Rule, i: usize) {
        let (w, values, slopes) = (rule.weights[i], &rule.values[i], &rule.slopes[i]);
        let k = jet.curvature();
        self.curvature = [self.curvature[0].min(k), self.curvature[1].max(k)];
        let momentum = jet.tensor.apply(velocity) * (2.0 * w);
        let force = Vector::new(jet.first[0].dot(velocity, velocity), jet.first[1].dot(velocity, velocity)) * w;
        self.pull = self.pull + (force * (1.0 - rule.points[i]) - momentum) * 0.5;
        let m = jet.tensor * (2.0 * w);
        let [mu, mv] = jet.first.map(|t| t.apply(velocity) * (2.0 * w));
        let [uu, uv, vv] = jet.second.map(|t| w * t.dot(velocity, velocity));
        let n = self.gradient.len();
        for (a, (&ba, &sa)) in values.iter().zip(slopes).enumerate() {
            self.gradient[2 * a] += sa * momentum.x + ba * force.x;
            self.gradient[2 * a + 1] += sa * momentum.y + ba * force.y;
            for (b, (&bb, &sb)) in values.iter().zip(slopes).enumerate().take(a + 1) {
                let (ss, sv, vs, bv) = (sa * sb, sa * bb, ba * sb, ba * bb);
                let frozen = [ss * m.xx, ss * m.xy, ss * m.xy, ss * m.yy];
                let moving = [
                    (sv + vs) * mu.x + bv * uu,
                    sv * mv.x + vs * mu.y + bv * uv,
                    sv * mu.y + vs * mv.x + bv * uv,
                    (sv + vs) * mv.y + bv * vv,
                ];
                let at =
                    [2 * a * n + 2 * b, 2 * a * n + 2 * b + 1, (2 * a + 1) * n + 2 * b, (2 * a + 1) * n + 2 * b + 1];
                for ((at, frozen), moving) in at.into_iter().zip(frozen).zip(moving) {
                    self.frozen[at] += frozen;
                    self.hessian[at] += frozen + moving;
                }
            }
        }
    }

    /// The step to the minimum of the quadratic model, and twice what the model gains by it. Where the Hessian is not
    /// positive definite the frozen one serves.
    fn newton_step(&self, modes: usize) -> Option<(Vec<Vector>, f64)> {
        let n = 2 * modes;
        let solution =
            solve(self.hessian.clone(), &self.gradient, n).or_else(|| solve(self.frozen.clone(), &self.gradient, n))?;
        let gain: f64 = solution.iter().zip(&self.gradient).map(|(s, g)| s * g).sum();
        let step = solution.chunks_exact(2).map(|s| Vector::new(-s[0], -s[1])).collect();
        gain.is_finite().then_some((step, gain))
    }
}

/// Solves a symmetric positive definite system, of which the lower half is given, by Cholesky's factors.
fn solve(mut a: Vec<f64>, right: &[f64], n: usize) -> Option<Vec<f64>> {
    for j in 0..n {
        for i in j..n {
            let (row_i, row_j) = (&a[i * n..i * n + j], &a[j * n..j * n + j]);
            let rest = a[i * n + j] - row_i.iter().zip(row_j).map(|(x, y)| x * y).sum::<f64>();
            if i > j {
                a[i * n + j] = rest / a[j * n + j];
            } else if rest > 1e-14 * a[j * n + j] {
                a[j * n + j] = rest.sqrt();
            } else {
                return None;
            }
        }
    }
    let mut x = right.to_vec();
    for i in 0..n {
        let known: f64 = (0..i).map(|k| a[i * n + k] * x[k]).sum();
        x[i] = (x[i] - known) / a[i * n + i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| a[k * n + i] * x[k]).sum();
        x[i] = (x[i] - known) / a[i * n + i];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half_plane(p: Point) -> Tensor {
        Tensor::isotropic(p.y)
    }

    fn hyperbolic(p: Point, q: Point) -> f64 {
        2.0 * (0.5 * (q - p).norm() / (p.y * q.y).sqrt()).asinh()
    }

    fn stages() -> impl Iterator<Item = Fineness> {
        std::iter::successors(Some(Fineness::COARSEST), |f| f.next())
    }

    #[test]
    fn half_plane_lengths_are_as_good_as_they_say() {
        let paths = Paths::default();
        let mut honest = 0;
        for i in 0..300 {
            let f = f64::from(i);
            let h = 0.05 + 0.015 * (f % 100.0);
            let p = Point::new(0.3, 1.0 + 0.5 * (1.3 * f).sin());
            let q = p + Vector::new(h * p.y * (2.7 * f).cos(), 0.6 * h * p.y * (2.7 * f).sin());
            let exact = hyperbolic(p, q);
            for fineness in stages() {
                let found = paths.length(&half_plane, p, q, fineness).unwrap();
                let error = (found.value / exact - 1.0).abs();
                honest += u32::from(error <= found.error);
                assert!(error < 10.0 * found.error && found.error < 1e-2, "{h} {fineness:?} {error} {found:?}");
                assert!(fineness != Fineness::FINEST || h > 1.0 || error < 1e-10, "{h} {error} {found:?}");
                assert!((found.curvature[0] + 1.0).abs() < 0.01 && (found.curvature[1] + 1.0).abs() < 0.01);
            }
        }
        assert!(honest > 890, "{honest} of 900");
    }

    #[test]
    fn the_pull_is_half_the_derivative_of_the_squared_length() {
        let paths = Paths::default();
        let (p, q) = (Point::new(0.1, 1.2), Point::new(0.7, 0.9));
        let pull = paths.solve(&half_plane, p, q, Fineness::FINEST).unwrap().pull;
        let h = 1e-5;
        let half = |p: Point| 0.5 * hyperbolic(p, q).powi(2);
        let slope = |e: Vector| (half(p + e * h) - half(p - e * h)) / (2.0 * h);
        assert!((pull.x - slope(Vector::new(1.0, 0.0))).abs() < 1e-4, "{pull:?}");
        assert!((pull.y - slope(Vector::new(0.0, 1.0))).abs() < 1e-4, "{pull:?}");
    }

    #[test]
    fn what_is_no_metric_has_no_length_and_kinks_have_one() {
        let paths = Paths::default();
        let (p, q) = (Point::new(-1.0, 0.0), Point::new(1.0, 1e-3));
        let nan = |_: Point| Tensor::new(f64::NAN, 0.0, 1.0);
        assert!(paths.length(&nan, p, q, Fineness::FINEST).is_none());
        let kinked = |p: Point| Tensor::isotropic(1.0 + 0.2 * (p.x - 0.1).abs() + p.y);
        let [coarse, fine] = [Fineness::COARSEST, Fineness::FINEST].map(|f| paths.length(&kinked, p, q, f).unwrap());
        assert!((coarse.value / fine.value - 1.0).abs() < 1e-3 && fine.error < 1e-5, "{coarse:?} {fine:?}");
    }

    #[test]
    fn in_a_uniform_metric_it_is_the_difference() {
        let (p, q) = (Point::new(0.2, -0.3), Point::new(1.0, 0.7));
        let found = Paths::default().logarithm(&|_: Point| Tensor::new(4.0, 1.0, 2.0), p, q, Fineness::MIDDLE).unwrap();
        assert!((found.velocity - (q - p)).norm() < 1e-9, "{:?}", found.velocity);
    }

    #[test]
    fn half_plane_geodesics_leave_along_their_circles() {
        // The circle around the origin through both points.
        let (p, q) = (Point::new(-0.6, 0.8), Point::new(0.6, 0.8));
        let half_plane = |p: Point| Tensor::isotropic(p.y);
        let found = Paths::default().logarithm(&half_plane, p, q, Fineness::FINEST).unwrap();
        let length = (1.0 + 1.2_f64.powi(2) / (2.0 * 0.64)).acosh();
        let tangent = Vector::new(0.8, 0.6) * (0.8 * length);
        assert!((found.velocity - tangent).norm() < 1e-5, "{:?} is not {tangent:?}", found.velocity);
    }

    #[test]
    fn there_is_none_from_a_point_to_itself() {
        let p = Point::new(0.5, 0.5);
        assert_eq!(Paths::default().logarithm(&|_: Point| Tensor::IDENTITY, p, p, Fineness::MIDDLE), None);
    }
}
