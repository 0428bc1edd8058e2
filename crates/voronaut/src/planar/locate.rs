//! Point location by walking along a straight line.

use super::Planar;
use crate::geometry::{Orientation, Point, centroid, holds, orientation};
use crate::triangulation::{FaceId, HalfEdge, VertexId};

/// Where a walk ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Location {
    /// Strictly inside the face.
    Face(FaceId),
    /// On the edge, between its ends.
    Edge(HalfEdge),
    /// At the position of the vertex.
    Vertex(VertexId),
    /// Behind the edge, which the walk may not cross: it is at the border, or constrained. The half-edge is that
    /// of the face the walk came from.
    Behind(HalfEdge),
}

impl Planar {
    /// Walks from a face to the point, straight from a point inside the face. With `confined` the walk also stops at
    /// constrained edges, else only at the border.
    ///
    /// In a domain with holes [`Location::Behind`] says only that the straight way is barred.
    pub(crate) fn walk(&self, from: FaceId, to: Point, confined: bool) -> Location {
        // A straight walk visits a face once; the bound only guards against the rounding of its start.
        let found = self.walk_within(from, to, confined, self.topology.face_slots() + 1);
        found.or_else(|| self.search(to)).unwrap_or(Location::Face(from))
    }

    /// The same through so many faces at most; `None` where the point lies beyond them.
    pub(crate) fn walk_within(&self, from: FaceId, to: Point, confined: bool, faces: usize) -> Option<Location> {
        let start = centroid(self.triangle(from));
        let mut entered: Option<HalfEdge> = None;
        let mut face = from;
        for _ in 0..faces {
            let Some(exit) = self.exit(face, entered, start, to) else { return Some(self.classify(face, to)) };
            if confined && self.topology.is_fixed(exit) {
                return Some(Location::Behind(exit));
            }
            let Some(twin) = self.topology.twin(exit) else { return Some(Location::Behind(exit)) };
            entered = Some(twin);
            face = twin.face();
        }
        None
    }

    /// The edge through which the line from `start` to `to` leaves the face; `None` where the face holds `to`.
    fn exit(&self, face: FaceId, entered: Option<HalfEdge>, start: Point, to: Point) -> Option<HalfEdge> {
        let beyond = |h: HalfEdge| {
            let [a, b] = self.ends(h);
            Some(h) != entered && orientation(a, b, to) == Orientation::Right
        };
        let mut candidates = face.half_edges().into_iter().filter(|&h| beyond(h));
        let first = candidates.next()?;
        let Some(second) = candidates.next() else { return Some(first) };
        // Both edges face the target: the line passes on one side of the vertex that they share.
        let (before, after) = if first.next() == second { (first, second) } else { (second, first) };
        let shared = self.position(self.topology.origin(after));
        let shared_is_right = orientation(start, to, shared) == Orientation::Right;
        Some(if shared_is_right { after } else { before })
    }

    /// Where exactly in a closed face that holds it a point lies.
    fn classify(&self, face: FaceId, p: Point) -> Location {
        let on_line = |h: &HalfEdge| {
            let [a, b] = self.ends(*h);
            orientation(a, b, p) == Orientation::Collinear
        };
        let mut touched = face.half_edges().into_iter().filter(on_line);
        match (touched.next(), touched.next()) {
            (None, _) => Location::Face(face),
            (Some(h), None) => Location::Edge(h),
            (Some(h), Some(k)) => {
                let shared = if h.next() == k { k } else { h };
                Location::Vertex(self.topology.origin(shared))
            }
        }
    }

    /// Exhaustive search, for when a walk went astray.
    fn search(&self, p: Point) -> Option<Location> {
        self.topology.faces().find(|&f| holds(self.triangle(f), p)).map(|f| self.classify(f, p))
    }
}
