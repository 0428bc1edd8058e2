//! How a distance crosses a triangle that is known by its three lengths.
//!
//! The triangle is laid out flat: the edge that the front has reached from (0, 0) to (l, 0), the apex above it. Distances
//! at the ends of the edge then give one at the apex. A rule answers only where the straight path to the apex crosses
//! the edge; else the ends alone reach it, along the other edges.

use crate::elementary::Elementary;
use crate::geometry::{Tensor, Vector};
use crate::triangulation::{HalfEdge, Triangulation};

/// The shape that a front is taken to have within a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Wave {
    /// A circle around a virtual source, laid out on the other side of the edge (Novotni and Klein 2002): exact on a flat
    /// canvas.
    #[default]
    Circular,
    /// A straight line: the local rule that Bornemann-Rasch, Konukoglu, FIM and Kimmel-Sethian share, with the metric
    /// of the flat layout. First order, and worst near the source.
    Plane,
}

/// A triangle: its base l, its sides from the base's start and end to the apex, and the distances at start and end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub(super) base: f64,
    pub(super) from_start: f64,
    pub(super) from_end: f64,
    pub(super) at_start: f64,
    pub(super) at_end: f64,
}

/// Distances at the ends of an edge that differ from its length by no more than this share may belong to a source on
/// its line.
const ON_LINE: f64 = 1e-9;

impl Crossing {
    /// The face of a half-edge, which is its base.
    pub(super) fn of(canvas: &Triangulation, h: HalfEdge, [at_start, at_end]: [f64; 2]) -> Self {
        let [base, from_start, from_end] = [h, h.prev(), h.next()].map(|e| canvas.length(e));
        Self { base, from_start, from_end, at_start, at_end }
    }

    /// The distance at the apex of a path through the base's interior; `None` if there is none, or if it is not longer
    /// than the distances that it comes from (such a value could not have come before them).
    pub(super) fn distance(&self, wave: Wave) -> Option<f64> {
        let found = match wave {
            Wave::Circular => self.circular(),
            Wave::Plane => self.plane(),
        };
        found.filter(|&distance| distance > self.at_start.max(self.at_end))
    }

    /// The distance at the apex from the source laid out flat; `None` where the path misses the base.
    pub(super) fn circular(&self) -> Option<f64> {
        let (u, depth) = self.source()?;
        let (x, y) = layout(self.base, self.from_start, self.from_end);
        let crossing = u * y + x * depth;
        let reach = depth + y;
        (crossing >= 0.0 && crossing <= self.base * reach).then(|| (x - u).hypotenuse(reach))
    }

    /// The virtual source lies at (u, -depth).
    fn source(&self) -> Option<(f64, f64)> {
        let (l, s, t) = (self.base, self.at_start, self.at_end);
        let u = 0.5 * (l + (s - t) * (s + t) / l);
        let depth2 = (s - u) * (s + u);
        (depth2 >= -ON_LINE * l * l).then(|| (u, depth2.max(0.0).sqrt()))
    }

    fn plane(&self) -> Option<f64> {
        let (slope, g) = self.gradient()?;
        let (x, y) = layout(self.base, self.from_start, self.from_end);
        let foot = x * g - y * slope;
        (foot >= 0.0 && foot <= self.base * g).then_some(self.at_start + slope * x + g * y)
    }

    /// The unit gradient (slope, g) of a plane wave.
    fn gradient(&self) -> Option<(f64, f64)> {
        let slope = (self.at_end - self.at_start) / self.base;
        let g = ((1.0 - slope) * (1.0 + slope)).max(0.0).sqrt();
        (g > 0.0).then_some((slope, g))
    }

    /// Where on the base's line the path to the apex (x, y) crosses it.
    fn foot(&self, wave: Wave, (x, y): (f64, f64)) -> Option<f64> {
        match wave {
            Wave::Circular => self.source().map(|(u, depth)| (u * y + x * depth) / (depth + y)),
            Wave::Plane => self.gradient().map(|(slope, g)| x - y * slope / g),
        }
    }
}

/// A triangle whose front comes from the face beyond its base, where the angle at its apex is too wide for a front to
/// reach both ends of the base before the apex (Kimmel and Sethian 1998): both faces are laid out in one plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unfolding {
    pub(super) base: f64,
    pub(super) from_start: f64,
    pub(super) from_end: f64,
    /// Distances of the far face's apex from the base's start and end.
    pub(super) beyond_start: f64,
    pub(super) beyond_end: f64,
}

