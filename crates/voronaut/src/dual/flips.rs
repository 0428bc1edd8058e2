//! Lawson's flips by the metric in-circle test, on a triangulation that stays embedded.

use super::{Dual, Effort};
use crate::triangulation::{HalfEdge, VertexId};

/// Margins closer to zero than this are ties: flipping them gains nothing and could go on for ever.
const TIE: f64 = 1e-9;

/// Edges flipped per edge examined before a pass gives up: inconsistent lengths can make flips cycle, and honest
/// passes were seen to need fewer than three.
const FLIPS_PER_EDGE: u64 = 10;

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

    /// Edges that the metric wants flipped and the plane forbids, with their margins.
    pub fn blocked_flips(&mut self) -> Vec<(HalfEdge, f64)> {
        let edges: Vec<HalfEdge> =
            self.planar.topology.edges().filter(|&h| !self.planar.topology.is_fixed(h)).collect();
        let mut blocked = Vec::new();
        for h in edges {
            let margin = self.margin(h, Effort::Full);
            if margin.value < -TIE && margin.is_certain() && !self.planar.is_convex(h) {
                blocked.push((h, margin.value));
            }
        }
        blocked
    }

    /// The smallest margin among all edges that could be flipped; `None` of none.
    pub fn smallest_margin(&mut self) -> Option<f64> {
        let edges: Vec<HalfEdge> =
            self.planar.topology.edges().filter(|&h| !self.planar.topology.is_fixed(h)).collect();
        edges.into_iter().map(|h| self.margin(h, Effort::Full).value).reduce(f64::min)
    }

    fn flip_stacked(&mut self, effort: Effort) -> u64 {
        let budget = FLIPS_PER_EDGE * self.stack.len() as u64;
        let mut flips = 0;
        while let Some(h) = self.stack.pop() {
            if self.planar.topology.is_fixed(h) || self.margin(h, effort).value >= -TIE || !self.planar.is_convex(h) {
                continue;
            }
            if flips == budget {
                self.stack.clear();
                break;
            }
            self.flip(h);
            flips += 1;
        }
        flips
    }

    fn flip(&mut self, h: HalfEdge) {
        let t = self.planar.topology.twin(h).expect("not fixed");
        self.planar.topology.flip(h);
        self.counters.flips += 1;
        self.touched.extend([h.face(), t.face()]);
        self.stack.extend([h.next(), h.prev(), t.next(), t.prev()]);
    }
}
