//! Chords of a surface, and how long what lies over them is.

use super::{Input, Place};
use crate::geometry::{Tensor3, Vector3};

/// A chord of the surface, and what lies over it.
pub(crate) struct Chord {
    /// The direction of the surface over the middle.
    pub along: Vector3,
    /// The direction across the chord that the surface bulges in, as long as the chord.
    pub up: Vector3,
    /// The length by the metric and the direction at each end.
    pub at: [f64; 2],
    /// How much the ends differ in what they say of the directions along and aside.
    pub spread: f64,
}

impl Chord {
    /// The metric length of the way over the chord by Simpson's rule, with the mean of two tensors in the middle: on an
    /// equation's surface along the cubic that the tangent planes at both ends make, of fourth order in the chord's length.
    pub(crate) fn simpson(&self, middle: [Tensor3; 2]) -> f64 {
        let [m, n] = middle.map(|tensor| tensor.length(self.along));
        (self.at[0] + 2.0 * (m + n) + self.at[1]) / 6.0
    }
}

impl Input {
    /// The chord between two different places, with the metric there; on a surface of triangles it is the way itself.
    pub(crate) fn chord(&self, [p, q]: [&Place; 2], [m, n]: [Tensor3; 2]) -> Chord {
        let e = q.position - p.position;
        let (up, [slope_p, slope_q]) = self.slopes(p, q, e);
        let at = [m.length(e + up * slope_p), n.length(e + up * slope_q)];
        let aside = e.cross(up);
        let spread = relative(at[0], at[1]).max(relative(m.length(aside), n.length(aside)));
        Chord { along: e + up * (-0.25 * (slope_p + slope_q)), up, at, spread }
    }

    /// The direction across a chord that the surface bulges in, as long as the chord, and the slopes of the surface over it at
    /// both ends; none in the plane of a triangle.
    fn slopes(&self, p: &Place, q: &Place, e: Vector3) -> (Vector3, [f64; 2]) {
        let mean = p.normal + q.normal;
        let square = e.dot(e);
        let across = mean - e * (mean.dot(e) / square);
        let Some(unit) = across.unit() else { return (Vector3::default(), [0.0; 2]) };
        if self.implicit.is_none() {
            return (unit * square.sqrt(), [0.0; 2]);
        }
        let up = unit * square.sqrt();
        (up, [p, q].map(|place| -place.normal.dot(e) / place.normal.dot(up)))
    }
}

fn relative(a: f64, b: f64) -> f64 {
    (a - b).abs() / a.min(b)
}
