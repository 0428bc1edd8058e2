//! What formats have no place for.

use super::gmsh::Version;
use super::{Fields, Format};
use voronaut::mesh::Mesh;

/// What a format keeps of a mesh besides positions and triangles.
#[derive(Default)]
#[expect(clippy::struct_excessive_bools, reason = "a table of what is kept")]
struct Kept {
    point_labels: bool,
    triangle_labels: bool,
    edges: bool,
    edge_labels: bool,
    /// Corners, and required vertices.
    vertex_marks: bool,
    /// Ridges, and required edges and triangles.
    marks: bool,
    /// Beside a `.mesh` they have a file of their own.
    fields: bool,
}

/// What a `.poly`, or else a `.geojson`, would not hold of a planar mesh and its fields besides its triangles, in words.
pub fn lost_in_outline(is_poly: bool, mesh: &Mesh, fields: &Fields) -> Vec<String> {
    let outline = Kept { triangle_labels: true, edges: true, edge_labels: true, ..Kept::default() };
    Kept { point_labels: is_poly, ..outline }.lost(mesh, fields)
}

impl Kept {
    fn lost(&self, mesh: &Mesh, fields: &Fields) -> Vec<String> {
        let labels = |labels: &[i32]| labels.iter().filter(|&&label| label != 0).count();
        let of_vertices = [&mesh.corners, &mesh.required_points].map(Vec::len).into_iter().sum();
        let marks = [&mesh.ridges, &mesh.required_edges, &mesh.required_triangles].map(Vec::len).into_iter().sum();
        let all = [
            (self.point_labels, labels(&mesh.point_labels), "labels of vertices"),
            (self.triangle_labels, labels(&mesh.triangle_labels), "labels of triangles"),
            (self.edges, mesh.edges.len(), "labelled edges"),
            (self.edge_labels || !self.edges, labels(&mesh.edge_labels), "labels of edges"),
            (self.vertex_marks, of_vertices, "corners and required vertices"),
            (self.marks, marks, "ridges, required edges and triangles"),
            (self.fields, fields.vertices.len() + fields.triangles.len(), "fields"),
        ];
        let lost = all.into_iter().filter(|(kept, count, _)| !kept && *count > 0);
        lost.map(|(_, count, what)| format!("{count} {what}")).collect()
    }
}

impl Format {
    /// What of a mesh and its fields a file of the format would not hold, in words; empty if nothing is lost.
    pub fn lost(self, mesh: &Mesh, fields: &Fields) -> Vec<String> {
        let is_rounded = |x: &f64| f64::from(*x as f32).to_bits() != x.to_bits();
        let digits = self == Format::Stl && mesh.points.as_flattened().iter().any(is_rounded);
        let digits = digits.then(|| "digits of coordinates beyond single precision".to_owned());
        self.kept().lost(mesh, fields).into_iter().chain(digits).collect()
    }

    fn kept(self) -> Kept {
        let all = Kept {
            point_labels: true,
            triangle_labels: true,
            edges: true,
            edge_labels: true,
            vertex_marks: true,
            marks: true,
            fields: true,
        };
        match self {
            Format::Medit(_) | Format::Vtu | Format::Vtp | Format::Gmsh(Version::V4_1, _) => all,
            // Marks of vertices are kept, of edges and triangles not.
            Format::Gmsh(Version::V2_2, _) => Kept { marks: false, ..all },
            Format::Ply(_) => Kept { point_labels: true, triangle_labels: true, fields: true, ..Kept::default() },
            Format::Obj => Kept { triangle_labels: true, edges: true, ..Kept::default() },
            Format::Off | Format::Stl => Kept::default(),
        }
    }
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
