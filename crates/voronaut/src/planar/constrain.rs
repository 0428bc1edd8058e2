//! Making the straight line between two vertices an edge of the triangulation, by flips (Sloan 1993).

use super::Planar;
use crate::geometry::{Orientation, orientation};
use crate::triangulation::{Constraint, HalfEdge, Lawson, VertexId};
use std::collections::VecDeque;

/// The segment crosses, or runs along, one that is already there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crossing {
    /// The constraint that is met.
    pub with: Constraint,
    /// The edge of it that is met.
    pub edge: [VertexId; 2],
}

/// What a ray from a vertex towards a target meets first, if a face at the vertex holds its beginning.
enum Ahead {
    /// A vertex that lies exactly on the segment (perhaps the target itself), along this half-edge.
    Vertex(HalfEdge),
    /// The edge opposite to the vertex, crossed in its interior.
    Edge(HalfEdge),
}

impl Planar {
    /// Makes the segment a-b a chain of constrained edges: one edge, or several where vertices lie exactly on it.
    ///
    /// # Errors
    /// The segment crosses a constrained edge, or runs along one. The triangulation stays valid.
    pub fn constrain(&mut self, a: VertexId, b: VertexId, constraint: Constraint) -> Result<(), Crossing> {
        let mut at = a;
        while at != b {
            let edge = match self.ahead(at, b).expect("the triangles around an interior vertex cover every direction") {
                Ahead::Vertex(edge) => {
                    self.demand_free(edge)?;
                    edge
                }
                Ahead::Edge(first) => self.recover(at, b, first)?,
            };
            self.topology.set_constraint(edge, constraint);
            at = self.topology.target(edge);
        }
        Ok(())
    }

    /// Flips away every edge between two vertices, so that they are joined by one. `None`, and nothing is changed, where
    /// `Planar::edges_between` finds no way. Whether the edges may be flipped is for the caller to ask before.
    pub(crate) fn connect(&mut self, a: VertexId, b: VertexId) -> Option<HalfEdge> {
        let crossed = self.edges_between(a, b)?;
        // A round flips at least one of the crossed edges (Sloan 1993), which bounds the rounds.
        let turns = crossed.len() * (crossed.len() + 1);
        self.flip_away(&crossed, [a, b], turns)?;
        self.topology.find(a, b)
    }

    /// The edges that the straight line between two vertices crosses, from the first vertex on. `None` where they are
    /// joined already, and where the line passes through another vertex or leaves the triangulation.
    pub(crate) fn edges_between(&self, a: VertexId, b: VertexId) -> Option<Vec<HalfEdge>> {
        let Ahead::Edge(first) = self.ahead(a, b)? else { return None };
        let (crossed, end) = self.crossed_edges([a, b], first)?;
        (end == b).then_some(crossed)
    }

    /// On which side of the line through two vertices another one is.
    fn side(&self, [a, b]: [VertexId; 2], v: VertexId) -> Orientation {
        orientation(self.position(a), self.position(b), self.position(v))
    }

    fn demand_free(&self, h: HalfEdge) -> Result<(), Crossing> {
        let edge = self.topology.ends(h);
        self.topology.constraint(h).map_or(Ok(()), |with| Err(Crossing { with, edge }))
    }

    fn ahead(&self, a: VertexId, b: VertexId) -> Option<Ahead> {
        let (p, q) = (self.position(a), self.position(b));
        for h in self.topology.star(a) {
            let (right, left) = (self.topology.target(h), self.topology.apex(h));
            let [of_right, of_left] = [right, left].map(|v| self.side([a, b], v));
            let forward = (self.position(right) - p).dot(q - p) > 0.0;
            if right == b || (of_right == Orientation::Collinear && forward) {
                return Some(Ahead::Vertex(h));
            }
            if of_right == Orientation::Right && of_left == Orientation::Left {
                return Some(Ahead::Edge(h.next()));
            }
        }
        None
    }

