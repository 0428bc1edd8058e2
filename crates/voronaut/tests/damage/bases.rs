//! Surfaces before anything happens to them.

use super::random::Random;
use std::collections::HashMap;
use voronaut::mesh::Mesh;

/// A closed or bordered surface without damage.
pub(crate) fn base(random: &mut Random) -> Mesh {
    let n = 3 + random.below(6) as u32;
    match random.below(6) {
        0 => cube(n),
        1 => grid(2 * n, n + 3, true, |u, v| round(3.0 + v.cos(), u, v.sin())),
        2 => sphere(n),
        3 => grid(n + 2, n + 2, false, |u, v| [u, v, 0.3 * (2.0 * u).sin() * v]),
        4 => voronaut_io::read(data("spot.obj").as_ref()).expect("a mesh").mesh,
        _ => voronaut_io::read(data("bob_small.obj").as_ref()).expect("a mesh").mesh,
    }
}

fn data(name: &str) -> String {
    format!("{}/../../data/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn round(r: f64, angle: f64, z: f64) -> [f64; 3] {
    [r * angle.cos(), r * angle.sin(), z]
}

/// The unit cube, each face n x n squares.
pub(crate) fn cube(n: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let mut known = HashMap::new();
    for (axis, is_far) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
        let mut vertex = |i: u32, j: u32| {
            let mut p = [0; 3];
            (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (if is_far { n } else { 0 }, i, j);
            *known.entry(p).or_insert_with(|| {
                mesh.points.push(p.map(|x| f64::from(x) / f64::from(n)));
                mesh.points.len() as u32 - 1
            })
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]].map(|[p, q, r]| if is_far { [p, q, r] } else { [p, r, q] }));
        }
    }
    mesh
}

/// The cube, blown up.
fn sphere(n: u32) -> Mesh {
    let mut mesh = cube(n);
    for p in &mut mesh.points {
        let q = p.map(|x| x - 0.5);
        let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        *p = q.map(|x| x / norm);
    }
    mesh
}

/// A grid in two angles, closed in both or in none.
fn grid(long: u32, short: u32, is_closed: bool, at: impl Fn(f64, f64) -> [f64; 3]) -> Mesh {
    let rim = u32::from(!is_closed);
    let angle = |i: u32, n: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    let points = (0..short + rim).flat_map(|j| (0..long + rim).map(move |i| (i, j)));
    let points = points.map(|(i, j)| at(angle(i, long), angle(j, short))).collect();
    let vertex = |i: u32, j: u32| i % (long + rim) + j % (short + rim) * (long + rim);
    let cells = (0..short).flat_map(|j| (0..long).map(move |i| (i, j)));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    Mesh { triangles: triangles.collect(), points, ..Mesh::default() }
}

/// The same with other numbers, other orders, and other units.
pub(crate) fn renumbered(mesh: &Mesh, random: &mut Random) -> Mesh {
    let mut order: Vec<usize> = (0..mesh.points.len()).collect();
    random.shuffle(&mut order);
    let mut number = vec![0; order.len()];
    for (new, &old) in (0..).zip(&order) {
        number[old] = new;
    }
    let scale = 10.0_f64.powf(18.0 * random.unit() - 9.0);
    let mut triangles: Vec<[u32; 3]> = mesh.triangles.iter().map(|t| t.map(|v| number[v as usize])).collect();
    random.shuffle(&mut triangles);
    for t in &mut triangles {
        t.rotate_left(random.below(3));
    }
    let points = order.iter().map(|&old| mesh.points[old].map(|x| x * scale)).collect();
    Mesh { points, triangles, ..Mesh::default() }
}
