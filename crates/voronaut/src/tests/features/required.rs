//! What the user marks stays: vertices, edges and triangles that are required, and sizes given at the vertices of the file.

use crate::manifold::Manifold;
use crate::manifold::surface::FeatureOptions;
use crate::manifold::surface::metric::{Sampled, Spec, field};
use crate::mesh::{Mesh, Solution, SolutionValues};
use crate::metric::Bounds;
use crate::progress::Silent;
use crate::quality::{check, metric_quality};
use crate::recipe::{MeshOptions, mesh_surface};
use crate::tests::parts;
use std::collections::BTreeSet;

fn cube() -> Mesh {
    parts::all().into_iter().find(|part| part.name == "cube").unwrap().mesh
}

fn cut(mesh: &Mesh) -> Manifold {
    Manifold::of(mesh).unwrap().cut(&FeatureOptions::default()).unwrap()
}

fn bits(mesh: &Mesh, v: u32) -> [u64; 3] {
    mesh.points[v as usize].map(f64::to_bits)
}

#[test]
fn required_vertices_edges_and_triangles_stay_to_the_last_bit() {
    let mut mesh = cube();
    // A triangle, all of whose corners are inside a side; and the edges and a vertex of others.
    let is_inner = |v: &u32| mesh.points[*v as usize].iter().filter(|&&x| (x - 0.5).abs() >= 0.5).count() == 1;
    let inner: Vec<u32> =
        (0..mesh.triangles.len() as u32).filter(|&t| mesh.triangles[t as usize].iter().all(is_inner)).collect();
    let [first, second, third] = [inner[0], inner[inner.len() / 2], inner[inner.len() - 1]];
    mesh.required_triangles = vec![first];
    let [a, b, c] = mesh.triangles[second as usize];
    (mesh.edges, mesh.edge_labels, mesh.required_edges) = (vec![[a, b], [b, c]], vec![7, 7], vec![0, 1]);
    mesh.required_points = vec![mesh.triangles[third as usize][0]];
    let manifold = cut(&mesh);
    let metric = field(&Spec::parse("uniform").unwrap(), &manifold, Bounds::default()).unwrap();
    let options = MeshOptions { vertices: Some(400), ..MeshOptions::default() };
    let made = mesh_surface(&manifold, metric.as_ref(), None, &options, &Silent).unwrap().mesh;
    check(&made).unwrap();
    let places: BTreeSet<[u64; 3]> = (0..made.points.len() as u32).map(|v| bits(&made, v)).collect();
    assert!(places.contains(&bits(&mesh, mesh.required_points[0])));
    let triangle = |mesh: &Mesh, t: u32| mesh.triangles[t as usize].map(|v| bits(mesh, v)).into_iter().collect();
    let truth: BTreeSet<[u64; 3]> = triangle(&mesh, first);
    assert_eq!(made.required_triangles.len(), 1);
    assert_eq!(triangle(&made, made.required_triangles[0]), truth);
    let edge = |mesh: &Mesh, e: u32| mesh.edges[e as usize].map(|v| bits(mesh, v)).into_iter().collect();
    let found: Vec<BTreeSet<[u64; 3]>> = made.required_edges.iter().map(|&e| edge(&made, e)).collect();
    for e in 0..2 {
        assert!(found.contains(&edge(&mesh, e)), "edge {e}");
    }
    assert!(made.required_points.iter().any(|&v| bits(&made, v) == bits(&mesh, mesh.required_points[0])));
}

#[test]
fn sizes_at_the_vertices_of_the_file_hold_on_all_sides_of_creases() {
    let mesh = cube();
    // Finer towards the edge x = y = 0, which two sides have.
    let sizes = mesh.points.iter().map(|p| 0.05 + 0.15 * p[0].max(p[1])).collect();
    let solution = Solution { dimension: 3, values: SolutionValues::Scalar(sizes) };
    let manifold = cut(&mesh);
    let metric = Sampled::from_solution(manifold.surface(), &manifold.spread(&solution).unwrap()).unwrap();
    let made = mesh_surface(&manifold, &metric, None, &MeshOptions::default(), &Silent).unwrap().mesh;
    check(&made).unwrap();
    let quality = metric_quality(&made, (&manifold, &metric)).unwrap();
    println!("{} vertices, {:?}", made.points.len(), quality.metric_edge_length);
    assert!(quality.metric_edge_length.unit_fraction > 0.95, "{:?}", quality.metric_edge_length);
    let few = Solution { dimension: 3, values: SolutionValues::Scalar(vec![1.0; 3]) };
    assert!(manifold.spread(&few).unwrap_err().to_string().contains("3 values for"));
}
