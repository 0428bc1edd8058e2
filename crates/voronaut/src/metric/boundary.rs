//! Sizes that grow with the distance to the boundary: thin cells along it, as boundary layers need.

use super::MetricField;
use super::validate::require;
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::{Aabb, BoxTree, Candidates, Point, Tensor, Vector, around};

/// What [`Boundary`] asks for, in Euclidean lengths. At distance d from the boundary the size across it is
/// `min(h_max, h0 + (growth - 1) d)`, and along it `aspect` times that, at most `h_max`.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct BoundarySizes {
    /// Size across the boundary, at the boundary.
    pub h0: f64,
    /// Ratio of the sizes of one layer of cells and the layer before it.
    pub growth: f64,
    /// Size along the boundary over the size across it.
    pub aspect: f64,
    /// The largest size; infinite for no limit.
    pub h_max: f64,
}

/// The field M = n n' / a^2 + t t' / b^2, where n points from the nearest point of the boundary to p, t is across n,
/// and a and b are the sizes across and along the boundary that [`BoundarySizes`] gives.
///
/// On the boundary, where rounding leaves n no direction, n is the normal of the segment; where several segments are
/// equally near (at a shared vertex, half-way between two walls) M is the log-Euclidean mean of their tensors.
/// The field has kinks half-way between walls and jumps at vertices of the boundary, where n does.
#[derive(Clone, Debug)]
pub struct Boundary {
    sizes: BoundarySizes,
    tree: BoxTree<Segment, 2>,
    /// Which of them may be nearest.
    candidates: Candidates,
    /// The largest absolute coordinate.
    reach: f64,
}

/// A segment with what a distance to it needs.
#[derive(Clone, Copy, Debug)]
struct Segment {
    start: Point,
    along: Vector,
    /// 1 / |along|^2; zero of a segment without length.
    inverse: f64,
}

/// Distances to two segments that differ by less, relative to the coordinates, are equal: a few roundings.
const TIE: f64 = 16.0 * f64::EPSILON;

impl BoundarySizes {
    /// The size at the boundary, with the defaults of the rest: growth 1.2, aspect 1, no largest size.
    pub(crate) fn from_h0(h0: f64) -> Self {
        Self { h0, growth: 1.2, aspect: 1.0, h_max: f64::INFINITY }
    }

    /// Whether the sizes make sense, alone and together.
    ///
    /// # Errors
    /// [`Error::Parse`] that names the parameter.
    pub(crate) fn check(&self) -> Result<()> {
        let Self { h0, growth, aspect, h_max } = *self;
        let place = "metric boundary";
        require(h0.is_finite() && h0 > 0.0, place, "h0", h0, "finite and positive")?;
        require(growth.is_finite() && growth >= 1.0, place, "growth", growth, "finite and at least 1")?;
        require(aspect.is_finite() && aspect > 0.0, place, "aspect", aspect, "finite and positive")?;
        require(h_max >= h0, place, "h_max", h_max, &format!("at least h0 = {h0}"))
    }

    /// Sizes across and along the boundary at distance `d`.
    fn at(&self, d: f64) -> (f64, f64) {
        let across = self.h_max.min(self.h0 + (self.growth - 1.0) * d);
        (across, self.h_max.min(self.aspect * across))
    }
}

impl Boundary {
    /// The field around these segments.
    ///
    /// # Errors
    /// [`Error::Parse`] of sizes that make no sense; [`Error::Domain`] of no segment, or of one that is not finite.
    pub fn new(segments: &[(Point, Point)], sizes: BoundarySizes) -> Result<Self> {
        sizes.check()?;
        if let Some(i) = segments.iter().position(|(a, b)| !a.is_finite() || !b.is_finite()) {
            let (a, b) = segments[i];
            let place = format!("segment {} from {a} to {b}", i + 1);
            return Err(Error::domain("a coordinate is not finite", place, "check the coordinates of the domain"));
        }
        let ends = segments.iter().flat_map(|&(a, b)| [a, b]);
        let Some(bounds) = Aabb::of(ends.clone()) else {
            return Err(Error::domain(
                "no boundary",
                "metric boundary",
                "use another metric where there is no boundary",
            ));
        };
        let boxes = segments.iter().map(|&(a, b)| around([a, b]));
        let tree = BoxTree::new(boxes.zip(segments.iter().copied().map(Segment::new)));
        let candidates = Candidates::new(bounds, segments.len());
        Ok(Self { sizes, tree, candidates, reach: ends.map(largest).fold(0.0, f64::max) })
    }

