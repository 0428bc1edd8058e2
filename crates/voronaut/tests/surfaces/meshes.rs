//! Meshes of surfaces: valid, of the surface's topology, with their vertices on it.

use std::collections::BTreeMap;
use voronaut::canvas::Kind;
use voronaut::dual::Road;
use voronaut::geometry::{Point, Point3, Tensor, Tensor3};
use voronaut::manifold::domain::{Domain, Polygon, Polygons, Ring, from_polygons};
use voronaut::manifold::surface::metric::{Spec, SurfaceMetric, field};
use voronaut::manifold::surface::{FeatureOptions, RepairOptions};
use voronaut::manifold::{Manifold, Place};
use voronaut::mesh::Mesh;
use voronaut::metric::Bounds;
use voronaut::progress::Silent;
use voronaut::quality::{metric_quality, surface_fidelity, validity};
use voronaut::recipe::{MeshOptions, Meshed, Seeding, mesh, mesh_surface};
use voronaut_io::Given;

/// A shape or a file.
fn read(spec: &str) -> Manifold {
    match Given::read(spec, RepairOptions::default()).unwrap().0 {
        Given::Surface(manifold) => manifold,
        Given::Plane(_) => panic!("{spec} is a surface"),
    }
}

fn data(name: &str) -> String {
    format!("{}/../../data/{name}", env!("CARGO_MANIFEST_DIR"))
}

struct Scaled<'a>(&'a dyn SurfaceMetric, f64);

impl SurfaceMetric for Scaled<'_> {
    fn at(&self, place: &Place) -> Tensor3 {
        self.0.at(place) * self.1
    }
}

fn meshed(manifold: &Manifold, metric: &str, options: &MeshOptions) -> (Meshed, f64, f64) {
    let metric = field(&Spec::parse(metric).unwrap(), manifold, Bounds::default()).unwrap();
    let meshed = mesh_surface(manifold, metric.as_ref(), None, options, &Silent).unwrap();
    let figures = metric_quality(&meshed.mesh, (manifold, &Scaled(metric.as_ref(), meshed.metric_scale))).unwrap();
    (meshed, figures.quality.mean, figures.quality.min)
}

/// The plane is a surface with one flat chart: a plate of two regions with a hole is meshed on both paths, with the same labels along the same lengths, the
/// same areas, and as well.
#[test]
fn planar_domains_are_flat_manifolds() {
    let ring = |x: [f64; 2], y: [f64; 2], label| Ring {
        points: vec![Point::new(x[0], y[0]), Point::new(x[1], y[0]), Point::new(x[1], y[1]), Point::new(x[0], y[1])],
        label,
    };
    let polygon = |number, region, rings| Polygon { feature: 1, number, region, rings };
    let left = polygon(1, 1, vec![ring([0.0, 2.0], [0.0, 2.0], 1), ring([0.5, 1.5], [0.5, 1.5], 2)]);
    let right = polygon(2, 7, vec![ring([2.0, 4.0], [0.0, 2.0], 3)]);
    let domain = Domain::new(&from_polygons(&Polygons { polygons: vec![left, right] }).unwrap()).unwrap();
    let flat = Manifold::flat(&domain).unwrap();
    let options = MeshOptions { vertices: Some(800), ..MeshOptions::default() };
    let thickness = |y: f64| 0.1 + 0.2 * (y - 1.0).abs();
    let planar = |p: Point| Tensor::new(9.0, 0.0, 1.0 / thickness(p.y).powi(2));
    let in_space = |p: Point3| Tensor3 { xx: 9.0, yy: 1.0 / thickness(p.y).powi(2), zz: 1.0, ..Tensor3::default() };
    let in_plane = mesh(&domain, &planar, &options, &Silent).unwrap();
    let on_surface = mesh_surface(&flat, &in_space, None, &options, &Silent).unwrap();
    let [a, b] = [&in_plane.mesh, &on_surface.mesh];
    assert!(validity(b).valid && b.is_planar() && a.points.len().abs_diff(b.points.len()) <= 8);
    let lengths = |mesh: &Mesh| {
        let mut sums = BTreeMap::new();
        for (ends, label) in mesh.edges.iter().zip(&mesh.edge_labels) {
            let [p, q] = ends.map(|v| mesh.position(v));
            *sums.entry(*label).or_insert(0.0) += p.distance(q);
        }
        sums
    };
    let areas = |mesh: &Mesh| {
        let mut sums = BTreeMap::new();
        for (&t, label) in mesh.triangles.iter().zip(&mesh.triangle_labels) {
            let [p, q, r] = mesh.positions_of(t);
            *sums.entry(*label).or_insert(0.0) += 0.5 * (q - p).cross(r - p).z;
        }
        sums
    };
    let are_close = |x: &BTreeMap<i32, f64>, y: &BTreeMap<i32, f64>| {
        x.len() > 1 && x.keys().eq(y.keys()) && x.values().zip(y.values()).all(|(x, y)| (x - y).abs() < 1e-12)
    };
    assert!(are_close(&lengths(a), &lengths(b)) && are_close(&areas(a), &areas(b)));
    let quality = |meshed: &Meshed| {
        let unit = |p: Point| planar(p) * meshed.metric_scale;
        let found = metric_quality(&meshed.mesh, &unit).unwrap();
        (found.metric_edge_length.unit_fraction, found.quality.mean)
    };
    let (plane, surface) = (quality(&in_plane), quality(&on_surface));
    assert!((plane.0 - surface.0).abs() < 0.03 && (plane.1 - surface.1).abs() < 0.03, "{plane:?} {surface:?}");
}

