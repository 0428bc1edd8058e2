//! A flip in the making: two triangles whose common side, and what is inside them, may move.

use super::bezier::{MOST, curve_of_nodes, exponents, interior_of_sides, nodes_of_curve};
use super::elements::{Elements, HALVINGS};
use super::jacobian::{bound, coefficients};
use super::newton::Aim;
use super::pair::Pair;
use super::rules::Rule;
use super::term::{Expansion, Freedom, curve_at, side, side_energy};
use crate::geometry::{Point, Vector};

/// Steps in which the new side settles, at most, and what the last one gains at least.
const STEPS: usize = 8;
const LEAST_GAIN: f64 = 1e-4;
/// Coefficients of Jacobians are raised to this share of their mean, in so many steps at most.
const LEAST_JACOBIAN: f64 = 0.5;
const UNTANGLING: usize = 10;
/// What is added to the squares of a coefficient's change over a unit of length, which are about one: it keeps steps short where
/// coefficients say little. From 0.003 to 0.3 as many flips were found.
const UNTANGLING_DAMPING: f64 = 0.03;

/// Where the unknown points of a flip are in its triangles, a d c and d b c: those of the new side from d to c, then the inner ones.
const UNKNOWN: [&[[Option<usize>; 2]]; 2] =
    [&[[Some(4), Some(5)]], &[[Some(5), Some(8)], [Some(6), Some(7)], [Some(9), None], [None, Some(9)]]];
/// Of triangle d b c the points on the new side, from d to c, ends included.
const NEW_SIDE: [&[usize]; 2] = [&[0, 5, 2], &[0, 8, 7, 2]];

/// A flip in the making.
pub(super) struct Local<'a> {
    aim: &'a Aim<'a>,
    rule: &'a Rule,
    order: usize,
    pub(super) triangles: [[Point; MOST]; 2],
}

impl<'a> Local<'a> {
    /// The new side goes through the middle of the old one, and between through the middles of the triangles.
    pub(super) fn of(elements: &Elements, aim: &'a Aim<'a>, rule: &'a Rule, pair: Pair) -> Self {
        let (order, count) = (elements.order, elements.count());
        let numbers = pair.numbers(elements);
        let triangles = numbers.map(|numbers| {
            let mut points = [Point::default(); MOST];
            for (p, &n) in points.iter_mut().zip(&numbers[..count]) {
                *p = elements.points[n as usize];
            }
            points
        });
        let mut local = Self { aim, rule, order, triangles };
        let [c, d] = [local.triangles[0][2], local.triangles[0][1]];
        let mut nodes = vec![d];
        if order == 3 {
            let middle = Rule::middle(order);
            let [t, s] = pair.triangles().map(|t| middle.image(&elements.of_triangle(&elements.points, t)));
            nodes.extend([s, t]);
        } else {
            let side: Vec<Point> = elements.side(pair.0[0]).iter().map(|&n| elements.points[n as usize]).collect();
            nodes.extend(nodes_of_curve(&side));
        }
        nodes.push(c);
        let inner = curve_of_nodes(&nodes);
        local.put(inner.into_iter().enumerate());
        if order == 3 {
            let inner = local.triangles.map(|points| interior_of_sides(&points));
            local.put([(2, inner[0]), (3, inner[1])].into_iter());
        }
        local
    }

