//! Straight segments by place.

use crate::geometry::{Aabb, BoxTree, Point};

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

/// Segments that can be searched by place.
pub(crate) struct Segments {
    tree: BoxTree<Piece, 2>,
}

impl Segments {
    /// An index of the pieces; all coordinates are finite.
    pub(crate) fn new(pieces: Vec<Piece>) -> Self {
        let boxed = |piece: Piece| Some((Aabb::of([piece.a, piece.b])?.into(), piece));
        Self { tree: BoxTree::new(pieces.into_iter().filter_map(boxed)) }
    }

    /// The pieces whose bounding box meets a box (both closed).
    pub(crate) fn meeting(&self, bounds: Aabb) -> impl Iterator<Item = &Piece> {
        self.tree.meeting(bounds.into())
    }

    /// The largest coordinate x of any piece.
    pub(crate) fn right_end(&self) -> f64 {
        self.tree.bounds().map_or(f64::NEG_INFINITY, |bounds| bounds[1][0])
    }

    /// Euclidean distance from a point to the nearest piece; `None` where there is no piece.
    pub(crate) fn distance(&self, p: Point) -> Option<f64> {
        let nearest = self.tree.nearest([p.x, p.y], |piece| {
            let away = p - piece.nearest(p);
            away.dot(away)
        });
        nearest.map(|piece| piece.nearest(p).distance(p))
    }
}