impl Unfolding {
    /// The distance at the apex of a path that crosses the edge from the base's start to the far apex, then the base;
    /// `None` if there is none, or if it is not longer than the distances that it comes from.
    pub(super) fn over_start_edge(&self, wave: Wave, at_start: f64, at_far: f64) -> Option<f64> {
        let (l, s, t) = (self.beyond_start, at_start, at_far);
        let apex = layout(self.base, self.from_start, self.from_end);
        let below = layout(self.base, self.beyond_start, self.beyond_end);
        // Coordinates along the far edge, from the base's start, and across it, towards the apex.
        let (cos, sin) = (below.0 / l, -below.1 / l);
        let (along, across) = (apex.0 * cos + apex.1 * sin, apex.1 * cos - apex.0 * sin);
        if across <= 0.0 {
            return None;
        }
        let crossing = Crossing {
            base: l,
            from_start: self.from_start,
            from_end: (along - l).hypotenuse(across),
            at_start: s,
            at_end: t,
        };
        // The path leaves the source for the apex and must pass the base's start on the side of its end.
        let foot = crossing.foot(wave, (along, across))?;
        let direction = ((along - foot) * cos - across * sin, (along - foot) * sin + across * cos);
        let at_base = apex.0 - direction.0 * apex.1 / direction.1;
        let is_through = direction.1 > 0.0 && at_base >= 0.0 && at_base <= self.base;
        if is_through { crossing.distance(wave) } else { None }
    }

    /// The mirror image: start and end exchanged.
    pub(super) fn mirrored(self) -> Self {
        Self {
            from_start: self.from_end,
            from_end: self.from_start,
            beyond_start: self.beyond_end,
            beyond_end: self.beyond_start,
            ..self
        }
    }
}

/// The apex of a triangle over the base from (0, 0) to (l, 0), at the distances a and b from its ends.
pub(crate) fn layout(l: f64, a: f64, b: f64) -> (f64, f64) {
    let x = 0.5 * (l + (a - b) * (a + b) / l);
    (x, ((a - x) * (a + x)).max(0.0).sqrt())
}

/// The local rule of first-order schemes, a plane wave that crosses the far edge of a triangle with a uniform metric: the
/// distance at a vertex, seen from which an edge has its ends at u and w, of the shortest way across that edge, along
/// which the distance varies linearly between the two given (Bornemann and Rasch 2006); `None` if that way leads
/// through an end. It is never less than both distances, and may be less than one.
pub(super) fn plane_crossing(metric: Tensor, [u, w]: [Vector; 2], at: [f64; 2]) -> Option<f64> {
    let e = u - w;
    let area = e.cross(w);
    by_plane(metric.dot(e, e), metric.dot(e, w), metric.determinant() * area * area, at)
}

/// The same in the one metric that gives a triangle its lengths: those of the sides from the vertex to the edge's ends, and of
/// the edge.
pub(super) fn plane_crossing_by_lengths([to_u, to_w]: [f64; 2], edge: f64, at: [f64; 2]) -> Option<f64> {
    let square = edge * edge;
    let along = 0.5 * (to_u * to_u - to_w * to_w - square);
    by_plane(square, along, square * to_w * to_w - along * along, at)
}