    fn unknown(&self) -> &'static [[Option<usize>; 2]] {
        UNKNOWN[self.order - 2]
    }

    fn put(&mut self, points: impl Iterator<Item = (usize, Point)>) {
        for (k, point) in points {
            for (triangle, place) in self.triangles.iter_mut().zip(UNKNOWN[self.order - 2][k]) {
                if let Some(place) = place {
                    triangle[place] = point;
                }
            }
        }
    }

    fn count(&self) -> usize {
        exponents(self.order).len()
    }

    pub(super) fn is_valid(&self) -> bool {
        self.triangles.iter().all(|t| bound(&t[..self.count()], self.order, HALVINGS).least > self.aim.least)
    }

    fn new_side(&self) -> Vec<Point> {
        NEW_SIDE[self.order - 2].iter().map(|&i| self.triangles[1][i]).collect()
    }

    pub(super) fn energy(&self) -> f64 {
        let of = |t: &[Point; MOST]| self.aim.of_points(self.rule, &t[..self.count()]);
        let lengths = self.aim.lengths;
        let of_side = if lengths > 0.0 { side_energy(&self.new_side(), self.aim.metric, lengths) } else { 0.0 };
        self.triangles.iter().map(of).sum::<f64>() + of_side
    }

    /// Newton's method on the unknown points; returns the energy in the end.
    pub(super) fn settle(&mut self, mut energy: f64) -> f64 {
        for _ in 0..STEPS {
            let Some(step) = self.step() else { break };
            let (before, old) = (self.triangles, energy);
            let mut share = 1.0;
            loop {
                self.triangles = before;
                self.put_moved(&step, share);
                if self.is_valid() {
                    energy = self.energy();
                    if energy < old {
                        break;
                    }
                }
                share *= 0.5;
                if share < 0.1 {
                    self.triangles = before;
                    return old;
                }
            }
            if old - energy < LEAST_GAIN {
                break;
            }
        }
        energy
    }

    /// Moves the unknown points to where all coefficients of both Jacobians are positive; whether that was found. By the least squares of what
    /// coefficients lack, which are linear in each coordinate.
    pub(super) fn untangle(&mut self) -> bool {
        let start = self.jacobians();
        let mean = start.iter().sum::<f64>() / start.len() as f64;
        if mean <= 0.0 {
            return false;
        }
        let [_, axes] = self.aim.metric.at(curve_at(&self.new_side(), 0.5).0).frames();
        (0..UNTANGLING).any(|_| {
            let step = self.untangling(mean, axes);
            if let Some(step) = &step {
                self.put_moved(step, 1.0);
            }
            step.is_some() && self.is_valid()
        })
    }

    /// A step of that, along axes of the metric's unit circle.
    fn untangling(&mut self, mean: f64, axes: [Vector; 2]) -> Option<Vec<f64>> {
        let (here, before) = (self.jacobians(), self.triangles);
        let lacking: Vec<(usize, f64)> =
            here.iter().map(|j| LEAST_JACOBIAN - j / mean).enumerate().filter(|(_, lack)| *lack > 0.0).collect();
        let size = 2 * self.unknown().len();
        let mut slope = |i: usize| -> Vec<f64> {
            let mut step = vec![0.0; size];
            step[i - i % 2..][..2].copy_from_slice(&[axes[i % 2].x, axes[i % 2].y]);
            self.put_moved(&step, 1.0);
            let there = self.jacobians();
            self.triangles = before;
            lacking.iter().map(|&(k, _)| (there[k] - here[k]) / mean).collect()
        };
        let slopes: Vec<Vec<f64>> = (0..size).map(&mut slope).collect();
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let damping = |i: usize, j: usize| if i == j { UNTANGLING_DAMPING } else { 0.0 };
        let row = |i: usize| (0..size).map(|j| product(&slopes[i], &slopes[j]) + damping(i, j)).collect();
        let lack: Vec<f64> = lacking.iter().map(|(_, lack)| *lack).collect();
        let right = slopes.iter().map(|s| product(s, &lack)).collect();
        let steps = solved((0..size).map(row).collect(), right)?;
        Some(steps.chunks(2).map(|s| axes[0] * s[0] + axes[1] * s[1]).flat_map(|v| [v.x, v.y]).collect())
    }

    /// The coefficients of the Jacobians of both triangles.
    fn jacobians(&self) -> Vec<f64> {
        let count = self.order * (2 * self.order - 1);
        self.triangles
            .iter()
            .flat_map(|t| coefficients(&t[..self.count()], self.order).0.into_iter().take(count))
            .collect()
    }

    fn put_moved(&mut self, step: &[f64], share: f64) {
        let moved = self.unknown().iter().zip(step.chunks(2)).map(|(places, step)| {
            let at = (0..2).find_map(|i| Some(self.triangles[i][places[i]?])).expect("in one of both");
            at + Vector::new(step[0], step[1]) * share
        });
        let moved: Vec<Point> = moved.collect();
        self.put(moved.into_iter().enumerate());
    }

    fn step(&self) -> Option<Vec<f64>> {
        let size = 2 * self.unknown().len();
        let (mut matrix, mut slope) = (vec![vec![0.0; size]; size], vec![0.0; size]);
        let mut add = |freedoms: &[Freedom], found: &Expansion| {
            let mut at = 0;
            for (a, one) in freedoms.iter().enumerate() {
                slope[one.row as usize] -= found.slope[a];
                for other in &freedoms[..=a] {
                    let (i, j) = (one.row.max(other.row), one.row.min(other.row));
                    matrix[i as usize][j as usize] += found.curvature[at];
                    at += 1;
                }
            }
        };
        for (i, t) in self.triangles.iter().enumerate() {
            let freedoms = both_axes(self.unknown().iter().map(|places| places[i]));
            add(&freedoms, &self.aim.expansion(self.rule, &t[..self.count()], &freedoms));
        }
        if self.aim.lengths > 0.0 {
            let freedoms = both_axes((1..self.order).map(Some));
            add(&freedoms, &side(&self.new_side(), &freedoms, self.aim.metric, self.aim.lengths));
        }
        solved(matrix, slope)
    }
}

/// Unknowns of points that move along x and y, two rows each.
fn both_axes(points: impl Iterator<Item = Option<usize>>) -> Vec<Freedom> {
    let axes = [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)];
    let of_point = |(k, point): (u32, Option<usize>)| {
        let point = point?;
        Some([0, 1].map(|i: u32| Freedom { point, axis: axes[i as usize], row: 2 * k + i }))
    };
    (0..).zip(points).filter_map(of_point).flatten().collect()
}

/// The solution of a small system by Cholesky's method, from the lower half of its matrix; none where that is not positive definite.
pub(super) fn solved(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let size = right.len();
    for i in 0..size {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum();
            let rest = matrix[i][j] - known;
            matrix[i][j] = if i == j { (rest > 0.0).then(|| rest.sqrt())? } else { rest / matrix[j][j] };
        }
        let known: f64 = (0..i).map(|k| matrix[i][k] * right[k]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    for i in (0..size).rev() {
        let known: f64 = (i + 1..size).map(|k| matrix[k][i] * right[k]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    Some(right)
}