    /// Distance to the boundary, the mean of n n' over the segments that are that near, and their number.
    fn nearest(&self, p: Point) -> (f64, Tensor, usize) {
        match self.candidates.at(p, |centre, within| self.around(centre, within)) {
            Some(places) => self.nearest_of(p, places),
            None => self.nearest_of(p, &self.around(p, 0.0)),
        }
    }

    /// The places in the tree, in order, of the segments that are no farther than the nearest one and a distance, or tie with what is.
    fn around(&self, p: Point, within: f64) -> Vec<u32> {
        let slack = within + 4.0 * self.tolerance(p);
        let (mut bound, mut seen) = (f64::INFINITY, Vec::new());
        self.tree.search([p.x, p.y], bound, |place, segment| {
            let square = segment.square(p);
            if square <= bound {
                bound = bound.min((square.sqrt() + slack).powi(2));
                seen.push((place, square));
            }
            bound
        });
        let mut places: Vec<u32> = seen.into_iter().filter(|seen| seen.1 <= bound).map(|seen| seen.0).collect();
        places.sort_unstable();
        places
    }

    /// [`Boundary::nearest`] of segments that are candidates.
    fn nearest_of(&self, p: Point, places: &[u32]) -> (f64, Tensor, usize) {
        let square = |place: u32| self.tree.item(place).map_or(f64::INFINITY, |segment| segment.square(p));
        let (mut least, mut second, mut nearest) = (f64::INFINITY, f64::INFINITY, 0);
        for &place in places {
            let found = square(place);
            if found < least {
                (second, least, nearest) = (least, found, place);
            } else if found < second {
                second = found;
            }
        }
        let (distance, tolerance) = (least.sqrt(), self.tolerance(p));
        let bound = (distance + tolerance).powi(2);
        let all: &[u32] = if second > bound { &[nearest] } else { places };
        let tied = all.iter().filter(|&&place| square(place) <= bound).filter_map(|&place| self.tree.item(place));
        let add = |(sum, count), segment: &Segment| (sum + segment.normal_square(p, tolerance), count + 1);
        let (sum, count) = tied.fold((Tensor::default(), 0), add);
        (distance, sum * (1.0 / count as f64), count)
    }

    /// What distances from a place may differ by and tie.
    fn tolerance(&self, p: Point) -> f64 {
        TIE * (self.reach + largest(p))
    }
}

impl Segment {
    fn new((start, end): (Point, Point)) -> Self {
        let along = end - start;
        let square = along.dot(along);
        Self { start, along, inverse: if square > 0.0 { 1.0 / square } else { 0.0 } }
    }

    /// From the nearest point of the segment to `p`, and whether that point lies between the ends.
    fn offset(&self, p: Point) -> (Vector, bool) {
        let from_start = p - self.start;
        let t = from_start.dot(self.along) * self.inverse;
        let clamped = t.clamp(0.0, 1.0);
        (from_start - self.along * clamped, 0.0 < t && t < 1.0)
    }

    /// The square of the distance to `p`.
    fn square(&self, p: Point) -> f64 {
        let (offset, _) = self.offset(p);
        offset.dot(offset)
    }

    /// n n' at a place: of the segment's normal where that is the direction or the direction is noise, else of the offset.
    fn normal_square(&self, p: Point, tolerance: f64) -> Tensor {
        let (offset, inside) = self.offset(p);
        let distance = offset.norm();
        if inside || distance <= tolerance {
            if self.inverse == 0.0 {
                return Tensor::new(0.5, 0.0, 0.5);
            }
            return Tensor::square(self.along.perpendicular()) * self.inverse;
        }
        Tensor::square(offset * (1.0 / distance))
    }
}

impl MetricField for Boundary {
    fn at(&self, p: Point) -> Tensor {
        let (distance, normals, count) = self.nearest(p);
        let (across, along) = self.sizes.at(distance);
        // Those that meet in the nearest vertex have one normal.
        if count == 1 || normals.determinant() <= 4.0 * f64::EPSILON {
            let least = 1.0 / (along * along);
            return normals * (1.0 / (across * across) - least) + Tensor::new(least, 0.0, least);
        }
        // The tied tensors have the same sizes: the mean of their logarithms is linear in the mean of n n'.
        let least = -2.0 * along.logarithm();
        (normals * (2.0 * (along / across).logarithm()) + Tensor::new(least, 0.0, least)).exp()
    }
}

