//! Making the straight line between two vertices an edge, by flips (Sloan 1993).

use super::Planar;
use crate::geometry::{Orientation, orientation};
use crate::triangulation::{HalfEdge, VertexId};
use std::collections::VecDeque;

impl Planar {
    /// Flips away every edge between two vertices, so that they are joined by one. `None`, and nothing is changed, where
    /// `Planar::edges_between` finds no way. Whether the edges may be flipped is for the caller to ask before.
    pub(crate) fn connect(&mut self, a: VertexId, b: VertexId) -> Option<HalfEdge> {
        let ends = |h| [self.topology.origin(h), self.topology.target(h)];
        let mut crossed: VecDeque<[VertexId; 2]> = self.edges_between(a, b)?.into_iter().map(ends).collect();
        // A round flips at least one of the crossed edges (Sloan 1993), which bounds the rounds.
        let mut turns = crossed.len() * (crossed.len() + 1);
        while let Some([u, v]) = crossed.pop_front() {
            let h = self.topology.find(u, v)?;
            if self.is_convex(h) {
                self.topology.flip(h);
                let ends = [self.topology.origin(h), self.topology.target(h)];
                if self.is_across(ends, [a, b]) {
                    crossed.push_back(ends);
                }
            } else {
                crossed.push_back([u, v]);
            }
            turns -= 1;
            if turns == 0 {
                break;
            }
        }
        self.topology.find(a, b)
    }

    /// Whether the ends of an edge lie strictly on both sides of the line through two vertices.
    fn is_across(&self, [u, v]: [VertexId; 2], [a, b]: [VertexId; 2]) -> bool {
        let side = |w: VertexId| orientation(self.position(a), self.position(b), self.position(w));
        side(u) != Orientation::Collinear && side(v) != Orientation::Collinear && side(u) != side(v)
    }

    /// The edges that the straight line between two vertices crosses, from the first vertex on. `None` where they are
    /// joined already, and where the line passes through another vertex or leaves the triangulation.
    pub(crate) fn edges_between(&self, a: VertexId, b: VertexId) -> Option<Vec<HalfEdge>> {
        let (p, q) = (self.position(a), self.position(b));
        let side = |v: VertexId| orientation(p, q, self.position(v));
        let is_ahead = |h: &HalfEdge| {
            let (right, left) = (self.topology.target(*h), self.topology.apex(*h));
            side(right) == Orientation::Right && side(left) == Orientation::Left
        };
        let mut h = self.topology.star(a).find(is_ahead)?.next();
        let mut crossed = Vec::new();
        loop {
            crossed.push(h);
            let t = self.topology.twin(h)?;
            let apex = self.topology.apex(t);
            if apex == b {
                return Some(crossed);
            }
            h = match side(apex) {
                Orientation::Collinear => return None,
                Orientation::Left => t.next(),
                Orientation::Right => t.prev(),
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::Point;
    use crate::planar::delaunay;
    use crate::triangulation::VertexId;

    #[test]
    fn far_vertices_are_joined_or_nothing_changes() {
        let point = |i: u32| Point::new(f64::from(i * 37 % 101) + 0.01 * f64::from(i % 7), f64::from(i * 61 % 97));
        let mut planar = delaunay(&(0..90).map(point).collect::<Vec<_>>()).unwrap();
        let mut joined = 0;
        for i in 0..40 {
            let (a, b) = (VertexId(i), VertexId(89 - i));
            let before: Vec<_> = planar.topology.faces().map(|f| planar.topology.corners(f)).collect();
            if planar.topology.find(a, b).is_none() {
                let found = planar.connect(a, b);
                joined += usize::from(found.is_some());
                let after: Vec<_> = planar.topology.faces().map(|f| planar.topology.corners(f)).collect();
                assert_eq!(found.is_some(), before != after);
                assert_eq!(found, planar.topology.find(a, b));
            }
            planar.topology.check().unwrap();
            assert!(planar.is_embedded());
        }
        assert!(joined > 15, "{joined}");
    }
}
