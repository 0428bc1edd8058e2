//! Circles and powers by geodesics.

use super::{Ball, Triangles};
use crate::geodesic::{Circle, Fineness, Paths, chord};
use crate::geometry::Point;
use crate::metric::MetricField;
use rayon::prelude::*;

/// A geodesic is taken to be no shorter than this share of the straight segment between its ends: seeds farther away than
/// that allows are not asked.
const LEAST_SHARE: f64 = 0.7;
/// Circles whose squared radius is known no better than this share are sought once more with the finest paths.
const VAGUE: f64 = 1e-4;
/// Steps at most in which the middle of a border edge is found, and the difference of the squared distances (share of
/// the squared edge) at which it is.
const STEPS: usize = 20;
const SETTLED: f64 = 1e-8;

/// Squared distances, circles and powers of seeds.
pub(super) struct Measure<'a> {
    paths: &'a Paths,
    field: &'a dyn MetricField,
    found: &'a Triangles<'a>,
    neighbours: Vec<Vec<u32>>,
}

impl<'a> Measure<'a> {
    pub(super) fn new(paths: &'a Paths, field: &'a dyn MetricField, found: &'a Triangles<'a>) -> Self {
        let mut neighbours = vec![Vec::new(); found.seeds.len()];
        for &[a, b, c] in found.triangles {
            for [i, j] in [[a, b], [b, c], [c, a]] {
                neighbours[i as usize].push(j);
                neighbours[j as usize].push(i);
            }
        }
        for list in &mut neighbours {
            list.sort_unstable();
            list.dedup();
        }
        Self { paths, field, found, neighbours }
    }

    /// The circles of all triangles that have one.
    pub(super) fn triangles(&self) -> Vec<Ball<3>> {
        self.found.triangles.par_iter().with_min_len(16).filter_map(|&corners| self.triangle(corners)).collect()
    }

    /// The circles of all border edges that have one.
    pub(super) fn border(&self) -> Vec<Ball<2>> {
        self.found.border.par_iter().with_min_len(16).filter_map(|&ends| self.border_edge(ends)).collect()
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
            least = least.min(geodesic.map_or(chord, |length| length.value));
        }
        least
    }

    fn seed(&self, i: u32) -> Point {
        self.found.seeds[i as usize]
    }

    fn triangle(&self, corners: [u32; 3]) -> Option<Ball<3>> {
        let around = |fineness| Circle::around(self.paths, self.field, corners.map(|i| self.seed(i)), fineness);
        let known = around(Fineness::MIDDLE).filter(|circle| circle.error < VAGUE * circle.square);
        let circle = known.or_else(|| around(Fineness::FINEST))?;
        let is_interior = (self.found.is_inside)(corners[0], circle.centre);
        Some(self.ball(corners, &circle, is_interior))
    }

    fn border_edge(&self, ends: [u32; 2]) -> Option<Ball<2>> {
        let circle = self.middle(ends.map(|i| self.seed(i)))?;
        Some(self.ball(ends, &circle, true))
    }

    fn ball<const N: usize>(&self, corners: [u32; N], circle: &Circle, is_interior: bool) -> Ball<N> {
        let (power, nearest) = self.least_power(&corners, circle);
        Ball { corners, centre: circle.centre, radius: circle.square.sqrt(), power, nearest, is_interior }
    }

    /// The least power of a seed that shares an edge with a corner, nearest chords first.
    fn least_power(&self, corners: &[u32], circle: &Circle) -> (f64, Option<u32>) {
        let mut around: Vec<u32> = corners.iter().flat_map(|&i| self.neighbours[i as usize].iter().copied()).collect();
        around.sort_unstable();
        around.dedup();
        around.retain(|i| !corners.contains(i));
        let chord = |i: u32| (chord(self.field, circle.centre, self.seed(i)), i);
        let mut chords: Vec<(f64, u32)> = around.into_iter().map(chord).collect();
        chords.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let (mut least, mut nearest) = (f64::INFINITY, None);
        for (chord, i) in chords {
            if (LEAST_SHARE * chord).powi(2) - circle.square > least {
                break;
            }
            let power = circle.power(self.paths, self.field, self.seed(i), Fineness::MIDDLE);
            let power = power.unwrap_or(chord * chord - circle.square);
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
