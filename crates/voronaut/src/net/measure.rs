//! Circles and powers by geodesics.

use super::{Ball, Net, Simplices};
use crate::geodesic::{Circle, Fineness, Paths, chord, flat_centre};
use crate::geometry::Point;
use crate::lists::{distinct, ranked};
use crate::metric::MetricField;
use crate::parallel::prelude::*;
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A geodesic is taken to be no shorter than this share of the straight segment between its ends: seeds farther away than
/// that allows are not asked.
const LEAST_SHARE: f64 = 0.7;
/// Circles whose squared radius is known no better than this share are sought once more with the finest paths.
const VAGUE: f64 = 1e-3;
/// Steps at most in which the middle of a border edge is found, and the difference of the squared distances (share of
/// the squared edge) at which it is.
const STEPS: usize = 20;
/// Where circumcentres are sought beside the longest side of a triangle, in halves of its length.
const BESIDE: [f64; 5] = [0.0, 0.5, -0.5, 1.0, -1.0];
const SETTLED: f64 = 1e-8;

/// Circles of triangles that were measured, with the seeds that they depend on.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory(HashMap<[u32; 3], Remembered>);

#[derive(Clone, Debug)]
struct Remembered {
    seeds: Vec<(u32, Point)>,
    /// `None` of a triangle that has none.
    ball: Option<Ball<3>>,
    /// It has none although its circumcentre seems to be in the domain.
    is_unmeasured: bool,
}

/// Squared distances, circles and powers of seeds.
pub(super) struct Measure<'a> {
    paths: Paths,
    field: &'a dyn MetricField,
    found: &'a Simplices<'a>,
    neighbours: Vec<Vec<u32>>,
    is_at_border: Vec<bool>,
    /// Lengths for which a chord stood in.
    chords: AtomicUsize,
}

impl<'a> Measure<'a> {
    pub(super) fn new(field: &'a dyn MetricField, found: &'a Simplices<'a>) -> Self {
        let neighbours = super::neighbours(found.seeds.len(), found.triangles.iter().copied());
        let mut is_at_border = vec![false; found.seeds.len()];
        found.border.iter().flatten().for_each(|&i| is_at_border[i as usize] = true);
        Self { paths: Paths::default(), field, found, neighbours, is_at_border, chords: AtomicUsize::new(0) }
    }

    /// The circles of some triangles and of all border edges, and what has none.
    pub(super) fn circles(&self, wanted: &[[u32; 3]], memory: &mut Memory) -> Net {
        let (triangles, unknown) = self.triangles(wanted, memory);
        let border = self.found.border.par_iter().with_min_len(16);
        let border: Vec<Ball<2>> = border.filter_map(|&ends| self.border_edge(ends)).collect();
        let unmeasured = unknown.len() + self.found.border.len() - border.len();
        Net { triangles, border, unmeasured, unknown, ..Net::default() }
    }

    /// The circles of those triangles that have one, as far as possible from memory, which then knows all of them; and
    /// those that have none although they should.
    fn triangles(&self, wanted: &[[u32; 3]], memory: &mut Memory) -> (Vec<Ball<3>>, Vec<[u32; 3]>) {
        let measured = |&corners: &[u32; 3]| {
            let seeds: Vec<(u32, Point)> =
                corners.into_iter().chain(self.around(&corners)).map(|i| (i, self.seed(i))).collect();
            let known = memory.0.get(&corners).filter(|known| known.seeds == seeds);
            if let Some(known) = known {
                return (corners, known.clone());
            }
            let ball = self.triangle(corners);
            (corners, Remembered { seeds, ball, is_unmeasured: ball.is_none() && self.may_be_interior(corners) })
        };
        let found: Vec<([u32; 3], Remembered)> = wanted.par_iter().with_min_len(4).map(measured).collect();
        let unknown =
            found.iter().filter(|(_, remembered)| remembered.is_unmeasured).map(|(corners, _)| *corners).collect();
        let balls = found.iter().filter_map(|(_, remembered)| remembered.ball).collect();
        memory.0.extend(found);
        (balls, unknown)
    }

    /// The least distance between neighbours: along the shortest chords until no other edge can be shorter.
    pub(super) fn mu(&self) -> f64 {
        let edges = self.neighbours.iter().enumerate().flat_map(|(i, list)| list.iter().map(move |&j| (i as u32, j)));
        let chord = |(i, j): (u32, u32)| (chord(self.field, self.seed(i), self.seed(j)), self.seed(i), self.seed(j));
        let mut edges: Vec<_> = edges.filter(|(i, j)| i < j).map(chord).collect();
        edges.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut least = f64::INFINITY;
        for (chord, p, q) in edges {
            if LEAST_SHARE * chord > least {
                break;
            }
            let geodesic = self.paths.length(self.field, p, q, Fineness::MIDDLE);
            least = least.min(geodesic.map_or_else(|| self.stand_in(chord), |length| length.value));
        }
        least
    }

    /// A chord where geodesics are not resolved: no less than the length that is wanted.
    fn stand_in(&self, chord: f64) -> f64 {
        self.chords.fetch_add(1, Ordering::Relaxed);
        chord
    }

    /// How many lengths, so far, are chords.
    pub(super) fn chords(&self) -> usize {
        self.chords.load(Ordering::Relaxed)
    }

    fn seed(&self, i: u32) -> Point {
        self.found.seeds[i as usize]
    }

