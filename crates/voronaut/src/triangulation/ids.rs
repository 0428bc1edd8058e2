//! Ids of what a triangulation is made of: plain `u32`, told apart by type.

/// The id that no slot has.
pub(super) const NONE: u32 = u32::MAX;

/// A vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct VertexId(pub u32);

/// A face (triangle).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceId(pub u32);

/// One side of an edge: it belongs to the face on its left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct HalfEdge(pub u32);

/// A piece of the user's boundary or features; what it means is the domain's affair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Constraint(pub u32);

impl VertexId {
    /// As an array index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl FaceId {
    /// As an array index.
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }

    /// The three half-edges of the face, counter-clockwise.
    pub(crate) fn half_edges(self) -> [HalfEdge; 3] {
        [3 * self.0, 3 * self.0 + 1, 3 * self.0 + 2].map(HalfEdge)
    }
}

impl HalfEdge {
    /// As an array index.
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }

    /// The face on the left.
    pub(crate) fn face(self) -> FaceId {
        FaceId(self.0 / 3)
    }

    /// The next half-edge of the face, counter-clockwise.
    #[must_use]
    pub(crate) fn next(self) -> HalfEdge {
        HalfEdge(if self.0 % 3 == 2 { self.0 - 2 } else { self.0 + 1 })
    }

    /// The previous half-edge of the face.
    #[must_use]
    pub(crate) fn prev(self) -> HalfEdge {
        HalfEdge(if self.0.is_multiple_of(3) { self.0 + 2 } else { self.0 - 1 })
    }
}
