//! Rigid motions of the plane.

use super::{Point, Vector};
use crate::elementary::Elementary;

/// A rotation by an angle with this cosine and sine, then a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motion {
    pub(crate) rotation: [f64; 2],
    pub(crate) translation: [f64; 2],
}

/// Turns by none, one, two and three right angles, whose cosines and sines are exact.
const EXACT: [[f64; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
/// Rounding of coordinates, as a multiple of the largest: what is no larger is none.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// An exact turn is preferred that misses the points by no more than so many times what the best turn does.
const SIMPLER: f64 = 3.0;

impl Motion {
    /// Where a point goes: (c x - s y + u, s x + c y + v), rounded after each operation, from the left to the right. A coordinate that a
    /// translation leaves alone stays the same to the last bit.
    pub(crate) fn image(&self, p: Point) -> Point {
        let ([c, s], [u, v]) = (self.rotation, self.translation);
        Point::new(c * p.x - s * p.y + u, s * p.x + c * p.y + v)
    }

    /// The motion that brings points nearest to others in the sense of least squares; of those that are as good but for rounding, the
    /// simplest: a translation, then turns by right angles, and no translation where it is next to none.
    pub(crate) fn between(from: &[Point], to: &[Point]) -> Self {
        let (a, b) = (mean(from), mean(to));
        let pairs = || from.iter().zip(to).map(|(&p, &q)| (p - a, q - b));
        let cosine: f64 = pairs().map(|(p, q)| p.dot(q)).sum();
        let sine: f64 = pairs().map(|(p, q)| p.cross(q)).sum();
        let length = cosine.hypotenuse(sine);
        let coordinates = from.iter().chain(to).flat_map(|p| [p.x.abs(), p.y.abs()]);
        let rounding = ROUNDING * coordinates.fold(0.0, f64::max);
        let best = Self::by([cosine / length, sine / length], a, b, rounding);
        let allowed = SIMPLER * best.misses(from, to) + rounding;
        let exact = EXACT.into_iter().map(|rotation| Self::by(rotation, from[0], to[0], rounding));
        exact.into_iter().find(|motion| motion.misses(from, to) <= allowed).unwrap_or(best)
    }

    /// The motion with this rotation that brings one point to another.
    fn by([c, s]: [f64; 2], from: Point, to: Point, rounding: f64) -> Self {
        let by = [to.x - (c * from.x - s * from.y), to.y - (s * from.x + c * from.y)];
        Self { rotation: [c, s], translation: by.map(|t| if t.abs() <= rounding { 0.0 } else { t }) }
    }

    /// By how much the motion misses some point at most.
    fn misses(&self, from: &[Point], to: &[Point]) -> f64 {
        from.iter().zip(to).map(|(&p, &q)| self.image(p).distance(q)).fold(0.0, f64::max)
    }
}

fn mean(points: &[Point]) -> Point {
    let first = points[0];
    let sum = points.iter().fold(Vector::default(), |sum, &p| sum + (p - first));
    first + sum * (1.0 / points.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CURVE: [Point; 3] = [Point::new(0.1, 0.2), Point::new(0.7, 0.3), Point::new(0.9, 1.1)];

    #[test]
    fn translations_are_exact() {
        let moved = CURVE.map(|p| Point::new(p.x + 0.75, p.y));
        let motion = Motion::between(&CURVE, &moved);
        assert_eq!((motion.rotation, motion.translation[1].to_bits()), ([1.0, 0.0], 0));
        assert!(CURVE.iter().zip(moved).all(|(&p, q)| motion.image(p).y.to_bits() == q.y.to_bits()));
        let same = Motion::between(&CURVE, &CURVE);
        assert!(CURVE.iter().all(|&p| same.image(p) == p));
    }

    #[test]
    fn turns_are_found_and_those_about_the_origin_have_no_translation() {
        for angle in [0.3_f64, 2.0, -3.0, std::f64::consts::FRAC_PI_2] {
            let (s, c) = angle.sin_cos();
            let turned = CURVE.map(|p| Point::new(c * p.x - s * p.y, s * p.x + c * p.y));
            let motion = Motion::between(&CURVE, &turned);
            assert!(motion.translation.iter().all(|by| by.to_bits() == 0), "{angle}");
            assert!(motion.misses(&CURVE, &turned) < 1e-15, "{angle}");
        }
        let quarter = Motion::between(&CURVE, &CURVE.map(|p| Point::new(4.0 - p.y, p.x)));
        assert_eq!(quarter, Motion { rotation: [0.0, 1.0], translation: [4.0, 0.0] });
    }

    #[test]
    fn points_that_are_rounded_are_moved_by_what_is_nearest() {
        let moved = CURVE.map(|p| Point::new(p.x + 2.0, p.y + 1e-6 * (40.0 * p.x).sin()));
        let motion = Motion::between(&CURVE, &moved);
        assert!(motion.misses(&CURVE, &moved) < 3e-6 && (motion.translation[0] - 2.0).abs() < 1e-5);
    }
}
