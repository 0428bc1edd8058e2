//! Distances from one source on a part of the canvas, without regard for other sources.

use super::Patches;
use super::update::Crossing;
use crate::triangulation::{HalfEdge, Triangulation, VertexId};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

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
    heap: BinaryHeap<Reached>,
}

const OUTSIDE: u32 = u32::MAX;

impl<'a> PatchSolver<'a> {
    /// A solver on a canvas.
    pub(super) fn new(canvas: &'a Triangulation) -> Self {
        let slots = vec![OUTSIDE; canvas.vertex_slots()];
        Self { canvas, slots, distances: Vec::new(), heap: BinaryHeap::new() }
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
        let canvas = self.canvas;
        let crossing = Crossing {
            base: canvas.length(h),
            from_start: canvas.length(h.prev()),
            from_end: canvas.length(h.next()),
            at_start: self.distance(canvas.origin(h)),
            at_end: self.distance(canvas.target(h)),
        };
        if crossing.at_start.is_finite() && crossing.at_end.is_finite() { crossing.circular() } else { None }
    }

    fn offer(&mut self, vertex: VertexId, distance: Option<f64>) {
        let (Some(distance), Some(old)) = (distance, self.distances.get_mut(self.slots[vertex.index()] as usize))
        else {
            return;
        };
        if distance < *old * (1.0 - ROUNDING) {
            *old = distance;
            self.heap.push(Reached { distance, vertex });
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
        let mut budget = patch.len() * ROUNDS;
        while let Some(Reached { distance, vertex }) = self.heap.pop() {
            if self.distance(vertex) < distance {
                continue;
            }
            self.spread(vertex);
            budget -= 1;
            if budget == 0 {
                self.heap.clear();
            }
        }
        for v in patch {
            self.slots[v.index()] = OUTSIDE;
        }
        std::mem::take(&mut self.distances)
    }
}

/// A heap entry; the nearest is the greatest.
#[derive(PartialEq)]
struct Reached {
    distance: f64,
    vertex: VertexId,
}

impl Eq for Reached {}
impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Reached {
    fn cmp(&self, other: &Self) -> Ordering {
        other.distance.total_cmp(&self.distance).then(other.vertex.cmp(&self.vertex))
    }
}
