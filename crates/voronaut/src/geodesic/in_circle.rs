//! In-circle tests from metric lengths.
//!
//! Of the two diagonals of a quadrilateral a d b c the Delaunay one, a-b, has opposite angles at c and d that sum to
//! at most pi (in the flat model space; DESIGN.md, "In-circle tests"). The *margin* is the sine of that sum: positive
//! where the edge is Delaunay, zero for four points on a circle, negative where it must flip.

use super::curve::PathLength;
use super::length::Length;
use crate::elementary::Elementary;
use crate::geometry::{Tensor, Vector};

/// Curvature's share in the margin's error, per area: of how much it varies, of the margin itself, of its square.
const VARYING: f64 = 1.0;
const OFF_CIRCLE: f64 = 0.5;
const SECOND_ORDER: f64 = 0.5;
/// And more of all that, per curvature times area.
const BENT: f64 = 4.0;
/// Rounding of positions and tensors, in the margin.
const ROUNDING: f64 = 1e-12;

/// The outcome of an in-circle test: the sine of the sum of the two angles that face an edge, were the surface flat;
/// positive where the edge is Delaunay.
///
/// That is the power of the fourth seed with respect to the circle through the other three, times twice the area of
/// their triangle, over the product of the four outer edges; so understood it has a meaning on any surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// The sine.
    pub value: f64,
    /// Estimated error of `value` (not a bound); infinite where the test could not tell.
    pub error: f64,
}

impl Margin {
    /// What a test says that could not tell.
    pub(crate) const UNKNOWN: Self = Self { value: 0.0, error: f64::INFINITY };

    /// Whether the sign is settled.
    pub(crate) fn is_certain(&self) -> bool {
        self.value.abs() > self.error
    }
}

/// The margin of the edge a-b with one tensor for the whole quadrilateral. Vectors run from c to a, c to b, d to b
/// and d to a; the triangles a b c and b a d are counter-clockwise.
pub(crate) fn frozen_margin(tensor: Tensor, [ca, cb]: [Vector; 2], [db, da]: [Vector; 2]) -> f64 {
    let root = tensor.determinant().max(0.0).sqrt();
    let at_c = Angles::normalised(tensor.dot(ca, cb), root * ca.cross(cb));
    let at_d = Angles::normalised(tensor.dot(db, da), root * db.cross(da));
    at_c.0 * at_d.1 + at_c.1 * at_d.0
}

/// The margin of the edge a-b from estimates of the lengths of a-b, a-c, b-c, a-d and b-d, with the error that theirs make to
/// first order; [`Margin::UNKNOWN`] where they make no triangles.
pub(crate) fn margin_of_estimates(lengths: [Length; 5]) -> Margin {
    let [ab, ac, bc, ad, bd] = lengths.map(|length| length.value);
    let relative = lengths.iter().map(|length| length.error).fold(0.0, f64::max);
    let angles = Angles::from_lengths(ab, [ac, bc], [ad, bd]);
    if angles.is_flat() { Margin::UNKNOWN } else { Margin { value: angles.margin(), error: angles.error(relative) } }
}

/// The margin of the edge a-b between the triangles a b c and b a d from the lengths of a-b, a-c, b-c, a-d and b-d.
///
/// Curvature K is accounted for to first order: on a surface of constant K the angles of a triangle exceed those of the flat
/// triangle with its sides by K area / 3 each (Legendre's theorem), so that the four points are on a circle when the
/// two flat angles sum to pi + K area / 6, the area that of both triangles. The error has a share for what K varies.
/// [`Margin::UNKNOWN`] where lengths make no triangle.
pub(crate) fn margin_from_lengths(lengths: &[PathLength; 5]) -> Margin {
    let [ab, ac, bc, ad, bd] = lengths.map(|l| l.value);
    let (at_c, area_c) = opposite(ab, ac, bc);
    let (at_d, area_d) = opposite(ab, ad, bd);
    let area = area_c + area_d;
    let least = lengths.iter().map(|l| l.curvature[0]).fold(f64::INFINITY, f64::min);
    let most = lengths.iter().map(|l| l.curvature[1]).fold(f64::NEG_INFINITY, f64::max);
    let (curvature, spread) = (0.5 * (least + most), 0.5 * (most - least));
    let (sine, cosine) = (at_c.0 * at_d.1 + at_c.1 * at_d.0, at_c.0 * at_d.0 - at_c.1 * at_d.1);
    let (shift_sine, shift_cosine) = (curvature * area / 6.0).sine_and_cosine();
    let value = sine * shift_cosine - cosine * shift_sine;
    let [e, f, g, h, i] = lengths.map(|l| l.error * l.value);
    let of_lengths = 0.5 * ab * ((e + f + g) / area_c + (e + h + i) / area_d);
    let bend = (curvature.abs() + spread) * area;
    let first_order = VARYING * spread * area + OFF_CIRCLE * bend * value.abs() + SECOND_ORDER * bend * bend;
    // Where a quadrilateral bends by radians, samples along its edges do not tell what it does inside.
    let of_curvature = first_order * (1.0 + BENT * bend);
    let error = of_lengths + of_curvature + ROUNDING;
    if value.is_finite() && error.is_finite() { Margin { value, error } } else { Margin::UNKNOWN }
}

