//! The triangles at which the mesh of a surface is none.

use super::contact::is_flat;
use super::edges::Edges;
use super::meetings::Meetings;
use super::self_intersections::{Pair, pairs};
use super::validity::split_vertices;
use crate::mesh::Mesh;

/// The triangles of a surface's mesh that are flat, have an edge or a vertex that is not manifold, or meet another one where the
/// surface does not meet itself; in order. [`validity_on`](super::validity_on()) says what is wrong with the mesh; this says where
/// it has to be made anew.
pub(crate) fn faulty_triangles(mesh: &Mesh, surface: &Meetings) -> Vec<u32> {
    let flat = |t: &u32| is_flat(mesh.positions_of(mesh.triangles[*t as usize]));
    let mut faulty: Vec<u32> = (0..mesh.triangles.len() as u32).filter(flat).collect();
    if faulty.is_empty() {
        let of_ours = |pair: &Pair| !pair.is_excused(mesh, surface);
        faulty
            .extend(pairs(mesh).iter().filter(|pair| of_ours(pair)).flat_map(|pair| pair.triangles).map(|t| t as u32));
    }
    let edges = Edges::of(&mesh.triangles);
    for (_, half_edges) in edges.iter().filter(|(_, half_edges)| !edges.is_manifold(half_edges)) {
        faulty.extend(half_edges.iter().map(|(_, half_edge)| half_edge / 3));
    }
    let split = split_vertices(mesh, &edges);
    let has_split = |t: &[u32; 3]| t.iter().any(|v| split.binary_search(v).is_ok());
    faulty.extend((0..).zip(&mesh.triangles).filter(|(_, t)| has_split(t)).map(|(i, _)| i));
    faulty.sort_unstable();
    faulty.dedup();
    faulty
}