/// Least mean and least quality that are asked for: low where the metric changes much over an edge.
#[test]
fn meshes_are_valid_and_of_the_surface_s_topology() {
    for (spec, metric, count, least) in [
        ("sphere:1", "uniform", 300, [0.96, 0.5]),
        ("torus:2,0.7", "curvature", 400, [0.93, 0.5]),
        (&data("spot.obj"), "curvature", 220, [0.85, 0.2]),
        (&data("bob_small.obj"), "curvature", 220, [0.9, 0.4]),
        ("chair", "curvature", 400, [0.88, 0.2]),
        ("sphere:1", "shock:phi=1", 400, [0.85, 0.05]),
        ("implicit:z-0.2*sin(3*x);-1,-1,-1,1,1,1", "uniform", 300, [0.9, 0.2]),
        ("implicit:(x^2+y^2+z^2-1)*((x-3)^2+y^2+z^2-0.25);-2,-2,-2,4,2,2", "uniform", 300, [0.95, 0.5]),
    ] {
        let manifold = read(spec);
        let (meshed, mean, min) =
            meshed(&manifold, metric, &MeshOptions { vertices: Some(count), ..MeshOptions::default() });
        let mesh = &meshed.mesh;
        let found = validity(mesh);
        println!("{spec} {metric}: {} vertices, quality {mean:.3} / {min:.3}", mesh.points.len());
        assert!(found.valid, "{spec}: {found:?}");
        assert_eq!(found.euler, manifold.surface().euler_characteristic(), "{spec}");
        assert_eq!(found.boundary_loops, validity(&manifold.surface().to_mesh()).boundary_loops, "{spec}");
        assert!(mesh.points.len().abs_diff(count) * 100 <= count, "{spec}: {}", mesh.points.len());
        let fidelity = surface_fidelity(mesh, &manifold).unwrap();
        assert!(fidelity.vertex_to_surface.value < 1e-9 * manifold.diagonal(), "{spec}: {fidelity:?}");
        assert!(fidelity.folded == 0 && !fidelity.reversed, "{spec}: {fidelity:?}");
        assert!(mean > least[0] && min > least[1], "{spec}: {mean} {min}");
    }
}

