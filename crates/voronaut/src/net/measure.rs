//! Circles and powers by geodesics.

use super::seen::{Seeds, Terrain, View};
use super::{Ball, Net};
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
#[derive(Clone, Debug)]
pub(crate) struct Memory<P = Point>(HashMap<[u32; 3], Remembered<P>>);

impl<P> Default for Memory<P> {
    fn default() -> Self {
        Self(HashMap::new())
    }
}

#[derive(Clone, Debug)]
struct Remembered<P> {
    /// The corners, and those around.
    seeds: Vec<(u32, P)>,
    /// The circle through the corners, as the first paths found it.
    circle: Option<Circle>,
    /// `None` of a triangle that has none.
    ball: Option<Ball<3, P>>,
    /// It has none although its circumcentre seems to be in the domain.
    is_unmeasured: bool,
}

/// Squared distances, circles and powers of seeds.
pub(super) struct Measure<'a, S> {
    paths: Paths,
    seeds: S,
    triangles: &'a [[u32; 3]],
    border: &'a [[u32; 2]],
    neighbours: Vec<Vec<u32>>,
    is_at_border: Vec<bool>,
    /// Lengths for which a chord stood in.
    chords: AtomicUsize,
}

impl<'a, S: Seeds> Measure<'a, S> {
    pub(super) fn new(seeds: S, triangles: &'a [[u32; 3]], border: &'a [[u32; 2]]) -> Self {
        let neighbours = super::neighbours(seeds.count(), triangles.iter().copied());
        let mut is_at_border = vec![false; seeds.count()];
        border.iter().flatten().for_each(|&i| is_at_border[i as usize] = true);
        let chords = AtomicUsize::new(0);
        Self { paths: Paths::default(), seeds, triangles, border, neighbours, is_at_border, chords }
    }

