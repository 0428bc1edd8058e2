//! Small meshes with known figures.

use crate::mesh::Mesh;

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

/// Equilateral triangles of side 1: a sheared grid.
pub(crate) fn lattice(n: u32) -> Mesh {
    let mut lattice = grid(n, n);
    for p in &mut lattice.points {
        // The grid's diagonals are its long ones after shearing to the right, so it is sheared to the left.
        (p[0], p[1]) = (p[0] - 0.5 * p[1], p[1] * 0.75_f64.sqrt());
    }
    lattice
}

/// A 3 x 3 grid without its middle square.
pub(crate) fn with_hole() -> Mesh {
    let mut holed = grid(3, 3);
    holed.triangles.drain(8..10);
    holed.triangle_labels.drain(8..10);
    holed
}

/// Triangles around a vertex that turn so many times; vertices of later turns lie farther out.
pub(crate) fn fan(triangles: u32, turns: u32) -> Mesh {
    let mut points = vec![[0.0, 0.0]];
    points.extend((0..triangles).map(|i| {
        let angle = std::f64::consts::TAU * f64::from(turns) * f64::from(i) / f64::from(triangles);
        let radius = 1.0 + f64::from(i) * 0.01;
        [radius * angle.cos(), radius * angle.sin()]
    }));
    let corners: Vec<[u32; 3]> = (0..triangles).map(|i| [0, 1 + i, 1 + (i + 1) % triangles]).collect();
    mesh(&points, &corners)
}
