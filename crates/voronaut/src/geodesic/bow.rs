//! The length of a short geodesic by its one leading mode of bending.

use super::length::{GAUSS, chord_by, relaxed_length};
use crate::geometry::{Point, Tensor, Vector};
use crate::metric::{MetricField, nearby};

/// Bows are tried at this share of the chord's length to either side of it.
const TRIAL: f64 = 0.1;
/// Beyond this bow the one mode does not tell the path.
const FAR: f64 = 0.3;
/// Segments of the path that serves then.
const SEGMENTS: usize = 8;
/// Its energy is minimised until a step gains no more than this share.
const SETTLED: f64 = 1e-4;
/// Where the tensors around a chord give it lengths that differ by this factor the best bow is searched, too,
const UNLIKE: f64 = 1.2;
/// and from this factor on the path of segments is tried beside it;
const WILD: f64 = 4.0;
/// and the path halved at its top unless it is no more than this,
const NEAR: f64 = 0.1;
/// and saves what was foreseen, but for this share of the length;
const FORESEEN: f64 = 5e-4;
/// so often at most: with five halvings meshes of the report's metrics are the same, and where edges are far too long for
/// their metric whole runs take two to five times as long.
const HALVINGS: u32 = 3;
/// The longest step from one bow to the next.
const LONGEST: f64 = 4.0;
/// Rounds in search of the best bow, each with trials closer to the last one's best.
const ROUNDS: u32 = 6;

/// Tensors at five places around a chord that differ by no more than this (in the norm of the one in the middle) are
/// interpolated.
const STEADY: f64 = 0.25;

/// Length of the geodesic p-q: the least length of the parabolas through p and q, by quadrature on three of them and on
/// the best of the parabola through their lengths. To second order in the length geodesics are parabolas; where the best
/// one bows out far, a path of segments ([`path_energy`](super::path_energy)) answers instead; where the metric differs around the chord
/// a path of parts of parabolas, and where it differs much the shorter of both. It asks nothing of the field's derivatives: kinks do no harm.
///
/// Where the metric varies little from end to end and across, tensors are interpolated from five, and the error is of
/// fourth order in the length; else the field is evaluated wherever it is needed, 21 times at least, and the length is
/// that of some path, never more than the chord's.
pub(crate) fn bowed_chord(field: &dyn MetricField, p: Point, q: Point) -> f64 {
    bowed_between(field, [p, q], [field.at(p), field.at(q)])
}

/// [`bowed_chord`] where the tensors at both ends are known.
pub(crate) fn bowed_between(field: &dyn MetricField, [p, q]: [Point; 2], ends: [Tensor; 2]) -> f64 {
    if p == q {
        return 0.0;
    }
    let at = nearby(field);
    let d = q - p;
    let middle = p.midpoint(q);
    let tensor = at(middle);
    let across = across(tensor, d);
    let samples = Samples { middle: tensor, ends, sides: [TRIAL, -TRIAL].map(|bow| at(middle + across * bow)) };
    let interpolated = |bow: f64| parabola(|t, offset| samples.at(t, offset), d, across, bow);
    if let Some(length) = Some(&samples).filter(|s| s.are_steady()).and_then(|_| least(interpolated).1) {
        return length;
    }
    let evaluated = |bow: f64| parabola(|t, offset| at(p + d * t + across * offset), d, across, bow);
    let (straight, best) = least(evaluated);
    let unlike = samples.unlike(d);
    let length = match best {
        Some(length) => length,
        None if (UNLIKE..WILD).contains(&unlike) => straight,
        None => Some(relaxed_length(field, p, q, SEGMENTS, SETTLED))
            .filter(|path| path.is_finite())
            .map_or(straight, |path| path.min(straight)),
    };
    if unlike > UNLIKE { length.min(halved(&at, [p, q], straight, HALVINGS)) } else { length }
}

/// Orthogonal to a chord in the metric at its middle, and of its length there.
fn across(tensor: Tensor, d: Vector) -> Vector {
    let conjugate = tensor.apply(d).perpendicular();
    conjugate * (tensor.length(d) / tensor.length(conjugate).max(f64::MIN_POSITIVE))
}

