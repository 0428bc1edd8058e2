//! Newton's method on the energy of a curved mesh.

use super::elements::Elements;
use super::rules::Rule;
use super::system::{Member, System};
use super::target::Target;
use super::term::{Expansion, Freedom, side, side_energy, triangle, triangle_energy};
use crate::error::Result;
use crate::geometry::{Point, Tensor, Vector};
use crate::lists::{distinct, marked};
use crate::metric::MetricField;
use crate::parallel::prelude::*;
use crate::progress::Progress;

/// A step is halved for all points alike where the energy would rise, and given up where less than this share is left of it.
const LEAST_SHARE: f64 = 0.03;
/// It is halved for the points of a triangle that would not be valid, at most so many times. (Triangles that cost more have to be let: barred
/// as well they held up all around them.)
const BARRED: usize = 5;

/// How damping falls and grows, where it stays, and how often it grows for one step.
const LESS: f64 = 0.4;
const MORE: f64 = 4.0;
const LEAST_DAMPING: f64 = 1e-6;
const TRIES: usize = 8;

/// What a curved mesh is to be good for.
#[derive(Clone, Copy)]
pub(super) struct Aim<'a> {
    pub(super) metric: &'a dyn MetricField,
    /// The weight of the lengths of sides, beside the energy of triangles.
    pub(super) lengths: f64,
    /// Where the Jacobian of a triangle may be no more than this, in units of its mean, it counts as not valid, unless it was no more before.
    pub(super) least: f64,
    /// What triangles are for in place of their shape in the metric.
    pub(super) target: Option<&'a Target<'a>>,
}

impl Aim<'_> {
    /// The energy of a triangle by its points.
    pub(super) fn of_points(&self, rule: &Rule, points: &[Point]) -> f64 {
        self.target.map_or_else(|| triangle_energy(rule, points, self.metric), |target| target.energy(points))
    }

    /// That with its derivatives by what may move.
    pub(super) fn expansion(&self, rule: &Rule, points: &[Point], freedoms: &[Freedom]) -> Expansion {
        self.target
            .map_or_else(|| triangle(rule, points, freedoms, self.metric), |target| target.expansion(points, freedoms))
    }

    /// The energy of a triangle, infinite where it is not valid.
    fn of_triangle(&self, elements: &Elements, rule: &Rule, points: &[Point], triangle: usize) -> f64 {
        let least = elements.bound(points, triangle).least;
        let was = || elements.bound(&elements.points, triangle).least;
        if least > self.least || (least > 0.0 && least >= was()) {
            self.of_points(rule, &elements.of_triangle(points, triangle)[..elements.count()])
        } else {
            f64::INFINITY
        }
    }

    /// That of a mesh; sums are made in order.
    pub(super) fn energy(&self, elements: &Elements) -> f64 {
        let triangles = self.of_triangles(elements, &Rule::of(elements.order));
        triangles.iter().sum::<f64>() + self.of_sides(elements, &elements.points)
    }

    /// The energies of all triangles.
    fn of_triangles(&self, elements: &Elements, rule: &Rule) -> Vec<f64> {
        let of_triangle = |t: usize| self.of_triangle(elements, rule, &elements.points, t);
        (0..elements.triangles.len()).into_par_iter().map(of_triangle).collect()
    }

    /// The cost of all sides.
    fn of_sides(&self, elements: &Elements, points: &[Point]) -> f64 {
        if self.lengths == 0.0 {
            return 0.0;
        }
        let sides: Vec<Vec<u32>> = elements.sides().collect();
        let of_side = |numbers: &Vec<u32>| {
            let points: Vec<Point> = numbers.iter().map(|&n| points[n as usize]).collect();
            side_energy(&points, self.metric, self.lengths)
        };
        sides.par_iter().map(of_side).collect::<Vec<f64>>().iter().sum()
    }

    fn expansions(&self, elements: &Elements, system: &System) -> Vec<Expansion> {
        let rule = Rule::of(elements.order);
        let (triangles, sides) = system.members.split_at(elements.triangles.len());
        let sides = if self.lengths > 0.0 { sides } else { &[] };
        let expand = |member: &Member| {
            let points = member.points(&elements.points);
            self.expansion(&rule, &points, &member.freedoms)
        };
        let expand_side =
            |member: &Member| side(&member.points(&elements.points), &member.freedoms, self.metric, self.lengths);
        let mut all: Vec<Expansion> = triangles.par_iter().map(expand).collect();
        all.extend(sides.par_iter().map(expand_side).collect::<Vec<_>>());
        all
    }
}

