//! The error of linear interpolation on a triangle, and the moves and flips that lower it. Vertices move in groups without edges between
//! them: those of a group can move at once.

use super::{Sheet, Work, is_allowed};
use crate::dual::Kind;
use crate::elementary::Elementary;
use crate::geometry::{Node, Point, Vector, radon};
use crate::metric::Norm;
use crate::parallel::prelude::*;
use crate::triangulation::{HalfEdge, Rounds, Triangulation, VertexId, flip_in_rounds};

/// Step of the differences that derivatives are taken by, as a share of the neighbours' mean distance.
const STEP: f64 = 0.03;
/// Longest move, in the same unit.
const LONGEST: f64 = 0.5;
/// Moves shorter than this change too little for neighbours to be tried again.
const SMALL: f64 = 0.02;
/// Shorter moves that are tried when a move does not lower the error, and by how much they are shorter.
const TRIALS: usize = 5;
const SHORTER: f64 = 0.4;
/// A second derivative is at least this share of the greatest.
const LEAST_CURVATURE: f64 = 1e-3;

impl<S: Sheet> Work<S> {
    /// Moves every vertex that is awake once, those of one colour at a time. Returns how many moved. Awake are then those around moves
    /// that were not [`SMALL`].
    pub(super) fn move_all(&mut self) -> u64 {
        let mut moved = 0;
        let awake = std::mem::replace(&mut self.awake, vec![false; self.places.len()]);
        let is_tried = |v: VertexId| awake[v.index()] && !matches!(self.sheet.kind(v), Kind::Corner(_) | Kind::Held);
        for group in colours(self.sheet.topology(), is_tried) {
            let better: Vec<Option<(Place<S::At>, f64)>> =
                group.par_iter().with_min_len(16).map(|&v| self.better(v)).collect();
            for (v, better) in group.into_iter().zip(better) {
                let Some((place, step)) = better else { continue };
                if self.sheet.move_vertex(v, place.at) {
                    self.places[v.index()] = place;
                    moved += 1;
                    if step > SMALL {
                        self.wake(v);
                    }
                }
            }
        }
        moved
    }

    /// A vertex and its neighbours are to be tried again.
    fn wake(&mut self, v: VertexId) {
        self.awake[v.index()] = true;
        for u in self.sheet.topology().around(v) {
            self.awake[u.index()] = true;
        }
    }

    /// Where a vertex would better be, and how far that is in the unit of [`STEP`]: a step of Newton's method on the error around it.
    fn better(&self, v: VertexId) -> Option<(Place<S::At>, f64)> {
        let topology = self.sheet.topology();
        let ring: Vec<[VertexId; 2]> = topology.star(v).map(|h| [topology.target(h), topology.apex(h)]).collect();
        let corners = |place: Place<S::At>, [a, b]: [VertexId; 2]| [place, self.place(a), self.place(b)];
        let error_at = |place: Place<S::At>| -> f64 {
            ring.iter().map(|&side| self.objective.of(&self.sheet, corners(place, side))).sum()
        };
        let shape_at = |place: Place<S::At>| {
            ring.iter().map(|&[a, b]| self.shape([v, a, b], corners(place, [a, b]))).fold(f64::INFINITY, f64::min)
        };
        let frame = self.frame(v, &ring)?;
        let here = self.place(v);
        let place = |step: [f64; 2]| {
            let at = self.sheet.stepped(v, &frame, step)?;
            Some(Place { at, value: self.sheet.value(at) })
        };
        let now = error_at(here);
        let [mut x, mut y] = frame.newton(now, |step| place(step).map_or(f64::INFINITY, error_at))?;
        for _ in 0..TRIALS {
            let there = place([x, y])?;
            if error_at(there) < now && is_allowed(shape_at(here), shape_at(there)) {
                return Some((there, x.hypotenuse(y)));
            }
            (x, y) = (x * SHORTER, y * SHORTER);
        }
        None
    }

    /// The directions and lengths in which a vertex can move: those of the ellipse of inertia of its neighbours.
    fn frame(&self, v: VertexId, ring: &[[VertexId; 2]]) -> Option<Frame> {
        if self.sheet.kind(v) == Kind::Curve {
            return self.sheet.on_segment(v);
        }
        let around: Vec<Vector> = ring.iter().flatten().map(|&u| self.sheet.offset(v, u)).collect();
        let mean = |of: fn(&Vector) -> f64| around.iter().map(of).sum::<f64>() / around.len() as f64;
        let (xx, xy, yy) = (mean(|d| d.x * d.x), mean(|d| d.x * d.y), mean(|d| d.y * d.y));
        let first = Vector::new(xx.sqrt(), xy / xx.sqrt());
        let rest = (yy - first.y * first.y).max(0.0).sqrt();
        (first.x > 0.0 && rest > 0.0).then_some(Frame { segment: None, first, second: Some(Vector::new(0.0, rest)) })
    }
}