/// The length of a path that bends far, or is a part of such a one, and may still be halved so often; `straight` without a
/// bend.
fn halved(at: &impl Fn(Point) -> Tensor, [p, q]: [Point; 2], straight: f64, halvings: u32) -> f64 {
    // Along any direction across, as paths go; the one that leads least far meets the fewest changes of the metric.
    let d = q - p;
    let aside = d.perpendicular();
    let aside = aside * (d.cross(across(at(p.midpoint(q)), d)) / d.cross(aside));
    let length = |bow: f64| parabola(|t, offset| at(p + d * t + aside * offset), d, aside, bow);
    let best = Best::of(length, straight);
    if best.is_trusted() || halvings == 0 || !straight.is_finite() {
        return best.length;
    }
    let top = p.midpoint(q) + aside * best.bow;
    let part = |ends: [Point; 2]| halved(at, ends, chord_by(at, ends[0], ends[1]), halvings - 1);
    let both = part([p, top]) + part([top, q]);
    if both < best.length { both } else { best.length }
}

/// The length without a bow, and the least one if the bow that it has is small, from the length by bow.
fn least(length: impl Fn(f64) -> f64) -> (f64, Option<f64>) {
    let [straight, left, right] = [0.0, TRIAL, -TRIAL].map(&length);
    let (slope, curvature) = ((left - right) / (2.0 * TRIAL), (left + right - 2.0 * straight) / (TRIAL * TRIAL));
    let best = -slope / curvature;
    let is_near = curvature > 0.0 && best.abs() <= FAR;
    (straight, is_near.then(|| length(best).min(straight)))
}

/// The best bow that was found.
struct Best {
    bow: f64,
    length: f64,
    /// By what share of itself the length differs from what the trials before had foreseen.
    surprise: f64,
}

impl Best {
    /// From no bow on by parabolas through the squares of the lengths of three bows, until the next one's is as foreseen: far
    /// from the best bow lengths themselves grow as straight lines.
    fn of(length: impl Fn(f64) -> f64, straight: f64) -> Self {
        let mut best = Self { bow: 0.0, length: straight, surprise: f64::INFINITY };
        let mut trial = TRIAL;
        for _ in 0..ROUNDS {
            let (centre, here) = (best.bow, best.length);
            let bows = [centre + trial, centre - trial];
            let lengths = bows.map(&length);
            let ([left, right], square) = (lengths.map(|length| length * length), here * here);
            let (slope, curvature) = (0.5 * (left - right) / trial, (left + right - 2.0 * square) / (trial * trial));
            // Where they are no upward parabola: on to the shorter side.
            let step = if curvature > 0.0 { -slope / curvature } else { -4.0 * trial * slope.signum() };
            let next = centre + step.clamp(-LONGEST, LONGEST);
            let found = length(next);
            let foreseen = square + step * (slope + 0.5 * step * curvature);
            for (bow, length) in [(next, found), (bows[0], lengths[0]), (bows[1], lengths[1])] {
                if length < best.length {
                    (best.bow, best.length) = (bow, length);
                }
            }
            best.surprise = (found - foreseen.max(0.0).sqrt()).abs() / found;
            if curvature > 0.0 && best.surprise <= FORESEEN {
                break;
            }
            trial = (best.bow - centre).abs().clamp(0.25 * trial, trial);
        }
        best
    }

    fn is_trusted(&self) -> bool {
        self.bow.abs() <= NEAR && self.surprise <= FORESEEN
    }
}

/// Length of the path p + t d + 4 t (1 - t) bow across for t from 0 to 1, with tensors by t and offset across.
fn parabola(tensor: impl Fn(f64, f64) -> Tensor, d: Vector, across: Vector, bow: f64) -> f64 {
    let speed = |&(t, weight): &(f64, f64)| {
        let velocity = d + across * (bow * (4.0 - 8.0 * t));
        weight * tensor(t, 4.0 * t * (1.0 - t) * bow).length(velocity)
    };
    GAUSS.iter().map(speed).sum()
}

/// Tensors around a chord: in its middle, at its ends, and beside its middle at the trial bows.
struct Samples {
    middle: Tensor,
    ends: [Tensor; 2],
    sides: [Tensor; 2],
}

impl Samples {
    /// Interpolated: quadratic along the chord and across.
    fn at(&self, t: f64, offset: f64) -> Tensor {
        let along = self.ends[0] * ((1.0 - t) * (1.0 - 2.0 * t))
            + self.middle * (4.0 * t * (1.0 - t))
            + self.ends[1] * (t * (2.0 * t - 1.0));
        let share = offset / TRIAL;
        let (left, right) = (0.5 * share * (share + 1.0), 0.5 * share * (share - 1.0));
        along + self.sides[0] * left + self.sides[1] * right + self.middle * -(share * share)
    }

