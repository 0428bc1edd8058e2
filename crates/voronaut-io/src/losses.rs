//! What formats have no place for.

use super::gmsh::Version;
use super::{Fields, Format, su2};
use voronaut::mesh::Mesh;

/// What a mesh and its fields hold besides positions and triangles.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    PointLabels,
    TriangleLabels,
    Edges,
    EdgeLabels,
    /// Corners, and required vertices.
    VertexMarks,
    /// Ridges, and required edges and triangles.
    Marks,
    /// Beside a `.mesh` they have a file of their own.
    Fields,
}

/// What a `.poly`, or else a `.geojson`, would not hold of a planar mesh and its fields besides its triangles, in words.
pub fn lost_in_outline(is_poly: bool, mesh: &Mesh, fields: &Fields) -> Vec<String> {
    let outline = [Part::TriangleLabels, Part::Edges, Part::EdgeLabels, Part::PointLabels];
    lost(if is_poly { &outline } else { &outline[..3] }, mesh, fields)
}

impl Format {
    /// What of a mesh and its fields a file of the format would not hold, in words; empty if nothing is lost.
    pub fn lost(self, mesh: &Mesh, fields: &Fields) -> Vec<String> {
        let kept: &[Part] = match self {
            // Marks of vertices are kept, of edges and triangles not.
            Format::Gmsh(Version::V2_2, _) => &[
                Part::PointLabels,
                Part::TriangleLabels,
                Part::Edges,
                Part::EdgeLabels,
                Part::VertexMarks,
                Part::Fields,
            ],
            Format::Medit(_) | Format::Vtu | Format::Vtp | Format::Gmsh(Version::V4_1, _) => return Vec::new(),
            Format::Ply(_) => &[Part::PointLabels, Part::TriangleLabels, Part::Fields],
            Format::Obj => &[Part::TriangleLabels, Part::Edges],
            Format::Su2 if mesh.is_planar() => &[Part::Edges, Part::EdgeLabels],
            Format::Su2 => &[Part::TriangleLabels],
            Format::Off | Format::Stl => &[],
        };
        let is_rounded = |x: &f64| f64::from(*x as f32).to_bits() != x.to_bits();
        let digits = self == Format::Stl && mesh.points.as_flattened().iter().any(is_rounded);
        let digits = digits.then(|| "digits of coordinates beyond single precision".to_owned());
        let inside = if self == Format::Su2 && mesh.is_planar() { su2::inner_edges(mesh) } else { 0 };
        let inside = (inside > 0).then(|| format!("{inside} labelled edges that are not on the boundary"));
        lost(kept, mesh, fields).into_iter().chain(digits).chain(inside).collect()
    }
}

fn lost(kept: &[Part], mesh: &Mesh, fields: &Fields) -> Vec<String> {
    let labels = |labels: &[i32]| labels.iter().filter(|&&label| label != 0).count();
    let of_vertices = mesh.corners.len() + mesh.required_points.len();
    let marks = mesh.ridges.len() + mesh.required_edges.len() + mesh.required_triangles.len();
    let all = [
        (Part::PointLabels, labels(&mesh.point_labels), "labels of vertices"),
        (Part::TriangleLabels, labels(&mesh.triangle_labels), "labels of triangles"),
        (Part::Edges, mesh.edges.len(), "labelled edges"),
        (Part::EdgeLabels, labels(&mesh.edge_labels), "labels of edges"),
        (Part::VertexMarks, of_vertices, "corners and required vertices"),
        (Part::Marks, marks, "ridges, required edges and triangles"),
        (Part::Fields, fields.vertices.len() + fields.triangles.len(), "fields"),
    ];
    // Where edges are lost so are their labels, which goes without saying.
    let is_said = |part| part != Part::EdgeLabels || kept.contains(&Part::Edges);
    let lost = all.into_iter().filter(|&(part, count, _)| count > 0 && !kept.contains(&part) && is_said(part));
    lost.map(|(_, count, what)| format!("{count} {what}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_lost_is_counted() {
        let mesh = Mesh {
            point_labels: vec![0, 3, 0],
            triangle_labels: vec![1],
            edges: vec![[0, 1]],
            edge_labels: vec![5],
            corners: vec![0, 1],
            ..Mesh::default()
        };
        let lost = |format: Format| format.lost(&mesh, &Fields::default());
        assert!(lost(Format::Vtu).is_empty());
        assert_eq!(lost(Format::Obj), ["1 labels of vertices", "1 labels of edges", "2 corners and required vertices"]);
        assert_eq!(lost(Format::Off).len(), 4);
    }
}
