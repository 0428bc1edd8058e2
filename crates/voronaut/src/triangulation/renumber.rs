//! New ids, so that what is near on the surface is near in memory.

use super::ids::NONE;
use super::{FaceId, HalfEdge, Triangulation, VertexId};

impl Triangulation {
    /// The same triangulation, its vertices in the given order and its faces in the order in which the stars of those
    /// vertices meet them. Dead slots are gone. The caller lists every living vertex once.
    #[must_use]
    pub(crate) fn renumbered(&self, order: &[VertexId]) -> Self {
        let mut vertex = vec![NONE; self.vertex_slots()];
        for (new, old) in order.iter().enumerate() {
            vertex[old.index()] = new as u32;
        }
        let (face, faces) = self.faces_by_stars(order);
        let half_edge = |h: u32| if h == NONE { NONE } else { 3 * face[HalfEdge(h).face().index()] + h % 3 };
        let slots = || faces.iter().flat_map(|f| f.half_edges()).map(HalfEdge::index);
        Self {
            origin: slots().map(|i| VertexId(vertex[self.origin[i].index()])).collect(),
            twin: slots().map(|i| half_edge(self.twin[i])).collect(),
            length: slots().map(|i| self.length[i]).collect(),
            constraint: slots().map(|i| self.constraint[i]).collect(),
            region: faces.iter().map(|f| self.region[f.index()]).collect(),
            start: order.iter().map(|v| half_edge(self.start[v.index()])).collect(),
            free_faces: Vec::new(),
            free_vertices: Vec::new(),
        }
    }

    /// The new number of each face slot, and the faces by their new numbers.
    fn faces_by_stars(&self, order: &[VertexId]) -> (Vec<u32>, Vec<FaceId>) {
        let mut number = vec![NONE; self.face_slots()];
        let mut faces = Vec::with_capacity(self.face_count());
        for h in order.iter().flat_map(|&v| self.star(v)) {
            let f = h.face();
            if number[f.index()] == NONE {
                number[f.index()] = faces.len() as u32;
                faces.push(f);
            }
        }
        (number, faces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn renumbering_keeps_every_star() {
        let triangles: Vec<_> = (0..6).map(|i| [0, i + 1, (i + 1) % 6 + 1]).collect();
        let mut t = Triangulation::from_triangles(7, &triangles, &[5; 6]);
        t.retain_faces(|f| f.0 != 2);
        t.set_length(HalfEdge(0), 3.0);
        let order: Vec<VertexId> = [4, 2, 0, 1, 3, 6, 5].map(VertexId).to_vec();
        let r = t.renumbered(&order);
        r.check().unwrap();
        assert_eq!((r.face_count(), r.vertex_count()), (5, 7));
        for (new, &old) in order.iter().enumerate() {
            let before: Vec<VertexId> = t.star(old).map(|h| t.target(h)).collect();
            let after: Vec<VertexId> = r.star(VertexId(new as u32)).map(|h| order[r.target(h).index()]).collect();
            assert_eq!(before, after);
        }
        let h = r.find(VertexId(2), VertexId(3)).unwrap();
        assert!((r.length(h) - 3.0).abs() < 1e-15);
    }
}