/// One or two directions, of the length of a typical edge that way.
pub(super) struct Frame {
    /// The ends of the segment that a vertex slides along, and where between them it is: steps do not add up their rounding.
    pub(super) segment: Option<([Point; 2], f64)>,
    pub(super) first: Vector,
    pub(super) second: Option<Vector>,
}

impl Frame {
    /// The step to the minimum of a quadratic through values around, made convex where it is not.
    fn newton(&self, now: f64, error: impl Fn([f64; 2]) -> f64) -> Option<[f64; 2]> {
        let h = STEP;
        let (right, left) = (error([h, 0.0]), error([-h, 0.0]));
        let (gx, xx) = ((right - left) / (2.0 * h), (right - 2.0 * now + left) / (h * h));
        let step = if self.second.is_some() {
            let (up, down) = (error([0.0, h]), error([0.0, -h]));
            let (gy, yy) = ((up - down) / (2.0 * h), (up - 2.0 * now + down) / (h * h));
            let corners = error([h, h]) + error([-h, -h]);
            let xy = (corners - right - left - up - down + 2.0 * now) / (2.0 * h * h);
            descent([gx, gy], [xx, xy, yy])?
        } else {
            [-gx / xx.abs(), 0.0]
        };
        let length = step[0].hypotenuse(step[1]);
        let share = (LONGEST / length).min(1.0);
        length.is_finite().then(|| step.map(|s| s * share))
    }
}

/// Minus the inverse of a symmetric matrix, of which eigenvalues count by their size, times a gradient. `None` where that is
/// not finite.
fn descent([gx, gy]: [f64; 2], [xx, xy, yy]: [f64; 3]) -> Option<[f64; 2]> {
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let radius = half.hypotenuse(xy);
    let (sine, cosine) = (0.5 * xy.arctangent_over(half)).sine_and_cosine();
    let [large, small] = [mean + radius, mean - radius].map(f64::abs);
    let least = LEAST_CURVATURE * large.max(small);
    let along = -(gx * cosine + gy * sine) / large.max(least);
    let across = -(gy * cosine - gx * sine) / small.max(least);
    let step = [along * cosine - across * sine, along * sine + across * cosine];
    step.iter().all(|s| s.is_finite()).then_some(step)
}

/// The vertices that can move, by colour: greedily, in the order of their ids.
pub(super) fn colours(topology: &Triangulation, can_move: impl Fn(VertexId) -> bool) -> Vec<Vec<VertexId>> {
    const NONE: u16 = u16::MAX;
    let mut colour = vec![NONE; topology.vertex_slots()];
    let mut groups: Vec<Vec<VertexId>> = Vec::new();
    let mut is_taken: Vec<bool> = Vec::new();
    for v in topology.vertices().filter(|&v| can_move(v)) {
        is_taken.clear();
        is_taken.resize(groups.len() + 1, false);
        for u in topology.around(v) {
            if let Some(taken) = is_taken.get_mut(usize::from(colour[u.index()])) {
                *taken = true;
            }
        }
        let free = is_taken.iter().position(|taken| !taken).unwrap_or(groups.len());
        if free == groups.len() {
            groups.push(Vec::new());
        }
        colour[v.index()] = free as u16;
        groups[free].push(v);
    }
    groups
}

/// A greater exponent counts as this one: powers of errors would differ by too much to be added.
const LARGEST_EXPONENT: f64 = 8.0;

/// The norm that polishing goes by where this one is asked for: L^8 for all above.
pub(crate) fn polishing_norm(norm: Norm) -> Norm {
    Norm::new(norm.exponent().min(LARGEST_EXPONENT)).unwrap_or(norm)
}

/// What is to be made small: the integral of |f - its linear interpolation|^p, in a unit of its own for f.
#[derive(Clone, Copy)]
pub(super) struct Objective {
    exponent: f64,
    unit: f64,
    nodes: [Node; 7],
}

/// A vertex, as errors see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<At> {
    pub(super) at: At,
    pub(super) value: f64,
}

impl Objective {
    /// Errors are measured in shares of `unit`, which is positive.
    pub(super) fn new(norm: Norm, unit: f64) -> Self {
        Self { exponent: polishing_norm(norm).exponent(), unit, nodes: radon() }
    }

    /// The triangle's share, by seven values of the function; infinite of a triangle that is turned over.
    ///
    /// Three values in the middles of the edges would not do: minimised, they find places where the function meets its
    /// interpolation there and nowhere else.
    pub(super) fn of<S: Sheet>(&self, sheet: &S, corners: [Place<S::At>; 3]) -> f64 {
        let [a, b, c] = corners;
        let places = corners.map(|corner| corner.at);
        let area = sheet.area(places);
        if area <= 0.0 {
            return f64::INFINITY;
        }
        let share = |&([u, v, w], weight): &Node| {
            let error = (sheet.value_within(places, [u, v, w]) - (u * a.value + v * b.value + w * c.value)) / self.unit;
            weight * self.power(error)
        };
        area * self.nodes.iter().map(share).sum::<f64>()
    }

