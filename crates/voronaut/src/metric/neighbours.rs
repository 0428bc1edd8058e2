//! Which vertices of a mesh share an edge.

use crate::mesh::Mesh;

/// The neighbours of every vertex in ascending order, one list after the other.
pub(super) struct Neighbours {
    starts: Vec<usize>,
    lists: Vec<u32>,
}

impl Neighbours {
    /// Of a mesh whose numbers are valid.
    pub(super) fn of(mesh: &Mesh) -> Self {
        let both_ways = |&[a, b, c]: &[u32; 3]| [[a, b], [b, a], [b, c], [c, b], [c, a], [a, c]];
        let mut pairs: Vec<[u32; 2]> = mesh.triangles.iter().flat_map(both_ways).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let starts = (0..=mesh.points.len()).map(|v| pairs.partition_point(|pair| (pair[0] as usize) < v)).collect();
        Self { starts, lists: pairs.iter().map(|pair| pair[1]).collect() }
    }

    /// Of one vertex; none where it has no triangle.
    pub(super) fn at(&self, v: usize) -> &[u32] {
        &self.lists[self.starts[v]..self.starts[v + 1]]
    }
}
