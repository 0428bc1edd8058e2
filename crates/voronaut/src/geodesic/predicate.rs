//! In-circle tests that know how far they can be trusted.

use super::curve::PathLength;
use super::in_circle::{Margin, opposite};

/// Curvature's share in the margin's error, per area: of how much it varies, of the margin itself, of its square.
const VARYING: f64 = 1.0;
const OFF_CIRCLE: f64 = 0.5;
const SECOND_ORDER: f64 = 0.5;
/// And more of all that, per curvature times area.
const BENT: f64 = 4.0;
/// Rounding of positions and tensors, in the margin.
const ROUNDING: f64 = 1e-12;

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
    let (shift_sine, shift_cosine) = (curvature * area / 6.0).sin_cos();
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

#[cfg(test)]
mod tests {
    use super::*;

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
