//! Small meshes for tests.

use voronaut::mesh::Mesh;

/// A mesh without labels.
pub(crate) fn mesh(points: &[[f64; 2]], triangles: &[[u32; 3]]) -> Mesh {
    Mesh {
        points: points.iter().map(|&[x, y]| [x, y, 0.0]).collect(),
        point_labels: vec![0; points.len()],
        triangles: triangles.to_vec(),
        triangle_labels: vec![1; triangles.len()],
        ..Mesh::default()
    }
}

/// The rectangle [0, columns] x [0, rows] in unit squares, each cut from lower left to upper right.
pub(crate) fn grid(columns: u32, rows: u32) -> Mesh {
    let points: Vec<[f64; 2]> =
        (0..=rows).flat_map(|j| (0..=columns).map(move |i| [f64::from(i), f64::from(j)])).collect();
    let mut triangles = Vec::new();
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let a = j * (columns + 1) + i;
        let d = a + columns + 1;
        triangles.extend([[a, a + 1, d + 1], [a, d + 1, d]]);
    }
    mesh(&points, &triangles)
}
