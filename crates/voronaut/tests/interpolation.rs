//! Meshes for the interpolation of a function: how small the error is, how it falls with the number of vertices, and what a solution
//! at vertices costs against the function itself.

use std::sync::OnceLock;
use voronaut::geometry::Point;
use voronaut::manifold::domain::Domain;
use voronaut::mesh::{Mesh, SolutionValues};
use voronaut::metric::{Expression, Norm, ScalarField, Snapshot, Variables};
use voronaut::progress::Silent;
use voronaut::quality::{check, interpolation_error};
use voronaut::recipe::{
    GradedAt, MeshOptions, Meshed, MetricOptions, PlanarMetric, mesh_for, metric_of_function, metric_of_solution,
};

/// A front along a sine and a layer at x = 0.
const LAYERS: &str = "0.5*tanh(40*(y - 0.5 - 0.25*sin(2*pi*x))) + exp(-x/0.02)";
/// Saddles and hills.
const SADDLES: &str = "sin(5*x)*sin(7*y)";

fn function(text: &str) -> Snapshot {
    Expression::parse(text, Variables::Plane).unwrap().into()
}

fn square() -> Domain {
    Domain::shape("rect:0,0,1,1").unwrap()
}

fn made(metric: &PlanarMetric, vertices: usize, polish: usize, norm: Norm) -> Meshed {
    let options = MeshOptions { vertices: Some(vertices), polish, ..MeshOptions::default() };
    let made = mesh_for(&square(), metric.field.as_ref(), metric.aim(norm), &options, &Silent).unwrap();
    check(&made.mesh).unwrap();
    assert_eq!(made.mesh.points.len(), vertices);
    made
}

fn for_function(text: &str, vertices: usize, polish: usize, norm: Norm) -> Meshed {
    made(&metric_for(text, vertices, norm), vertices, polish, norm)
}

fn metric_for(text: &str, vertices: usize, norm: Norm) -> PlanarMetric {
    let options = MetricOptions { norm, ..MetricOptions::default() };
    metric_of_function(&function(text), square().planar(), &options, GradedAt::of(Some(vertices), None)).unwrap()
}

/// The mesh for the layers with 2,000 vertices, made once.
fn layers() -> &'static Mesh {
    static MADE: OnceLock<Mesh> = OnceLock::new();
    MADE.get_or_init(|| for_function(LAYERS, 2000, 20, Norm::default()).mesh)
}

/// The L2 error times the number of vertices, and the greatest error times it.
fn errors(mesh: &Mesh, text: &str) -> [f64; 2] {
    let found = interpolation_error(mesh, &function(text), Norm::default()).unwrap();
    [found.norm, found.max.value].map(|error| error * mesh.points.len() as f64)
}

#[test]
fn errors_are_below_those_of_peers() {
    // bamg 0.884 and 9.6, mmg2d 0.979 and 9.9, each the best of many options and passes (scripts/compare_hessian.py). The greatest error is a
    // draw, 7.7 to 11 for numbers of vertices around 2,000: its mean over three.
    let [error, greatest] = errors(layers(), LAYERS);
    let beside = [1900, 2100].map(|n| errors(&for_function(LAYERS, n, 20, Norm::default()).mesh, LAYERS)[1]);
    let greatest = (greatest + beside[0] + beside[1]) / 3.0;
    assert!(error < 0.95 * 0.884 && greatest < 9.6, "{error} {greatest}");
    // bamg 2.453, mmg2d 2.546.
    let [error, _] = errors(&for_function(SADDLES, 2000, 20, Norm::default()).mesh, SADDLES);
    assert!(error < 0.95 * 2.453, "{error}");
}

#[test]
fn the_error_falls_as_one_over_the_number_of_vertices() {
    let error = |n| errors(&for_function(SADDLES, n, 20, Norm::default()).mesh, SADDLES)[0];
    let (coarse, fine) = (error(500), error(4000));
    assert!((fine / coarse - 1.0).abs() < 0.12, "{coarse} {fine}");
}

#[test]
fn polishing_lowers_the_error_in_the_norm_that_was_asked_for() {
    for (p, least) in [(1.0, 0.95), (4.0, 0.92)] {
        let norm = Norm::new(p).unwrap();
        let metric = metric_for(LAYERS, 500, norm);
        let error = |polish| {
            let mesh = made(&metric, 500, polish, norm).mesh;
            interpolation_error(&mesh, &function(LAYERS), norm).unwrap().norm
        };
        let (before, after) = (error(0), error(20));
        assert!(after < least * before, "{p}: {before} {after}");
    }
}

#[test]
fn polishing_never_raises_its_error_and_keeps_corners() {
    let made = for_function(LAYERS, 800, 20, Norm::default());
    let polished = made.polished.unwrap();
    assert!(polished.error.windows(2).all(|two| two[1] <= two[0]) && polished.moves > 0 && polished.flips > 0);
    for corner in [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]] {
        assert!(made.mesh.points.contains(&corner), "{corner:?}");
    }
    let on_edges = made.mesh.edges.as_flattened().iter().map(|&v| made.mesh.point(v));
    assert!(on_edges.into_iter().all(|p| [p.x, 1.0 - p.x, p.y, 1.0 - p.y].iter().any(|d| d.abs() < 1e-15)));
}

#[test]
fn threads_do_not_matter() {
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| for_function(LAYERS, 400, 5, Norm::default()).mesh)
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn units_of_the_function_do_not_matter() {
    let of = |unit: &str| for_function(&format!("{unit}*({SADDLES})"), 300, 5, Norm::default()).mesh;
    let plain = of("1");
    for unit in ["1024", "(1/1048576)"] {
        let other = of(unit);
        assert_eq!(other.triangles.len(), plain.triangles.len());
        let [a, b] = [&plain, &other].map(|mesh| errors(mesh, SADDLES)[0]);
        assert!((a / b - 1.0).abs() < 0.03, "{unit}: {a} {b}");
    }
}

#[test]
fn a_solution_at_vertices_is_nearly_as_good_as_its_function() {
    let (exact, f) = (layers(), function(LAYERS));
    let values = |mesh: &Mesh| mesh.points.iter().map(|&[x, y, _]| f.value(Point::new(x, y))).collect();
    let options = MetricOptions::default();
    let metric = metric_of_solution(
        exact,
        &SolutionValues::Scalar(values(exact)),
        square().planar(),
        &options,
        GradedAt::of(Some(2000), None),
    );
    let mesh = made(&metric.unwrap(), 2000, 20, Norm::default()).mesh;
    let (exact, recovered) = (errors(exact, LAYERS)[0], errors(&mesh, LAYERS)[0]);
    // 1.12 to 1.24 times with 1,900 to 2,150 vertices.
    assert!(recovered < 1.3 * exact, "{exact} {recovered}");
}

#[test]
fn what_a_coarse_solution_does_not_know_is_not_polished() {
    let even = made(&PlanarMetric::plain(voronaut::metric::Uniform::default()), 500, 0, Norm::default()).mesh;
    let f = function(LAYERS);
    let values = even.points.iter().map(|&[x, y, _]| f.value(Point::new(x, y))).collect();
    let options = MetricOptions::default();
    let at = GradedAt::of(Some(500), None);
    let metric = metric_of_solution(&even, &SolutionValues::Scalar(values), square().planar(), &options, at).unwrap();
    let made = made(&metric, 500, 20, Norm::default());
    assert!(made.notes.iter().any(|note| note.contains("too coarse to polish")), "{:?}", made.notes);
    assert!(made.polished.is_none());
}