/// Takes Newton's steps, so many at most, until one gains less than a share of the energy. Returns the energy.
///
/// # Errors
/// The work is to stop.
pub(super) fn minimise(
    elements: &mut Elements,
    aim: &Aim,
    steps: usize,
    gain: f64,
    progress: &dyn Progress,
) -> Result<f64> {
    let mut system = System::of(elements);
    let rule = Rule::of(elements.order);
    let mut energies = aim.of_triangles(elements, &rule);
    let mut energy = energies.iter().sum::<f64>() + aim.of_sides(elements, &elements.points);
    for _ in 0..steps {
        let expansions = aim.expansions(elements, &system);
        let Some(step) = system.step(&expansions, elements, &[], &[]) else { break };
        let mut shares = std::iter::successors(Some(1.0), |share| Some(0.5 * share)).take_while(|&s| s > LEAST_SHARE);
        let moved = shares.find_map(|share| {
            let moved = Moved::by(elements, aim, &rule, &energies, &step, share);
            let now = moved.energies.iter().sum::<f64>() + aim.of_sides(elements, &moved.points);
            (now < energy).then_some((moved, now))
        });
        let Some((moved, now)) = moved else { break };
        let gained = energy - now;
        (elements.points, energies, energy) = (moved.points, moved.energies, now);
        progress.advance(0)?;
        if gained < gain * energy {
            break;
        }
    }
    Ok(energy)
}

/// Takes Levenberg's and Marquardt's steps, so many at most: to go a unit of the metric costs the damping beside, which grows until a step gains, and
/// falls then. Returns how many were taken. For energies that hardly change in some directions, which would be gone too far.
///
/// # Errors
/// The work is to stop.
pub(super) fn minimise_damped(
    elements: &mut Elements,
    aim: &Aim,
    steps: usize,
    damping: &mut f64,
    progress: &dyn Progress,
) -> Result<u64> {
    let mut system = System::of(elements);
    let rule = Rule::of(elements.order);
    let mut energies = aim.of_triangles(elements, &rule);
    for taken in 0..steps {
        let expansions = aim.expansions(elements, &system);
        let units: Vec<Tensor> = elements.points.par_iter().map(|&p| aim.metric.at(p)).collect();
        let energy: f64 = energies.iter().sum();
        let mut gaining = || {
            let held: Vec<Tensor> = units.iter().map(|&unit| unit * *damping).collect();
            let step = system.step(&expansions, elements, &[], &held)?;
            let moved = Moved::by(elements, aim, &rule, &energies, &step, 1.0);
            let gains = moved.energies.iter().sum::<f64>() < energy;
            *damping = if gains { (LESS * *damping).max(LEAST_DAMPING) } else { MORE * *damping };
            gains.then_some(moved)
        };
        let Some(moved) = (0..TRIES).find_map(|_| gaining()) else { return Ok(taken as u64) };
        (elements.points, energies) = (moved.points, moved.energies);
        progress.advance(0)?;
    }
    Ok(steps as u64)
}

/// Moves some points, which hold nothing, by given steps, and the others along, if they are to; less far where triangles would not be valid.
pub(super) fn displace(elements: &mut Elements, aim: &Aim, given: &[(u32, Vector)], is_alone: bool) {
    let rule = Rule::of(elements.order);
    let energies = aim.of_triangles(elements, &rule);
    let along = || {
        let mut system = System::of(elements);
        let expansions = aim.expansions(elements, &system);
        system.step(&expansions, elements, given, &[])
    };
    let others = (!is_alone).then(along).flatten();
    let mut step = others.unwrap_or_else(|| vec![Vector::default(); elements.points.len()]);
    for &(p, d) in given {
        step[p as usize] = d;
    }
    elements.points = Moved::by(elements, aim, &rule, &energies, &step, 1.0).points;
}

/// Where a step leads, and what triangles cost there.
struct Moved {
    points: Vec<Point>,
    energies: Vec<f64>,
}

impl Moved {
    /// A share of a step. Where a triangle would not be valid its points go half as far, or stay in the end: what goes wrong in one
    /// place does not hold up the others.
    fn by(elements: &Elements, aim: &Aim, rule: &Rule, before: &[f64], step: &[Vector], share: f64) -> Self {
        let count = elements.points.len();
        let (mut shares, mut halved) = (vec![share; count], vec![0; count]);
        let mut found = Self { points: elements.points.clone(), energies: before.to_vec() };
        let mut moved: Vec<u32> = (0..count as u32).collect();
        while !moved.is_empty() {
            for &p in &moved {
                let (old, share) = (elements.points[p as usize], shares[p as usize]);
                found.points[p as usize] =
                    if share > 0.0 { elements.within(p, old + step[p as usize] * share) } else { old };
            }
            let is_moved = marked(count, moved.iter().copied());
            let near: Vec<usize> = (0..elements.triangles.len())
                .filter(|&t| elements.numbers(t).iter().any(|&n| is_moved[n as usize]))
                .collect();
            let now: Vec<f64> = near.par_iter().map(|&t| aim.of_triangle(elements, rule, &found.points, t)).collect();
            for (&t, energy) in near.iter().zip(now) {
                found.energies[t] = energy;
            }
            let bad = near.into_iter().filter(|&t| !found.energies[t].is_finite());
            moved = distinct(bad.flat_map(|t| elements.numbers(t)).copied());
            moved.retain(|&p| shares[p as usize] > 0.0);
            for &p in &moved {
                halved[p as usize] += 1;
                shares[p as usize] = if halved[p as usize] < BARRED { 0.5 * shares[p as usize] } else { 0.0 };
            }
        }
        found
    }
}
