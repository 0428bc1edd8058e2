//! Smooth curves through the vertices of a domain's boundaries and interfaces.

use super::{Chain, Pslg};
use crate::geometry::{Point, Vector};
use crate::lists::in_order;
use std::collections::{HashMap, HashSet};

/// A curve has a corner where it turns by more than this angle (degrees): the one for creases of surfaces.
const CORNER: f64 = 45.0;
/// A segment so many times as long as those that it goes on in is straight: in samples of a curve neighbours differ by less, and a straight part comes
/// without vertices.
const STRAIGHT: f64 = 3.0;
/// Rounds of Gauss and Seidel's method: each leaves half of what is missing at most, for the diagonal is twice the rest of a row.
const ROUNDS: usize = 60;

/// Cubic splines through the vertices of a graph's curves, between corners and straight segments. Their parameter is the length of chords;
/// first and second derivatives are continuous, and they leave straight segments in their direction (de Boor 1978, chapter 4). The error is of order 4 in the
/// length of chords.
pub(crate) struct Splines {
    runs: Vec<Run>,
    /// Of each position where its vertex is: runs, and places in them.
    places: HashMap<[u64; 2], Vec<[u32; 2]>>,
    /// The ends of the segments that are in no run, the lesser vertex first.
    straight: HashSet<[[u64; 2]; 2]>,
}

/// A spline by its values and derivatives.
struct Run {
    /// A closed one ends with the point that it starts with.
    points: Vec<Point>,
    parameters: Vec<f64>,
    slopes: Vec<Vector>,
    is_closed: bool,
}

/// A piece of a spline.
#[derive(Clone, Copy)]
pub(crate) struct Arc<'a> {
    run: &'a Run,
    from: f64,
    to: f64,
}

impl Splines {
    pub(crate) fn of(pslg: &Pslg) -> Self {
        let mut found = Self { runs: Vec::new(), places: HashMap::new(), straight: HashSet::new() };
        for chain in pslg.chains() {
            found.add(pslg, &chain);
        }
        found
    }

    /// The piece of a curve that a straight edge between two of its vertices stands for; none where that is straight.
    pub(crate) fn between(&self, ends: [Point; 2]) -> Option<Arc<'_>> {
        let keys = ends.map(key);
        if self.straight.contains(&in_order(keys)) {
            return None;
        }
        let [ones, others] = [self.places.get(&keys[0])?, self.places.get(&keys[1])?];
        let arcs = ones.iter().flat_map(|&[run, i]| {
            let same = others.iter().filter(move |other| other[0] == run);
            same.map(move |&[_, j]| self.runs[run as usize].arc(i as usize, j as usize))
        });
        arcs.min_by(|a, b| a.length().total_cmp(&b.length()))
    }

    /// Cuts a curve at its corners and straight segments. Required ones are straight.
    fn add(&mut self, pslg: &Pslg, chain: &Chain) {
        let curve = Curve::of(pslg, chain);
        let n = curve.sides.len();
        let ends = |i: usize| in_order([i, i + 1].map(|i| key(curve.points[i])));
        self.straight.extend((0..n).filter(|&i| curve.is_straight[i]).map(ends));
        let Some(start) = (0..n).find(|&i| !curve.goes_on(curve.before(i))) else {
            return self.push(Run::closed(curve.points));
        };
        let mut run = vec![curve.points[start]];
        for i in (start..start + n).map(|i| i % n) {
            run.push(curve.points[i + 1]);
            if !curve.goes_on(i) {
                let before = curve.before((i + n + 2 - run.len()) % n);
                let directions = [curve.straight_at(before, before), curve.straight_at(i, curve.after(i))];
                let done = std::mem::replace(&mut run, vec![curve.points[i + 1]]);
                if !curve.is_straight[i] {
                    self.push(Run::open(done, directions));
                }
            }
        }
    }

    fn push(&mut self, run: Run) {
        let number = self.runs.len() as u32;
        let last = run.points.len() - usize::from(run.is_closed);
        for (i, &p) in (0..).zip(&run.points[..last]) {
            self.places.entry(key(p)).or_default().push([number, i]);
        }
        self.runs.push(run);
    }
}

/// A curve of the graph, and where it is smooth.
struct Curve {
    points: Vec<Point>,
    sides: Vec<Vector>,
    is_closed: bool,
    is_straight: Vec<bool>,
}

impl Curve {
    fn of(pslg: &Pslg, Chain { vertices, kind }: &Chain) -> Self {
        let points: Vec<Point> = vertices.iter().map(|&v| pslg.points[v as usize]).collect();
        let sides: Vec<Vector> = points.windows(2).map(|w| w[1] - w[0]).collect();
        let is_closed = vertices[0] == vertices[sides.len()];
        let mut curve = Self { points, sides, is_closed, is_straight: Vec::new() };
        curve.is_straight = (0..curve.sides.len()).map(|i| kind.required || curve.looks_straight(i)).collect();
        curve
    }