    /// The factor by which lengths of the chord by one tensor alone differ.
    fn unlike(&self, d: Vector) -> f64 {
        let lengths = || self.ends.iter().chain(&self.sides).chain([&self.middle]).map(|tensor| tensor.length(d));
        lengths().fold(0.0, f64::max) / lengths().fold(f64::INFINITY, f64::min)
    }

    fn are_steady(&self) -> bool {
        let inverse = self.middle.inverse();
        let is_near = |t: &Tensor| {
            let d = *t - self.middle;
            // The trace of the square of (inverse d).
            let [a, b, c, e] = [
                inverse.xx * d.xx + inverse.xy * d.xy,
                inverse.xx * d.xy + inverse.xy * d.yy,
                inverse.xy * d.xx + inverse.yy * d.xy,
                inverse.xy * d.xy + inverse.yy * d.yy,
            ];
            a * a + 2.0 * b * c + e * e <= STEADY * STEADY
        };
        self.ends.iter().chain(&self.sides).all(is_near)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodesic::chord;
    use std::f64::consts::PI;

    #[test]
    fn to_itself_a_point_has_no_way() {
        let asked = std::sync::atomic::AtomicUsize::new(0);
        let field = |p: Point| {
            asked.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            assert!(p.is_finite());
            Tensor::isotropic(2.0 + p.x)
        };
        let p = Point::new(0.3, 0.4);
        assert_eq!(bowed_chord(&field, p, p).to_bits(), 0);
        assert!(asked.into_inner() <= 2);
    }

    #[test]
    fn uniform_metrics_have_straight_geodesics() {
        let field = |_: Point| Tensor::new(7.0, 2.0, 1.5);
        let (p, q) = (Point::new(0.1, 0.2), Point::new(-0.4, 0.9));
        assert!((bowed_chord(&field, p, q) - field(p).length(q - p)).abs() < 1e-15);
    }

    #[test]
    fn half_plane_lengths_are_of_fourth_order() {
        let field = |p: Point| Tensor::isotropic(p.y);
        let error = |h: f64, measure: &dyn Fn(Point, Point) -> f64| {
            let (p, q) = (Point::new(0.0, 1.0), Point::new(h, 1.0 + 0.1 * h));
            let d2 = (q - p).dot(q - p);
            measure(p, q) / (1.0 + d2 / (2.0 * p.y * q.y)).acosh() - 1.0
        };
        let bowed = |p: Point, q: Point| bowed_chord(&field, p, q);
        let errors = [1.6, 0.8, 0.4, 0.2, 0.1].map(|h| error(h, &bowed).abs());
        // The first is halved, of the second the field is evaluated all along, of the others tensors are interpolated.
        assert!(errors[0] < errors[1] && errors[2] < errors[1] / 4.0, "{errors:?}");
        assert!((errors[2] / errors[4]).log2() > 5.0, "{errors:?}");
        assert!(errors[4] < 2e-3 * error(0.1, &|p, q| chord(&field, p, q)), "{errors:?}");
    }

    #[test]
    fn chords_far_too_long_are_bent() {
        // Flat space pulled back by a wave that is a hundred times as high as these edges are long.
        let image = |p: Point| Point::new(p.x / 40.0, p.y + 0.5 * (PI * p.x).sin());
        let field = |p: Point| {
            let slope = 0.5 * PI * (PI * p.x).cos();
            Tensor::new(1.0 / 1600.0 + slope * slope, slope, 1.0)
        };
        let edges = [(0.281, -0.5, -0.091, 0.105), (-0.439, -0.14, 0.082, -0.04), (-0.624, -0.102, 0.086, 0.033)];
        for (x, y, dx, dy) in edges {
            let (p, q) = (Point::new(x, y), Point::new(x + dx, y + dy));
            let exact = image(p).distance(image(q));
            let (found, straight) = (bowed_chord(&field, p, q) / exact, chord(&field, p, q) / exact);
            assert!(straight > 3.0 && (found - 1.0).abs() < 5e-3, "{straight} {found}");
        }
    }

    #[test]
    fn nonsense_has_a_length_all_the_same() {
        let nan = |_: Point| Tensor::new(f64::NAN, 0.0, 1.0);
        let _ = bowed_chord(&nan, Point::new(0.0, 0.0), Point::new(1.0, 0.0));
        let kinked = |p: Point| Tensor::isotropic(1e-3 + p.x.abs());
        let (p, q) = (Point::new(-1.0, 0.0), Point::new(1.0, 1e-9));
        assert!(bowed_chord(&kinked, p, q) <= chord(&kinked, p, q) * (1.0 + 1e-14));
    }
}
