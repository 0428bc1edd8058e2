//! Curved triangles on round domains and surfaces: how far they are from these, by closed forms.

use crate::curved::{Rule, bezier_points, curve_at, points_in_space, side};
use crate::geometry::{Point, Point3, Tensor, Tensor3, Vector};
use crate::manifold::Manifold;
use crate::manifold::domain::{Domain, Polygon, Polygons, Ring, from_polygons, shape};
use crate::mesh::{Edges, Mesh};
use crate::metric::{Expression, MetricField, Norm, Snapshot, Variables};
use crate::progress::Silent;
use crate::quality::{surface_fidelity, validity};
use crate::recipe::{Aim, Boundary, MeshOptions, Meshed, mesh, mesh_for, mesh_surface};
use std::f64::consts::PI;

fn options(vertices: usize, order: usize, boundary: Boundary) -> MeshOptions {
    MeshOptions { vertices: Some(vertices), order, boundary, ..MeshOptions::default() }
}

fn made(domain: &Domain, metric: &dyn MetricField, options: &MeshOptions) -> Meshed {
    let meshed = mesh(domain, metric, options, &Silent).unwrap();
    assert_eq!(meshed.notes, Vec::<String>::new());
    assert!(validity(&meshed.mesh).valid);
    meshed
}

/// Points of the sides on the boundary.
fn of_boundary(mesh: &Mesh) -> Vec<Point> {
    let edges = Edges::of(&mesh.triangles);
    let on_side = |edge: crate::mesh::EdgeSide| {
        let (points, order) = bezier_points(mesh, edge.triangle());
        let curve: Vec<Point> = side(order, edge.half_edge as usize % 3).map(|i| points[i]).collect();
        (0..=16).map(move |i| curve_at(&curve, f64::from(i) / 16.0).0).collect::<Vec<_>>()
    };
    edges.boundary().flat_map(on_side).collect()
}

/// The order at which an error falls with a length.
fn order_of([(coarse, long), (fine, short)]: [(f64, f64); 2]) -> f64 {
    (coarse / fine).ln() / (long / short).ln()
}

fn away_from_circle(mesh: &Mesh) -> f64 {
    let away = of_boundary(mesh).into_iter().map(|p| ((p - Point::default()).norm() - 1.0).abs());
    away.fold(0.0, f64::max)
}

#[test]
fn disks_are_round_to_the_order_of_their_triangles_and_one_more() {
    let domain = Domain::new(&shape("disk:0,0,1").unwrap().unwrap()).unwrap();
    for order in [2, 3] {
        let away = [100, 400].map(|vertices| {
            let meshed = made(&domain, &|_: Point| Tensor::IDENTITY, &options(vertices, order, Boundary::Auto));
            (away_from_circle(&meshed.mesh), 1.0 / meshed.mesh.edges.len() as f64)
        });
        assert!(order_of(away) > order as f64 + 0.7, "{order}: {away:?}");
    }
    let straight = options(160, 2, Boundary::Polyline);
    assert!(away_from_circle(&made(&domain, &|_: Point| Tensor::IDENTITY, &straight).mesh) > 1e-3);
}

#[test]
fn polishing_leaves_boundaries_on_their_curves() {
    let domain = Domain::new(&shape("disk:0,0,1").unwrap().unwrap()).unwrap();
    let front = Snapshot::from(Expression::parse("tanh(20*(x + y^2))", Variables::Plane).unwrap());
    let aim = Aim { function: &front, norm: Norm::default(), known_to: 0.0 };
    for order in [2, 3] {
        let options = options(60, order, Boundary::Auto);
        let meshed = mesh_for(&domain, &|_: Point| Tensor::IDENTITY, Some(aim), &options, &Silent).unwrap();
        assert!(validity(&meshed.mesh).valid && meshed.polished.unwrap().error.len() > 2);
        let away = away_from_circle(&meshed.mesh);
        // The chords of thirty even sides are 5e-3 away.
        assert!(away < 1e-4, "{order}: {away}");
    }
}

/// The half of a disk above the x axis, as a polygon of so many sides on its arc.
fn half_disk(sides: u32) -> Domain {
    let on_arc = |i: u32| PI * f64::from(i) / f64::from(sides);
    let arc = (1..sides).map(on_arc).map(|a| Point::new(a.cos(), a.sin()));
    let points = [Point::new(1.0, 0.0)].into_iter().chain(arc).chain([Point::new(-1.0, 0.0)]).collect();
    of_rings(vec![points])
}

fn of_rings(rings: Vec<Vec<Point>>) -> Domain {
    let polygon = |(number, points)| Polygon { feature: 1, number, region: 1, rings: vec![Ring { points, label: 3 }] };
    let polygons = Polygons { polygons: (1..).zip(rings).map(polygon).collect() };
    Domain::new(&from_polygons(&polygons).unwrap()).unwrap()
}

#[test]
fn splines_keep_corners_and_straight_sides() {
    let domain = half_disk(40);
    for order in [2, 3] {
        let meshed = made(&domain, &|_: Point| Tensor::IDENTITY, &options(150, order, Boundary::Spline));
        for p in of_boundary(&meshed.mesh) {
            let away = p.y.abs().min(((p - Point::default()).norm() - 1.0).abs());
            assert!(away < 2e-5 && p.y > -1e-15 && p.x.abs() <= 1.0 + 2e-5, "{p}");
        }
        for corner in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]] {
            assert!(meshed.mesh.points.contains(&corner));
        }
        assert!((validity(&meshed.mesh).area - 0.5 * PI).abs() < 1e-4);
        assert!(meshed.mesh.edge_labels.iter().all(|&label| label == 3));
    }
}

