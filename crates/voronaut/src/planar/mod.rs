//! A triangulation embedded in the plane: every living face is counter-clockwise, by exact predicates, at every moment.

mod constrain;
mod delaunay;
mod halve;
mod locate;
mod operations;
mod order;

pub use constrain::Crossing;
pub use delaunay::delaunay;
pub(crate) use locate::Location;
pub(crate) use order::hilbert_order;

use crate::geometry::{Aabb, Orientation, Point, orientation, signed_area};
use crate::parallel::copy_over;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};

/// A triangulation and the position of each of its vertices.
#[derive(Clone, Debug, Default)]
pub struct Planar {
    /// Topology, lengths, constraints.
    pub topology: Triangulation,
    /// Position of each vertex slot.
    pub positions: Vec<Point>,
}

impl Planar {
    /// Becomes another one, in the memory that this one has.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.topology.copy_from(&other.topology);
        copy_over(&mut self.positions, &other.positions);
    }

    /// The position of a vertex.
    pub(crate) fn position(&self, v: VertexId) -> Point {
        self.positions[v.index()]
    }

    /// The positions of a face's corners, counter-clockwise.
    pub fn triangle(&self, f: FaceId) -> [Point; 3] {
        self.topology.corners(f).map(|v| self.position(v))
    }

    /// The positions of a half-edge's ends.
    pub(crate) fn ends(&self, h: HalfEdge) -> [Point; 2] {
        self.topology.ends(h).map(|v| self.position(v))
    }

    /// The face at a vertex that the straight way to a point enters (one of two where that is along an edge); `None` where
    /// it leaves the triangulation.
    pub(crate) fn face_towards(&self, v: VertexId, p: Point) -> Option<FaceId> {
        let at = self.position(v);
        let is_left = |a: VertexId, b: Point| orientation(at, self.position(a), b) != Orientation::Right;
        let holds = |h: &HalfEdge| {
            let apex = self.topology.apex(*h);
            is_left(self.topology.target(*h), p) && orientation(at, self.position(apex), p) != Orientation::Left
        };
        self.topology.star(v).find(holds).map(HalfEdge::face)
    }

    /// The Euclidean area of all faces.
    pub(crate) fn area(&self) -> f64 {
        self.topology.faces().map(|f| self.triangle(f)).map(|[a, b, c]| 0.5 * signed_area(a, b, c)).sum()
    }

    /// The edges with a face on one side only: the outline of what is covered.
    pub(crate) fn boundary(&self) -> Vec<(Point, Point)> {
        self.topology.borders().map(|h| self.ends(h).into()).collect()
    }

    /// The corners of all faces.
    pub(crate) fn triangles(&self) -> Vec<[Point; 3]> {
        self.topology.faces().map(|f| self.triangle(f)).collect()
    }

    /// The smallest axis-aligned box around all faces; `None` without any.
    pub(crate) fn bounds(&self) -> Option<Aabb> {
        Aabb::of(self.topology.vertices().map(|v| self.position(v)))
    }

    /// Whether the edge has two faces that form a strictly convex quadrilateral: a flip keeps the embedding.
    pub(crate) fn is_convex(&self, h: HalfEdge) -> bool {
        let Some(quad) = self.topology.quad(h) else { return false };
        let [a, b, c, d] = quad.map(|v| self.position(v));
        orientation(d, b, c) == Orientation::Left && orientation(c, a, d) == Orientation::Left
    }

    /// The positions of the two neighbours along the constraint that a vertex is in the middle of; `None` where there are
    /// none.
    pub(crate) fn neighbours_on_segment(&self, v: VertexId) -> Option<[Point; 2]> {
        let mut ends = self.topology.along_fixed(v);
        let (first, second) = (ends.next()?, ends.next()?);
        Some([self.position(first), self.position(second)])
    }

    /// Whether every face is counter-clockwise.
    pub(crate) fn is_embedded(&self) -> bool {
        self.topology.faces().map(|f| self.triangle(f)).all(|[a, b, c]| orientation(a, b, c) == Orientation::Left)
    }
}

/// Whether a triangle is counter-clockwise.
fn is_left(a: Point, b: Point, c: Point) -> bool {
    orientation(a, b, c) == Orientation::Left
}
