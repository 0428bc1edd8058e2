//! Flips of an embedded triangulation by one tensor for each quadrilateral, the mean of its corners'.

use crate::geodesic::frozen_margin;
use crate::geometry::Tensor;
use crate::planar::Planar;
use crate::triangulation::{FaceId, Flipping, HalfEdge, Limit, Triangulation, VertexId};

/// The test must be violated by more than this (sine of the angles' sum) for a flip: tests of neighbouring quadrilaterals with
/// different tensors contradict each other near zero.
const CLEARLY: f64 = 1e-2;
/// Flips after one insertion at most; measured was a little more than one in the mean.
pub(super) const LIMIT: Limit = Limit::OfAll(64);

/// A triangulation that flips by the tensors at its vertices.
pub(super) struct Frozen<'a> {
    pub(super) planar: &'a mut Planar,
    /// One per vertex slot.
    pub(super) tensors: &'a [Tensor],
    /// Only edges opposite to this vertex follow.
    pub(super) around: Option<VertexId>,
    /// Faces that were flipped are added here.
    pub(super) changed: &'a mut Vec<FaceId>,
}

impl Flipping for Frozen<'_> {
    fn topology(&mut self) -> &mut Triangulation {
        &mut self.planar.topology
    }

    fn wants_flip(&mut self, h: HalfEdge) -> bool {
        let Some(quad) = self.planar.topology.quad(h).filter(|_| !self.planar.topology.is_fixed(h)) else {
            return false;
        };
        let mean = quad.iter().fold(Tensor::default(), |sum, v| sum + self.tensors[v.index()]) * 0.25;
        let [a, b, c, d] = quad.map(|v| self.planar.position(v));
        frozen_margin(mean, [a - c, b - c], [b - d, a - d]) <= -CLEARLY && self.planar.is_convex(h)
    }

    fn flip(&mut self, h: HalfEdge) {
        self.changed.extend(self.planar.topology.sides(h).map(HalfEdge::face));
        self.planar.topology.flip(h);
    }

    fn follows(&self, h: HalfEdge) -> bool {
        self.around.is_none_or(|v| self.planar.topology.apex(h) == v)
    }
}
