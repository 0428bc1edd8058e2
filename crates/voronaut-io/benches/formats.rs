//! How long every format takes to write and read a mesh of an n x n grid, with labels and fields.
//!
//! `cargo bench -p voronaut --bench formats -- 708` for a million triangles (the default); numbers are seconds and megabytes (10^6
//! bytes) per second, of files in the directory for temporary files.

use std::time::Instant;
use voronaut::mesh::{Mesh, SolutionValues};
use voronaut_io::{Field, Fields, Format, write_document};

const ENDINGS: [&str; 9] = ["mesh", "meshb", "msh", "obj", "off", "ply", "stl", "vtu", "vtp"];

fn main() {
    let n = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(708);
    let mesh = grid(n);
    let place = tempfile::tempdir().expect("a directory for files");
    println!("{} vertices, {} triangles", mesh.points.len(), mesh.triangles.len());
    println!("{:>14} {:>10} {:>9} {:>9} {:>9} {:>9}", "", "MB", "write s", "MB/s", "read s", "MB/s");
    for (name, fields) in [("", Fields::default()), (" and fields", fields(&mesh))] {
        for ending in ENDINGS.iter().filter(|ending| name.is_empty() || ["msh", "ply", "vtu", "vtp"].contains(ending)) {
            let path = place.path().join(format!("grid.{ending}"));
            let start = Instant::now();
            write_document(&mesh, &fields, &path).expect("a mesh written");
            let written = start.elapsed().as_secs_f64();
            let size = std::fs::metadata(&path).expect("a file").len() as f64 / 1e6;
            let start = Instant::now();
            let read = voronaut_io::read(&path).expect("a mesh read");
            let seconds = start.elapsed().as_secs_f64();
            assert_eq!(read.mesh.triangles.len(), mesh.triangles.len());
            assert!(Format::of_ending(&path).is_some());
            let [out, back] = [written, seconds].map(|seconds| size / seconds);
            println!("{:>14} {size:10.1} {written:9.3} {out:9.0} {seconds:9.3} {back:9.0}", format!(".{ending}{name}"));
        }
    }
}

/// A grid of n x n vertices, shaken a little so that coordinates have all their digits.
fn grid(n: u32) -> Mesh {
    let step = 1.0 / f64::from(n - 1);
    let at = |k: u32| {
        let (i, j) = (f64::from(k % n), f64::from(k / n));
        [step * (i + 0.3 * (7.0 * j).sin()), step * (j + 0.3 * (5.0 * i).sin()), 0.0]
    };
    let squares = (0..(n - 1) * (n - 1)).map(|k| k % (n - 1) + k / (n - 1) * n);
    let triangles: Vec<[u32; 3]> = squares.flat_map(|a| [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]).collect();
    let edges: Vec<[u32; 2]> = (1..n).map(|i| [i - 1, i]).collect();
    Mesh {
        points: (0..n * n).map(at).collect(),
        point_labels: vec![1; (n * n) as usize],
        triangle_labels: vec![2; triangles.len()],
        triangles,
        edge_labels: vec![3; edges.len()],
        edges,
        ..Mesh::default()
    }
}

fn fields(mesh: &Mesh) -> Fields {
    let of = |point: &[f64; 3]| (3.0 * point[0]).sin() + point[1];
    let metric = |point: &[f64; 3]| [2.0 + of(point), 0.1 * of(point), 3.0];
    let scalar = SolutionValues::Scalar(mesh.points.iter().map(of).collect());
    let tensor = SolutionValues::Tensor(mesh.points.iter().map(metric).collect());
    let cells = SolutionValues::Scalar(mesh.triangles.iter().map(|t| f64::from(t[0]).sqrt()).collect());
    let field = |name: &str, values| Field { name: name.into(), values };
    Fields { vertices: vec![field("u", scalar), field("metric", tensor)], triangles: vec![field("error", cells)] }
}
