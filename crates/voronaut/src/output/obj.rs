//! Wavefront `.obj`.

use crate::mesh::Mesh;
use std::fmt::Write;

/// A mesh as the text of an `.obj` file: vertices in order, triangles in order with a group `region_LABEL` wherever the
/// label changes, then the labelled edges as lines. Coordinates read back as the same bits.
pub(super) fn obj(mesh: &Mesh) -> String {
    let mut text = String::from("# voronaut\n");
    // Writing to a string cannot fail.
    for [x, y, z] in &mesh.points {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    let mut group = None;
    for (i, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        let label = mesh.triangle_labels.get(i).copied().unwrap_or(0);
        if group.replace(label) != Some(label) {
            let _ = writeln!(text, "g region_{label}");
        }
        let [a, b, c] = [a, b, c].map(|v| u64::from(v) + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    if !mesh.edges.is_empty() {
        text.push_str("g edges\n");
    }
    for &[a, b] in &mesh.edges {
        let _ = writeln!(text, "l {} {}", u64::from(a) + 1, u64::from(b) + 1);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_regions() {
        let mesh = Mesh {
            points: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.0, 1.0, 0.0]],
            point_labels: vec![0; 4],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            triangle_labels: vec![1, -2],
            edges: vec![[0, 2]],
            edge_labels: vec![7],
            ..Mesh::default()
        };
        let expected = "# voronaut\nv 0 0 0\nv 1 0 0\nv 1 0.1 0\nv 0 1 0\n\
                        g region_1\nf 1 2 3\ng region_-2\nf 1 3 4\ng edges\nl 1 3\n";
        assert_eq!(obj(&mesh), expected);
    }
}
