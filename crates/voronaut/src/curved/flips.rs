//! Flips of sides by the energy of the triangles beside them.

use super::bezier::{MOST, curve_of_nodes, exponents, interior_of_sides, nodes_of_curve};
use super::elements::{Elements, HALVINGS};
use super::jacobian::bound;
use super::newton::Aim;
use super::rules::Rule;
use super::term::{Expansion, Freedom, side, side_energy, triangle, triangle_energy};
use crate::geometry::{Point, Vector};
use crate::lists::ranked;
use crate::mesh::edges::NONE;
use crate::parallel::prelude::*;

/// Flips have to gain so much at least: what rounding and half-settled points make of none.
const LEAST_GAIN: f64 = 1e-4;
/// A flip is tried whose first guess costs no more than so many times what is there, and so much.
const HOPEFUL: (f64, f64) = (2.0, 0.5);
/// Steps in which the new side settles.
const STEPS: usize = 4;

/// Two triangles beside a side: the half-edge of the one and of the other.
#[derive(Clone, Copy)]
struct Pair([usize; 2]);

/// What a flip would make: the points of both triangles, the new side's and their inner ones among them.
struct Flipped {
    gain: f64,
    half_edge: usize,
    triangles: [[Point; MOST]; 2],
}

/// Flips sides that cost less on the other diagonal, the best first and none beside another; the number of flips.
pub(super) fn flip(elements: &mut Elements, aim: &Aim) -> usize {
    let inner: Vec<usize> = (0..elements.twins.len())
        .filter(|&h| elements.twins[h] != NONE && h < elements.twins[h] as usize && !elements.is_held[h])
        .collect();
    let rule = Rule::of(elements.order);
    let found: Vec<Flipped> = inner.par_iter().filter_map(|&h| tried(elements, aim, &rule, h)).collect();
    let mut is_touched = vec![false; elements.triangles.len()];
    let mut flips = 0;
    for (_, i) in ranked(found.iter().zip(0..).map(|(f, i): (&Flipped, usize)| (-f.gain, i))) {
        let pair = Pair::of(elements, found[i].half_edge);
        if pair.triangles().iter().any(|&t| is_touched[t]) || pair.has_other_side(elements) {
            continue;
        }
        pair.triangles().into_iter().for_each(|t| is_touched[t] = true);
        pair.flip(elements, &found[i].triangles);
        flips += 1;
    }
    flips
}

impl Pair {
    fn of(elements: &Elements, half_edge: usize) -> Self {
        Self([half_edge, elements.twins[half_edge] as usize])
    }

    fn triangles(self) -> [usize; 2] {
        self.0.map(|h| h / 3)
    }

    /// Whether the vertices opposite are neighbours already: between two vertices is one side at most.
    fn has_other_side(self, elements: &Elements) -> bool {
        let [from, to] = self.0.map(|h| Elements::next(Elements::next(h)));
        let d = elements.origin(to);
        elements
            .around(from)
            .any(|h| elements.origin(Elements::next(h)) == d || elements.origin(Elements::next(Elements::next(h))) == d)
    }

    /// The half-edges of the new triangles but for the new side: of the first a to d and c to a, where the old side goes from a to b,
    /// with c on its left and d on its right; of the second d to b and b to c.
    fn outer(self) -> [[usize; 2]; 2] {
        let [h, twin] = self.0;
        let after = Elements::next;
        [[after(twin), after(after(h))], [after(after(twin)), after(h)]]
    }

    /// The numbers of the points of both new triangles, a d c and d b c, with the old side's points on the new one.
    fn numbers(self, elements: &Elements) -> [[u32; MOST]; 2] {
        let order = elements.order;
        let inner = order - 1;
        let [[ad, ca], [db, bc]] = self.outer().map(|pair| pair.map(|h| elements.side(h)));
        let old = elements.side(self.0[0]);
        let mut new = old[1..order].to_vec();
        let assemble = |sides: [&[u32]; 3], corners: [u32; 3], triangle: usize| {
            let mut numbers = [NONE; MOST];
            numbers[..3].copy_from_slice(&corners);
            for (s, side) in sides.into_iter().enumerate() {
                numbers[3 + s * inner..][..inner].copy_from_slice(side);
            }
            if order == 3 {
                numbers[9] = elements.triangles[triangle][9];
            }
            numbers
        };
        let (a, d, c, b) = (ad[0], ad[order], ca[0], bc[0]);
        let [one, two] = self.triangles();
        let first = assemble([&ad[1..order], &new, &ca[1..order]], [a, d, c], one);
        new.reverse();
        [first, assemble([&db[1..order], &bc[1..order], &new], [d, b, c], two)]
    }

