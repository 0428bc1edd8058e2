use super::*;
use crate::geometry::{Point3, Tensor3};
use crate::manifold::Manifold;
use crate::manifold::surface::metric::Constant;
use crate::manifold::surface::metric::SurfaceMetric;
use crate::manifold::surface::{FeatureOptions, sphere, torus};
use crate::progress::Silent;
use crate::quality::{Meetings, validity_on};
use crate::recipe::{Effort, mesh_surface};

fn options(vertices: usize) -> MeshOptions {
    MeshOptions { vertices: Some(vertices), effort: Effort::Fast, ..MeshOptions::default() }
}

/// The mesh in parts, and how many parts each round had.
fn made(
    manifold: &Manifold,
    metric: &dyn SurfaceMetric,
    parts: usize,
    options: &MeshOptions,
) -> Result<(Meshed, Vec<usize>)> {
    let mut rounds = Vec::new();
    let mut make = |_: &'static str, parts: &[Part], take: &mut dyn FnMut(Mesh)| {
        rounds.push(parts.len());
        let mesh = |part| mesh_surface_part(part, manifold, metric, None, options, &Silent);
        parts.iter().try_for_each(|part| mesh(part).map(&mut *take))
    };
    let meshed = mesh_surface_in_parts(manifold, metric, Some(parts), options, &mut make, &Silent)?;
    Ok((meshed, rounds))
}

/// The shares of edges of metric length between 1 / sqrt 2 and sqrt 2.
fn unit_share(mesh: &Mesh, metric: &dyn Fn(Point3) -> Tensor3) -> f64 {
    let ends: Vec<[u32; 2]> = Edges::of(&mesh.triangles).ends().collect();
    let unit = ends.iter().filter(|&&[a, b]| {
        let (p, q) = (mesh.position(a), mesh.position(b));
        let length = metric(p.lerp(q, 0.5)).length(q - p);
        (0.5_f64.sqrt()..=2.0_f64.sqrt()).contains(&length)
    });
    unit.count() as f64 / ends.len() as f64
}

#[test]
fn closed_surfaces_come_together_again() {
    let turning = |p: Point3| Tensor3::IDENTITY * (1.0 + p.z * p.z);
    for surface in [sphere(1.0, 0.15).unwrap(), torus(2.0, 0.7, 0.3).unwrap()] {
        let euler = surface.euler_characteristic();
        let manifold = Manifold::new(surface, None).cut(&FeatureOptions::default()).unwrap();
        for parts in [2, 3] {
            let (meshed, rounds) = made(&manifold, &turning, parts, &options(3600)).unwrap();
            let found = validity_on(&meshed.mesh, &Meetings::of(manifold.whole_mesh()));
            assert!(found.valid && (found.euler, found.boundary_loops) == (euler, 0), "{found:?}");
            assert_eq!((meshed.mesh.points.len(), rounds[0]), (3600, parts), "{:?}", meshed.notes);
            assert!(meshed.mesh.edges.is_empty() && meshed.mesh.corners.is_empty(), "nothing of cuts is left");
            let one = mesh_surface(&manifold, &turning, None, &options(3600), &Silent).unwrap();
            let share = |of: &Meshed| unit_share(&of.mesh, &|p| turning(p) * of.metric_scale);
            assert!(share(&meshed) > share(&one) - 0.01, "{} for {} in one piece", share(&meshed), share(&one));
        }
    }
}

/// Of twelve triangles, with creases, labels and a required edge.
#[test]
fn features_of_a_cube_stay() {
    let points = (0..8).map(|i| [f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)]).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let triangle_labels = (0..12).map(|t| t / 2 + 1).collect();
    let edges = vec![[0, 1]];
    let cube = Mesh { points, triangles, triangle_labels, edges, edge_labels: vec![5], ..Mesh::default() };
    let manifold = Manifold::of(&cube).unwrap().cut(&FeatureOptions::default()).unwrap();
    let metric = Constant(Tensor3::IDENTITY);
    let (meshed, _) = made(&manifold, &metric, 2, &options(2400)).unwrap();
    let mesh = &meshed.mesh;
    assert!(validity_on(mesh, &Meetings::of(manifold.whole_mesh())).valid);
    let one = mesh_surface(&manifold, &metric, None, &options(2400), &Silent).unwrap().mesh;
    let length = |mesh: &Mesh, label: i32| -> f64 {
        let of = mesh.edges.iter().zip(&mesh.edge_labels).filter(|(_, it)| **it == label);
        of.map(|(&[a, b], _)| mesh.position(a).distance(mesh.position(b))).sum()
    };
    for label in [0, 5] {
        assert!((length(mesh, label) - length(&one, label)).abs() < 1e-12, "{label}: {}", length(mesh, label));
    }
    assert_eq!((mesh.corners.len(), mesh.ridges.len()), (8, mesh.edges.len()));
    let area = |label: i32| -> f64 {
        let of = mesh.triangles.iter().zip(&mesh.triangle_labels).filter(|(_, it)| **it == label);
        of.map(|(&t, _)| mesh.positions_of(t)).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).norm()).sum()
    };
    assert!((1..=6).all(|label| (area(label) - 1.0).abs() < 1e-12), "{:?}", (1..=6).map(area).collect::<Vec<_>>());
}

#[test]
fn what_is_of_the_whole_is_refused_by_name() {
    let manifold = Manifold::new(sphere(1.0, 0.3).unwrap(), None);
    let message =
        |options: &MeshOptions| made(&manifold, &Constant(Tensor3::IDENTITY), 2, options).unwrap_err().to_string();
    let of = options(3000);
    for changed in [MeshOptions { fit: true, ..of.clone() }, MeshOptions { hausd: Some(0.1), ..of.clone() }] {
        assert!(message(&changed).contains("distances to the surface of a mesh in parts"), "{}", message(&changed));
    }
    assert!(message(&options(1500)).contains("1500 vertices in 2 parts"), "{}", message(&options(1500)));
}