fn largest(p: Point) -> f64 {
    p.x.abs().max(p.y.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::check_field;
    use proptest::prelude::*;

    const SIZES: BoundarySizes = BoundarySizes { h0: 0.01, growth: 1.5, aspect: 8.0, h_max: 2.0 };

    /// A closed polygon as segments.
    fn ring(corners: &[(f64, f64)]) -> Vec<(Point, Point)> {
        let point = |i: usize| Point::new(corners[i % corners.len()].0, corners[i % corners.len()].1);
        (0..corners.len()).map(|i| (point(i), point(i + 1))).collect()
    }

    fn square() -> Boundary {
        Boundary::new(&ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]), SIZES).unwrap()
    }

    fn assert_close(a: Tensor, b: Tensor) {
        let error = (a.xx - b.xx).abs().max((a.xy - b.xy).abs()).max((a.yy - b.yy).abs());
        assert!(error < 1e-10 * (b.xx + b.yy), "{a:?}, not {b:?}");
    }

    fn diagonal(hx: f64, hy: f64) -> Tensor {
        Tensor::new(1.0 / (hx * hx), 0.0, 1.0 / (hy * hy))
    }

    #[test]
    fn sizes_near_a_wall_are_the_formula() {
        let field = square();
        assert_close(field.at(Point::new(0.4, 0.0)), diagonal(0.08, 0.01));
        assert_close(field.at(Point::new(0.4, 0.1)), diagonal(8.0 * 0.06, 0.06));
        assert_close(field.at(Point::new(0.9, 0.3)), diagonal(0.06, 8.0 * 0.06));
        assert_close(field.at(Point::new(0.5, -0.3)), diagonal(8.0 * 0.16, 0.16));
        assert_close(field.at(Point::new(0.5, -30.0)), Tensor::isotropic(2.0));
    }

    #[test]
    fn around_a_corner_the_direction_turns() {
        let n = Vector::new(-0.6, -0.8);
        let truth = Tensor::from_axis(n, 0.06f64.powi(-2), 0.48f64.powi(-2));
        assert_close(square().at(Point::new(-0.06, -0.08)), truth);
    }

    #[test]
    fn ties_are_log_euclidean_means() {
        let field = square();
        let mean = |a, b| Tensor::log_mean([(a, 0.5), (b, 0.5)]);
        assert_close(field.at(Point::new(0.0, 0.0)), mean(diagonal(0.08, 0.01), diagonal(0.01, 0.08)));
        assert_close(field.at(Point::new(0.2, 0.2)), mean(diagonal(0.88, 0.11), diagonal(0.11, 0.88)));
        let (across, along) = SIZES.at(0.5);
        assert_close(field.at(Point::new(0.5, 0.5)), Tensor::isotropic((across * along).sqrt()));
    }

    #[test]
    fn rounding_on_a_slanted_wall_does_not_turn_the_tensor() {
        let (a, b) = (Point::new(1000.1, 2000.3), Point::new(1007.7, 2004.9));
        let field = Boundary::new(&[(a, b)], SIZES).unwrap();
        let t = (b - a) * (1.0 / (b - a).norm());
        let truth = Tensor::from_axis(t, 0.08f64.powi(-2), 0.01f64.powi(-2));
        for i in 0..=1000 {
            assert_close(field.at(a.lerp(b, f64::from(i) / 1000.0)), truth);
        }
    }

    #[test]
    fn what_was_asked_before_has_no_say() {
        let corners = |i: u32| (f64::from(i) * 0.1).sin_cos();
        let corners: Vec<(f64, f64)> = (0..60).map(corners).map(|(y, x)| (x + 0.3 * y * y, y)).collect();
        let field = Boundary::new(&ring(&corners), SIZES).unwrap();
        let points = (0..40).map(|i| Point::new(f64::from(i % 7) * 0.4 - 1.2, f64::from(i / 7) * 0.4));
        for p in points {
            assert_eq!(field.at(p), field.clone().at(p));
            assert_eq!(field.nearest(p), field.nearest_of(p, &field.around(p, 0.0)));
        }
        let nowhere = Boundary::new(&[(Point::default(), Point::default())], SIZES).unwrap();
        assert!(nowhere.at(Point::default()).is_positive_definite());
    }

    #[test]
    fn a_circle_s_centre_ties_with_everything() {
        let corners: Vec<(f64, f64)> =
            (0..360).map(|i| f64::from(i).to_radians()).map(|angle| (angle.cos(), angle.sin())).collect();
        let m = Boundary::new(&ring(&corners), SIZES).unwrap().at(Point::default());
        assert!(m.anisotropy() < 1.01, "{m:?}");
    }

    #[test]
    fn scaling_the_plane_scales_the_sizes() {
        for scale in [1e-9, 1e-3, 1e6] {
            let big: Vec<(Point, Point)> = ring(&[(0.0, 0.0), (scale, 0.0), (scale, scale), (0.0, scale)]);
            let sizes = BoundarySizes { h0: SIZES.h0 * scale, h_max: SIZES.h_max * scale, ..SIZES };
            let field = Boundary::new(&big, sizes).unwrap();
            for (x, y) in [(0.5, 0.5), (0.3, 0.0), (0.2, 0.2), (0.7, 0.1), (-0.3, -0.4)] {
                let m = field.at(Point::new(x * scale, y * scale)) * (scale * scale);
                assert_close(m, square().at(Point::new(x, y)));
            }
        }
    }

    proptest! {
        #[test]
        fn the_distance_is_that_of_brute_force(
            ends in prop::collection::vec((-1.0..1.0, -1.0..1.0, -0.1..0.1, -0.1..0.1), 1..100),
            (x, y) in (-2.0..2.0, -2.0..2.0),
        ) {
            let segments: Vec<(Point, Point)> =
                ends.iter().map(|&(x, y, u, v)| (Point::new(x, y), Point::new(x + u, y + v))).collect();
            let p = Point::new(x, y);
            let truth = segments.iter().map(|&(a, b)| {
                let (u, w) = (b - a, p - a);
                let t = (w.dot(u) / u.dot(u)).clamp(0.0, 1.0);
                p.distance(a.lerp(b, t))
            }).fold(f64::INFINITY, f64::min);
            let field = Boundary::new(&segments, SIZES).unwrap();
            let (distance, normals, _) = field.nearest(p);
            prop_assert!((distance - truth).abs() < 1e-14);
            prop_assert!((normals.xx + normals.yy - 1.0).abs() < 1e-12);
            prop_assert!(check_field(&field, [p].into_iter()).is_ok());
        }
    }

    #[test]
    fn segments_without_length_are_points() {
        let a = Point::new(1.0, 2.0);
        let field = Boundary::new(&[(a, a)], SIZES).unwrap();
        assert_close(field.at(Point::new(1.2, 2.0)), diagonal(0.11, 0.88));
        assert!(field.at(a).is_positive_definite());
        assert!(!field.at(Point::new(f64::NAN, 0.0)).is_positive_definite());
    }

    #[test]
    fn bad_input_is_named() {
        let wall = [(Point::new(0.0, 0.0), Point::new(1.0, 0.0))];
        for (sizes, message, help) in [
            (BoundarySizes { h0: 0.0, ..SIZES }, "metric boundary: h0 = 0", "h0 must be finite and positive"),
            (
                BoundarySizes { growth: 0.9, ..SIZES },
                "metric boundary: growth = 0.9",
                "growth must be finite and at least 1",
            ),
            (
                BoundarySizes { aspect: -1.0, ..SIZES },
                "metric boundary: aspect = -1",
                "aspect must be finite and positive",
            ),
            (
                BoundarySizes { h_max: 0.001, ..SIZES },
                "metric boundary: h_max = 0.001",
                "h_max must be at least h0 = 0.01",
            ),
            (BoundarySizes { h_max: f64::NAN, ..SIZES }, "metric boundary: h_max = NaN", "h_max must be at least"),
        ] {
            let error = Boundary::new(&wall, sizes).unwrap_err();
            assert_eq!(error.to_string(), message);
            assert!(error.help().contains(help), "{}", error.help());
        }
        let error = Boundary::new(&[], SIZES).unwrap_err();
        assert_eq!(error.to_string(), "invalid domain: no boundary at metric boundary");
        let bad = [wall[0], (Point::new(0.0, f64::INFINITY), Point::new(1.0, 0.0))];
        let error = Boundary::new(&bad, SIZES).unwrap_err();
        assert_eq!(
            error.to_string(),
            "invalid domain: a coordinate is not finite at segment 2 from (0, inf) to (1, 0)"
        );
    }
}
