//! Which triangle is nearest to the eye, by samples: a z-buffer.

/// No triangle.
pub(super) const NONE: u32 = u32::MAX;
/// How many samples a pixel has along each side.
pub(super) const SAMPLES: usize = 3;
/// Triangles reach so much farther than they do, in samples: no sample falls between neighbours.
const SLACK: f64 = 1e-7;

/// A triangle in samples: x to the right, y down, the third coordinate towards the eye.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    corners: [[f64; 3]; 3],
    /// Twice its area in the picture, negative where it is counter-clockwise there (y is down).
    area: f64,
}

/// The nearest triangle at each sample, row by row.
pub(super) struct DepthMap {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) nearest: Vec<u32>,
    depths: Vec<f32>,
}

impl Facet {
    /// A triangle given in pixels.
    pub(super) fn new(corners: [[f64; 3]; 3]) -> Self {
        let corners = corners.map(|corner| corner.map(|x| x * SAMPLES as f64));
        let [a, b, c] = corners;
        Self { corners, area: (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) }
    }

    /// Whether the eye sees the side from which the corners are counter-clockwise.
    pub(super) fn is_front(&self) -> bool {
        self.area < 0.0
    }

    /// Barycentric coordinates of a point of the picture.
    pub(super) fn weights(&self, x: f64, y: f64) -> [f64; 3] {
        [0, 1, 2].map(|i| {
            let [slope, offset] = self.side(i, y);
            slope * x + offset
        })
    }

    /// How near it is to the eye at a point of the picture; at most as near as its nearest corner, and as far as its
    /// farthest, also beyond its sides.
    pub(super) fn depth(&self, x: f64, y: f64) -> f64 {
        let weights = self.weights(x, y);
        let depths = self.corners.map(|corner| corner[2]);
        let [low, high] = range(depths);
        weights.iter().zip(depths).map(|(w, depth)| w * depth).sum::<f64>().clamp(low, high)
    }

    /// Its normal in the picture, of any length: to the right, up, to the eye; towards the eye.
    pub(super) fn normal(&self) -> [f64; 3] {
        let [a, b, c] = self.corners;
        let [[ux, uy, uz], [vx, vy, vz]] = [b, c].map(|p| [p[0] - a[0], a[1] - p[1], p[2] - a[2]]);
        let sign = 1.0_f64.copysign(ux * vy - uy * vx);
        [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx].map(|x| sign * x)
    }

    /// The barycentric coordinate of corner i on the row y, as slope and offset along x.
    fn side(&self, i: usize, y: f64) -> [f64; 2] {
        let [p, q] = [self.corners[(i + 1) % 3], self.corners[(i + 2) % 3]];
        let slope = (p[1] - q[1]) / self.area;
        [slope, ((q[0] - p[0]) * (y - p[1])) / self.area - slope * p[0]]
    }

    /// From where to where it reaches on the row y.
    fn span(&self, y: f64) -> [f64; 2] {
        let [mut low, mut high] = range(self.corners.map(|corner| corner[0]));
        for i in 0..3 {
            let [slope, offset] = self.side(i, y);
            if slope > 0.0 {
                low = low.max(-offset / slope);
            } else if slope < 0.0 {
                high = high.min(-offset / slope);
            }
        }
        [low - SLACK, high + SLACK]
    }
}

impl DepthMap {
    /// A map of so many pixels in which nothing is.
    pub(super) fn new([width, height]: [f64; 2]) -> Self {
        let [width, height] = [width, height].map(|side| side as usize * SAMPLES);
        Self { width, height, nearest: vec![NONE; width * height], depths: vec![f32::NEG_INFINITY; width * height] }
    }

    /// Enters the triangle with number `id`: where others are as near, they stay.
    pub(super) fn enter(&mut self, id: u32, facet: &Facet) {
        if facet.area == 0.0 {
            return;
        }
        let [top, bottom] = range(facet.corners.map(|corner| corner[1]));
        for row in samples([top - SLACK, bottom + SLACK], self.height) {
            let y = row as f64 + 0.5;
            for column in samples(facet.span(y), self.width) {
                let (at, depth) = (row * self.width + column, facet.depth(column as f64 + 0.5, y) as f32);
                if depth > self.depths[at] {
                    self.depths[at] = depth;
                    self.nearest[at] = id;
                }
            }
        }
    }

    /// The triangle that is nearest at a point of the picture, given in samples; `None` outside of all.
    pub(super) fn at(&self, x: f64, y: f64) -> Option<u32> {
        let is_inside = (0.0..self.width as f64).contains(&x) && (0.0..self.height as f64).contains(&y);
        let id = if is_inside { self.nearest[y as usize * self.width + x as usize] } else { NONE };
        (id != NONE).then_some(id)
    }
}

fn range([a, b, c]: [f64; 3]) -> [f64; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

/// The samples whose middles are in a range, among the first `count`.
fn samples([low, high]: [f64; 2], count: usize) -> std::ops::Range<usize> {
    let first = (low - 0.5).ceil().max(0.0) as usize;
    let end = ((high - 0.5).floor() + 1.0).clamp(0.0, count as f64) as usize;
    first..end
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles that make a square, and one before a part of it.
    fn map() -> (DepthMap, Vec<Facet>) {
        let facets: Vec<Facet> = [
            [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 8.0, 8.0]],
            [[0.0, 0.0, 0.0], [8.0, 8.0, 8.0], [0.0, 8.0, 8.0]],
            [[4.0, 0.0, 4.0], [8.0, 0.0, 4.0], [8.0, 8.0, 4.0]],
        ]
        .map(Facet::new)
        .to_vec();
        let mut map = DepthMap::new([8.0, 8.0]);
        for (id, facet) in facets.iter().enumerate() {
            map.enter(id as u32, facet);
        }
        (map, facets)
    }

    #[test]
    fn neighbours_leave_no_sample_between_them() {
        let (map, _) = map();
        assert!(map.nearest.iter().all(|&id| id != NONE));
        assert_eq!([map.at(-0.1, 3.0), map.at(3.0, 24.0), map.at(f64::NAN, 1.0)], [None; 3]);
    }

    #[test]
    fn the_nearest_is_seen_and_triangles_may_cross() {
        let (map, facets) = map();
        // The third is flat at 4: before the sloped square where that is farther, in the upper half.
        assert_eq!(map.at(22.0, 3.0), Some(2));
        assert_eq!(map.at(23.0, 20.0), Some(0));
        assert_eq!(map.at(3.0, 20.0), Some(1));
        assert!((facets[0].depth(20.0, 15.0) - 15.0).abs() < 1e-9);
        assert!((facets[0].depth(20.0, 150.0) - 24.0).abs() < 1e-9);
        assert!(!facets[0].is_front() && facets[0].normal()[2] > 0.0);
    }
}
