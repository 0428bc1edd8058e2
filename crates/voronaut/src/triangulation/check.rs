//! Whole-structure invariants, for tests, fuzzers and the end of every pipeline.

use super::{HalfEdge, Triangulation, VertexId};

/// The first invariant found broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Broken {
    /// The twin of the half-edge's twin is another half-edge, or the two do not run between the same vertices.
    Twin(HalfEdge),
    /// Length or constraint differ between the two sides of the edge.
    EdgeData(HalfEdge),
    /// The half-edge where the vertex starts does not leave it, or is not at the border of a border vertex.
    Start(VertexId),
    /// The faces around the vertex are not one fan.
    Fan(VertexId),
}

impl Triangulation {
    /// Checks every invariant of the structure: twins, data of both sides, starts, one fan per vertex.
    ///
    /// # Errors
    /// The first invariant that does not hold.
    pub fn check(&self) -> Result<(), Broken> {
        let mut degree = vec![0_usize; self.vertex_slots()];
        for h in self.faces().flat_map(super::FaceId::half_edges) {
            self.check_twin(h)?;
            degree[self.origin(h).index()] += 1;
        }
        for v in (0..self.vertex_slots() as u32).map(VertexId) {
            self.check_vertex(v, degree[v.index()])?;
        }
        Ok(())
    }

    fn check_twin(&self, h: HalfEdge) -> Result<(), Broken> {
        let Some(t) = self.twin(h) else { return Ok(()) };
        let same_ends = self.origin(h) == self.target(t) && self.target(h) == self.origin(t);
        if self.twin(t) != Some(h) || t == h || !same_ends || !self.is_face(t.face()) {
            return Err(Broken::Twin(h));
        }
        let same_length = self.length(h).to_bits() == self.length(t).to_bits();
        if !same_length || self.constraint(h) != self.constraint(t) {
            return Err(Broken::EdgeData(h));
        }
        Ok(())
    }

    fn check_vertex(&self, v: VertexId, degree: usize) -> Result<(), Broken> {
        let Some(start) = self.start(v) else {
            return if degree == 0 { Ok(()) } else { Err(Broken::Start(v)) };
        };
        if self.origin(start) != v {
            return Err(Broken::Start(v));
        }
        if self.star(v).take(degree + 1).count() != degree {
            return Err(Broken::Fan(v));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::*;

    /// A hexagon of six triangles around vertex 0.
    fn hexagon() -> Triangulation {
        let triangles: Vec<_> = (0..6).map(|i| [0, i + 1, (i + 1) % 6 + 1]).collect();
        Triangulation::from_triangles(7, &triangles, &[5; 6])
    }

    #[test]
    fn hexagon_is_sound() {
        let t = hexagon();
        t.check().unwrap();
        assert_eq!(t.edges().count(), 12);
        assert_eq!(t.star(VertexId(0)).count(), 6);
        assert!(t.is_border_vertex(VertexId(3)) && !t.is_border_vertex(VertexId(0)));
    }

    #[test]
    fn flips_insertions_and_removal_keep_every_invariant() {
        let mut t = hexagon();
        let spoke = t.find(VertexId(0), VertexId(1)).unwrap();
        t.flip(spoke);
        t.check().unwrap();
        assert_eq!((t.origin(spoke), t.target(spoke)), (VertexId(6), VertexId(2)));
        let v = t.add_vertex();
        t.split_face(FaceId(2), v);
        t.check().unwrap();
        t.remove_degree_three(v);
        t.check().unwrap();
        assert_eq!(t.face_count(), 6);
        let w = t.add_vertex();
        assert_eq!(w, v, "freed vertices are used again");
        let inner = t.find(VertexId(0), VertexId(4)).unwrap();
        t.split_edge(inner, w);
        t.check().unwrap();
        assert_eq!((t.face_count(), t.star(w).count()), (8, 4));
    }

    /// Faces a b c and b a d whose edges at a are one edge: flips by length can leave a vertex with one edge only.
    #[test]
    fn a_flip_inside_a_cone_keeps_twins() {
        for glued in [[2, 4], [1, 5]] {
            let mut t = Triangulation::from_triangles(4, &[[0, 1, 2], [1, 0, 3]], &[0, 0]);
            let [h, g] = glued.map(HalfEdge);
            let (c, d) = (VertexId(2), VertexId(3));
            for e in [0, 1, 2, 3, 4, 5].map(HalfEdge) {
                if t.origin(e) == d {
                    t.origin[e.index()] = c;
                }
            }
            t.start[d.index()] = ids::NONE;
            t.glue(h, g);
            for e in [0, 1, 2, 3, 4, 5].map(HalfEdge) {
                let v = t.origin(e);
                t.start[v.index()] = ids::NONE;
            }
            for e in [0, 1, 2, 3, 4, 5].map(HalfEdge) {
                t.set_start(e);
            }
            t.check().unwrap();
            t.flip(HalfEdge(0));
            t.check().unwrap();
            assert_eq!((t.origin(HalfEdge(0)), t.target(HalfEdge(0))), (c, c), "a loop");
        }
    }

    #[test]
    fn splitting_a_border_edge_keeps_its_constraint() {
        let mut t = hexagon();
        let rim = t.find(VertexId(1), VertexId(2)).unwrap();
        t.set_constraint(rim, Constraint(9));
        let v = t.add_vertex();
        let second = t.split_edge(rim, v);
        t.check().unwrap();
        assert_eq!((t.constraint(rim), t.constraint(second)), (Some(Constraint(9)), Some(Constraint(9))));
        assert_eq!(t.constraint(rim.next()), None);
        assert!(t.is_border_vertex(v));
    }

    #[test]
    fn a_pinched_vertex_is_split_into_fans() {
        let mut t = Triangulation::from_triangles(5, &[[0, 1, 2], [0, 3, 4]], &[0, 0]);
        assert_eq!(t.check(), Err(Broken::Fan(VertexId(0))));
        let copies = t.split_pinched_vertices();
        t.check().unwrap();
        assert_eq!(copies, vec![(VertexId(5), VertexId(0))]);
    }

    #[test]
    fn retaining_faces_makes_border_and_frees_vertices() {
        let mut t = hexagon();
        t.retain_faces(|f| f.0 < 2);
        t.check().unwrap();
        assert_eq!((t.face_count(), t.vertex_count()), (2, 4));
        assert!(t.is_border_vertex(VertexId(0)));
    }
}