    /// The side before one, around a closed curve.
    fn before(&self, i: usize) -> usize {
        (i + self.sides.len() - 1) % self.sides.len()
    }

    fn after(&self, i: usize) -> usize {
        (i + 1) % self.sides.len()
    }

    /// Whether the curve has no corner behind a side.
    fn is_smooth(&self, i: usize) -> bool {
        let is_end = !self.is_closed && i + 1 == self.sides.len();
        !is_end && self.sides[i].turn(self.sides[self.after(i)]).to_degrees() <= CORNER
    }

    fn looks_straight(&self, i: usize) -> bool {
        let before = self.before(i);
        let beside = [self.is_smooth(before).then_some(before), self.is_smooth(i).then_some(self.after(i))];
        beside.into_iter().flatten().all(|other| self.sides[i].norm() > STRAIGHT * self.sides[other].norm())
    }

    /// Whether a spline goes on behind a side.
    fn goes_on(&self, i: usize) -> bool {
        self.is_smooth(i) && !self.is_straight[i] && !self.is_straight[self.after(i)]
    }

    /// The direction of a side that is straight, where the curve is smooth behind another one.
    fn straight_at(&self, behind: usize, side: usize) -> Option<Vector> {
        let is_met = self.is_smooth(behind) && self.is_straight[side];
        is_met.then(|| self.sides[side] * (1.0 / self.sides[side].norm()))
    }
}

impl Run {
    fn closed(points: Vec<Point>) -> Self {
        let mut run = Self::through(points, true);
        let n = run.points.len() - 1;
        for _ in 0..ROUNDS {
            for i in 0..n {
                run.slopes[i] = run.balanced([(i + n - 1) % n, i, i + 1], (i + n - 1) % n);
            }
            run.slopes[n] = run.slopes[0];
        }
        run
    }

    /// One that has these directions at its ends; where none is given that of the parabola through three points, or two and the other direction.
    fn open(points: Vec<Point>, ends: [Option<Vector>; 2]) -> Self {
        let mut run = Self::through(points, false);
        let n = run.points.len() - 1;
        if n == 1 {
            let chord = run.secant(0);
            let [first, last] = ends;
            let mirrored = |other: Option<Vector>| other.map_or(chord, |slope| chord * 2.0 - slope);
            run.slopes = vec![first.unwrap_or_else(|| mirrored(last)), last.unwrap_or_else(|| mirrored(first))];
            return run;
        }
        let parabola = |[near, far]: [usize; 2]| {
            let share = run.width(near) / (run.width(near) + run.width(far));
            run.secant(near) * (1.0 + share) - run.secant(far) * share
        };
        let [first, last] =
            [ends[0].unwrap_or_else(|| parabola([0, 1])), ends[1].unwrap_or_else(|| parabola([n - 1, n - 2]))];
        (run.slopes[0], run.slopes[n]) = (first, last);
        for _ in 0..ROUNDS {
            for i in 1..n {
                run.slopes[i] = run.balanced([i - 1, i, i + 1], i - 1);
            }
        }
        run
    }

    /// With the parameters of points, and no slopes yet.
    fn through(points: Vec<Point>, is_closed: bool) -> Self {
        let mut parameters = vec![0.0];
        for pair in points.windows(2) {
            parameters.push(parameters[parameters.len() - 1] + pair[0].distance(pair[1]));
        }
        let slopes = vec![Vector::default(); points.len()];
        Self { points, parameters, slopes, is_closed }
    }

    /// The length of a chord.
    fn width(&self, i: usize) -> f64 {
        self.parameters[i + 1] - self.parameters[i]
    }

    fn secant(&self, i: usize) -> Vector {
        (self.points[i + 1] - self.points[i]) * (1.0 / self.width(i))
    }

    /// The slope in the middle of three points for which second derivatives are continuous there; the side before the middle one is given.
    fn balanced(&self, [before, middle, after]: [usize; 3], side: usize) -> Vector {
        let [h, k] = [side, middle].map(|i| self.width(i));
        let right = (self.secant(side) * k + self.secant(middle) * h) * 3.0;
        (right - self.slopes[before] * k - self.slopes[after] * h) * (0.5 / (h + k))
    }

