//! Edges whose length is given by what has to be kept: borders, features, corners, required edges.

use super::{Edges, is_unit};
use crate::geometry::Point3;
use crate::mesh::Mesh;
use std::collections::BTreeMap;

/// How what has to be kept bears on an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Forced {
    /// It does not.
    No,
    /// The edge is short, and joins two places of borders or features across the domain.
    Across,
    /// The edge is kept as it is, or ends where such an edge does.
    Kept,
}

impl Forced {
    /// Of all edges of a mesh, in order, by their metric lengths; curves that turn by more than `corner` (radians) in a vertex
    /// have a corner there.
    pub(super) fn of(mesh: &Mesh, edges: &Edges, lengths: &[f64], corner: f64) -> Vec<Self> {
        let curves = Curves::of(mesh, edges, corner);
        let mut crowded = vec![false; mesh.points.len()];
        let mut all = vec![Forced::No; lengths.len()];
        for (((ends, _), &length), forced) in edges.iter().zip(lengths).zip(&mut all) {
            let kept = curves.kept.get(&ends);
            let both = |list: &[bool]| length < 1.0 && ends.iter().all(|&v| list[v as usize]);
            if is_unit(length) {
                continue;
            }
            if kept.is_some_and(|kept| kept.is_required || both(&curves.is_corner)) {
                for v in ends {
                    crowded[v as usize] = true;
                }
            } else if kept.is_none() && both(&curves.is_on) {
                *forced = Forced::Across;
            }
        }
        for ((ends, _), forced) in edges.iter().zip(&mut all) {
            if ends.iter().any(|&v| crowded[v as usize]) {
                *forced = Forced::Kept;
            }
        }
        all
    }
}

/// What has to be kept of a mesh.
struct Curves {
    /// The edges of borders and features, by their vertices.
    kept: BTreeMap<[u32; 2], Kept>,
    /// Vertices on them, and required ones.
    is_on: Vec<bool>,
    /// Vertices that cannot slide along them.
    is_corner: Vec<bool>,
}

#[derive(Clone, Copy, Default)]
struct Kept {
    label: i32,
    is_required: bool,
}

impl Curves {
    fn of(mesh: &Mesh, edges: &Edges, corner: f64) -> Self {
        let kept = kept(mesh, edges);
        let mut on: BTreeMap<u32, Vec<(u32, Kept)>> = BTreeMap::new();
        for (&[a, b], &edge) in &kept {
            on.entry(a).or_default().push((b, edge));
            on.entry(b).or_default().push((a, edge));
        }
        let listed = mesh.corners.iter().chain(&mesh.required_points).copied();
        let found = on.iter().filter(|(v, around)| is_corner(mesh, **v, around, corner)).map(|(&v, _)| v);
        let is_corner = marked(mesh, listed.chain(found));
        let is_on = marked(mesh, on.keys().chain(&mesh.corners).chain(&mesh.required_points).copied());
        Self { kept, is_on, is_corner }
    }
}

/// The edges of one triangle, and those that the mesh lists, as far as they are edges of triangles.
fn kept(mesh: &Mesh, edges: &Edges) -> BTreeMap<[u32; 2], Kept> {
    let single = edges.iter().filter(|(_, half_edges)| half_edges.len() != 2);
    let mut kept: BTreeMap<[u32; 2], Kept> = single.map(|(ends, _)| (ends, Kept::default())).collect();
    for (i, &[a, b]) in mesh.edges.iter().enumerate().filter(|(_, ends)| edges.contains(ends[0], ends[1])) {
        let label = mesh.edge_labels.get(i).copied().unwrap_or(0);
        kept.insert([a.min(b), a.max(b)], Kept { label, is_required: false });
    }
    for [a, b] in mesh.required_edges.iter().filter_map(|&i| mesh.edges.get(i as usize)) {
        kept.entry([*a.min(b), *a.max(b)]).and_modify(|kept| kept.is_required = true);
    }
    kept
}

/// Whether a vertex with these neighbours along borders and features cannot slide along them.
fn is_corner(mesh: &Mesh, v: u32, around: &[(u32, Kept)], corner: f64) -> bool {
    let &[(a, before), (b, after)] = around else { return true };
    let [p, at, q]: [Point3; 3] = [a, v, b].map(|v| mesh.position(v));
    let (to, from) = (at - p, q - at);
    let turn = to.cross(from).norm().atan2(to.dot(from));
    before.label != after.label || before.is_required || after.is_required || turn > corner
}

fn marked(mesh: &Mesh, vertices: impl Iterator<Item = u32>) -> Vec<bool> {
    let mut marks = vec![false; mesh.points.len()];
    vertices.for_each(|v| marks.get_mut(v as usize).map_or((), |mark| *mark = true));
    marks
}
