//! What a change of some stars does to the agreement of all.

use super::star::{Star, has};
use super::star_set::Stars;
use crate::triangulation::{VertexId, smallest_first};
use std::collections::{BTreeMap, BTreeSet};

/// The stars of some vertices as they were.
pub(super) struct Before(BTreeMap<VertexId, Star>);

impl Before {
    /// Notes stars that are going to change.
    pub(super) fn of(stars: &Stars, dirty: impl IntoIterator<Item = VertexId>) -> Self {
        Self(dirty.into_iter().map(|v| (v, stars.by_vertex[v.index()].clone())).collect())
    }

    /// Puts them back.
    pub(super) fn restore(self, stars: &mut Stars) {
        for (v, star) in self.0 {
            stars.by_vertex[v.index()] = star;
        }
    }

    /// On how many of the simplices that changed, or may have, stars disagreed, and on how many they do now.
    pub(super) fn disagreements(&self, now: &Stars) -> [usize; 2] {
        let both = |(&v, star): (&VertexId, &Star)| -> Vec<[VertexId; 3]> {
            let spokes = star.iter().chain(&now.by_vertex[v.index()]);
            spokes.map(|spoke| smallest_first([v, spoke.ends[0], spoke.ends[1]])).collect()
        };
        let touched: BTreeSet<[VertexId; 3]> = self.0.iter().flat_map(both).collect();
        let had = |v, ends| self.0.get(&v).map_or_else(|| now.has(v, ends), |star| has(star, ends));
        let holders = |[a, b, c]: [VertexId; 3], has: &dyn Fn(VertexId, [VertexId; 2]) -> bool| {
            [has(a, [b, c]), has(b, [c, a]), has(c, [a, b])].iter().filter(|&&has| has).count()
        };
        let disagreed = |has: &dyn Fn(VertexId, [VertexId; 2]) -> bool| {
            touched.iter().filter(|&&corners| (1..3).contains(&holders(corners, has))).count()
        };
        [disagreed(&had), disagreed(&|v, ends| now.has(v, ends))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::steiner::Steiner;
    use crate::geometry::{Point, Tensor};
    use crate::manifold::domain::Domain;
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
        assert_eq!(before.disagreements(&stars), [0, 0]);
        stars.by_vertex[first.index()].pop().unwrap();
        assert_eq!(before.disagreements(&stars), [0, 1]);
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