    /// All triangles.
    pub(super) fn all(&self) -> &'a [[u32; 3]] {
        self.triangles
    }

    /// The circles of some triangles and of all border edges, and what has none.
    pub(super) fn circles(&self, wanted: &[[u32; 3]], memory: &mut Memory<S::Place>) -> Net<S::Place> {
        let (triangles, unknown) = self.triangles(wanted, memory);
        let border = self.border.par_iter().with_min_len(16);
        let border: Vec<Ball<2, S::Place>> = border.filter_map(|&ends| self.border_edge(ends)).collect();
        let unmeasured = unknown.len() + self.border.len() - border.len();
        Net { triangles, border, unmeasured, unknown, ..Net::default() }
    }

    /// The circles of those triangles that have one, as far as possible from memory, which then knows all of them; and
    /// those that have none although they should.
    fn triangles(&self, wanted: &[[u32; 3]], memory: &mut Memory<S::Place>) -> (Vec<Ball<3, S::Place>>, Vec<[u32; 3]>) {
        let measured = |&corners: &[u32; 3]| {
            let seeds: Vec<(u32, S::Place)> =
                corners.into_iter().chain(self.around(&corners)).map(|i| (i, self.seeds.place(i))).collect();
            let known = memory.0.get(&corners).filter(|known| known.seeds[..3] == seeds[..3]);
            if let Some(known) = known.filter(|known| known.seeds == seeds) {
                return (corners, known.clone());
            }
            let view = self.seeds.around(&corners);
            let circle =
                known.map_or_else(|| view.as_ref().and_then(|view| self.circle(view, corners)), |known| known.circle);
            let ball = view.as_ref().and_then(|view| self.triangle(view, corners, circle));
            let is_unmeasured = ball.is_none() && view.is_none_or(|view| self.may_be_interior(&view, corners));
            (corners, Remembered { seeds, circle, ball, is_unmeasured })
        };
        let found: Vec<([u32; 3], Remembered<S::Place>)> = wanted.par_iter().with_min_len(4).map(measured).collect();
        let unknown =
            found.iter().filter(|(_, remembered)| remembered.is_unmeasured).map(|(corners, _)| *corners).collect();
        let balls = found.iter().filter_map(|(_, remembered)| remembered.ball).collect();
        memory.0.extend(found);
        (balls, unknown)
    }

    /// The least distance between neighbours: along the shortest chords until no other edge can be shorter.
    pub(super) fn mu(&self) -> f64 {
        let edges = self.neighbours.iter().enumerate().flat_map(|(i, list)| list.iter().map(move |&j| (i as u32, j)));
        // Seeds that are not seen from the middle between them are far apart.
        let chord = |(i, j): (u32, u32)| {
            let ends = [i, j];
            let view = self.seeds.around(&ends)?;
            Some((chord(view.field(), view.seed(i)?, view.seed(j)?), i, j))
        };
        let edges: Vec<(u32, u32)> = edges.filter(|(i, j)| i < j).collect();
        let mut edges: Vec<_> = edges.into_par_iter().with_min_len(64).filter_map(chord).collect();
        edges.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut least = f64::INFINITY;
        for (chord, i, j) in edges {
            if LEAST_SHARE * chord > least {
                break;
            }
            let ends = [i, j];
            let view = self.seeds.around(&ends);
            let geodesic =
                view.and_then(|view| self.paths.length(view.field(), view.seed(i)?, view.seed(j)?, Fineness::MIDDLE));
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

    /// The circle through three seeds, if it is found at once.
    fn circle(&self, view: &impl View, corners: [u32; 3]) -> Option<Circle> {
        let circle = Circle::around(&self.paths, view.field(), seen(view, corners)?, Fineness::MIDDLE);
        circle.filter(|circle| circle.error < VAGUE * circle.square)
    }

    fn triangle<V: View<Place = S::Place>>(
        &self,
        view: &V,
        corners: [u32; 3],
        known: Option<Circle>,
    ) -> Option<Ball<3, S::Place>> {
        let points = seen(view, corners)?;
        let around = |fineness| Circle::around(&self.paths, view.field(), points, fineness);
        // Circles around centres far outside the domain are not worth the finest paths.
        let fine = || around(Fineness::FINEST).or_else(|| Circle::around_carefully(&self.paths, view.field(), points));
        let circle = known.or_else(|| self.may_be_interior(view, corners).then(fine).flatten());
        let ball = |circle: Circle| self.ball(view, corners, &circle, view.is_inside(corners[0], circle.centre));
        if let Some(found) = circle.and_then(ball).filter(|ball| ball.power > 0.0 || !ball.is_interior) {
            return Some(found);
        }
        if !self.may_be_interior(view, corners) {
            return circle.and_then(ball);
        }
        // Of several circles the one of cells that meet has no seed in it.
        let starts = starts(view.field(), points);
        let near = |start| Circle::near(&self.paths, view.field(), points, start, view.is_smooth());
        let others = starts.into_iter().filter_map(near).filter_map(ball);
        let best = |a: Ball<3, S::Place>, b: Ball<3, S::Place>| {
            let rank = |ball: &Ball<3, S::Place>| if ball.is_interior { ball.power } else { f64::NEG_INFINITY };
            if rank(&b) > rank(&a) { b } else { a }
        };
        circle.and_then(ball).into_iter().chain(others).reduce(best)
    }

    /// Whether the circumcentre with one tensor is in the domain, or no corner at the border says that it may be outside.
    fn may_be_interior(&self, view: &impl View, corners: [u32; 3]) -> bool {
        let is_free = |i: &u32| !self.is_at_border[*i as usize];
        (!self.border.is_empty() && corners.iter().all(is_free)) || seems_interior(view, corners)
    }

    fn border_edge(&self, ends: [u32; 2]) -> Option<Ball<2, S::Place>> {
        let view = self.seeds.around(&ends)?;
        let circle = self.middle(view.field(), seen(&view, ends)?)?;
        self.ball(&view, ends, &circle, true)
    }

    fn ball<const N: usize, V: View<Place = S::Place>>(
        &self,
        view: &V,
        corners: [u32; N],
        circle: &Circle,
        is_interior: bool,
    ) -> Option<Ball<N, S::Place>> {
        let (power, nearest) = self.least_power(view, &corners, circle);
        let centre = view.place(circle.centre)?;
        Some(Ball { corners, centre, radius: circle.square.sqrt(), power, nearest, is_interior })
    }

    /// The seeds that share an edge with a corner and are none, in order.
    fn around(&self, corners: &[u32]) -> Vec<u32> {
        let around = corners.iter().flat_map(|&i| self.neighbours[i as usize].iter().copied());
        distinct(around.filter(|i| !corners.contains(i)))
    }

    /// The least power of a seed that shares an edge with a corner, nearest chords first.
    fn least_power(&self, view: &impl View, corners: &[u32], circle: &Circle) -> (f64, Option<u32>) {
        let seed = |i: u32| view.seed(i).map(|p| (i, p));
        let chord = |(i, p): (u32, Point)| (chord(view.field(), circle.centre, p), i);
        let (mut least, mut nearest) = (f64::INFINITY, None);
        for (chord, i) in ranked(self.around(corners).into_iter().filter_map(seed).map(chord)) {
            if (LEAST_SHARE * chord).powi(2) - circle.square > least {
                break;
            }
            let power = view.seed(i).and_then(|p| circle.power(&self.paths, view.field(), p, Fineness::MIDDLE));
            let power = power.unwrap_or_else(|| self.stand_in(chord).powi(2) - circle.square);
            if power < least {
                (least, nearest) = (power, Some(i));
            }
        }
        (least, nearest)
    }

    /// The circle around the point of a straight border edge that is equally far from both ends, by the secant method:
    /// the difference of the squared distances is nearly linear.
    fn middle(&self, field: &dyn MetricField, [a, b]: [Point; 2]) -> Option<Circle> {
        let square =
            |p: Point, q: Point| self.paths.length(field, p, q, Fineness::MIDDLE).map(|length| length.value.powi(2));
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

/// Where seeds are in a view, if all are seen.
fn seen<const N: usize>(view: &impl View, seeds: [u32; N]) -> Option<[Point; N]> {
    let found = seeds.map(|i| view.seed(i));
    found.iter().all(Option::is_some).then(|| found.map(Option::unwrap_or_default))
}

/// Whether the circumcentre with one tensor is in the domain.
fn seems_interior(view: &impl View, corners: [u32; 3]) -> bool {
    let Some(points) = seen(view, corners) else { return true };
    let centre = flat_centre(view.field().at(Point::centroid(points)), points);
    centre.is_some_and(|centre| view.is_inside(corners[0], centre))
}

/// Places from which a circumcentre may be found where the metric turns fast: the circumcentres with the tensors at the
/// corners, and places beside the longest side.
fn starts(field: &dyn MetricField, corners: [Point; 3]) -> Vec<Point> {
    let flat = corners.iter().filter_map(|&p| flat_centre(field.at(p), corners));
    let [a, b, c] = corners;
    let sides = [[a, b], [b, c], [c, a]].map(|[p, q]| (chord(field, p, q), p, q));
    let (length, p, q) = sides.into_iter().fold(sides[0], |most, side| if side.0 > most.0 { side } else { most });
    let middle = p.midpoint(q);
    let tensor = field.at(middle);
    let across = tensor.inverse().apply((q - p).perpendicular());
    let across = across * (0.5 * length / tensor.length(across));
    flat.chain(BESIDE.iter().map(|&share| middle + across * share)).collect()
}
