//! New ids, so that what is near on the surface is near in memory.

use super::ids::NONE;
use super::{FaceId, HalfEdge, Triangulation, VertexId};
use crate::lists::Rows;
use crate::parallel::prelude::*;

impl Triangulation {
    /// The same triangulation, its vertices in the given order and its faces in the order in which the stars of those
    /// vertices meet them. Dead slots are gone. The caller lists every living vertex once.
    #[must_use]
    pub(crate) fn renumbered(&self, order: &[VertexId]) -> Self {
        let mut is_met = vec![false; self.face_slots()];
        let met = order.iter().flat_map(|&v| self.star(v)).map(HalfEdge::face);
        let faces: Vec<FaceId> = met.filter(|f| !std::mem::replace(&mut is_met[f.index()], true)).collect();
        self.in_order(order, &numbers(self.vertex_slots(), order.iter().map(|v| v.index())), &faces)
    }

    /// The same with its faces in the order of the first of their corners, those of one corner in the order of before, and stars that begin
    /// at the last half-edge that may begin them.
    #[must_use]
    pub(crate) fn renumbered_by_corners(&self, order: &[VertexId]) -> Self {
        let vertex = numbers(self.vertex_slots(), order.iter().map(|v| v.index()));
        let first = |f: FaceId| self.corners(f).map(|v| vertex[v.index()]).into_iter().min().unwrap_or(NONE);
        let faces = Rows::new(order.len(), self.faces().map(|f| (first(f), f.0))).into_items();
        let faces: Vec<FaceId> = faces.into_iter().map(FaceId).collect();
        let mut new = self.in_order(order, &vertex, &faces);
        new.start.fill(NONE);
        for h in (0..new.origin.len() as u32).map(HalfEdge) {
            new.set_start(h);
        }
        new
    }

    /// Vertices and faces in an order, with the new numbers of vertices.
    fn in_order(&self, order: &[VertexId], vertex: &[u32], faces: &[FaceId]) -> Self {
        let face = numbers(self.face_slots(), faces.iter().map(|f| f.index()));
        let half_edge = |h: u32| if h == NONE { NONE } else { 3 * face[HalfEdge(h).face().index()] + h % 3 };
        let slots = || (0..3 * faces.len()).into_par_iter().with_min_len(TOGETHER);
        let old = |slot: usize| 3 * faces[slot / 3].index() + slot % 3;
        Self {
            origin: slots().map(|slot| VertexId(vertex[self.origin[old(slot)].index()])).collect(),
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

/// The places of slots in a list, by slot; [`NONE`] of those that are not in it.
fn numbers(slots: usize, list: impl Iterator<Item = usize>) -> Vec<u32> {
    let mut numbers = vec![NONE; slots];
    for (number, slot) in (0..).zip(list) {
        numbers[slot] = number;
    }
    numbers
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