/// The arc is ten times as far from its chords as the layer is thick.
#[test]
fn thin_layers_are_bent_with_their_boundary() {
    let domain = half_disk(20);
    let layer = |p: Point| {
        let out = p - Point::default();
        let (r, away) = (out.norm(), (1.0 - out.norm()).abs());
        let across = (3e-4 + 0.3 * away).min(0.2);
        Tensor::from_axis(if r > 0.0 { out * (1.0 / r) } else { Vector::new(1.0, 0.0) }, across.powi(-2), 25.0)
    };
    let meshed = made(&domain, &layer, &options(300, 2, Boundary::Spline));
    assert!((validity(&meshed.mesh).area - 0.5 * PI).abs() < 1e-4);
}

/// Where both sides of a triangle at a vertex are on a smooth boundary they would make a half turn there.
#[test]
fn triangles_in_smooth_corners_keep_a_margin() {
    let ring = (0..12).map(|i| PI * f64::from(i) / 6.0).map(|a| Point::new(a.cos(), a.sin())).collect();
    let domain = of_rings(vec![ring]);
    for order in [2, 3] {
        let options = options(12, order, Boundary::Spline);
        let meshed = mesh(&domain, &|_: Point| Tensor::IDENTITY, &options, &Silent).unwrap();
        let found = validity(&meshed.mesh);
        assert!(found.valid && found.least_jacobian.unwrap() > 1e-6, "{:?}", found.least_jacobian);
    }
}

/// The part above a curve that dips where its segments do not, and the part below another one that is close to these.
fn above_and_below() -> [Vec<Point>; 2] {
    let points = |all: &[(f64, f64)]| all.iter().map(|&(x, y)| Point::new(x, y)).collect::<Vec<_>>();
    let above = points(&[(-1.0, 0.6), (-0.5, 0.45), (0.5, 0.45), (1.0, 0.6)]);
    let below = (0..=8).map(|i| 1.0 - f64::from(i) / 4.0).map(|x| Point::new(x, 0.44 * (1.0 - x * x))).collect();
    [above, below]
}

#[test]
fn curves_that_meet_outside_are_an_error_with_the_place() {
    let [above, below] = above_and_below();
    let ends = [[(1.0, 2.0), (-1.0, 2.0)], [(-1.0, -1.0), (1.0, -1.0)]];
    let [upper, lower] = ends.map(|ends| ends.map(|(x, y)| Point::new(x, y)));
    let domain = of_rings(vec![[above, upper.to_vec()].concat(), [below, lower.to_vec()].concat()]);
    let error = mesh(&domain, &|_: Point| Tensor::IDENTITY, &options(100, 2, Boundary::Spline), &Silent).unwrap_err();
    assert!(error.to_string().contains("curves of the boundary meet"), "{error}");
}

#[test]
fn curves_that_would_meet_inside_stay_apart() {
    let [above, below] = above_and_below();
    let domain = of_rings(vec![[above, below].concat()]);
    let meshed = mesh(&domain, &|_: Point| Tensor::IDENTITY, &options(100, 2, Boundary::Spline), &Silent).unwrap();
    assert!(validity(&meshed.mesh).valid);
    assert!(meshed.notes.iter().any(|note| note.contains("are not on its curve")), "{:?}", meshed.notes);
}

#[test]
fn triangles_are_on_surfaces_of_equations_to_more_than_their_order_and_one() {
    let torus = |p: Point3| (p.x.hypot(p.y) - 1.0).hypot(p.z) - 0.4;
    let ball = |p: Point3| p.x.hypot(p.y).hypot(p.z) - 1.0;
    let truths: [(&str, &dyn Fn(Point3) -> f64); 2] = [("torus:1,0.4", &torus), ("sphere:1", &ball)];
    for (spec, distance) in truths {
        let manifold = crate::manifold::surface::shape(spec, None).unwrap().unwrap();
        for order in [2, 3] {
            let away = [200, 800]
                .map(|vertices| (farthest(&manifold, vertices, order, distance), 1.0 / (vertices as f64).sqrt()));
            assert!(order_of(away) > order as f64 + 1.1, "{spec} {order}: {away:?}");
        }
    }
}

/// How far the triangles of a mesh of a surface are from it at most.
fn farthest(manifold: &Manifold, vertices: usize, order: usize, distance: &dyn Fn(Point3) -> f64) -> f64 {
    let metric = |_: Point3| Tensor3::IDENTITY;
    let meshed = mesh_surface(manifold, &metric, None, &options(vertices, order, Boundary::Auto), &Silent).unwrap();
    assert_eq!(meshed.notes, Vec::<String>::new());
    let all = (0..meshed.mesh.triangles.len()).flat_map(|t| {
        let points = points_in_space(&meshed.mesh, t);
        Rule::fine(&meshed.mesh).places.into_iter().map(move |place| place.image_in_space(&points))
    });
    let most = all.map(|p| distance(p).abs()).fold(0.0, f64::max);
    let seen = surface_fidelity(&meshed.mesh, manifold).unwrap().curved.unwrap().hausdorff;
    assert!((seen - most).abs() < 1e-12 + 1e-3 * most, "{seen} {most}");
    most
}
