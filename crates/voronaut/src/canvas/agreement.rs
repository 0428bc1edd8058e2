//! What a change of some stars does to the agreement of all.

use super::star::Star;
use super::star_set::Stars;
use crate::triangulation::VertexId;
use std::collections::{BTreeMap, BTreeSet};

/// The stars of some vertices as they were.
pub(super) struct Before {
    stars: BTreeMap<VertexId, Star>,
}

/// Simplices that stars disagree on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Change {
    /// Before the change, of those that it touches.
    pub(super) before: usize,
    /// After it.
    pub(super) after: usize,
}

impl Before {
    /// Notes stars that are going to change.
    pub(super) fn of(stars: &Stars, dirty: impl IntoIterator<Item = VertexId>) -> Self {
        Self { stars: dirty.into_iter().map(|v| (v, stars.by_vertex[v.index()].clone())).collect() }
    }

    /// Puts them back.
    pub(super) fn restore(self, stars: &mut Stars) {
        for (v, star) in self.stars {
            stars.by_vertex[v.index()] = star;
        }
    }

    /// The simplices that changed, or may have, and on which stars disagree, before and after.
    pub(super) fn change(&self, now: &Stars) -> Change {
        let mut touched: BTreeSet<[VertexId; 3]> = BTreeSet::new();
        for (&v, star) in &self.stars {
            let both = star.iter().chain(&now.by_vertex[v.index()]);
            touched.extend(both.map(|spoke| first_smallest([v, spoke.ends[0], spoke.ends[1]])));
        }
        let mut change = Change::default();
        for corners in touched {
            let turns = [0, 1, 2].map(|i| (corners[i], [corners[(i + 1) % 3], corners[(i + 2) % 3]]));
            let holders =
                |has: &dyn Fn(VertexId, [VertexId; 2]) -> bool| turns.iter().filter(|&&(v, ends)| has(v, ends)).count();
            let had = |v: VertexId, ends: [VertexId; 2]| {
                self.stars.get(&v).map_or_else(|| now.has(v, ends), |star| star.iter().any(|s| s.ends == ends))
            };
            change.before += usize::from((1..3).contains(&holders(&had)));
            change.after += usize::from((1..3).contains(&holders(&|v, ends| now.has(v, ends))));
        }
        change
    }
}

fn first_smallest([a, b, c]: [VertexId; 3]) -> [VertexId; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}