#[test]
fn any_number_of_threads_and_any_canvas_make_a_mesh() {
    let manifold = read("torus:2,0.7");
    for canvas in Kind::ALL {
        let (seeding, dual) = (Seeding::Farthest, Road::Canvas);
        let few = MeshOptions { lloyd: 2, canvas_size: 20, ..MeshOptions::default() };
        let options = MeshOptions { vertices: Some(150), canvas, seeding, dual, ..few };
        let of_threads = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| meshed(&manifold, "curvature", &options).0.mesh)
        });
        assert_eq!(of_threads[0], of_threads[1], "{canvas}");
        assert!(validity(&of_threads[0]).valid);
    }
    let of_threads = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let options = MeshOptions { vertices: Some(300), ..MeshOptions::default() };
        pool.install(|| meshed(&manifold, "curvature", &options).0)
    });
    assert_eq!(of_threads[0].mesh, of_threads[1].mesh);
    assert!(of_threads[0].canvas.is_none());
}

#[test]
fn fitting_brings_spot_nearer_and_keeps_shapes() {
    let manifold = read(&data("spot.obj"));
    let of = |fit: bool| {
        let options = MeshOptions { vertices: Some(1020), fit, ..MeshOptions::default() };
        let (meshed, mean, min) = meshed(&manifold, "curvature", &options);
        let fidelity = surface_fidelity(&meshed.mesh, &manifold).unwrap();
        println!("fit {fit}: quality {mean:.3} / {min:.3}, {:?}", fidelity.both);
        assert!(validity(&meshed.mesh).valid && mean >= 0.9 && min >= 0.2, "{mean} {min}");
        fidelity.both
    };
    let (on, off) = (of(false), of(true));
    assert!(off.rms_share < 6e-4 && off.hausdorff_share < 5e-3, "{off:?}");
    assert!(off.rms < 0.6 * on.rms, "{on:?} {off:?}");
}

#[test]
fn a_distance_asks_for_more_vertices_unless_their_number_is_given() {
    let manifold = read("sphere:1");
    let options = MeshOptions { complexity: Some(60.0), hausd: Some(5e-3), ..MeshOptions::default() };
    let (found, ..) = meshed(&manifold, "uniform", &options);
    let distance = found.fidelity.unwrap().both.hausdorff;
    assert!(distance <= 5e-3 && found.mesh.points.len() > 200 && found.notes.is_empty(), "{distance}");
    let few = MeshOptions { vertices: Some(80), hausd: Some(5e-3), ..MeshOptions::default() };
    let (found, ..) = meshed(&manifold, "uniform", &few);
    assert!(found.mesh.points.len() == 80 && found.notes[0].contains("`hausd` asks for"), "{:?}", found.notes);
}

/// Cones ten times as high as wide: their apex stays, and the triangles around it are no needles, though the normal there is none of theirs.
#[test]
fn pointed_cones_have_no_needles() {
    let cones = [(8, true, "uniform", 500), (16, true, "curvature", 500), (32, false, "uniform", 500)];
    // Halves of triangles that are hardly more than needles.
    let needles = [(32, false, "uniform", 300), (32, true, "uniform", 300)];
    for (sides, is_closed, metric, count) in cones.into_iter().chain(needles) {
        let rim = (0..sides).map(|i| std::f64::consts::TAU * f64::from(i) / f64::from(sides));
        let points = [[0.0, 0.0, 10.0], [0.0; 3]].into_iter().chain(rim.map(|angle| [angle.cos(), angle.sin(), 0.0]));
        let next = |i: u32| 2 + (i + 1) % sides;
        let wall = (0..sides).map(|i| [0, 2 + i, next(i)]);
        let base = (0..sides).filter(|_| is_closed).map(|i| [1, next(i), 2 + i]);
        let cone = Mesh { points: points.collect(), triangles: wall.chain(base).collect(), ..Mesh::default() };
        let manifold = Manifold::of(&cone).unwrap().cut(&FeatureOptions::default()).unwrap();
        let options = MeshOptions { vertices: Some(count), ..MeshOptions::default() };
        let (meshed, mean, min) = meshed(&manifold, metric, &options);
        assert!(meshed.mesh.points.contains(&[0.0, 0.0, 10.0]), "{sides} sides");
        assert!(meshed.mesh.points.len() == count && min > 0.1 && mean > 0.9, "{sides} sides: {min} {mean}");
    }
}