    /// Flips away what lies between a and the next vertex on the segment a-b; returns the half-edge between them.
    fn recover(&mut self, a: VertexId, b: VertexId, first: HalfEdge) -> Result<HalfEdge, Crossing> {
        let (crossed, end) = self.crossed_edges([a, b], first).expect("the segment ends inside the triangulation");
        crossed.iter().try_for_each(|&h| self.demand_free(h))?;
        let created = self.flip_away(&crossed, [a, end], usize::MAX).expect("only an edge's own flip removes it");
        let edge = self.topology.find(a, end).expect("no edge crosses the segment any more");
        // Held during the flips that restore the Delaunay property around it; the caller names the constraint.
        self.topology.set_constraint(edge, Constraint(0));
        let mut lawson = Lawson::default();
        lawson.queue(created.into_iter().filter_map(|[u, v]| self.topology.find(u, v)));
        self.legalise(&mut lawson);
        Ok(self.topology.find(a, end).expect("constrained edges are not flipped"))
    }

    /// The edges that the way from one vertex to another crosses, in order, and the first vertex on it. `None` where it leaves the
    /// triangulation.
    fn crossed_edges(&self, way: [VertexId; 2], first: HalfEdge) -> Option<(Vec<HalfEdge>, VertexId)> {
        let mut crossed = vec![first];
        loop {
            let t = self.topology.twin(crossed[crossed.len() - 1])?;
            let apex = self.topology.apex(t);
            match self.side(way, apex) {
                Orientation::Collinear => return Some((crossed, apex)),
                Orientation::Left => crossed.push(t.next()),
                Orientation::Right => crossed.push(t.prev()),
            }
        }
    }

    /// Flips edges until none of those that come of it crosses the line, or so many times were tried; returns those that do not.
    fn flip_away(&mut self, crossed: &[HalfEdge], line: [VertexId; 2], turns: usize) -> Option<Vec<[VertexId; 2]>> {
        // Edges by their ends: half-edge ids move when a neighbour is flipped.
        let mut crossed: VecDeque<_> = crossed.iter().map(|&h| self.topology.ends(h)).collect();
        let mut created = Vec::new();
        for _ in 0..turns {
            let Some([u, v]) = crossed.pop_front() else { break };
            let h = self.topology.find(u, v)?;
            if !self.is_convex(h) {
                crossed.push_back([u, v]);
                continue;
            }
            self.topology.flip(h);
            let diagonal = self.topology.ends(h);
            let sides = diagonal.map(|w| self.side(line, w));
            if sides[0] != sides[1] && !sides.contains(&Orientation::Collinear) {
                crossed.push_back(diagonal);
            } else {
                created.push(diagonal);
            }
        }
        Some(created)
    }
}

#[cfg(test)]
mod tests {
    use super::super::delaunay;
    use super::*;
    use crate::geometry::Point;

    fn grid(n: u32) -> Planar {
        let points: Vec<Point> = (0..n * n).map(|i| Point::new(f64::from(i % n), f64::from(i / n))).collect();
        delaunay(&points).unwrap()
    }

    #[test]
    fn a_long_segment_becomes_a_chain_through_the_vertices_on_it() {
        let mut planar = grid(13);
        planar.constrain(VertexId(0), VertexId(13 * 6 + 12), Constraint(4)).unwrap();
        planar.topology.check().unwrap();
        assert!(planar.is_embedded());
        let chain = planar.topology.edges().filter(|&h| planar.topology.constraint(h).is_some()).count();
        assert_eq!(chain, 6, "the vertices (2 k, k) lie on the segment");
    }

    #[test]
    fn a_segment_across_many_triangles_is_recovered() {
        let mut planar = grid(20);
        planar.constrain(VertexId(1), VertexId(20 * 19 + 18), Constraint(1)).unwrap();
        planar.constrain(VertexId(0), VertexId(20 * 18), Constraint(2)).unwrap();
        planar.topology.check().unwrap();
        assert!(planar.is_embedded());
        assert!(planar.topology.find(VertexId(1), VertexId(20 * 19 + 18)).is_some());
    }

    #[test]
    fn crossing_segments_are_refused_with_the_edge() {
        let mut planar = grid(6);
        planar.constrain(VertexId(1), VertexId(34), Constraint(1)).unwrap();
        let crossing = planar.constrain(VertexId(6), VertexId(29), Constraint(2)).unwrap_err();
        assert_eq!(crossing.with, Constraint(1));
        planar.topology.check().unwrap();
    }

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
