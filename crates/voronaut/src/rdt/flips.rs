//! Lawson's flips on a topology, in rounds: tests in parallel, then flips of edges that share no triangle.

use super::judge::{Judge, LEVELS, RESOLUTION};
use super::{Rdt, Tested};
use crate::geodesic::Margin;
use crate::triangulation::HalfEdge;

/// How often one slot is flipped at most: on a test that is certain, and on one that is not. Tests that contradict each other
/// must not go on for ever.
const FLIPS_PER_SLOT: [u8; 2] = [20, 3];

impl<J: Judge> Rdt<J> {
    /// Flips until every test agrees: first on what one tensor says with certainty, so that few geodesics are asked for
    /// that are not going to stay, then on everything.
    pub(super) fn settle(&mut self) {
        self.flip_rounds(0);
        self.flips_of_slot.fill(0);
        self.flip_rounds(LEVELS - 1);
        self.store_lengths();
    }

    fn flip_rounds(&mut self, last: usize) {
        let mut work: Vec<HalfEdge> = self.topology.edges().collect();
        while !work.is_empty() {
            self.test(&work, last);
            let mut wanted: Vec<(HalfEdge, Tested)> =
                work.iter().filter_map(|&h| Some((h, self.tested[h.index()]?))).collect();
            wanted.retain(|(_, t)| self.wants_flip(t.margin, last > 0));
            wanted.sort_by(|a, b| a.1.margin.value.total_cmp(&b.1.margin.value).then(a.0.cmp(&b.0)));
            work = self.flip_apart(&wanted, last > 0);
        }
    }

    /// Flips those edges, in this order, whose triangles no flip before has changed. Returns the edges to test anew.
    fn flip_apart(&mut self, wanted: &[(HalfEdge, Tested)], is_final: bool) -> Vec<HalfEdge> {
        let mut changed = vec![false; self.topology.face_slots()];
        let mut work = Vec::new();
        for &(h, tested) in wanted {
            let Some(t) = self.topology.twin(h) else { continue };
            if changed[h.face().index()] || changed[t.face().index()] {
                // Its slot may hold another edge by now; whichever it is, it is among the edges of a changed triangle.
                continue;
            }
            let [blocked, circling] = [!self.may_flip(h), self.is_circling(h, tested)];
            if blocked || circling {
                self.counters.blocked += u64::from(blocked && is_final);
                self.counters.circling += u64::from(circling && !blocked && is_final);
                continue;
            }
            self.flips_of_slot[h.index()] += 1;
            self.topology.flip(h);
            self.counters.flips += 1;
            changed[h.face().index()] = true;
            changed[t.face().index()] = true;
            work.extend(h.face().half_edges().into_iter().chain(t.face().half_edges()));
        }
        let canonical = |h: HalfEdge| self.topology.twin(h).map_or(h, |t| h.min(t));
        let mut work: Vec<HalfEdge> = work.into_iter().map(canonical).collect();
        work.sort_unstable();
        work.dedup();
        for h in &work {
            self.tested[h.index()] = None;
        }
        work
    }

    /// Whether the other diagonal joins two different seeds that no edge joins yet.
    fn may_flip(&self, h: HalfEdge) -> bool {
        let Some(quad) = self.quad(h) else { return false };
        let (c, t) = (self.topology.apex(h), self.topology.twin(h));
        let is_there = |e: HalfEdge| [e, e.next()].into_iter().any(|e| self.seed(self.topology.target(e)) == quad.d);
        quad.c != quad.d && t.is_some() && !self.topology.star(c).any(is_there)
    }

    fn is_circling(&self, h: HalfEdge, tested: Tested) -> bool {
        let limit = FLIPS_PER_SLOT[usize::from(!tested.margin.is_certain())];
        self.flips_of_slot[h.index()] >= limit
    }

    /// Puts the lengths that are known on the half-edges.
    fn store_lengths(&mut self) {
        for h in self.topology.edges().collect::<Vec<_>>() {
            let (i, j) = (self.seed(self.topology.origin(h)), self.seed(self.topology.target(h)));
            if let Some(length) = self.length(i, j) {
                self.topology.set_length(h, length.value);
            }
        }
    }

    /// Whether a test asks for a flip: with certainty, or at the end by its best estimate; four seeds on a circle do not.
    fn wants_flip(&self, margin: Margin, is_final: bool) -> bool {
        let is_followed = is_final && margin.error > RESOLUTION && margin.error <= self.judge.doubt();
        margin.value < 0.0 && (margin.is_certain() || is_followed)
    }
}
