//! Which vertices of a mesh share an edge.

use crate::lists::Rows;
use crate::mesh::{Mesh, edges_of};

/// The neighbours of every vertex in ascending order, one list after the other.
pub(crate) struct Neighbours(Rows<u32>);

impl Neighbours {
    /// Of a mesh whose numbers are valid.
    pub(crate) fn of(mesh: &Mesh) -> Self {
        Self::of_triangles(mesh.points.len(), mesh.triangles.iter().copied(), [])
    }

    /// Of so many vertices: those that share a triangle, and more pairs.
    pub(crate) fn of_triangles(
        count: usize,
        triangles: impl IntoIterator<Item = [u32; 3]>,
        more: impl IntoIterator<Item = [u32; 2]>,
    ) -> Self {
        let edges: Vec<[u32; 2]> = triangles.into_iter().flat_map(edges_of).chain(more).collect();
        Self(Rows::new(count, edges.iter().flat_map(|&[a, b]| [(a, b), (b, a)])).distinct())
    }

    /// Of one vertex; none where it has no triangle.
    pub(crate) fn at(&self, v: usize) -> &[u32] {
        self.0.row(v)
    }

    /// Of any of these vertices, in ascending order.
    pub(crate) fn of_all(&self, vertices: &[u32]) -> Vec<u32> {
        let mut is_beside = vec![false; self.count()];
        let mut all = Vec::new();
        self.tell(vertices, &mut is_beside, |w| all.push(w));
        all.sort_unstable();
        all
    }

    /// The rounds in which word gets from the first vertex of a piece of the mesh to all of that piece, one edge a round; of all
    /// pieces the most. No two vertices of a piece are more than twice as many edges apart.
    pub(crate) fn hops(&self) -> usize {
        let mut hears = vec![false; self.count()];
        let mut most = 0;
        for first in 0..self.count() {
            let (mut rounds, mut told) = (0, vec![first as u32]);
            while !told.is_empty() && (rounds > 0 || !hears[first]) {
                let mut next = Vec::new();
                self.tell(&told, &mut hears, |w| next.push(w));
                (rounds, told) = (rounds + usize::from(!next.is_empty()), next);
            }
            most = most.max(rounds);
        }
        most
    }

    /// Calls each neighbour of these vertices that is not marked, and marks it.
    fn tell(&self, vertices: &[u32], is_marked: &mut [bool], mut call: impl FnMut(u32)) {
        for &w in vertices.iter().flat_map(|&v| self.at(v as usize)) {
            if !std::mem::replace(&mut is_marked[w as usize], true) {
                call(w);
            }
        }
    }

    fn count(&self) -> usize {
        self.0.count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn word_gets_around_one_edge_a_round() {
        // A strip of six triangles, and one triangle apart from it.
        let strip = (0..6).map(|i| [i, i + 1, i + 2]).chain([[9, 10, 8]]);
        let mesh = Mesh { points: vec![[0.0; 3]; 12], triangles: strip.collect(), ..Mesh::default() };
        let around = Neighbours::of(&mesh);
        assert_eq!(around.of_all(&[0, 9, 11]), [1, 2, 8, 10]);
        assert_eq!(around.of_all(&[3]), [1, 2, 4, 5]);
        // 0 to 2, 4, 6, 7.
        assert_eq!(around.hops(), 4);
    }
}
