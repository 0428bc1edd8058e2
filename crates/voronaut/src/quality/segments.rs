//! Straight segments in an R-tree.

use crate::geometry::{Aabb, Point};
use rstar::{AABB, PointDistance, RTree, RTreeObject};

/// A segment with a number to know it by.
pub(crate) struct Piece {
    pub(crate) a: Point,
    pub(crate) b: Point,
    pub(crate) id: u32,
}

impl Piece {
    /// The point of the segment (as a closed set) nearest to `p`.
    fn nearest(&self, p: Point) -> Point {
        let along = self.b - self.a;
        let t = (p - self.a).dot(along) / along.dot(along);
        if t.is_nan() { self.a } else { self.a.lerp(self.b, t.clamp(0.0, 1.0)) }
    }
}

impl RTreeObject for Piece {
    type Envelope = AABB<[f64; 2]>;
    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners([self.a.x, self.a.y], [self.b.x, self.b.y])
    }
}

impl PointDistance for Piece {
    fn distance_2(&self, &[x, y]: &[f64; 2]) -> f64 {
        let away = Point::new(x, y) - self.nearest(Point::new(x, y));
        away.dot(away)
    }
}

/// Segments that can be searched by place.
pub(crate) struct Segments {
    tree: RTree<Piece>,
}

impl Segments {
    /// An index of the pieces; all coordinates are finite.
    pub(crate) fn new(pieces: Vec<Piece>) -> Self {
        Self { tree: RTree::bulk_load(pieces) }
    }

    /// The pieces whose bounding box meets a box (both closed).
    pub(crate) fn meeting(&self, bounds: Aabb) -> impl Iterator<Item = &Piece> {
        let Aabb { min, max } = bounds;
        self.tree.locate_in_envelope_intersecting(AABB::from_corners([min.x, min.y], [max.x, max.y]))
    }

    /// The largest coordinate x of any piece.
    pub(crate) fn right_end(&self) -> f64 {
        self.tree.root().envelope().upper()[0]
    }

    /// Euclidean distance from a point to the nearest piece; `None` where there is no piece.
    pub(crate) fn distance(&self, p: Point) -> Option<f64> {
        self.tree.nearest_neighbor([p.x, p.y]).map(|piece| piece.nearest(p).distance(p))
    }
}
