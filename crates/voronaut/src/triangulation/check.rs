//! Whole-structure invariants, for tests, fuzzers and the end of every pipeline.

use super::{HalfEdge, Triangulation, VertexId};

/// The first invariant found broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Broken {
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
    pub(crate) fn check(&self) -> Result<(), Broken> {
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

    /// Collapses edges, in a random order, as long as that is possible; everything holds after each.
    fn shrink(t: &mut Triangulation, euler: isize) {
        let mut random = 1_u64;
        loop {
            let possible: Vec<HalfEdge> =
                t.faces().flat_map(FaceId::half_edges).filter(|&h| t.can_collapse(h)).collect();
            let Some(last) = possible.len().checked_sub(1) else { break };
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let h = possible[(random >> 33) as usize % (last + 1)];
            let (gone, kept) = (t.origin(h), t.target(h));
            t.collapse(h);
            t.check().unwrap();
            assert!(!t.is_vertex(gone) && t.is_vertex(kept));
            let mut sorted: Vec<_> =
                t.edges().map(|h| (t.origin(h).min(t.target(h)), t.origin(h).max(t.target(h)))).collect();
            sorted.sort_unstable();
            assert!(sorted.windows(2).all(|pair| pair[0] != pair[1]), "a double edge");
            let count = t.vertices().count().cast_signed() - sorted.len().cast_signed();
            assert_eq!(count + t.face_count().cast_signed(), euler);
        }
    }

    #[test]
    fn collapses_keep_the_topology_to_the_last() {
        // An octahedron with vertices inside its faces shrinks to a tetrahedron.
        let octahedron = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        let mut sphere = Triangulation::from_triangles(6, &octahedron, &[0; 8]);
        for f in (0..8).chain([3, 9, 12]).map(FaceId) {
            let v = sphere.add_vertex();
            sphere.split_face(f, v);
        }
        shrink(&mut sphere, 2);
        assert_eq!((sphere.face_count(), sphere.vertex_count()), (4, 4));
        // A hexagon shrinks to a triangle, an annulus to one with three vertices on each side.
        let mut disk = hexagon();
        shrink(&mut disk, 1);
        assert_eq!((disk.face_count(), disk.vertex_count()), (1, 3));
        let ring: Vec<[u32; 3]> =
            (0..5).flat_map(|i| [[i, (i + 1) % 5, i + 5], [(i + 1) % 5, (i + 1) % 5 + 5, i + 5]]).collect();
        let mut ring = Triangulation::from_triangles(10, &ring, &[0; 10]);
        shrink(&mut ring, 0);
        assert_eq!(ring.edges().filter(|&h| ring.twin(h).is_none()).count(), 6);
    }

    #[test]
    fn a_collapse_keeps_constraints_and_forgets_lengths() {
        let mut t = hexagon();
        t.edges().collect::<Vec<_>>().into_iter().for_each(|h| t.set_length(h, 1.0));
        let spoke = t.find(VertexId(1), VertexId(0)).unwrap();
        t.set_constraint(spoke, Constraint(3));
        let inner = t.find(VertexId(0), VertexId(2)).unwrap();
        t.collapse(inner);
        t.check().unwrap();
        assert_eq!(t.constraint(t.find(VertexId(1), VertexId(2)).unwrap()), Some(Constraint(3)));
        assert!(t.star(VertexId(2)).all(|h| t.length(h).is_nan()));
        let far = t.find(VertexId(4), VertexId(5)).unwrap();
        assert!((t.length(far) - 1.0).abs() < 1e-15);
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
