//! Walking around a vertex.

use super::{HalfEdge, Triangulation, VertexId};

/// The half-edges that leave a vertex, counter-clockwise. See [`Triangulation::star`].
#[derive(Clone)]
pub(crate) struct Star<'a> {
    triangulation: &'a Triangulation,
    first: Option<HalfEdge>,
    next: Option<HalfEdge>,
}

impl<'a> Star<'a> {
    pub(super) fn new(triangulation: &'a Triangulation, v: VertexId) -> Self {
        let first = triangulation.start(v);
        Self { triangulation, first, next: first }
    }
}

impl Iterator for Star<'_> {
    type Item = HalfEdge;

    fn next(&mut self) -> Option<HalfEdge> {
        let h = self.next?;
        self.next = self.triangulation.twin(h.prev()).filter(|&n| Some(n) != self.first);
        Some(h)
    }
}
