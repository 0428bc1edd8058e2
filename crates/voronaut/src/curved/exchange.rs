//! Exchange of vertices: as many go where sides are short as come where sides are long.

use super::bezier::{MOST, exponents, side};
use super::elements::{Elements, HALVINGS, Hold, Loose, Side, Vertex};
use super::jacobian::bound;
use super::newton::Aim;
use super::rules::Rule;
use super::term::{curve_length, side_energy};
use crate::geometry::{Point, Vector};
use crate::lists::{distinct, ranked};
use crate::mesh::edges::NONE;
use crate::parallel::prelude::*;

/// Sides that are shorter may go, and those that are longer may be halved: what is left of a longer one is not shorter than this.
const SHORT: f64 = 0.8;
const LONG: f64 = 1.3;
/// Where errors are what counts, a side of a triangle may go that costs less than this, where the mean is one, and that of one may be halved that costs more.
const CHEAP: f64 = 0.3;
const DEAR: f64 = 2.0;
/// What a collapse costs before anything settles counts by half: flips and steps mend that much of it.
const MENDED: f64 = 0.5;

/// A change of a few triangles.
struct Change {
    /// What the energy gains by it, before anything settles.
    gain: f64,
    /// Triangles that go, and those that come; a new vertex in these is `NONE`.
    old: Vec<usize>,
    new: Vec<Loose>,
    /// The vertex that goes or comes.
    vertex: Option<Vertex>,
}

/// Exchanges vertices, so many at most: pairs of a collapse and a split that lower the energy together, none beside another. The mesh
/// with them; none where there are none.
pub(super) fn exchange(elements: &Elements, aim: &Aim, most: usize) -> Option<Elements> {
    let rule = Rule::of(elements.order);
    let work = Work { elements, aim, rule: &rule, loose: elements.loose() };
    let (splits, collapses) = work.possible();
    let chosen = chosen(&splits, &collapses, elements.triangles.len(), most);
    (!chosen.is_empty()).then(|| work.changed(&chosen))
}

/// Splits with collapses, the best of either first.
fn chosen<'a>(splits: &'a [Change], collapses: &'a [Change], triangles: usize, most: usize) -> Vec<&'a Change> {
    let by_gain = |changes: &[Change]| ranked(changes.iter().zip(0..).map(|(c, i): (&Change, usize)| (-c.gain, i)));
    let mut chosen = Vec::new();
    let mut is_touched = vec![false; triangles];
    let is_free = |change: &Change, is_touched: &[bool]| change.old.iter().all(|&t| !is_touched[t]);
    let mut going = by_gain(collapses).into_iter();
    for (loss, i) in by_gain(splits) {
        if !is_free(&splits[i], &is_touched) {
            continue;
        }
        splits[i].old.iter().for_each(|&t| is_touched[t] = true);
        let Some((cost, j)) = going.find(|&(_, j)| is_free(&collapses[j], &is_touched)) else { break };
        if loss + MENDED * cost >= 0.0 || chosen.len() >= 2 * most {
            break;
        }
        collapses[j].old.iter().for_each(|&t| is_touched[t] = true);
        chosen.extend([&splits[i], &collapses[j]]);
    }
    chosen
}

struct Work<'a> {
    elements: &'a Elements,
    aim: &'a Aim<'a>,
    rule: &'a Rule,
    loose: Vec<Loose>,
}

