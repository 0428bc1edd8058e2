//! What a change of some stars does to the agreement of all.

use super::star::Star;
use super::star_set::Stars;
use crate::triangulation::{VertexId, smallest_first};
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
            touched.extend(both.map(|spoke| smallest_first([v, spoke.ends[0], spoke.ends[1]])));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::steiner::Steiner;
    use crate::domain::Domain;
    use crate::geometry::{Point, Tensor};
    use crate::metric::Uniform;

    #[test]
    fn a_simplex_that_one_star_loses_is_counted_once_and_comes_back() {
        let square = Domain::shape("rect:0,0,1,1").unwrap();
        let metric = Uniform(Tensor::isotropic(1.0));
        let mut stars = Stars::new(Steiner::metric(square.planar().clone(), &metric).unwrap());
        let first = stars.steiner.planar.topology.vertices().next().unwrap();
        stars.place(first, Point::new(0.4, 0.45), 1.0).unwrap();
        stars.update_all();
        let whole = stars.by_vertex.clone();
        let before = Before::of(&stars, [first]);
        assert_eq!(before.change(&stars), Change { before: 0, after: 0 });
        stars.by_vertex[first.index()].pop().unwrap();
        assert_eq!(before.change(&stars), Change { before: 0, after: 1 });
        before.restore(&mut stars);
        assert_eq!(stars.by_vertex, whole);
    }

    #[test]
    fn turns_of_a_triangle_are_one() {
        let [a, b, c] = [3, 7, 9].map(VertexId);
        for turn in [[a, b, c], [b, c, a], [c, a, b]] {
            assert_eq!(smallest_first(turn), [a, b, c]);
        }
        assert_eq!(smallest_first([c, b, a]), [a, c, b]);
    }
}
