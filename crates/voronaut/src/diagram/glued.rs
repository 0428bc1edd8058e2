//! The nerve as it hangs together: one triangle for every canvas face of three colours, glued along the borders of cells.

use super::{Diagram, Ground};
use crate::triangulation::{FaceId, HalfEdge, Triangulation};

impl<'a, G: Ground<'a>> Diagram<'a, G> {
    /// The triangulation whose vertices are the seeds, whose faces are the canvas faces of three colours, and in which two are
    /// neighbours if the border of two cells leads from one to the other, whatever else these cells have in common. Where
    /// every cell is a disc it has the topology of the canvas. It may have several edges between two seeds: their cells
    /// meet several times. A cell that is no disc has several fans of faces, each but the first with a vertex of its own behind
    /// those of the seeds; the list has the seeds of these.
    pub(crate) fn glued_nerve(&self) -> (Triangulation, Vec<u32>) {
        let topology = self.ground.topology();
        let witnesses: Vec<FaceId> =
            topology.faces().filter(|&f| self.three_colours(topology.corners(f)).is_some()).collect();
        let mut number = vec![u32::MAX; topology.face_slots()];
        (0..).zip(&witnesses).for_each(|(i, f)| number[f.index()] = i);
        let triangles: Vec<[u32; 3]> = witnesses.iter().map(|&f| self.colours_at(topology.corners(f))).collect();
        let beyond = |h: HalfEdge| {
            let end = self.follow(h, &number)?;
            Some(3 * number[end.face().index()] + (end.index() % 3) as u32)
        };
        let twins: Vec<Option<u32>> = witnesses.iter().flat_map(|f| f.half_edges()).map(beyond).collect();
        let mut glued = Triangulation::glued(self.colours(), &triangles, &twins);
        let mut seeds = Vec::new();
        for (copy, of) in glued.split_pinched_vertices() {
            let seed = if of.index() < self.colours() { of.0 } else { seeds[of.index() - self.colours()] };
            seeds.resize(copy.index() + 1 - self.colours(), seed);
        }
        (glued, seeds)
    }

    /// From a side of a face of three colours along the border between its two cells: the side of the next such face through
    /// which that is entered; `None` where the border of the domain comes first.
    fn follow(&self, from: HalfEdge, number: &[u32]) -> Option<HalfEdge> {
        let topology = self.ground.topology();
        let mut side = topology.twin(from)?;
        // A border between cells crosses each face once.
        for _ in 0..topology.face_slots() {
            if number[side.face().index()] != u32::MAX {
                return Some(side);
            }
            let [apex, origin, target] =
                self.colours_at([topology.apex(side), topology.origin(side), topology.target(side)]);
            side = topology.twin(match apex {
                _ if apex == origin => side.next(),
                _ if apex == target => side.prev(),
                _ => return None,
            })?;
        }
        None
    }
}
