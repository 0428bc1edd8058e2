//! Errors, overshoot, masses and seconds of transfer between meshes of the unit square: `cargo bench -p voronaut --bench transfer`.
//!
//! Meshes are grids of mixed diagonals with vertices moved at random, no two alike; `thin` ones are squeezed 100 times along y, so
//! that triangles are thin. A function is sampled on the first mesh, carried, and measured against itself; *again* means 20 times
//! to and fro.

use std::hint::black_box;
use std::time::Instant;
use voronaut::geometry::Point;
use voronaut::mesh::Mesh;
use voronaut::transfer::{Carried, Field, Kind, Overshoot, Place, conservative, interpolate};

type Carry = fn(&Mesh, &Mesh, &[Field]) -> Carried;

const METHODS: [(&str, Carry); 3] = [
    ("interpolate", |old, new, fields| interpolate(old, new, fields).expect("one domain").0.remove(0)),
    ("conservative", |old, new, fields| {
        conservative(old, new, fields, Overshoot::Spread).expect("one domain").0.remove(0)
    }),
    ("  overshooting", |old, new, fields| {
        conservative(old, new, fields, Overshoot::Kept).expect("one domain").0.remove(0)
    }),
];

fn main() {
    let smooth = |p: Point| (6.0 * p.x).sin() * (4.0 * p.y + 1.0).cos();
    let front = |p: Point| 0.5 + 0.5 * (60.0 * (p.x + 0.4 * p.y - 0.613)).tanh();
    let jump = |p: Point| f64::from(u8::from(p.x + 0.4 * p.y > 0.613));
    println!("function n^2 times method           error     overshoot  drift     seconds");
    for (name, f) in [("smooth", &smooth as &dyn Fn(Point) -> f64), ("front", &front), ("jump", &jump)] {
        for n in [20, 40, 80] {
            for times in [1, 20] {
                compare(name, f, n, times, 1.0);
            }
        }
    }
    for (n, squeeze) in [(100, 1.0), (316, 1.0), (316, 0.01)] {
        compare(if squeeze < 1.0 { "thin" } else { "smooth" }, &smooth, n, 1, squeeze);
    }
}

fn compare(name: &str, f: &dyn Fn(Point) -> f64, n: u32, times: u32, squeeze: f64) {
    let meshes = [square(n, 0.35, 0.4, squeeze), square(n - n / 10, 0.35, 2.0, squeeze)];
    let at = |v: u32, mesh: &Mesh| f(Point::new(mesh.point(v).x, mesh.point(v).y / squeeze));
    let values = (0..meshes[0].points.len() as u32).map(|v| at(v, &meshes[0])).collect();
    let first = Field { place: Place::Vertices, kind: Kind::Linear(1), values };
    let (low, high) = first.values.iter().fold((0.0_f64, 0.0_f64), |(low, high), &u| (low.min(u), high.max(u)));
    for (method, carry) in METHODS {
        let (start, mut field, mut drift, mut over) = (Instant::now(), first.clone(), 0.0_f64, 0.0_f64);
        for i in 0..times as usize {
            let carried = carry(&meshes[i % 2], &meshes[(i + 1) % 2], &[field]);
            drift += carried.after[0].mass - carried.before[0].mass;
            over = over.max(low - carried.after[0].min).max(carried.after[0].max - high);
            field = black_box(carried.field);
        }
        let seconds = start.elapsed().as_secs_f64() / f64::from(times);
        let error = distance(&meshes[times as usize % 2], &field, f, squeeze);
        let drift = drift.abs() / squeeze;
        println!(
            "{name:<8} {:>6} x{times:<3} {method:<16} {error:.3e} {over:>10.1e} {drift:>9.1e} {seconds:>9.3}",
            n * n
        );
    }
}

/// The L2 distance of a field and a function, over the unit square, by 36 points in every triangle.
fn distance(mesh: &Mesh, field: &Field, f: &dyn Fn(Point) -> f64, squeeze: f64) -> f64 {
    let mut sum = 0.0;
    for &t in &mesh.triangles {
        let ([a, b, c], [fa, fb, fc]) = (mesh.corners_of(t), t.map(|v| field.values[v as usize]));
        let area = 0.5 * (b - a).cross(c - a).abs() / squeeze;
        for i in 0..8 {
            for j in 0..8 - i {
                let (s, t) = ((f64::from(i) + 1.0 / 3.0) / 8.0, (f64::from(j) + 1.0 / 3.0) / 8.0);
                let p = a + (b - a) * s + (c - a) * t;
                sum += area / 36.0 * (fa + s * (fb - fa) + t * (fc - fa) - f(Point::new(p.x, p.y / squeeze))).powi(2);
            }
        }
    }
    sum.sqrt()
}

fn square(n: u32, wobble: f64, seed: f64, squeeze: f64) -> Mesh {
    let step = 1.0 / f64::from(n);
    let noise = |i: u32, j: u32| {
        let is_inside = !(i.is_multiple_of(n) || j.is_multiple_of(n));
        wobble * step * (f64::from(i * 7 + j * 13) * 1.7 + seed).sin() * f64::from(u8::from(is_inside))
    };
    let position = |k: u32| {
        let (i, j) = (k % (n + 1), k / (n + 1));
        [f64::from(i) * step + noise(i, j), squeeze * (f64::from(j) * step + noise(j, i)), 0.0]
    };
    let cell = |k: u32| {
        let a = k % n + k / n * (n + 1);
        let (b, c, d) = (a + 1, a + n + 1, a + n + 2);
        if (k + seed as u32).is_multiple_of(3) { [[a, b, c], [b, d, c]] } else { [[a, b, d], [a, d, c]] }
    };
    Mesh {
        points: (0..(n + 1) * (n + 1)).map(position).collect(),
        triangles: (0..n * n).flat_map(cell).collect(),
        ..Mesh::default()
    }
}