impl Work<'_> {
    /// Splits of long sides, and collapses of short ones either way.
    fn possible(&self) -> (Vec<Change>, Vec<Change>) {
        let twins = &self.elements.twins;
        let by_cost = self.aim.target.is_some();
        let lengths: Vec<f64> =
            (0..twins.len()).into_par_iter().map(|h| if by_cost { 0.0 } else { self.length(h) }).collect();
        let costs: Vec<f64> = self.loose.par_iter().map(|t| if by_cost { self.energy(t) } else { 0.0 }).collect();
        let is_required = |h: usize| {
            // A labelled side between vertices that stay is whole.
            let ends = [h, Elements::next(h)].map(|h| self.elements.holds[self.elements.origin(h) as usize]);
            self.elements.held[h] != NONE && ends == [Hold::Fixed; 2]
        };
        let first = |h: usize| twins[h] == NONE || h < twins[h] as usize;
        let is_long = |h: usize| if by_cost { costs[h / 3] > DEAR } else { lengths[h] > LONG };
        let is_short = |h: usize| if by_cost { costs[h / 3] < CHEAP } else { lengths[h] < SHORT };
        let are_long = |h: usize| is_long(h) || (twins[h] != NONE && is_long(twins[h] as usize));
        let all = 0..twins.len();
        let long: Vec<usize> = all.clone().filter(|&h| first(h) && are_long(h) && !is_required(h)).collect();
        let short: Vec<usize> = all.filter(|&h| is_short(h)).collect();
        let collapses = short.par_iter().filter_map(|&h| self.collapse(h)).collect();
        (long.par_iter().map(|&h| self.split(h)).collect(), collapses)
    }

    fn length(&self, half_edge: usize) -> f64 {
        let points: Vec<Point> =
            self.elements.side(half_edge).iter().map(|&n| self.elements.points[n as usize]).collect();
        curve_length(&points, self.aim.metric)
    }

    /// The energy of a triangle and half the cost of its sides, which others have as well.
    fn energy(&self, triangle: &Loose) -> f64 {
        let Aim { metric, lengths, .. } = *self.aim;
        let of_side = |s: usize| {
            let points: Vec<Point> = side(self.elements.order, s).map(|i| triangle.points[i]).collect();
            side_energy(&points, metric, 0.5 * lengths)
        };
        let of_sides = if lengths > 0.0 { (0..3).map(of_side).sum() } else { 0.0 };
        self.aim.of_points(self.rule, &triangle.points[..self.elements.count()]) + of_sides
    }

    fn gain(&self, old: &[usize], new: &[Loose]) -> f64 {
        let before: f64 = old.iter().map(|&t| self.energy(&self.loose[t])).sum();
        before - new.iter().map(|t| self.energy(t)).sum::<f64>()
    }

    /// The half-edges of a side.
    fn both(&self, half_edge: usize) -> Vec<usize> {
        let twin = self.elements.twins[half_edge];
        std::iter::once(half_edge).chain((twin != NONE).then_some(twin as usize)).collect()
    }

    /// A triangle with the corner that a half-edge leaves first.
    fn from(&self, half_edge: usize) -> Loose {
        let turned = |by: usize| {
            let (old, order) = (self.loose[half_edge / 3], self.elements.order);
            let mut new = old;
            for i in 0..3 {
                (new.corners[i], new.sides[i]) = (old.corners[(i + by) % 3], old.sides[(i + by) % 3]);
                for (to, from) in side(order, i).zip(side(order, (i + by) % 3)) {
                    new.points[to] = old.points[from];
                }
            }
            new
        };
        turned(half_edge % 3)
    }

    /// Halves a side and the triangles beside it, which stay what they are.
    fn split(&self, half_edge: usize) -> Change {
        let mut change = Change { gain: 0.0, old: Vec::new(), new: Vec::new(), vertex: None };
        for h in self.both(half_edge) {
            let triangle = self.from(h);
            change.old.push(h / 3);
            change.new.extend(halves(&triangle, self.elements.order));
        }
        let held = change.new[0].sides[0].held;
        let [a, b] = [half_edge, Elements::next(half_edge)].map(|h| self.elements.origin(h) as usize);
        let line = |v: usize| if let Hold::Along(line) = self.elements.holds[v] { Some(line) } else { None };
        let ends = || [a, b].map(|v| self.elements.points[v]);
        let hold = if held == NONE { Hold::Free } else { Hold::Along(line(a).or(line(b)).unwrap_or_else(ends)) };
        change.vertex = Some(Vertex { place: change.new[0].points[1], hold, source: NONE });
        change.gain = self.gain(&change.old, &change.new);
        change
    }

    /// Moves the vertex that a half-edge leaves onto the one that it goes to, where that leaves valid triangles.
    fn collapse(&self, half_edge: usize) -> Option<Change> {
        let elements = self.elements;
        let [v, w] = [half_edge, Elements::next(half_edge)].map(|h| elements.origin(h));
        let held = elements.held[half_edge];
        match elements.holds[v as usize] {
            Hold::Fixed => return None,
            Hold::Along(_) if held == NONE => return None,
            _ => {}
        }
        let around: Vec<usize> = elements.around(half_edge).collect();
        let beside = self.both(half_edge);
        let [mine, others] = [half_edge, Elements::next(half_edge)].map(|h| self.neighbours(h));
        let common = mine.iter().filter(|u| others.contains(u)).count();
        if common != beside.len() || around.len() < 2 + beside.len() {
            return None;
        }
        let away = elements.points[w as usize] - elements.points[v as usize];
        let gone: Vec<usize> = beside.iter().map(|h| h / 3).collect();
        let stay = around.iter().filter(|&&h| !gone.contains(&(h / 3)));
        let new: Vec<Loose> = stay.map(|&h| self.moved(self.from(h), w, away, &gone)).collect();
        let is_valid =
            |t: &Loose| bound(&t.points[..elements.count()], elements.order, HALVINGS).least > self.aim.least;
        if !new.iter().all(is_valid) {
            return None;
        }
        let old: Vec<usize> = around.iter().map(|h| h / 3).collect();
        let gain = self.gain(&old, &new);
        Some(Change { gain, old, new, vertex: None })
    }

    fn neighbours(&self, half_edge: usize) -> Vec<u32> {
        let elements = self.elements;
        let ends = elements.around(half_edge).flat_map(|h| {
            let next = Elements::next(h);
            [elements.origin(next), elements.origin(Elements::next(next))]
        });
        distinct(ends)
    }

    /// A triangle whose first corner goes to another vertex, its points with it, the less the farther away they are; sides that were there
    /// already are as they were.
    fn moved(&self, mut triangle: Loose, to: u32, away: Vector, gone: &[usize]) -> Loose {
        let order = self.elements.order;
        for (p, e) in triangle.points.iter_mut().zip(exponents(order)) {
            *p = *p + away * (f64::from(e[0]) / order as f64);
        }
        triangle.corners[0] = to;
        for &t in gone {
            for s in 0..3 {
                let [a, b] = [s, (s + 1) % 3].map(|i| self.loose[t].corners[i]);
                // The side from `to` to the corner opposite, in either direction.
                for i in [0, 2] {
                    let [c, d] = [i, (i + 1) % 3].map(|i| triangle.corners[i]);
                    let old: Vec<Point> = side(order, s).map(|i| self.loose[t].points[i]).collect();
                    let places: Vec<usize> = side(order, i).collect();
                    if [a, b] == [c, d] {
                        places.iter().zip(&old).for_each(|(&i, &p)| triangle.points[i] = p);
                    } else if [b, a] == [c, d] {
                        places.iter().rev().zip(&old).for_each(|(&i, &p)| triangle.points[i] = p);
                    } else {
                        continue;
                    }
                    triangle.sides[i] = self.loose[t].sides[s];
                }
            }
        }
        triangle
    }

    /// The mesh with changes done, vertices and triangles numbered anew.
    fn changed(&self, changes: &[&Change]) -> Elements {
        let mut vertices = self.elements.loose_vertices();
        let mut is_gone = vec![false; self.loose.len()];
        let mut triangles = Vec::new();
        for change in changes {
            change.old.iter().for_each(|&t| is_gone[t] = true);
            let new = vertices.len() as u32;
            vertices.extend(change.vertex);
            triangles.extend(
                change.new.iter().map(|&t| Loose { corners: t.corners.map(|v| if v == NONE { new } else { v }), ..t }),
            );
        }
        let kept = self.loose.iter().zip(is_gone).filter(|(_, is_gone)| !is_gone).map(|(&t, _)| t);
        let mut triangles: Vec<Loose> = kept.chain(triangles).collect();
        let used = distinct(triangles.iter().flat_map(|t| t.corners));
        for triangle in &mut triangles {
            triangle.corners = triangle.corners.map(|v| used.binary_search(&v).expect("it is used") as u32);
        }
        let vertices: Vec<Vertex> = used.iter().map(|&v| vertices[v as usize]).collect();
        Elements::assembled(self.elements.order, &vertices, &triangles)
    }
}

/// Both halves of a triangle cut from the middle of its first side to the corner opposite; the new vertex is `NONE`.
pub(super) fn halves(triangle: &Loose, order: usize) -> [Loose; 2] {
    let at = |e: [u8; 3]| exponents(order).iter().position(|f| *f == e).expect("exponents of this order");
    let [a, b, c] = triangle.corners;
    let [ab, bc, ca] = triangle.sides;
    let mut first =
        Loose { corners: [a, NONE, c], sides: [ab, Side::FREE, ca], points: [Point::default(); MOST], ..*triangle };
    let mut second = Loose { corners: [NONE, b, c], sides: [ab, bc, Side::FREE], ..first };
    for k in 0..=order as u8 {
        let length = order as u8 - k;
        let mut row: Vec<Point> = (0..=length).map(|j| triangle.points[at([length - j, j, k])]).collect();
        for round in 0..=length {
            first.points[at([length - round, round, k])] = row[0];
            second.points[at([round, length - round, k])] = row[row.len() - 1];
            row = row.windows(2).map(|pair| pair[0].midpoint(pair[1])).collect();
        }
    }
    [first, second]
}
