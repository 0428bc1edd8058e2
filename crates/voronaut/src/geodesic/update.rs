//! How a distance crosses a triangle that is known by its three lengths.
//!
//! The triangle is laid out flat: the edge that the front has reached from (0, 0) to (l, 0), the apex above it. Distances
//! at the ends of the edge then give one at the apex. A rule answers only where the straight path to the apex crosses
//! the edge; else the ends alone reach it, along the other edges.

/// The shape that a front is taken to have within a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wave {
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
    /// The distance at the apex of a path through the base's interior; `None` if there is none, or if it is not longer
    /// than the distances that it comes from (such a value could not have come before them).
    pub(super) fn distance(&self, wave: Wave) -> Option<f64> {
        let found = match wave {
            Wave::Circular => self.circular(),
            Wave::Plane => self.plane(),
        };
        found.filter(|&distance| distance > self.at_start.max(self.at_end))
    }

    fn apex(&self) -> (f64, f64) {
        let (l, a, b) = (self.base, self.from_start, self.from_end);
        let x = 0.5 * (l + (a - b) * (a + b) / l);
        (x, ((a - x) * (a + x)).max(0.0).sqrt())
    }

    /// The distance at the apex from the source laid out flat; `None` where the path misses the base.
    pub(super) fn circular(&self) -> Option<f64> {
        let (l, s, t) = (self.base, self.at_start, self.at_end);
        // The source lies at (u, -depth).
        let u = 0.5 * (l + (s - t) * (s + t) / l);
        let depth2 = (s - u) * (s + u);
        if depth2 < -ON_LINE * l * l {
            return None;
        }
        let depth = depth2.max(0.0).sqrt();
        let (x, y) = self.apex();
        let crossing = u * y + x * depth;
        let reach = depth + y;
        (crossing >= 0.0 && crossing <= l * reach).then(|| (x - u).hypot(reach))
    }

    fn plane(&self) -> Option<f64> {
        let (l, d) = (self.base, self.at_end - self.at_start);
        let (x, y) = self.apex();
        // The gradient is (d / l, g), |gradient| = 1; the characteristic through the apex meets the base at x - y d / (l g).
        let slope = d / l;
        let g = ((1.0 - slope) * (1.0 + slope)).max(0.0).sqrt();
        let foot = x * g - y * slope;
        (g > 0.0 && foot >= 0.0 && foot <= l * g).then(|| self.at_start + slope * x + g * y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let (c, exact) = crossing((1.0 + (1.3 * f).sin(), -1.0 - f / 50.0), (0.9 + 0.5 * (2.1 * f).cos(), 1.0), 2.0);
            if let Some(distance) = c.distance(Wave::Circular) {
                assert!((distance - exact).abs() < 1e-13, "{c:?}");
            }
        }
        let (c, exact) = crossing((0.7, 0.0), (0.9, 1.0), 2.0);
        assert!((c.distance(Wave::Circular).unwrap() - exact).abs() < 1e-13, "a source on the edge");
    }

    #[test]
    fn plane_waves_are_the_limit_of_far_sources() {
        let (c, exact) = crossing((300.0, -1000.0), (0.9, 1.0), 2.0);
        let plane = c.distance(Wave::Plane).unwrap();
        assert!((plane - exact).abs() < 1e-3 && plane < exact);
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
}
