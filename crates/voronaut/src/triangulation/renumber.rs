//! New ids, so that what is near on the surface is near in memory.

use super::ids::NONE;
use super::{FaceId, HalfEdge, Triangulation, VertexId};
use crate::lists::{Classes, Rows, distinct};
use crate::parallel::prelude::*;

impl Triangulation {
    /// The same triangulation, its vertices in the given order and its faces in the order in which the stars of those
    /// vertices meet them. Dead slots are gone. The caller lists every living vertex once.
    #[must_use]
    pub(crate) fn renumbered(&self, order: &[VertexId]) -> Self {
        let mut is_met = vec![false; self.face_slots()];
        let met = order.iter().flat_map(|&v| self.star(v)).map(HalfEdge::face);
        let faces: Vec<FaceId> = met.filter(|f| !std::mem::replace(&mut is_met[f.index()], true)).collect();
        self.in_order(order, &faces, &self.numbers(order, &faces))
    }

    /// The same with its faces in the order of the first of their corners, those of one corner in the order of before, and stars that begin
    /// at the last half-edge that may begin them.
    #[must_use]
    pub(crate) fn renumbered_by_corners(&self, order: &[VertexId]) -> Self {
        let Numbers { vertices, .. } = self.numbers(order, &[]);
        let first = |f: FaceId| self.corners(f).map(|v| vertices[v.index()]).into_iter().min().unwrap_or(NONE);
        let faces = Rows::new(order.len(), self.faces().map(|f| (first(f), f.0))).into_items();
        let faces: Vec<FaceId> = faces.into_iter().map(FaceId).collect();
        let mut new = self.in_order(order, &faces, &self.numbers(order, &faces));
        new.start.fill(NONE);
        for h in (0..new.origin.len() as u32).map(HalfEdge) {
            new.set_start(h);
        }
        new
    }

    /// Its connected parts, each with the vertices of before that its own are. No vertex has several fans.
    pub(crate) fn pieces(&self) -> Vec<(Self, Vec<VertexId>)> {
        let mut joined = Classes::new(self.face_slots());
        for h in self.edges() {
            if let Some(t) = self.twin(h) {
                joined.join(h.face().0, t.face().0);
            }
        }
        joined.flatten();
        let by_piece = Rows::new(self.face_slots(), self.faces().map(|f| (joined.of(f.0), f)));
        let pieces = (0..by_piece.count()).map(|piece| by_piece.row(piece)).filter(|faces| !faces.is_empty());
        let pieces: Vec<(&[FaceId], Vec<VertexId>)> =
            pieces.map(|faces| (faces, distinct(faces.iter().flat_map(|&f| self.corners(f))))).collect();
        let mut numbers = self.numbers(&[], &[]);
        for (faces, order) in &pieces {
            numbers.give(order, faces);
        }
        pieces.into_iter().map(|(faces, order)| (self.in_order(&order, faces, &numbers), order)).collect()
    }

    fn numbers(&self, order: &[VertexId], faces: &[FaceId]) -> Numbers {
        let mut numbers = Numbers { vertices: vec![NONE; self.vertex_slots()], faces: vec![NONE; self.face_slots()] };
        numbers.give(order, faces);
        numbers
    }

    /// Vertices and faces in an order.
    fn in_order(&self, order: &[VertexId], faces: &[FaceId], new: &Numbers) -> Self {
        let half_edge = |h: u32| if h == NONE { NONE } else { 3 * new.faces[HalfEdge(h).face().index()] + h % 3 };
        let slots = || (0..3 * faces.len()).into_par_iter().with_min_len(TOGETHER);
        let old = |slot: usize| 3 * faces[slot / 3].index() + slot % 3;
        Self {
            origin: slots().map(|slot| VertexId(new.vertices[self.origin[old(slot)].index()])).collect(),
            twin: slots().map(|slot| half_edge(self.twin[old(slot)])).collect(),
            length: slots().map(|slot| self.length[old(slot)]).collect(),
            constraint: slots().map(|slot| self.constraint[old(slot)]).collect(),
            region: faces.iter().map(|f| self.region[f.index()]).collect(),
            start: order.iter().map(|v| half_edge(self.start[v.index()])).collect(),
            free_faces: Vec::new(),
            free_vertices: Vec::new(),
        }
    }
}

/// Half-edges that are worth a thread's while.
const TOGETHER: usize = 1 << 14;

/// New numbers by slots; [`NONE`] of what has none.
struct Numbers {
    vertices: Vec<u32>,
    faces: Vec<u32>,
}

impl Numbers {
    /// From 0 on.
    fn give(&mut self, order: &[VertexId], faces: &[FaceId]) {
        (0..).zip(order).for_each(|(number, v)| self.vertices[v.index()] = number);
        (0..).zip(faces).for_each(|(number, f)| self.faces[f.index()] = number);
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

    #[test]
    fn pieces_are_all_there() {
        // Two fans, whose vertices and faces take turns.
        let triangles: Vec<_> = (0..6).map(|i| [i % 2, 2 + i, 2 + (i + 2) % 6]).collect();
        let whole = Triangulation::from_triangles(8, &triangles, &[0, 1, 2, 3, 4, 5]);
        let pieces = whole.pieces();
        assert_eq!(pieces.len(), 2);
        for (i, (piece, old)) in pieces.iter().enumerate() {
            piece.check().unwrap();
            assert_eq!((piece.face_count(), piece.vertex_count()), (3, 4));
            assert_eq!(old[0], VertexId(i as u32));
            let found = piece.faces().map(|f| piece.corners(f).map(|v| old[v.index()].0)).collect::<Vec<_>>();
            assert_eq!(found, [i, i + 2, i + 4].map(|k| triangles[k]));
        }
    }
}
