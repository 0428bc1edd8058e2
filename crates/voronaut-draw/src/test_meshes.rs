//! Small meshes for tests.

use voronaut::mesh::{Curved, Mesh};

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

/// A square of side 1 in two triangles of order 2 or 3, whose lower side is bowed down by 0.2.
pub(crate) fn bowed(order: usize) -> Mesh {
    let mut bowed = mesh(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], &[[0, 1, 2], [2, 3, 0]]);
    let along = |a: usize, b: usize, bow: f64| {
        let [p, q] = [a, b].map(|v| bowed.points[v]);
        let at = move |i: usize| i as f64 / order as f64;
        (1..order).map(move |i| [0, 1, 2].map(|k| p[k] + at(i) * (q[k] - p[k]) - if k == 1 { bow } else { 0.0 }))
    };
    let sides = [(0, 1, 0.2), (1, 2, 0.0), (2, 0, 0.0), (2, 3, 0.0), (3, 0, 0.0)];
    let nodes = sides.into_iter().flat_map(|(a, b, bow)| along(a, b, bow)).chain([[0.6, 0.4, 0.0], [0.4, 0.6, 0.0]]);
    let triangles = if order == 2 { vec![0, 1, 2, 3, 4, 2] } else { vec![0, 1, 2, 3, 4, 5, 10, 6, 7, 8, 9, 5, 4, 11] };
    let nodes = nodes.collect();
    bowed.curved = Some(Curved { order, nodes, triangles });
    bowed
}
