//! Changes that keep the embedding: each checks first, and does nothing where the result would not be embedded.

use super::{Planar, is_left};
use crate::geometry::Point;
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, HalfEdge, VertexId};

impl Planar {
    /// Puts a vertex strictly inside a face. `None` if rounding put the point on or beyond the face's edges.
    pub(crate) fn insert_in_face(&mut self, f: FaceId, p: Point) -> Option<VertexId> {
        let [a, b, c] = self.triangle(f);
        let inside = [(a, b), (b, c), (c, a)].iter().all(|&(u, v)| is_left(u, v, p));
        inside.then(|| {
            let v = self.add_vertex(p);
            self.topology.split_face(f, v);
            v
        })
    }

    /// Puts a vertex on an edge (or where rounding put it, next to the edge). `None` if one of the new triangles would
    /// not be counter-clockwise.
    pub(crate) fn insert_on_edge(&mut self, h: HalfEdge, p: Point) -> Option<VertexId> {
        let fits = |side: HalfEdge| {
            let [a, b] = self.ends(side);
            let c = self.position(self.topology.apex(side));
            is_left(a, p, c) && is_left(p, b, c)
        };
        (fits(h) && self.topology.twin(h).is_none_or(fits)).then(|| {
            let v = self.add_vertex(p);
            self.topology.split_edge(h, v);
            v
        })
    }

    /// Moves a vertex if all its faces stay counter-clockwise; says whether it did.
    pub(crate) fn move_vertex(&mut self, v: VertexId, to: Point) -> bool {
        let topology = &self.topology;
        let fits =
            topology.star(v).all(|h| is_left(to, self.position(topology.target(h)), self.position(topology.apex(h))));
        if fits {
            self.positions[v.index()] = to;
        }
        fits
    }

    /// Moves vertices all at once, but for those of faces that would not stay counter-clockwise; says which moved.
    pub(crate) fn move_together(&mut self, moves: &[(VertexId, Point)]) -> Vec<bool> {
        let mut to = self.positions.clone();
        let mut moving = vec![false; to.len()];
        for &(v, p) in moves {
            (to[v.index()], moving[v.index()]) = (p, true);
        }
        let at = |v: VertexId, moving: &[bool]| if moving[v.index()] { to[v.index()] } else { self.position(v) };
        let moving = self.topology.movable_together(moving, |f, moving| {
            let [a, b, c] = self.topology.corners(f).map(|v| at(v, moving));
            !is_left(a, b, c)
        });
        self.positions.par_iter_mut().zip(&to).zip(&moving).with_min_len(1024).for_each(|((position, &to), &moves)| {
            if moves {
                *position = to;
            }
        });
        moves.par_iter().with_min_len(1024).map(|&(v, p)| self.position(v) == p).collect()
    }

    /// Removes an interior vertex that no constraint touches: flips its edges away until three are left. Says whether
    /// it could; where it could not, the vertex stays, with fewer edges.
    pub(crate) fn remove_vertex(&mut self, v: VertexId) -> bool {
        if self.topology.is_border_vertex(v) || self.topology.star(v).any(|h| self.topology.is_fixed(h)) {
            return false;
        }
        while self.topology.star(v).count() > 3 {
            let Some(spoke) = self.topology.star(v).find(|&h| self.is_convex(h)) else { return false };
            self.topology.flip(spoke);
        }
        let link: Vec<Point> = self.topology.star(v).map(|h| self.position(self.topology.target(h))).collect();
        let fits = link.len() == 3 && is_left(link[0], link[1], link[2]);
        if fits {
            self.topology.remove_degree_three(v);
        }
        fits
    }

    fn add_vertex(&mut self, p: Point) -> VertexId {
        let v = self.topology.add_vertex();
        if v.index() == self.positions.len() {
            self.positions.push(p);
        } else {
            self.positions[v.index()] = p;
        }
        v
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;
    use crate::planar::delaunay;

    /// A grid with a wobble, and moves of its vertices by up to `reach` of its step.
    fn grid_and_moves(reach: f64) -> (Planar, Vec<(VertexId, Point)>) {
        let wave = |k: f64| (k * 0.618).fract() - 0.5;
        let at = |i: u32| Point::new(f64::from(i % 20), f64::from(i / 20)) + Vector::new(wave(f64::from(i)), 0.0) * 0.2;
        let points: Vec<Point> = (0..400).map(at).collect();
        let planar = delaunay(&points).unwrap();
        let inner = (0..400).filter(|i| (1..19).contains(&(i % 20)) && (1..19).contains(&(i / 20)));
        let by = |i: u32| Vector::new(wave(f64::from(i) * 3.7), wave(f64::from(i) * 5.3)) * (2.0 * reach);
        let moves = inner.map(|i| (VertexId(i), planar.position(VertexId(i)) + by(i))).collect();
        (planar, moves)
    }

    #[test]
    fn short_moves_are_done_at_once_and_long_ones_as_far_as_triangles_stay() {
        for (reach, least) in [(0.1, 1.0), (0.5, 0.3), (3.0, 0.0)] {
            let (mut planar, moves) = grid_and_moves(reach);
            let before = planar.clone();
            let moved = planar.move_together(&moves);
            assert!(planar.is_embedded());
            let share = moved.iter().filter(|is| **is).count() as f64 / moves.len() as f64;
            assert!(share >= least && (share < 1.0 || reach < 0.2), "{reach}: {share}");
            for (&(v, to), moved) in moves.iter().zip(moved) {
                assert_eq!(planar.position(v), if moved { to } else { before.position(v) });
            }
        }
    }

    #[test]
    fn one_that_leaps_over_the_others_stays_and_they_go() {
        let (mut planar, mut moves) = grid_and_moves(0.1);
        moves[100].1 = Point::new(18.5, 17.5);
        let moved = planar.move_together(&moves);
        let staying = moved.iter().filter(|is| !**is).count();
        assert!(planar.is_embedded() && !moved[100] && staying < 30, "{staying}");
    }

    #[test]
    fn walks_end_within_their_reach_or_not_at_all() {
        let (planar, _) = grid_and_moves(0.0);
        let from = planar.topology.star(VertexId(0)).next().unwrap().face();
        let to = Point::new(15.3, 14.4);
        let there = planar.walk(from, to, false);
        assert_eq!(planar.walk_within(from, to, false, 200), Some(there));
        assert_eq!(planar.walk_within(from, to, false, 10), None);
        assert_eq!(
            planar.walk_within(from, planar.position(VertexId(1)), false, 10),
            Some(planar.walk(from, planar.position(VertexId(1)), false))
        );
    }
}