    /// From one of its points to another; the shorter way if it is closed.
    fn arc(&self, i: usize, j: usize) -> Arc<'_> {
        let whole = self.parameters[self.parameters.len() - 1];
        let (from, mut to) = (self.parameters[i], self.parameters[j]);
        if self.is_closed && (to - from).abs() > 0.5 * whole {
            to += if to < from { whole } else { -whole };
        }
        Arc { run: self, from, to }
    }

    fn at(&self, parameter: f64) -> Point {
        let n = self.points.len() - 1;
        let whole = self.parameters[n];
        let s = if self.is_closed { parameter.rem_euclid(whole) } else { parameter.clamp(0.0, whole) };
        let i = self.parameters.partition_point(|&p| p <= s).clamp(1, n) - 1;
        let h = self.width(i);
        let t = (s - self.parameters[i]) / h;
        let rest = 1.0 - t;
        // Hermite's form.
        let [a, b] = [self.slopes[i] * h, self.slopes[i + 1] * h];
        let chord = self.points[i + 1] - self.points[i];
        self.points[i] + chord * (t * t * (1.0 + 2.0 * rest)) + a * (t * rest * rest) - b * (t * t * rest)
    }
}

impl Arc<'_> {
    fn length(&self) -> f64 {
        (self.to - self.from).abs()
    }

    /// Its point at a share of the way.
    pub(crate) fn at(&self, share: f64) -> Point {
        self.run.at(self.from + share * (self.to - self.from))
    }
}

/// A position to look up.
fn key(p: Point) -> [u64; 2] {
    // Zero has two signs.
    [p.x, p.y].map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::domain::{Polygon, Polygons, Ring, from_polygons};
    use std::f64::consts::{PI, TAU};

    fn splines(points: Vec<Point>) -> Splines {
        let polygon = Polygon { feature: 1, number: 1, region: 1, rings: vec![Ring { points, label: 1 }] };
        let pslg = from_polygons(&Polygons { polygons: vec![polygon] }).unwrap();
        Splines::of(pslg.validated().unwrap().pslg())
    }

    fn on_circle(angle: f64) -> Point {
        Point::new(angle.cos(), angle.sin())
    }

    fn order(errors: [f64; 2]) -> f64 {
        (errors[0] / errors[1]).log2()
    }

    #[test]
    fn a_circle_is_met_to_order_four() {
        let errors = [32, 64].map(|n| {
            let points: Vec<Point> = (0..n).map(|i| on_circle(TAU * f64::from(i) / f64::from(n))).collect();
            let splines = splines(points.clone());
            let arcs = (0..n as usize).map(|i| splines.between([points[i], points[(i + 1) % n as usize]]).unwrap());
            arcs.map(|arc| (arc.at(0.5) - Point::default()).norm() - 1.0).fold(0.0, |most: f64, e| most.max(e.abs()))
        });
        assert!(order(errors) > 3.9, "{errors:?}");
    }

    #[test]
    fn chords_over_several_segments_go_the_shorter_way() {
        let points: Vec<Point> = (0..64).map(|i| on_circle(TAU * f64::from(i) / 64.0)).collect();
        let splines = splines(points.clone());
        for (i, j) in [(60, 4), (4, 60)] {
            let arc = splines.between([points[i], points[j]]).unwrap();
            assert!(arc.at(0.0).distance(points[i]) + arc.at(1.0).distance(points[j]) < 1e-14);
            assert!(arc.at(0.5).distance(Point::new(1.0, 0.0)) < 1e-14);
        }
    }

    /// Two half circles of radius 1 between straight sides of length 4.
    #[test]
    fn straight_sides_stay_and_are_left_in_their_direction() {
        let errors = [16, 32].map(|n| {
            let half = |x: f64, start: f64| {
                (0..=n).map(move |i| on_circle(start + PI * f64::from(i) / f64::from(n)) + Vector::new(x, 0.0))
            };
            let points: Vec<Point> = half(2.0, -0.5 * PI).chain(half(-2.0, 0.5 * PI)).collect();
            let splines = splines(points.clone());
            let n = n as usize;
            assert!(splines.between([points[n], points[n + 1]]).is_none());
            let arcs = (0..n).map(|i| splines.between([points[i], points[i + 1]]).unwrap());
            arcs.map(|arc| arc.at(0.5).distance(Point::new(2.0, 0.0)) - 1.0).fold(0.0, |most: f64, e| most.max(e.abs()))
        });
        assert!(order(errors) > 3.5, "{errors:?}");
    }

    #[test]
    fn corners_stay_and_their_sides_are_curves_by_themselves() {
        let parabola = (0..=20).map(|i| f64::from(i) / 10.0 - 1.0).map(|x| Point::new(x, 1.0 - x * x));
        let points: Vec<Point> = parabola.collect();
        let splines = splines(points.clone());
        assert!(splines.between([points[20], points[0]]).is_none(), "its chord is straight");
        let arc = splines.between([points[0], points[1]]).unwrap();
        let middle = arc.at(0.5);
        assert!((middle.y - (1.0 - middle.x * middle.x)).abs() < 5e-4, "{middle:?}");
    }
}