    fn power(&self, error: f64) -> f64 {
        // Exact on purpose: the default, and the fast one.
        #[expect(clippy::float_cmp)]
        let is_square = self.exponent == 2.0;
        if is_square { error * error } else { error.abs().raised_to(self.exponent) }
    }

    /// The norm of the error from the sum of all shares.
    pub(super) fn norm(&self, sum: f64) -> f64 {
        self.unit * sum.raised_to(1.0 / self.exponent)
    }
}

/// Rounds of flips in a sweep, at most: the next sweep has more.
const ROUNDS: usize = 8;
/// A flip gains this share of the two triangles' error at least.
const GAIN: f64 = 1e-9;

impl<S: Sheet> Work<S> {
    /// Flips until no edge gains by it; the greatest gains first. Returns how many flips.
    pub(super) fn flip_all(&mut self) -> u64 {
        flip_in_rounds(self, ROUNDS)
    }

    /// By how much a flip would lower the error; `None` where it would not, or may not be.
    fn gain(&self, h: HalfEdge) -> Option<f64> {
        let [a, b, c, d] = self.sheet.topology().quad(h).filter(|_| self.sheet.may_flip(h))?;
        let of = |vertices: [VertexId; 3]| self.objective.of(&self.sheet, self.places_of(vertices));
        let (old, new) = ([[a, b, c], [b, a, d]], [[d, b, c], [c, a, d]]);
        let before: f64 = old.into_iter().map(of).sum();
        let gain = before - new.into_iter().map(of).sum::<f64>();
        if gain.is_nan() || gain <= GAIN * before {
            return None;
        }
        let least = |faces: [[VertexId; 3]; 2]| {
            faces.into_iter().map(|f| self.shape(f, self.places_of(f))).fold(f64::INFINITY, f64::min)
        };
        is_allowed(least(old), least(new)).then_some(gain)
    }

    fn places_of(&self, vertices: [VertexId; 3]) -> [Place<S::At>; 3] {
        vertices.map(|v| self.place(v))
    }
}

impl<S: Sheet> Rounds for Work<S> {
    fn topology(&self) -> &Triangulation {
        self.sheet.topology()
    }

    fn wanted(&mut self, edges: &[HalfEdge]) -> Vec<(f64, HalfEdge)> {
        let is_awake = |&&h: &&HalfEdge| self.sheet.topology().ends(h).iter().any(|v| self.awake[v.index()]);
        let awake = edges.par_iter().with_min_len(64).filter(is_awake);
        awake.filter_map(|&h| Some((-self.gain(h)?, h))).collect()
    }

    fn flip(&mut self, h: HalfEdge) -> bool {
        let is_flipped = self.sheet.flip(h);
        if is_flipped {
            for v in self.sheet.topology().ends(h) {
                self.wake(v);
            }
        }
        is_flipped
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::planar::delaunay;

    #[test]
    fn the_minimum_of_a_quadratic_is_found_at_once() {
        let (first, second) = (Vector::new(1.0, 0.0), Some(Vector::new(0.0, 1.0)));
        let frame = Frame { segment: None, first, second };
        let error = |[x, y]: [f64; 2]| 3.0 * (x - 0.1).powi(2) + 2.0 * (x - 0.1) * (y + 0.2) + (y + 0.2).powi(2);
        let [x, y] = frame.newton(error([0.0, 0.0]), error).unwrap();
        assert!((x - 0.1).abs() < 1e-9 && (y + 0.2).abs() < 1e-9, "{x} {y}");
    }

    #[test]
    fn where_it_is_not_convex_the_step_goes_downhill() {
        let [x, y] = descent([1.0, -2.0], [-3.0, 0.5, -1.0]).unwrap();
        assert!(x - 2.0 * y < 0.0, "{x} {y}");
        assert_eq!(descent([1.0, f64::NAN], [1.0, 0.0, 1.0]), None);
        assert_eq!(descent([0.0, 0.0], [0.0, 0.0, 0.0]), None);
    }

    #[test]
    fn no_edge_is_inside_a_group_and_no_vertex_is_forgotten() {
        let at = |i: u32| Point::new((f64::from(i) * 0.618).fract(), (f64::from(i) * 0.414).fract());
        let points: Vec<Point> = (0..500).map(at).collect();
        let planar = delaunay(&points).unwrap();
        let groups = colours(&planar.topology, |v| v != VertexId(7));
        let mut group = vec![usize::MAX; planar.topology.vertex_slots()];
        for (i, all) in groups.iter().enumerate() {
            for v in all {
                group[v.index()] = i;
            }
        }
        let ends = |h| planar.topology.ends(h).map(|v| group[v.index()]);
        assert!(planar.topology.edges().map(ends).all(|[a, b]| a != b));
        let has_none = |v: &VertexId| group[v.index()] == usize::MAX;
        assert_eq!(planar.topology.vertices().filter(has_none).collect::<Vec<_>>(), [VertexId(7)]);
        assert!(groups.len() <= 12, "{}", groups.len());
    }
}
