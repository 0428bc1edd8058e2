//! A part of a mesh as a mesh of its own.

use crate::error::{Error, Result};
use crate::lists::{distinct, in_order, marked};
use crate::manifold::surface::CUT as LABEL;
use crate::mesh::{Edges, Mesh};
use std::collections::HashMap;

/// The label of cuts.
pub(super) const CUT: i32 = LABEL;

/// Refuses the label of cuts.
pub(super) fn refuse_label(label: i32) -> Result<()> {
    if label != CUT {
        return Ok(());
    }
    let what = format!("a label {CUT} in a mesh that is made in parts");
    Err(Error::unsupported(what, "give the curve another label: this one is that of cuts"))
}

/// Some triangles of a mesh with what is on them; and which of its edges are of the `rim`. Those have the label of cuts unless they have one.
pub(super) fn submesh(mesh: &Mesh, triangles: &[u32], rim: &[[u32; 2]]) -> (Mesh, Vec<u32>) {
    let taken: Vec<[u32; 3]> = triangles.iter().map(|&t| mesh.triangles[t as usize]).collect();
    let is_used = marked(mesh.points.len(), taken.as_flattened().iter().copied());
    let old: Vec<u32> = (0..).zip(&is_used).filter(|(_, used)| **used).map(|(v, _)| v).collect();
    let mut number = vec![u32::MAX; mesh.points.len()];
    (0..).zip(&old).for_each(|(new, &v)| number[v as usize] = new);
    let numbers = |list: &[u32]| list.iter().map(|&v| number[v as usize]).filter(|&v| v != u32::MAX).collect();
    let is_required = marked(mesh.triangles.len(), mesh.required_triangles.iter().copied());
    let required = (0..).zip(triangles).filter(|&(_, &t)| is_required[t as usize]).map(|(new, _)| new);
    let mut part = Mesh {
        points: old.iter().map(|&v| mesh.points[v as usize]).collect(),
        point_labels: old.iter().map(|&v| mesh.point_labels[v as usize]).collect(),
        triangles: taken.iter().map(|t| t.map(|v| number[v as usize])).collect(),
        triangle_labels: triangles.iter().map(|&t| mesh.triangle_labels[t as usize]).collect(),
        corners: numbers(&mesh.corners),
        required_points: numbers(&mesh.required_points),
        required_triangles: required.collect(),
        ..Mesh::default()
    };
    let rim = list_edges(&mut part, mesh, &Edges::of(&taken), rim, |ends| ends.map(|v| number[v as usize]));
    (part, rim)
}

/// Lists the edges of a mesh that are `here` in a part of it, and those of the rim, whose numbers it returns.
fn list_edges(
    part: &mut Mesh,
    mesh: &Mesh,
    here: &Edges,
    rim: &[[u32; 2]],
    numbered: impl Fn([u32; 2]) -> [u32; 2],
) -> Vec<u32> {
    let is_here = |ends: [u32; 2]| !here.at(ends).is_empty();
    let mut rim: HashMap<[u32; 2], bool> =
        rim.iter().filter(|&&ends| is_here(ends)).map(|&ends| (in_order(ends), false)).collect();
    let [required, ridges] =
        [&mesh.required_edges, &mesh.ridges].map(|list| marked(mesh.edges.len(), list.iter().copied()));
    let mut on_rim = Vec::new();
    for (i, &ends) in mesh.edges.iter().enumerate().filter(|(_, ends)| is_here(**ends)) {
        let new = part.edges.len() as u32;
        on_rim.extend(rim.get_mut(&in_order(ends)).map(|is_listed| {
            *is_listed = true;
            new
        }));
        part.required_edges.extend(required[i].then_some(new));
        part.ridges.extend(ridges[i].then_some(new));
        part.edges.push(numbered(ends));
        part.edge_labels.push(mesh.edge_labels[i]);
    }
    let mut cuts: Vec<[u32; 2]> = rim.into_iter().filter(|(_, is_listed)| !is_listed).map(|(ends, _)| ends).collect();
    cuts.sort_unstable();
    for ends in cuts {
        on_rim.push(part.edges.len() as u32);
        part.edges.push(numbered(ends));
        part.edge_labels.push(CUT);
    }
    on_rim
}

impl Mesh {
    /// Requires some of its edges, and those that are required.
    pub(super) fn require(&mut self, edges: impl IntoIterator<Item = u32>) {
        let all = std::mem::take(&mut self.required_edges).into_iter().chain(edges);
        self.required_edges = distinct(all);
    }
}
