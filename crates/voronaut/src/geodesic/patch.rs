//! Distances from one source on a part of the canvas, without regard for other sources.

use super::front::Front;
use super::update::Crossing;
use super::{Label, Patches};
use crate::triangulation::{HalfEdge, Triangulation, VertexId};

/// Improvements by a smaller share of the distance are rounding.
const ROUNDING: f64 = 1e-12;
/// Vertices are settled at most so many times as the patch has vertices: corrections must not go on for ever.
const ROUNDS: usize = 20;

/// Solves for one patch after the other with the same memory.
///
/// Within a patch a value may be corrected after its neighbours have used it, so that (unlike in
/// [`Marching`](super::Marching)) a front may cross a face in any direction: with circular waves, distances on a flat
/// intrinsic Delaunay canvas are exact, obtuse faces or not, where the straight path stays in the patch.
pub(super) struct PatchSolver<'a> {
    canvas: &'a Triangulation,
    slots: Vec<u32>,
    distances: Vec<f64>,
    front: Front,
}

const OUTSIDE: u32 = u32::MAX;

impl<'a> PatchSolver<'a> {
    /// A solver on a canvas.
    pub(super) fn new(canvas: &'a Triangulation) -> Self {
        let vertices = canvas.vertex_slots();
        Self { canvas, slots: vec![OUTSIDE; vertices], distances: Vec::new(), front: Front::new(vertices) }
    }

    fn distance(&self, v: VertexId) -> f64 {
        self.distances.get(self.slots[v.index()] as usize).copied().unwrap_or(f64::INFINITY)
    }

    fn spread(&mut self, v: VertexId) {
        let canvas = self.canvas;
        let distance = self.distance(v);
        for h in canvas.star(v) {
            let left = h.prev();
            self.offer(canvas.target(h), Some(distance + canvas.length(h)));
            self.offer(canvas.target(h), self.across(left));
            self.offer(canvas.origin(left), self.across(h));
            if canvas.twin(left).is_none() {
                self.offer(canvas.origin(left), Some(distance + canvas.length(left)));
            }
        }
    }

    /// The distance at the apex of a half-edge's face of a path across the half-edge.
    fn across(&self, h: HalfEdge) -> Option<f64> {
        let at = self.canvas.ends(h).map(|v| self.distance(v));
        if at.iter().all(|d| d.is_finite()) { Crossing::of(self.canvas, h, at).circular() } else { None }
    }

    fn offer(&mut self, vertex: VertexId, distance: Option<f64>) {
        let (Some(distance), Some(old)) = (distance, self.distances.get_mut(self.slots[vertex.index()] as usize))
        else {
            return;
        };
        if distance < *old * (1.0 - ROUNDING) {
            *old = distance;
            self.front.set(vertex, &Label::of_source(distance, 0));
        }
    }
}

impl Patches for PatchSolver<'_> {
    fn distances(&mut self, patch: &[VertexId], starts: &[(VertexId, f64)]) -> Vec<f64> {
        for (i, v) in patch.iter().enumerate() {
            self.slots[v.index()] = i as u32;
        }
        self.distances.clear();
        self.distances.resize(patch.len(), f64::INFINITY);
        for &(v, distance) in starts {
            self.offer(v, Some(distance));
        }
        for _ in 0..patch.len() * ROUNDS {
            let Some(v) = self.front.pop() else { break };
            self.spread(v);
        }
        while self.front.pop().is_some() {}
        for v in patch {
            self.slots[v.index()] = OUTSIDE;
        }
        std::mem::take(&mut self.distances)
    }
}
