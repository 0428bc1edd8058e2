//! Flips on a topology, in rounds, whose tests run in parallel.

use super::{Judge, Rdt};
use crate::geodesic::Margin;
use crate::in_circle::{LEVELS, Quad, RESOLUTION};
use crate::triangulation::{HalfEdge, Rounds, Triangulation, flip_in_rounds};

/// How often one slot is flipped at most: on a test that is certain, and on one that is not. Tests that contradict each other
/// must not go on for ever.
const FLIPS_PER_SLOT: [u8; 2] = [20, 3];

impl<J: Judge> Rdt<J> {
    /// Flips until every test agrees: first on what one tensor says with certainty, so that few geodesics are asked for
    /// that are not going to stay, then on everything.
    pub(super) fn settle(&mut self) {
        for last in [0, LEVELS - 1] {
            self.flips_of_slot.fill(0);
            self.counters.flips += flip_in_rounds(&mut UpTo { rdt: self, last }, usize::MAX);
        }
        let found = self.memory.tests.counters;
        (self.counters.tests, self.counters.paths, self.counters.vetoed) = (found.tests, found.paths, found.vetoed);
        self.store_lengths();
    }

    /// Whether the other diagonal joins two different seeds that no edge joins yet.
    fn may_flip(&self, h: HalfEdge) -> bool {
        let Some(quad) = self.quad(h) else { return false };
        let (c, t) = (self.topology.apex(h), self.topology.twin(h));
        let is_there = |e: HalfEdge| [e, e.next()].into_iter().any(|e| self.seed(self.topology.target(e)) == quad.d);
        quad.c != quad.d && t.is_some() && !self.topology.star(c).any(is_there)
    }

    fn is_circling(&self, h: HalfEdge, last: usize) -> bool {
        let is_certain = self.tested(h, last).is_some_and(|tested| tested.margin.is_certain());
        self.flips_of_slot[h.index()] >= FLIPS_PER_SLOT[usize::from(!is_certain)]
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

/// Tests up to a level.
struct UpTo<'a, J> {
    rdt: &'a mut Rdt<J>,
    last: usize,
}

impl<J: Judge> Rounds for UpTo<'_, J> {
    fn topology(&self) -> &Triangulation {
        &self.rdt.topology
    }

    fn wanted(&mut self, edges: &[HalfEdge]) -> Vec<(f64, HalfEdge)> {
        let (rdt, last) = (&mut *self.rdt, self.last);
        let (edges, quads): (Vec<HalfEdge>, Vec<Quad>) = edges.iter().filter_map(|&h| Some((h, rdt.quad(h)?))).unzip();
        let found = rdt.memory.tests.test(&rdt.judge, &quads, last);
        let margins = edges.into_iter().zip(found).filter_map(|(h, tested)| Some((tested?.margin, h)));
        margins.filter(|(margin, _)| rdt.wants_flip(*margin, last > 0)).map(|(margin, h)| (margin.value, h)).collect()
    }

    fn flip(&mut self, h: HalfEdge) -> bool {
        let rdt = &mut *self.rdt;
        let [blocked, circling] = [!rdt.may_flip(h), rdt.is_circling(h, self.last)];
        if blocked || circling {
            rdt.counters.blocked += u64::from(blocked && self.last > 0);
            rdt.counters.circling += u64::from(circling && !blocked && self.last > 0);
            return false;
        }
        rdt.flips_of_slot[h.index()] += 1;
        rdt.topology.flip(h);
        true
    }
}
