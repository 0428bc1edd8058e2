//! Newton's method on the energy of a curved mesh.

use super::elements::Elements;
use super::rules::Rule;
use super::system::System;
use super::term::{Expansion, side, side_energy, triangle, triangle_energy};
use crate::error::Result;
use crate::geometry::{Point, Vector};
use crate::metric::MetricField;
use crate::parallel::prelude::*;
use crate::progress::Progress;

/// A step is shortened by half at most so many times, for all points alike where the energy would rise.
const SHORTENED: usize = 6;
/// And for the points of a triangle that would not be valid.
const BARRED: usize = 5;

/// What a curved mesh is to be good for.
#[derive(Clone, Copy)]
pub(super) struct Aim<'a> {
    pub(super) metric: &'a dyn MetricField,
    /// The weight of the lengths of sides, beside the energy of triangles.
    pub(super) lengths: f64,
}

impl Aim<'_> {
    /// The energy of the mesh with its points at these places; sums are made in order.
    pub(super) fn energy(&self, elements: &Elements, points: &[Point]) -> f64 {
        let rule = Rule::of(elements.order);
        let count = elements.count();
        let of_triangle = |t: usize| triangle_energy(&rule, &elements.of_triangle(points, t)[..count], self.metric);
        let all: Vec<f64> = (0..elements.triangles.len()).into_par_iter().map(of_triangle).collect();
        let sides: Vec<Vec<u32>> = if self.lengths > 0.0 { elements.sides().collect() } else { Vec::new() };
        let of_side = |numbers: &Vec<u32>| {
            let points: Vec<Point> = numbers.iter().map(|&n| points[n as usize]).collect();
            side_energy(&points, self.metric, self.lengths)
        };
        let sides: Vec<f64> = sides.par_iter().map(of_side).collect();
        all.iter().chain(&sides).sum()
    }

    fn expansions(&self, elements: &Elements, system: &System) -> Vec<Expansion> {
        let rule = Rule::of(elements.order);
        let (triangles, sides) = system.members.split_at(elements.triangles.len());
        let sides = if self.lengths > 0.0 { sides } else { &[] };
        let expand = |member: &super::system::Member| {
            let points = member.points(&elements.points);
            triangle(&rule, &points, &member.freedoms, self.metric)
        };
        let expand_side = |member: &super::system::Member| {
            side(&member.points(&elements.points), &member.freedoms, self.metric, self.lengths)
        };
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
    let mut energy = aim.energy(elements, &elements.points);
    for _ in 0..steps {
        let expansions = aim.expansions(elements, &system);
        let Some(step) = system.step(&expansions, elements) else { break };
        let Some((points, now)) = shortened(elements, aim, &step, energy) else { break };
        elements.points = points;
        let gained = energy - now;
        energy = now;
        progress.advance(1)?;
        if gained < gain * energy {
            break;
        }
    }
    Ok(energy)
}

/// The places after a step, shortened until the energy falls, and that energy.
fn shortened(elements: &Elements, aim: &Aim, step: &[Vector], energy: f64) -> Option<(Vec<Point>, f64)> {
    let mut share = 1.0;
    for _ in 0..SHORTENED {
        let points = barred(elements, step, share);
        let now = aim.energy(elements, &points);
        if now < energy {
            return Some((points, now));
        }
        share *= 0.5;
    }
    None
}

/// The places after a share of a step; where a triangle would not be valid its points go half as far, or stay in the end.
fn barred(elements: &Elements, step: &[Vector], share: f64) -> Vec<Point> {
    let mut shares = vec![share; elements.points.len()];
    let mut halved = vec![0; elements.points.len()];
    let mut points = elements.points.clone();
    let mut moved: Vec<usize> = (0..points.len()).collect();
    let mut suspects: Vec<usize> = (0..elements.triangles.len()).collect();
    loop {
        for &p in &moved {
            let old = elements.points[p];
            points[p] = if shares[p] > 0.0 { elements.within(p as u32, old + step[p] * shares[p]) } else { old };
        }
        let is_bad = |&t: &usize| !elements.bound(&points, t).is_valid();
        let bad: Vec<usize> = suspects.par_iter().copied().filter(is_bad).collect();
        if bad.is_empty() {
            return points;
        }
        moved = crate::lists::distinct(bad.iter().flat_map(|&t| elements.numbers(t)).map(|&n| n as usize));
        moved.retain(|&p| shares[p] > 0.0);
        if moved.is_empty() {
            return elements.points.clone();
        }
        for &p in &moved {
            halved[p] += 1;
            shares[p] = if halved[p] < BARRED { 0.5 * shares[p] } else { 0.0 };
        }
        suspects = (0..elements.triangles.len()).collect();
    }
}
