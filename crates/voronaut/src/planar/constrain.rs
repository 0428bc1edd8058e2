//! Making a segment an edge of the triangulation, by flips (Sloan 1993).

use super::Planar;
use crate::geometry::{Orientation, orientation};
use crate::triangulation::{Constraint, HalfEdge, Lawson, VertexId};
use std::collections::VecDeque;

/// Edges by their ends: half-edge ids move when a neighbour is flipped.
type Edges = VecDeque<[VertexId; 2]>;

/// The segment crosses, or runs along, one that is already there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crossing {
    /// The constraint that is met.
    pub with: Constraint,
    /// The edge of it that is met.
    pub edge: [VertexId; 2],
}

/// What a ray from a vertex towards a target meets first.
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
            let (edge, recovered) = match self.ahead(at, b) {
                Ahead::Vertex(edge) => (edge, false),
                Ahead::Edge(first) => (self.recover(at, b, first)?, true),
            };
            let next = self.topology.target(edge);
            if let Some(with) = self.topology.constraint(edge).filter(|_| !recovered) {
                return Err(Crossing { with, edge: [at, next] });
            }
            self.topology.set_constraint(edge, constraint);
            at = next;
        }
        Ok(())
    }

    fn ahead(&self, a: VertexId, b: VertexId) -> Ahead {
        let (p, q) = (self.position(a), self.position(b));
        for h in self.topology.star(a) {
            let (right, left) = (self.topology.target(h), self.topology.apex(h));
            let of_right = orientation(p, q, self.position(right));
            let of_left = orientation(p, q, self.position(left));
            let forward = (self.position(right) - p).dot(q - p) > 0.0;
            if right == b || (of_right == Orientation::Collinear && forward) {
                return Ahead::Vertex(h);
            }
            if of_right == Orientation::Right && of_left == Orientation::Left {
                return Ahead::Edge(h.next());
            }
        }
        unreachable!("the triangles around an interior vertex cover every direction")
    }

    /// Flips away what lies between a and the next vertex on the segment a-b; returns the half-edge between them.
    fn recover(&mut self, a: VertexId, b: VertexId, first: HalfEdge) -> Result<HalfEdge, Crossing> {
        let (mut crossed, end) = self.crossed_edges(a, b, first)?;
        let mut created = Edges::new();
        while let Some([u, v]) = crossed.pop_front() {
            let h = self.topology.find(u, v).expect("only this edge's own flip removes it");
            if !self.is_convex(h) {
                crossed.push_back([u, v]);
                continue;
            }
            self.topology.flip(h);
            let diagonal = [self.topology.origin(h), self.topology.target(h)];
            let list = if self.crosses(diagonal, [a, end]) { &mut crossed } else { &mut created };
            list.push_back(diagonal);
        }
        let edge = self.topology.find(a, end).expect("no edge crosses the segment any more");
        // Held during the flips that restore the Delaunay property around it; the caller names the constraint.
        self.topology.set_constraint(edge, Constraint(0));
        let mut lawson = Lawson::default();
        lawson.queue(created.into_iter().filter_map(|[u, v]| self.topology.find(u, v)));
        self.legalise(&mut lawson);
        Ok(self.topology.find(a, end).expect("constrained edges are not flipped"))
    }

    /// Whether the ends of an edge lie strictly on both sides of the line through the segment's ends.
    fn crosses(&self, [u, v]: [VertexId; 2], [a, b]: [VertexId; 2]) -> bool {
        let side = |w: VertexId| orientation(self.position(a), self.position(b), self.position(w));
        side(u) != Orientation::Collinear && side(v) != Orientation::Collinear && side(u) != side(v)
    }

    /// The edges that the segment crosses, in order, up to the first vertex on it.
    fn crossed_edges(&self, a: VertexId, b: VertexId, first: HalfEdge) -> Result<(Edges, VertexId), Crossing> {
        let (p, q) = (self.position(a), self.position(b));
        let mut crossed = VecDeque::new();
        let mut h = first;
        loop {
            let edge = [self.topology.origin(h), self.topology.target(h)];
            if let Some(with) = self.topology.constraint(h) {
                return Err(Crossing { with, edge });
            }
            crossed.push_back(edge);
            let t = self.topology.twin(h).expect("the segment ends inside the triangulation");
            let apex = self.topology.apex(t);
            match orientation(p, q, self.position(apex)) {
                Orientation::Collinear => return Ok((crossed, apex)),
                Orientation::Left => h = t.next(),
                Orientation::Right => h = t.prev(),
            }
        }
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
}
