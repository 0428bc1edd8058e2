//! The filtered in-circle test: each level costs more and errs less, and runs only where the one before cannot tell.

use super::judge::{Judge, Quad, RESOLUTION};
use super::{Rdt, Tested};
use crate::geodesic::Margin;
use crate::triangulation::HalfEdge;
use rayon::prelude::*;

impl<J: Judge> Rdt<J> {
    /// The quadrilateral around an edge with two triangles.
    pub(super) fn quad(&self, h: HalfEdge) -> Option<Quad> {
        let [a, b, c, d] = self.topology.quad(h)?.map(|v| self.seed(v));
        Some(Quad { a, b, c, d })
    }

    /// Tests edges, in parallel, level by level, up to and including `last`; stores and returns the outcomes.
    pub(super) fn test(&mut self, edges: &[HalfEdge], last: usize) {
        let mut pending: Vec<(HalfEdge, Quad)> = edges.iter().filter_map(|&h| Some((h, self.quad(h)?))).collect();
        pending.retain(|(h, quad)| {
            let known = self.memory.test(quad);
            self.tested[h.index()] = known.or(self.tested[h.index()]);
            known.is_none()
        });
        for level in 0..=last {
            let (tested, passed): (Vec<_>, Vec<_>) = pending.into_iter().partition(|(h, quad)| {
                self.judge.may_tell(quad, level, &self.lengths, self.tested[h.index()].map(|t| t.level))
            });
            if self.judge.is_by_lengths(level) {
                self.solve_for(&tested, level);
            }
            let (judge, lengths) = (&self.judge, &self.lengths);
            let outcomes: Vec<Margin> =
                tested.par_iter().with_min_len(16).map(|(_, quad)| judge.margin(quad, level, lengths)).collect();
            pending = passed;
            for ((h, quad), margin) in tested.into_iter().zip(outcomes) {
                if !self.settles(h, margin, level) {
                    pending.push((h, quad));
                }
            }
        }
        for (h, _) in pending {
            self.counters.tests[self.tested[h.index()].map_or(0, |t| t.level)] += 1;
        }
    }

    /// Keeps the outcome of a level unless the one before was better; says whether that is all that is to be known.
    fn settles(&mut self, h: HalfEdge, margin: Margin, level: usize) -> bool {
        self.keep(h, margin, level);
        let is_settled = margin.is_certain() || margin.error < RESOLUTION;
        self.counters.tests[level] += u64::from(is_settled);
        is_settled
    }

    /// Keeps the outcome of a level unless the one before was better.
    fn keep(&mut self, h: HalfEdge, margin: Margin, level: usize) {
        let known = &mut self.tested[h.index()];
        if level == 0 || known.is_none_or(|k| margin.error < k.margin.error) {
            *known = Some(Tested { margin, level });
        }
    }

    /// Solves, in parallel, for the lengths that quadrilaterals lack at a level.
    fn solve_for(&mut self, pending: &[(HalfEdge, Quad)], level: usize) {
        let is_lacking =
            |pair: &(u32, u32)| self.lengths.get(pair).is_none_or(|known| known.level < level && !known.is_vetoed);
        let mut pairs: Vec<(u32, u32)> = pending.iter().flat_map(|(_, quad)| quad.pairs()).filter(is_lacking).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let judge = &self.judge;
        let solved: Vec<Option<super::Known>> =
            pairs.par_iter().with_min_len(16).map(|&(i, j)| judge.solve(i, j, level)).collect();
        self.counters.paths += pairs.len() as u64;
        for (pair, known) in pairs.into_iter().zip(solved) {
            if let Some(known) = known {
                self.counters.vetoed += u64::from(known.is_vetoed);
                self.lengths.insert(pair, known);
            }
        }
    }
}