    fn flip(self, elements: &mut Elements, points: &[[Point; MOST]; 2]) {
        let numbers = self.numbers(elements);
        let outer = self.outer();
        let known = outer.map(|pair| pair.map(|h| (elements.twins[h], elements.is_held[h])));
        let [t, s] = self.triangles();
        let count = elements.count();
        for (triangle, numbers, points) in [(t, numbers[0], points[0]), (s, numbers[1], points[1])] {
            elements.triangles[triangle] = numbers;
            for (&n, p) in numbers[..count].iter().zip(points) {
                elements.points[n as usize] = p;
            }
        }
        // Sides: a d, d c, c a and d b, b c, c d.
        let new = [[3 * t, 3 * t + 2], [3 * s, 3 * s + 1]];
        for (half_edges, known) in new.into_iter().zip(known) {
            for (h, (twin, is_held)) in half_edges.into_iter().zip(known) {
                (elements.twins[h], elements.is_held[h]) = (twin, is_held);
                if twin != NONE {
                    elements.twins[twin as usize] = h as u32;
                }
            }
        }
        let [dc, cd] = [3 * t + 1, 3 * s + 2];
        (elements.twins[dc], elements.twins[cd]) = (cd as u32, dc as u32);
        (elements.is_held[dc], elements.is_held[cd]) = (false, false);
    }
}

/// What a flip would gain, where it is valid and gains anything.
fn tried(elements: &Elements, aim: &Aim, rule: &Rule, half_edge: usize) -> Option<Flipped> {
    let pair = Pair::of(elements, half_edge);
    let before = cost(elements, aim, rule, pair);
    let mut local = Local::of(elements, aim, rule, pair);
    if !local.is_valid() {
        return None;
    }
    let guess = local.energy();
    if guess > HOPEFUL.0 * before + HOPEFUL.1 {
        return None;
    }
    let gain = before - local.settle(guess);
    (gain > LEAST_GAIN).then_some(Flipped { gain, half_edge, triangles: local.triangles })
}

/// The energy of two triangles and the side between them.
fn cost(elements: &Elements, aim: &Aim, rule: &Rule, pair: Pair) -> f64 {
    let count = elements.count();
    let of_triangle = |t: usize| triangle_energy(rule, &elements.of_triangle(&elements.points, t)[..count], aim.metric);
    let side: Vec<Point> = elements.side(pair.0[0]).iter().map(|&n| elements.points[n as usize]).collect();
    let of_side = if aim.lengths > 0.0 { side_energy(&side, aim.metric, aim.lengths) } else { 0.0 };
    pair.triangles().map(of_triangle).iter().sum::<f64>() + of_side
}

/// Where the unknown points of a flip are in its triangles, a d c and d b c: those of the new side from d to c, then the inner ones.
const UNKNOWN: [&[[Option<usize>; 2]]; 2] =
    [&[[Some(4), Some(5)]], &[[Some(5), Some(8)], [Some(6), Some(7)], [Some(9), None], [None, Some(9)]]];
/// Of triangle d b c the points on the new side, from d to c, ends included.
const NEW_SIDE: [&[usize]; 2] = [&[0, 5, 2], &[0, 8, 7, 2]];

/// A flip in the making.
struct Local<'a> {
    aim: &'a Aim<'a>,
    rule: &'a Rule,
    order: usize,
    triangles: [[Point; MOST]; 2],
}

impl<'a> Local<'a> {
    /// The new side goes through the middle of the old one, and between through the middles of the triangles.
    fn of(elements: &Elements, aim: &'a Aim<'a>, rule: &'a Rule, pair: Pair) -> Self {
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

    fn is_valid(&self) -> bool {
        self.triangles.iter().all(|t| bound(&t[..self.count()], self.order, HALVINGS).is_valid())
    }

    fn new_side(&self) -> Vec<Point> {
        NEW_SIDE[self.order - 2].iter().map(|&i| self.triangles[1][i]).collect()
    }

    fn energy(&self) -> f64 {
        let of = |t: &[Point; MOST]| triangle_energy(self.rule, &t[..self.count()], self.aim.metric);
        let lengths = self.aim.lengths;
        let of_side = if lengths > 0.0 { side_energy(&self.new_side(), self.aim.metric, lengths) } else { 0.0 };
        self.triangles.iter().map(of).sum::<f64>() + of_side
    }

    /// Newton's method on the unknown points; returns the energy in the end.
    fn settle(&mut self, mut energy: f64) -> f64 {
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
            add(&freedoms, &triangle(self.rule, &t[..self.count()], &freedoms, self.aim.metric));
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
fn solved(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
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
