//! How far the points of some triangles are from something, at most and in the mean, by samples that become dense where the
//! greatest distance may be.

use crate::geometry::Point3;
use crate::parallel::prelude::*;

/// A point of the triangles' side, and its distance to the other side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) at: Point3,
    pub(super) distance: f64,
}

/// What was found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampled {
    /// The farthest sample.
    pub(super) farthest: Sample,
    /// The integral of the squared distance over the triangles.
    pub(super) squares: f64,
    /// The triangles' area.
    pub(super) area: f64,
}

/// The greatest distance is found to this share of it.
const TOLERANCE: f64 = 0.01;
/// How often triangles are cut in four, at most.
const MOST_CUTS: usize = 14;
/// How many pieces are cut at once, at most: those with the greatest distances.
const MOST_PIECES: usize = 200_000;

/// Samples triangles at their corners, at three points of every edge and at three inside, and from there on where the distance,
/// taken as smooth between samples, may exceed the greatest one by more than 1 %. Distances below `floor` do not matter.
/// `None` without triangles. The same bits for any number of threads.
///
/// The greatest distance is that of a sample, so never more than the truth. The integral is by the midpoints of the edges of
/// quarters of the triangles: exact where the squared distance is quadratic on each.
pub(super) fn sample(
    triangles: &[[Point3; 3]],
    floor: f64,
    measure: impl Fn(Point3) -> Sample + Sync,
) -> Option<Sampled> {
    let quarters = |&corners: &[Point3; 3]| Piece::new(corners, &measure).cut(&measure);
    let mut pieces: Vec<Piece> = triangles.par_iter().flat_map_iter(quarters).collect();
    let mut farthest = farthest_of(&pieces)?;
    let (mut squares, mut area) = (0.0, 0.0);
    for piece in &pieces {
        squares += piece.area() * piece.middles.iter().map(|m| m.distance * m.distance).sum::<f64>() / 3.0;
        area += piece.area();
    }
    for _ in 0..MOST_CUTS {
        let enough = floor.max(farthest.distance * (1.0 + TOLERANCE));
        pieces.retain(|piece| piece.expected() > enough);
        if pieces.is_empty() {
            break;
        }
        if pieces.len() > MOST_PIECES {
            pieces.sort_by(|a, b| b.expected().total_cmp(&a.expected()));
            pieces.truncate(MOST_PIECES);
        }
        pieces = pieces.par_iter().flat_map_iter(|piece| piece.cut(&measure)).collect();
        farthest = farthest_of(&pieces).filter(|new| new.distance > farthest.distance).unwrap_or(farthest);
    }
    Some(Sampled { farthest, squares, area })
}

/// The first of the farthest samples.
fn farthest_of(pieces: &[Piece]) -> Option<Sample> {
    let samples = pieces.iter().flat_map(|piece| piece.samples.iter().chain(&piece.middles));
    samples.copied().reduce(|best, next| if next.distance > best.distance { next } else { best })
}

/// A triangle with what is at its corners, and at the middles of its edges, that opposite of corner i as entry i.
struct Piece {
    corners: [Point3; 3],
    samples: [Sample; 3],
    middles: [Sample; 3],
}

impl Piece {
    fn new(corners: [Point3; 3], measure: &impl Fn(Point3) -> Sample) -> Self {
        Self { corners, samples: corners.map(measure), middles: midpoints(corners).map(measure) }
    }

    /// Four of half the size.
    fn cut(&self, measure: &impl Fn(Point3) -> Sample) -> [Piece; 4] {
        let middle = midpoints(self.corners);
        let inner = midpoints(middle).map(measure);
        let at_corner = |i: usize| {
            let (next, last) = ((i + 1) % 3, (i + 2) % 3);
            let corner = self.corners[i];
            // Counter-clockwise: the corner, the middle of the edge that leaves it, that of the edge that comes in.
            let corners = [corner, middle[last], middle[next]];
            let halves = [middle[next], middle[last]].map(|m| measure(corner.lerp(m, 0.5)));
            Piece {
                corners,
                samples: [self.samples[i], self.middles[last], self.middles[next]],
                middles: [inner[i], halves[0], halves[1]],
            }
        };
        let centre = Piece { corners: middle, samples: self.middles, middles: inner };
        [at_corner(0), at_corner(1), at_corner(2), centre]
    }

    /// About the greatest distance that a closer look may find. Between two ends and their middle a parabola rises above the
    /// highest of the three by a quarter of its bend (how far the middle is off the chord) at most.
    fn expected(&self) -> f64 {
        let all = self.samples.iter().chain(&self.middles);
        let most = all.map(|sample| sample.distance).fold(0.0, f64::max);
        let bend = |i: usize| {
            let ends = [self.samples[(i + 1) % 3], self.samples[(i + 2) % 3]];
            (self.middles[i].distance - f64::midpoint(ends[0].distance, ends[1].distance)).abs()
        };
        most + 0.25 * (bend(0) + bend(1) + bend(2))
    }

    fn area(&self) -> f64 {
        let [a, b, c] = self.corners;
        0.5 * (b - a).cross(c - a).norm()
    }
}

fn midpoints([a, b, c]: [Point3; 3]) -> [Point3; 3] {
    [b.lerp(c, 0.5), c.lerp(a, 0.5), a.lerp(b, 0.5)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn triangle() -> [Point3; 3] {
        [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from)
    }

    #[test]
    fn mean_squares_of_linear_distances_are_exact() {
        // The integral of (1 + x + 2 y)^2 over the triangle.
        let distance = |p: Point3| 1.0 + p.x + 2.0 * p.y;
        let found = sample(&[triangle()], 0.0, |at| Sample { at, distance: distance(at) }).unwrap();
        let on_edges = midpoints(triangle()).map(distance).map(|d| d * d).iter().sum::<f64>() / 3.0;
        assert!((found.squares - on_edges).abs() < 1e-12 && (found.area - 1.0).abs() < 1e-15, "{found:?}");
        assert!((found.farthest.distance - 3.0).abs() < 1e-15);
        assert!(sample(&[], 0.0, |at| Sample { at, distance: 1.0 }).is_none());
    }

    proptest! {
        #[test]
        fn a_bump_anywhere_is_climbed(s in 0.0..1.0, t in 0.0..1.0, width in 0.2..2.0) {
            let [s, t]: [f64; 2] = if s + t > 1.0 { [1.0 - s, 1.0 - t] } else { [s, t] };
            let peak = Point3::weighted(triangle(), [1.0 - s - t, s, t]);
            let distance = |p: Point3| {
                let x: f64 = p.distance(peak) / width;
                (-x * x).exp()
            };
            let found = sample(&[triangle()], 0.0, |at| Sample { at, distance: distance(at) }).unwrap();
            prop_assert!(found.farthest.distance > 0.99 && found.farthest.distance <= 1.0, "{found:?}");
            prop_assert!((distance(found.farthest.at) - found.farthest.distance).abs() < 1e-15);
        }
    }
}
