//! Laws of transfer between meshes of one surface.

use super::*;
use crate::geometry::Point3;
use crate::manifold::surface::{sphere, torus};
use crate::test_cases::cube;

fn sampled(mesh: &Mesh, f: impl Fn(Point3) -> f64) -> Field {
    let values = mesh.points.iter().map(|&p| f(p.into())).collect();
    Field { place: Place::Vertices, kind: Kind::Linear(1), values }
}

fn worst(field: &Field, truth: &Field) -> f64 {
    field.values.iter().zip(&truth.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn both_ways(old: &Mesh, new: &Mesh, field: &Field) -> [(Carried, Cover); 2] {
    let one = |(mut carried, cover): (Vec<Carried>, Cover)| (carried.swap_remove(0), cover);
    let fields = std::slice::from_ref(field);
    [one(interpolate(old, new, fields).unwrap()), one(conservative(old, new, fields, Overshoot::default()).unwrap())]
}

#[test]
fn the_same_mesh_gives_values_back() {
    for mesh in [sphere(1.0, 0.3).unwrap().to_mesh(), cube(4, 0.2)] {
        let field = sampled(&mesh, |p| (3.0 * p.x).sin() + p.y * p.z);
        for (carried, _) in both_ways(&mesh, &mesh, &field) {
            assert!(worst(&carried.field, &field) < 1e-11, "{}", worst(&carried.field, &field));
        }
    }
}

/// Where both meshes have their vertices in the same flat facets, all is exact.
#[test]
fn on_flat_facets_linear_functions_are_reproduced() {
    let (old, new) = (cube(5, 0.3), cube(7, 0.2));
    let linear = |p: Point3| 2.0 * p.x - p.y + 0.5 * p.z + 3.0;
    let truth = sampled(&new, linear);
    for (carried, cover) in both_ways(&old, &new, &sampled(&old, linear)) {
        assert!(worst(&carried.field, &truth) < 1e-11, "{}", worst(&carried.field, &truth));
        assert!((carried.after[0].mass - carried.before[0].mass).abs() < 1e-12 * carried.before[0].mass);
        assert!(cover.areas.is_none_or(|shares| shares.uncovered == 0.0 && shares.left.abs() < 1e-12), "{cover:?}");
    }
}

#[test]
fn on_curved_surfaces_masses_are_kept_and_errors_fall_with_second_order() {
    let smooth = |p: Point3| 2.0 + (3.0 * p.x).sin() * p.y + p.z;
    let error = |size: f64| -> [f64; 2] {
        let (old, new) = (torus(1.0, 0.4, size).unwrap().to_mesh(), torus(1.0, 0.4, 0.83 * size).unwrap().to_mesh());
        let truth = sampled(&new, smooth);
        let found = both_ways(&old, &new, &sampled(&old, smooth));
        let [before, after] = [&found[1].0.before[0], &found[1].0.after[0]].map(|extent| extent.mass);
        assert!((after - before).abs() < 1e-12 * before, "{before} {after}");
        let shares = found[1].1.areas.unwrap();
        assert!(shares.uncovered < 0.02 && shares.overlapped < 0.02 && shares.left.abs() < 0.05, "{shares:?}");
        found.map(|(carried, _)| worst(&carried.field, &truth))
    };
    let (coarse, fine) = (error(0.1), error(0.05));
    assert!((0..2).all(|i| fine[i] < 0.4 * coarse[i]), "{coarse:?} {fine:?}");
}

/// A plate thinner than its triangles: its two sides do not mix.
#[test]
fn sides_of_a_thin_plate_are_told_apart() {
    let thin = |n| {
        let mut mesh = cube(n, 0.2);
        mesh.points.iter_mut().for_each(|p| p[2] *= 1e-3);
        mesh
    };
    let (old, new) = (thin(5), thin(6));
    let side = |p: Point3| 1e3 * p.z;
    let field = sampled(&old, side);
    let (carried, _) = conservative(&old, &new, &[field], Overshoot::default()).unwrap();
    assert!(worst(&carried[0].field, &sampled(&new, side)) < 1e-9);
}

#[test]
fn metrics_of_space_are_interpolated_by_their_logarithms() {
    let (old, new) = (sphere(1.0, 0.3).unwrap().to_mesh(), sphere(1.0, 0.2).unwrap().to_mesh());
    let values = |mesh: &Mesh| mesh.points.iter().flat_map(|_| [9.0, 1.0, 4.0, 0.0, 0.0, 2.0]).collect();
    let field = Field { place: Place::Vertices, kind: Kind::SpaceMetric, values: values(&old) };
    let (carried, _) = conservative(&old, &new, &[field], Overshoot::default()).unwrap();
    let truth = Field { values: values(&new), ..carried[0].field.clone() };
    assert!(worst(&carried[0].field, &truth) < 1e-12);
}

#[test]
fn what_does_not_fit_is_named() {
    let ball = sphere(1.0, 0.4).unwrap().to_mesh();
    let flat = Mesh {
        points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let far = sphere(3.0, 0.9).unwrap().to_mesh();
    let count = ball.points.len();
    let plain = Field { place: Place::Vertices, kind: Kind::Linear(1), values: vec![1.0; count] };
    let planar = Field { place: Place::Vertices, kind: Kind::Metric, values: [1.0, 0.0, 1.0].repeat(count) };
    for (new, field, says) in [
        (&flat, &plain, "is not zero at vertex"),
        (&far, &plain, "reaches beyond the old one at the old mesh ((-1"),
        (&ball, &planar, "metrics of the plane on the mesh of a surface"),
    ] {
        let error = interpolate(&ball, new, std::slice::from_ref(field)).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}
