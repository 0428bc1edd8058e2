//! Lawson's flips by the metric in-circle test, on a triangulation that stays embedded.

use super::margin::pair;
use super::{Dual, Effort, Margin};
use crate::geometry::Tensor;
use crate::triangulation::{HalfEdge, VertexId};

/// Margins closer to zero than this are ties: flipping them gains nothing and could go on for ever.
const TIE: f64 = 1e-9;

/// How often one pass flips the edge in one slot: inconsistent tests can make flips go round in a circle, which must
/// neither last for ever nor keep the rest of the mesh from its flips.
const FLIPS_PER_SLOT: u8 = 6;

/// A flip may not leave a triangle whose quality is below this if both were better before: where lengths of straight
/// edges contradict each other, or geodesics bend away from them, it would leave slivers.
const POOR: f64 = 0.5;

impl Dual<'_> {
    /// Flips every edge that the metric wants flipped and the plane allows. Returns the number of flips.
    pub fn flip_all(&mut self, effort: Effort) -> u64 {
        let before = self.counters.flips;
        if effort == Effort::Full {
            // Cheap flips first: few margins are then left to be measured one by one.
            self.flip_all(Effort::Chord);
            self.measure_margins();
        }
        let edges: Vec<HalfEdge> = self.planar.topology.edges().collect();
        self.stack.extend(edges);
        self.flip_stacked(effort);
        self.counters.flips - before
    }

    /// Flips around a vertex and onwards.
    pub fn flip_around(&mut self, v: VertexId, effort: Effort) -> u64 {
        let star = self.planar.topology.star(v).flat_map(|h| [h, h.next()]);
        self.stack.extend(star);
        self.flip_stacked(effort)
    }

    /// Edges that the metric wants flipped and the plane forbids, with their margins, certain or not.
    pub fn blocked_flips(&mut self, effort: Effort) -> Vec<(HalfEdge, Margin)> {
        let forbidden: Vec<HalfEdge> = self.free_edges().filter(|&h| !self.allows_flip(h)).collect();
        let with_margin = forbidden.into_iter().map(|h| (h, self.margin(h, effort)));
        with_margin.filter(|(_, margin)| margin.value < -TIE).collect()
    }

    /// The smallest margin among all edges that are not constrained; `None` of none.
    pub fn smallest_margin(&mut self, effort: Effort) -> Option<f64> {
        let edges: Vec<HalfEdge> = self.free_edges().collect();
        edges.into_iter().map(|h| self.margin(h, effort).value).reduce(f64::min)
    }

    /// The edges that a flip may remove.
    pub(super) fn free_edges(&self) -> impl Iterator<Item = HalfEdge> + '_ {
        self.planar.topology.edges().filter(|&h| !self.planar.topology.is_fixed(h) && !self.is_held(h))
    }

    pub(super) fn is_held(&self, h: HalfEdge) -> bool {
        let topology = &self.planar.topology;
        !self.known.held.is_empty() && self.known.held.contains(&pair(topology.origin(h), topology.target(h)))
    }

    fn flip_stacked(&mut self, effort: Effort) -> u64 {
        let mut flipped: Vec<HalfEdge> = Vec::new();
        while let Some(h) = self.stack.pop() {
            if self.planar.topology.is_fixed(h)
                || self.is_held(h)
                || self.margin(h, effort).value >= -TIE
                || !self.allows_flip(h)
            {
                continue;
            }
            let slot = self.planar.topology.twin(h).map_or(h, |t| h.min(t));
            self.flips_of_slot.resize(3 * self.planar.topology.face_slots(), 0);
            let count = &mut self.flips_of_slot[slot.index()];
            if *count < FLIPS_PER_SLOT {
                *count += 1;
                flipped.push(slot);
                self.flip(h);
            }
        }
        for slot in &flipped {
            self.flips_of_slot[slot.index()] = 0;
        }
        flipped.len() as u64
    }

    /// Whether the plane allows a flip: the quadrilateral is strictly convex, and the flip leaves no straight triangle
    /// that is poor in the metric and poorer than both of before.
    pub(super) fn allows_flip(&self, h: HalfEdge) -> bool {
        let topology = self.topology();
        let Some(t) = topology.twin(h).filter(|_| self.planar.is_convex(h)) else { return false };
        let [a, b, c, d] = [topology.origin(h), topology.target(h), topology.apex(h), topology.apex(t)];
        let after = self.shape([d, b, c]).min(self.shape([c, a, d]));
        after > POOR || after > self.shape([a, b, c]).min(self.shape([b, a, d]))
    }

    /// Quality of a straight triangle in the mean tensor of its corners: 1 of an equilateral one.
    pub(super) fn shape(&self, corners: [VertexId; 3]) -> f64 {
        let tensor = corners.iter().fold(Tensor::default(), |sum, &v| sum + self.local(v).tensor) * (1.0 / 3.0);
        tensor.shape(corners.map(|v| self.position(v)))
    }

    fn flip(&mut self, h: HalfEdge) {
        let t = self.planar.topology.twin(h).expect("not fixed");
        self.planar.topology.flip(h);
        self.counters.flips += 1;
        self.touched.extend([h.face(), t.face()]);
        self.stack.extend([h.next(), h.prev(), t.next(), t.prev()]);
    }
}