/// From the products of e = u - w with itself and with w, and the determinant of the Gram matrix of e and w.
fn by_plane(square: f64, along: f64, gram: f64, [at_u, at_w]: [f64; 2]) -> Option<f64> {
    let difference = at_u - at_w;
    let rest = square - difference * difference;
    if !(rest > 0.0 && gram > 0.0) {
        return None;
    }
    let foot = (-along - difference * (gram / rest).sqrt()) / square;
    let distance = at_w + (-difference * along + (gram * rest).sqrt()) / square;
    (foot > 0.0 && foot < 1.0 && distance.is_finite()).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unfolded_circular_waves_are_exact_in_the_plane() {
        let to = |p: (f64, f64), q: (f64, f64)| (p.0 - q.0).hypot(p.1 - q.1);
        let (start, end, apex, far) = ((0.0, 0.0), (2.0, 0.0), (0.8, 0.3), (1.1, -1.0));
        let unfolding = Unfolding {
            base: 2.0,
            from_start: to(start, apex),
            from_end: to(end, apex),
            beyond_start: to(start, far),
            beyond_end: to(end, far),
        };
        let mut found = 0;
        for i in 0..400 {
            let angle = f64::from(i) * 0.004 * std::f64::consts::PI - std::f64::consts::PI;
            let source = (1.0 + 3.0 * angle.cos(), 3.0 * angle.sin());
            let left = unfolding.over_start_edge(Wave::Circular, to(start, source), to(far, source));
            let right = unfolding.mirrored().over_start_edge(Wave::Circular, to(end, source), to(far, source));
            // Two distances do not tell a source from its mirror image: only sources beyond the edge count.
            let is_beyond =
                |p: (f64, f64), q: (f64, f64)| (q.0 - p.0) * (source.1 - p.1) - (q.1 - p.1) * (source.0 - p.0) < -1e-9;
            for (distance, counts) in [(left, is_beyond(start, far)), (right, is_beyond(far, end))] {
                let Some(distance) = distance.filter(|_| counts) else { continue };
                found += 1;
                let exact = to(source, apex);
                assert!((distance - exact).abs() < 1e-13, "{source:?} {distance} {exact}");
            }
        }
        assert!(found > 150, "{found}");
    }

    fn crossing(source: (f64, f64), apex: (f64, f64), l: f64) -> (Crossing, f64) {
        let to = |p: (f64, f64), q: (f64, f64)| (p.0 - q.0).hypot(p.1 - q.1);
        let (start, end) = ((0.0, 0.0), (l, 0.0));
        let c = Crossing {
            base: l,
            from_start: to(start, apex),
            from_end: to(end, apex),
            at_start: to(start, source),
            at_end: to(end, source),
        };
        (c, to(source, apex))
    }

    #[test]
    fn circular_waves_are_exact_in_the_plane() {
        for i in 0..200 {
            let f = f64::from(i);
            let (c, exact) =
                crossing((1.0 + (1.3 * f).sin(), -1.0 - f / 50.0), (0.9 + 0.5 * (2.1 * f).cos(), 1.0), 2.0);
            if let Some(distance) = c.distance(Wave::Circular) {
                assert!((distance - exact).abs() < 1e-13, "{c:?}");
            }
        }
        let (c, exact) = crossing((0.7, 0.0), (0.9, 1.0), 2.0);
        assert!((c.circular().unwrap() - exact).abs() < 1e-13, "a source on the edge");
        assert_eq!(c.distance(Wave::Circular), None, "the apex is nearer than an end");
    }

    #[test]
    fn plane_waves_are_the_limit_of_far_sources() {
        let (c, exact) = crossing((3000.0, -10_000.0), (0.9, 1.0), 2.0);
        let plane = c.distance(Wave::Plane).unwrap();
        assert!((plane - exact).abs() < 1e-3, "{plane} {exact}");
    }

    #[test]
    fn plane_waves_obey_the_shared_closed_form() {
        // literature.md, section 2, with M = I, x the apex, y_i the start, y_j the end of the base.
        let (c, _) = crossing((0.4, -3.0), (0.9, 1.0), 2.0);
        let (u, w) = ((-0.9, -1.0), (1.1, -1.0));
        let e = (u.0 - w.0, u.1 - w.1);
        let dot = |p: (f64, f64), q: (f64, f64)| p.0 * q.0 + p.1 * q.1;
        let (a, b, cc, d) = (dot(e, e), dot(e, w), dot(w, w), c.at_start - c.at_end);
        let big = a * cc - b * b;
        let p = (-b - d * (big / (a - d * d)).sqrt()) / a;
        assert!((0.0..=1.0).contains(&p));
        let t = c.at_end + (-d * b + (big * (a - d * d)).sqrt()) / a;
        assert!((t - c.distance(Wave::Plane).unwrap()).abs() < 1e-13);
    }

    #[test]
    fn paths_beside_the_edge_are_refused() {
        let (c, _) = crossing((-5.0, -1.0), (0.9, 1.0), 2.0);
        assert_eq!((c.distance(Wave::Circular), c.distance(Wave::Plane)), (None, None));
    }

    #[test]
    fn it_is_the_least_over_the_edge() {
        let mut found = 0;
        for i in 0..200 {
            let f = f64::from(i);
            let (angle, ratio) = (0.7 * f, 1.0 + (3.0 * f).sin().abs() * 30.0);
            let metric = Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), ratio, 1.0);
            let (u, w) = (Vector::new(1.0 + (1.1 * f).sin(), 0.5), Vector::new(-0.4, 1.0 + 0.5 * (2.3 * f).cos()));
            let at = [2.0 + 0.8 * (1.7 * f).sin(), 2.0];
            let through = |p: f64| p * at[0] + (1.0 - p) * at[1] + metric.length(u * p + w * (1.0 - p));
            let least = (0..=20_000).map(|k| through(f64::from(k) / 20_000.0)).fold(f64::INFINITY, f64::min);
            let sides = [metric.length(u), metric.length(w)];
            let by_lengths = plane_crossing_by_lengths(sides, metric.length(u - w), at);
            match plane_crossing(metric, [u, w], at) {
                Some(distance) => {
                    found += 1;
                    assert!((distance - least).abs() < 1e-6, "{distance} {least}");
                    assert!(distance >= at[0].min(at[1]));
                    assert!((by_lengths.unwrap() - distance).abs() < 1e-6, "{by_lengths:?} {distance}");
                }
                None => assert!(least >= through(0.0).min(through(1.0)) - 1e-12),
            }
        }
        assert!(found > 40, "{found}");
    }
}
