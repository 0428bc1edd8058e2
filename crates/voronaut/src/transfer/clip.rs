//! The intersection of two triangles, and integrals over it.

use crate::geometry::{Point, Vector};

/// A triangle as a frame: everything is measured in its barycentric coordinates, so that it is never thin and corners that two
/// triangles share are in the same place for both.
pub(super) struct Frame {
    /// The ends of the edge opposite to each corner, and the one over twice the signed area.
    edges: [(Point, Vector); 3],
    scale: f64,
}

/// What two triangles have in common.
pub(super) struct Overlap {
    /// Its share of the frame's area.
    pub(super) share: f64,
    /// Integrals, over it and per unit area of the frame, of the product of barycentric coordinate i of the frame and
    /// coordinate k of the other triangle: `products[i][k]`.
    pub(super) products: [[f64; 3]; 3],
    polygon: Polygon,
}

/// A corner of the intersection: its barycentric coordinates in the frame and in the other triangle.
#[derive(Clone, Copy, Default)]
struct Corner {
    frame: [f64; 3],
    other: [f64; 3],
}

/// Corners of a triangle cut by three lines.
const MOST: usize = 6;

#[derive(Clone, Copy)]
struct Polygon {
    corners: [Corner; MOST],
    count: usize,
}

impl Frame {
    /// The frame of a triangle, oriented either way; `None` of one without area.
    pub(super) fn new([a, b, c]: [Point; 3]) -> Option<Self> {
        let scale = 1.0 / (b - a).cross(c - a);
        scale.is_finite().then_some(Self { edges: [(b, c - b), (c, a - c), (a, b - a)], scale })
    }

    fn coordinates(&self, p: Point) -> [f64; 3] {
        self.edges.map(|(start, along)| along.cross(p - start) * self.scale)
    }

    /// The intersection with another triangle, oriented either way; `None` where they have no area in common.
    pub(super) fn overlap(&self, other: [Point; 3]) -> Option<Overlap> {
        let at = other.map(|p| self.coordinates(p));
        if (0..3).any(|i| at.iter().all(|corner| corner[i] <= 0.0)) {
            return None;
        }
        let mut polygon = Polygon { corners: [Corner::default(); MOST], count: 3 };
        for (i, frame) in at.into_iter().enumerate() {
            let mut other = [0.0; 3];
            other[i] = 1.0;
            polygon.corners[i] = Corner { frame, other };
        }
        for i in (0..3).filter(|&i| at.iter().any(|corner| corner[i] < 0.0)) {
            polygon = polygon.cut(i);
        }
        Overlap::of(&polygon)
    }
}

impl Overlap {
    fn of(polygon: &Polygon) -> Option<Self> {
        let (mut share, mut products) = (0.0, [[0.0; 3]; 3]);
        for j in 2..polygon.count {
            let fan = [polygon.corners[0], polygon.corners[j - 1], polygon.corners[j]];
            let [p, q, r] = fan.map(|corner| Point::new(corner.frame[1], corner.frame[2]));
            let piece = (q - p).cross(r - p);
            share += piece;
            for (i, row) in products.iter_mut().enumerate() {
                for (k, product) in row.iter_mut().enumerate() {
                    let (f, g) = (fan.map(|corner| corner.frame[i]), fan.map(|corner| corner.other[k]));
                    let together: f64 = (0..3).map(|m| f[m] * g[m]).sum();
                    *product += piece / 12.0 * (f.iter().sum::<f64>() * g.iter().sum::<f64>() + together);
                }
            }
        }
        if share < 0.0 {
            share = -share;
            products.as_flattened_mut().iter_mut().for_each(|product| *product = -*product);
        }
        (share > 0.0 && share.is_finite()).then_some(Self { share, products, polygon: *polygon })
    }

    /// The least and the greatest value, on the intersection, of what is linear on the other triangle.
    pub(super) fn range(&self, values: [f64; 3]) -> (f64, f64) {
        let at = |corner: &Corner| super::interpolation::mean(values, corner.other);
        let corners = self.polygon.corners[..self.polygon.count].iter().map(at);
        corners.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    }
}

impl Polygon {
    /// The part where coordinate `i` of the frame is not negative (Sutherland and Hodgman 1974). A point between two corners is
    /// reckoned from the one that is kept, from either side of an edge that two polygons share: they fit.
    fn cut(&self, i: usize) -> Self {
        let mut left = Self { corners: [Corner::default(); MOST], count: 0 };
        for j in 0..self.count {
            let (here, next) = (self.corners[j], self.corners[(j + 1) % self.count]);
            let (is_in, is_next_in) = (here.frame[i] >= 0.0, next.frame[i] >= 0.0);
            if is_in {
                left.push(here);
            }
            if is_in != is_next_in {
                left.push(if is_in { here.towards(&next, i) } else { next.towards(&here, i) });
            }
        }
        left
    }

    fn push(&mut self, corner: Corner) {
        // A convex polygon gains one corner for each line at most; only rounding could do otherwise.
        if self.count < MOST {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }
}

impl Corner {
    /// Where coordinate `i` of the frame is zero on the way to a corner beyond.
    fn towards(&self, beyond: &Corner, i: usize) -> Corner {
        let t = self.frame[i] / (self.frame[i] - beyond.frame[i]);
        let between = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * t);
        let mut corner = Corner { frame: between(self.frame, beyond.frame), other: between(self.other, beyond.other) };
        corner.frame[i] = 0.0;
        corner
    }
}