/// The angles at the two ends of a diagonal, from five metric lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angles {
    margin: f64,
    sensitivity: f64,
    flatness: f64,
}

impl Angles {
    /// From the lengths of the edge and of the other two edges of each of its triangles.
    pub(crate) fn from_lengths(edge: f64, [ac, bc]: [f64; 2], [ad, bd]: [f64; 2]) -> Self {
        let (c, area_c) = opposite(edge, ac, bc);
        let (d, area_d) = opposite(edge, ad, bd);
        let sensitivity = |a: f64, b: f64, area: f64| edge * (edge + a + b) / (2.0 * area.max(f64::MIN_POSITIVE));
        Self {
            margin: c.0 * d.1 + c.1 * d.0,
            sensitivity: sensitivity(ac, bc, area_c) + sensitivity(ad, bd, area_d),
            flatness: (area_c / (ac * bc).max(edge * edge)).min(area_d / (ad * bd).max(edge * edge)),
        }
    }

    /// The margin: the sine of the sum of the two angles.
    pub(crate) fn margin(&self) -> f64 {
        self.margin
    }

    /// Whether one of the triangles is nearly flat (height below a twentieth of the base), or its lengths break the
    /// triangle inequality, as those of chords may: its angles then say nothing.
    pub(crate) fn is_flat(&self) -> bool {
        self.flatness < 0.025
    }

    /// A first-order bound on the margin's error, of lengths with this relative error.
    pub(crate) fn error(&self, relative: f64) -> f64 {
        self.sensitivity * relative
    }

    /// (cosine, sine) of the angle with this dot and cross product.
    fn normalised(dot: f64, cross: f64) -> (f64, f64) {
        let size = (dot * dot + cross * cross).sqrt().max(f64::MIN_POSITIVE);
        (dot / size, cross / size)
    }
}

/// (cosine, sine) of the angle opposite to `edge` in a triangle with the other sides a and b, and the triangle's
/// area. Where the lengths break the triangle inequality the triangle is flat.
pub(super) fn opposite(edge: f64, a: f64, b: f64) -> ((f64, f64), f64) {
    let squared = (a + b + edge) * (a + b - edge).max(0.0) * (edge + a - b).max(0.0) * (edge - a + b).max(0.0);
    let area = 0.25 * squared.sqrt();
    (Angles::normalised(0.5 * (a * a + b * b - edge * edge), 2.0 * area), area)
}

/// The circumradius of a flat triangle with these sides; infinite where they make none.
pub(crate) fn circumradius(a: f64, b: f64, c: f64) -> f64 {
    a * b * c / (4.0 * opposite(a, b, c).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_has_margin_zero_and_lozenges_have_signs() {
        let diagonal = 2.0_f64.sqrt();
        assert!(Angles::from_lengths(diagonal, [1.0, 1.0], [1.0, 1.0]).margin().abs() < 1e-15);
        assert!(Angles::from_lengths(1.0, [1.0, 1.0], [1.0, 1.0]).margin() > 0.86);
        assert!(Angles::from_lengths(3.0_f64.sqrt(), [1.0, 1.0], [1.0, 1.0]).margin() < -0.86);
    }

    #[test]
    fn frozen_margin_agrees_with_lengths() {
        let m = Tensor::new(4.0, 1.0, 2.0);
        let [a, b, c, d] = [(0.0, 0.0), (1.0, 0.1), (0.4, 0.9), (0.6, -0.7)].map(|(x, y)| Vector::new(x, y));
        let length = |u: Vector, v: Vector| m.length(u - v);
        let by_lengths = Angles::from_lengths(length(a, b), [length(a, c), length(b, c)], [length(a, d), length(b, d)]);
        let frozen = frozen_margin(m, [a - c, b - c], [b - d, a - d]);
        assert!((by_lengths.margin() - frozen).abs() < 1e-14);
    }

    fn plain(value: f64, curvature: f64) -> PathLength {
        PathLength { value, error: 1e-12, curvature: [curvature; 2] }
    }

    #[test]
    fn flat_squares_and_lozenges() {
        let of = |edge: f64, side: f64| margin_from_lengths(&[edge, side, side, side, side].map(|l| plain(l, 0.0)));
        assert!(of(2.0_f64.sqrt(), 1.0).value.abs() < 1e-15);
        assert!(of(1.0, 1.0).value > 0.86 && of(1.0, 1.0).is_certain());
        assert!(of(1.7, 1.0).value < -0.79);
        assert_eq!(of(2.5, 1.0), Margin::UNKNOWN);
    }

    #[test]
    fn squares_on_spheres_have_margin_zero_to_second_order() {
        // Vertices at the distance r from a pole: sides and diagonal by spherical trigonometry.
        let margin = |r: f64| {
            let side = (r.cos() * r.cos()).acos();
            margin_from_lengths(&[2.0 * r, side, side, side, side].map(|l| plain(l, 1.0)))
        };
        for r in [0.4, 0.2, 0.1] {
            let found = margin(r);
            assert!(found.value.abs() < found.error, "{r} {found:?}");
            assert!(found.value.abs() < r.powi(4), "{r} {found:?}");
        }
    }
}