    fn triangle(&self, corners: [u32; 3]) -> Option<Ball<3>> {
        let points = corners.map(|i| self.seed(i));
        let around = |fineness| Circle::around(&self.paths, self.field, points, fineness);
        let known = around(Fineness::MIDDLE).filter(|circle| circle.error < VAGUE * circle.square);
        // Circles around centres far outside the domain are not worth the finest paths.
        let fine = || around(Fineness::FINEST).or_else(|| Circle::around_carefully(&self.paths, self.field, points));
        let circle = known.or_else(|| self.may_be_interior(corners).then(fine).flatten());
        let ball = |circle: Circle| self.ball(corners, &circle, (self.found.is_inside)(corners[0], circle.centre));
        if let Some(found) = circle.map(ball).filter(|ball| ball.power > 0.0 || !ball.is_interior) {
            return Some(found);
        }
        if !self.may_be_interior(corners) {
            return circle.map(ball);
        }
        // Of several circles the one of cells that meet has no seed in it.
        let starts = self.starts(points);
        let others =
            starts.into_iter().filter_map(|start| Circle::near(&self.paths, self.field, points, start)).map(ball);
        let best = |a: Ball<3>, b: Ball<3>| {
            let rank = |ball: &Ball<3>| if ball.is_interior { ball.power } else { f64::NEG_INFINITY };
            if rank(&b) > rank(&a) { b } else { a }
        };
        circle.map(ball).into_iter().chain(others).reduce(best)
    }

    /// Places from which a circumcentre may be found where the metric turns fast: the circumcentres with the tensors at the
    /// corners, and places beside the longest side.
    fn starts(&self, corners: [Point; 3]) -> Vec<Point> {
        let flat = corners.iter().filter_map(|&p| flat_centre(self.field.at(p), corners));
        let [a, b, c] = corners;
        let sides = [[a, b], [b, c], [c, a]].map(|[p, q]| (chord(self.field, p, q), p, q));
        let (length, p, q) = sides.into_iter().fold(sides[0], |most, side| if side.0 > most.0 { side } else { most });
        let middle = p.midpoint(q);
        let tensor = self.field.at(middle);
        let across = tensor.inverse().apply((q - p).perpendicular());
        let across = across * (0.5 * length / tensor.length(across));
        flat.chain(BESIDE.iter().map(|&share| middle + across * share)).collect()
    }

    /// Whether the circumcentre with one tensor is in the domain, or no corner at the border says that it may be outside.
    fn may_be_interior(&self, corners: [u32; 3]) -> bool {
        let is_free = |i: &u32| !self.is_at_border[*i as usize];
        (!self.found.border.is_empty() && corners.iter().all(is_free)) || self.seems_interior(corners)
    }

    /// Whether the circumcentre with one tensor is in the domain.
    fn seems_interior(&self, corners: [u32; 3]) -> bool {
        let points = corners.map(|i| self.seed(i));
        let centre = flat_centre(self.field.at(Point::centroid(points)), points);
        centre.is_some_and(|centre| (self.found.is_inside)(corners[0], centre))
    }

    fn border_edge(&self, ends: [u32; 2]) -> Option<Ball<2>> {
        let circle = self.middle(ends.map(|i| self.seed(i)))?;
        Some(self.ball(ends, &circle, true))
    }

    fn ball<const N: usize>(&self, corners: [u32; N], circle: &Circle, is_interior: bool) -> Ball<N> {
        let (power, nearest) = self.least_power(&corners, circle);
        Ball { corners, centre: circle.centre, radius: circle.square.sqrt(), power, nearest, is_interior }
    }

    /// The seeds that share an edge with a corner and are none, in order.
    fn around(&self, corners: &[u32]) -> Vec<u32> {
        let around = corners.iter().flat_map(|&i| self.neighbours[i as usize].iter().copied());
        distinct(around.filter(|i| !corners.contains(i)))
    }

    /// The least power of a seed that shares an edge with a corner, nearest chords first.
    fn least_power(&self, corners: &[u32], circle: &Circle) -> (f64, Option<u32>) {
        let chord = |i: u32| (chord(self.field, circle.centre, self.seed(i)), i);
        let (mut least, mut nearest) = (f64::INFINITY, None);
        for (chord, i) in ranked(self.around(corners).into_iter().map(chord)) {
            if (LEAST_SHARE * chord).powi(2) - circle.square > least {
                break;
            }
            let power = circle.power(&self.paths, self.field, self.seed(i), Fineness::MIDDLE);
            let power = power.unwrap_or_else(|| self.stand_in(chord).powi(2) - circle.square);
            if power < least {
                (least, nearest) = (power, Some(i));
            }
        }
        (least, nearest)
    }

    /// The circle around the point of a straight border edge that is equally far from both ends, by the secant method:
    /// the difference of the squared distances is nearly linear.
    fn middle(&self, [a, b]: [Point; 2]) -> Option<Circle> {
        let square = |p: Point, q: Point| {
            self.paths.length(self.field, p, q, Fineness::MIDDLE).map(|length| length.value.powi(2))
        };
        let whole = square(a, b)?;
        let (mut before, mut t) = ((0.0, -whole), 0.5);
        for _ in 0..STEPS {
            let centre = a.lerp(b, t);
            let [to_a, to_b] = [square(a, centre)?, square(b, centre)?];
            let difference = to_a - to_b;
            if difference.abs() < SETTLED * whole {
                return Some(Circle { centre, square: 0.5 * (to_a + to_b), error: difference.abs() });
            }
            let next: f64 = t - difference * (t - before.0) / (difference - before.1);
            before = (t, difference);
            t = next.clamp(0.01, 0.99);
        }
        None
    }
}
