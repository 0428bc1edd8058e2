//! Meshes that the tests of this module share.

use crate::geometry::{Point, Tensor};
use crate::mesh::Mesh;

/// The unit square as 2 n^2 triangles, inner vertices moved by up to half `jitter` of a cell's width along each axis.
pub(crate) fn grid(n: u32, jitter: f64) -> Mesh {
    let step = 1.0 / f64::from(n);
    let moved = |k: u32, seed: f64| {
        let noise = (f64::from(k) * 12.9898 + seed).sin() * 43_758.545;
        (noise - noise.floor() - 0.5) * jitter * step
    };
    let position = |k: u32| {
        let (i, j) = (k % (n + 1), k / (n + 1));
        let inside = f64::from(u8::from(i % n != 0 && j % n != 0));
        [f64::from(i) * step + inside * moved(k, 1.0), f64::from(j) * step + inside * moved(k, 2.0), 0.0]
    };
    let cell = |k: u32| {
        let a = k % n + k / n * (n + 1);
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    Mesh {
        points: (0..(n + 1) * (n + 1)).map(position).collect(),
        triangles: (0..n * n).flat_map(cell).collect(),
        ..Mesh::default()
    }
}

/// A field at the vertices.
pub(crate) fn tensors_at(mesh: &Mesh, field: impl Fn(Point) -> Tensor) -> Vec<Tensor> {
    (0..mesh.points.len() as u32).map(|v| field(mesh.point(v))).collect()
}
