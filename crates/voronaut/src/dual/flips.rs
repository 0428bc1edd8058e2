//! Lawson's flips by the metric in-circle test, on a triangulation that stays embedded.

use super::{Dual, Effort, Margin};
use crate::geometry::signed_area;
use crate::triangulation::{HalfEdge, VertexId};

/// Margins closer to zero than this are ties: flipping them gains nothing and could go on for ever.
const TIE: f64 = 1e-9;

/// How often one pass flips the edge in one slot: inconsistent tests can make flips go round in a circle, which must
/// neither last for ever nor keep the rest of the mesh from its flips.
const FLIPS_PER_SLOT: u8 = 6;

/// A flip may not make a triangle smaller than this share of the smaller one before: where lengths of straight edges
/// contradict each other it would leave slivers.
const FLATTEST: f64 = 0.1;

impl Dual<'_> {
    /// Flips every edge that the metric wants flipped and the plane allows. Returns the number of flips.
    pub fn flip_all(&mut self, effort: Effort) -> u64 {
        let edges: Vec<HalfEdge> = self.planar.topology.edges().collect();
        self.stack.extend(edges);
        self.flip_stacked(effort)
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

    fn free_edges(&self) -> impl Iterator<Item = HalfEdge> + '_ {
        self.planar.topology.edges().filter(|&h| !self.planar.topology.is_fixed(h))
    }

    fn flip_stacked(&mut self, effort: Effort) -> u64 {
        let mut flipped: Vec<HalfEdge> = Vec::new();
        while let Some(h) = self.stack.pop() {
            if self.planar.topology.is_fixed(h) || self.margin(h, effort).value >= -TIE || !self.allows_flip(h) {
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

    /// Whether the plane allows a flip: the quadrilateral is strictly convex, and the flip leaves no triangle that is
    /// next to nothing beside both triangles of before.
    fn allows_flip(&self, h: HalfEdge) -> bool {
        let Some(t) = self.planar.topology.twin(h) else { return false };
        let [a, b] = self.planar.ends(h);
        let [c, d] = [h, t].map(|e| self.planar.position(self.planar.topology.apex(e)));
        let before = signed_area(a, b, c).min(signed_area(b, a, d));
        let after = signed_area(d, b, c).min(signed_area(c, a, d));
        after > FLATTEST * before && self.planar.is_convex(h)
    }

    fn flip(&mut self, h: HalfEdge) {
        let t = self.planar.topology.twin(h).expect("not fixed");
        self.planar.topology.flip(h);
        self.counters.flips += 1;
        self.touched.extend([h.face(), t.face()]);
        self.stack.extend([h.next(), h.prev(), t.next(), t.prev()]);
    }
}
