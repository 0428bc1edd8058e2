//! Geodesic edges and Riemannian triangles against closed forms, and where they are hard: a singular centre, a border that
//! bars the way.

mod simplices;

use crate::canvas::Canvas;
use crate::diagram::Diagram;
use crate::dual::Road;
use crate::geodesic::Polyline;
use crate::geometry::{Point, Tensor};
use crate::manifold::domain::Domain;
use crate::metric::MetricField;
use crate::progress::Silent;
use crate::quality::{Validity, validity};
use crate::realisation::{Found, Realisation};
use crate::recipe;
use crate::test_cases::plate;

/// So many points along the additive sequence of the plastic number, in a rectangle.
pub(crate) fn seeds(count: usize, low: Point, high: Point) -> Vec<Point> {
    let at = |i: usize, a: f64, [low, high]: [f64; 2]| low + (high - low) * ((0.5 + i as f64 * a) % 1.0);
    let point = |i| Point::new(at(i, 0.754_877_666, [low.x, high.x]), at(i, 0.569_840_291, [low.y, high.y]));
    (1..=count).map(point).collect()
}

pub(crate) fn realised(domain: &str, field: &dyn MetricField, seeds: &[Point], canvas: usize) -> Realisation {
    let domain = Domain::shape(domain).unwrap();
    let canvas = Canvas::intrinsic(domain.planar(), field, canvas).unwrap();
    let diagram = Diagram::new(&canvas, field, seeds).unwrap();
    let dual = recipe::dual(&diagram, Road::Both, &Silent);
    Realisation::new(&diagram, &dual.triangles)
}

fn demand_embedded(found: &Realisation) -> Validity {
    assert!(found.crossing.is_empty() && found.open() == 0, "{:?} {}", found.crossing, found.open());
    let outcome = validity(&found.to_mesh());
    assert!(outcome.valid, "{outcome:?}");
    outcome
}

/// Lengths, as reported and of the polylines, against a closed form for distances in the whole surface. Only an edge that is
/// led around may be longer.
fn lengths_are_right(name: &str, domain: &str, field: &dyn MetricField, distance: impl Fn(Point, Point) -> f64) {
    let corner: Vec<f64> = domain[5..].split(',').map(|x| x.parse().unwrap()).collect();
    let seeds = seeds(160, Point::new(corner[0], corner[1]), Point::new(corner[2], corner[3]));
    let found = realised(domain, field, &seeds, 12_000);
    demand_embedded(&found);
    let (mut smooth, mut worst) = (0, 0.0_f64);
    for edge in &found.edges {
        let exact = distance(seeds[edge.ends[0] as usize], seeds[edge.ends[1] as usize]);
        let drawn = Polyline::length_of(field, &edge.points) / exact - 1.0;
        let told = edge.length / exact - 1.0;
        assert!(told > -1e-6 && drawn > -1e-6, "{name} {edge:?} {exact}");
        assert!((drawn - told).abs() < 1e-3, "{name} {edge:?} {drawn} {told}");
        if edge.found == Found::Smooth {
            smooth += 1;
            worst = worst.max(told.abs()).max(drawn.abs());
            assert!(told.abs() < 2.0 * edge.error + 1e-9, "{name} {told} {}", edge.error);
        }
    }
    println!("{name}: {smooth} of {} edges smooth, worst length {worst:.1e}", found.edges.len());
    assert!(worst < 1e-3 && smooth * 10 > 8 * found.edges.len(), "{name} {worst} {smooth}");
}

#[test]
fn waves_of_flat_space() {
    let pi = std::f64::consts::PI;
    let map = |p: Point| Point::new(0.2 * p.x, p.y + 0.25 * (pi * p.x).sin());
    let field = |p: Point| {
        let a = 0.25 * pi * (pi * p.x).cos();
        Tensor::new(0.04 + a * a, a, 1.0)
    };
    lengths_are_right("waves", "rect:-1,-1,1,1", &field, |p, q| map(p).distance(map(q)));
}

#[test]
fn half_plane_and_sphere() {
    let half_plane = |p: Point| Tensor::isotropic(p.y);
    let hyperbolic = |p: Point, q: Point| 2.0 * (0.5 * (q - p).norm() / (p.y * q.y).sqrt()).asinh();
    lengths_are_right("half-plane", "rect:-1,0.25,1,2.25", &half_plane, hyperbolic);
    let size = |p: Point| 1.0 + p.x * p.x + p.y * p.y;
    let sphere = |p: Point| Tensor::isotropic(0.5 * size(p));
    let spherical = |p: Point, q: Point| 2.0 * ((q - p).norm() / (size(p) * size(q)).sqrt()).min(1.0).asin();
    lengths_are_right("sphere", "rect:-1.5,-1.5,1.5,1.5", &sphere, spherical);
}

#[test]
fn edges_of_uniform_metrics_are_segments() {
    let field = |_: Point| Tensor::new(4.0, 1.0, 1.0);
    let found = realised("rect:0,0,1,1", &field, &seeds(60, Point::new(0.0, 0.0), Point::new(1.0, 1.0)), 6000);
    for edge in &found.edges {
        let [p, q] = edge.ends.map(|i| found.seeds[i as usize]);
        assert!((edge.length / field(p).length(q - p) - 1.0).abs() < 1e-9, "{edge:?}");
        assert!(edge.points.iter().all(|x| (q - p).cross(*x - p).abs() < 1e-12));
    }
    demand_embedded(&found);
}

#[test]
fn swirl_and_shock_are_embedded_although_straight_edges_are_not() {
    for (domain, metric, half) in [("rect:-2,-2,2,2", "swirl", 2.0), ("rect:-1,-1,1,1", "shock:phi=1,lambda=0.6", 1.0)]
    {
        let field = recipe::metric_named(metric, Domain::shape(domain).unwrap().planar()).unwrap();
        // The centre of the swirl is singular, and edges of the seeds around run together there.
        let mut seeds = seeds(280, Point::new(-half, -half), Point::new(half, half));
        seeds.extend((0..20).map(|i| {
            let (at, side) = (half * (f64::from(i % 5) / 2.5 - 1.0), i / 5);
            [Point::new(at, -half), Point::new(half, at), Point::new(-at, half), Point::new(-half, -at)][side as usize]
        }));
        let found = realised(domain, field.as_ref(), &seeds, 40_000);
        let outcome = demand_embedded(&found);
        println!("{metric}: {} edges, {} vertices", found.edges.len(), found.to_mesh().points.len());
        assert_eq!((outcome.euler, outcome.boundary_loops), (1, 1), "{metric}");
        // Edges between seeds on the border stay inside, though the metric would have them leave.
        let outside = |p: &Point| p.x.abs().max(p.y.abs()) - half;
        let farthest = found.edges.iter().flat_map(|e| &e.points).map(outside).fold(0.0, f64::max);
        assert!(farthest < 1e-8, "{metric} {farthest}");
        let straight = straight_crossings(&found);
        assert!(straight > 0, "{metric}: straight edges embed, the test tests nothing");
    }
}

/// How often straight edges would cross.
fn straight_crossings(found: &Realisation) -> usize {
    let mesh = crate::mesh::Mesh {
        points: found.seeds.iter().map(|p| [p.x, p.y, 0.0]).collect(),
        triangles: found.triangles.clone(),
        ..crate::mesh::Mesh::default()
    };
    crate::quality::crossing_edges(&mesh).len()
}

#[test]
fn edges_are_led_around_a_hole() {
    let domain = plate(&[
        &[[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]],
        &[[-1.0, -0.1], [1.0, -0.1], [1.0, 0.1], [-1.0, 0.1]],
    ]);
    let field = |_: Point| Tensor::IDENTITY;
    let seeds = [(-0.2, -0.6), (-0.1, 0.7), (1.9, -1.9), (-1.9, 1.9)].map(|(x, y)| Point::new(x, y));
    let canvas = Canvas::intrinsic(domain.planar(), &field, 4000).unwrap();
    let diagram = Diagram::new(&canvas, &field, &seeds).unwrap();
    let found = Realisation::new(&diagram, &[[0, 2, 1], [1, 3, 0]]);
    let edge = &found.edges[found.edge_between(0, 1).unwrap()];
    let [below, above] = [-0.1, 0.1].map(|y| Point::new(-1.0, y));
    let shortest = seeds[0].distance(below) + 0.2 + above.distance(seeds[1]);
    assert!((edge.length / shortest - 1.0).abs() < 1e-3, "{} {shortest}", edge.length);
    assert_eq!(edge.found, Found::Traced);
    assert_eq!(found.edges[found.edge_between(0, 2).unwrap()].found, Found::Smooth);
}

#[test]
fn nothing_is_realised_as_nothing() {
    let found = realised("rect:0,0,1,1", &|_: Point| Tensor::IDENTITY, &[Point::new(0.5, 0.5)], 500);
    assert!(found.edges.is_empty() && found.regions.is_empty() && found.to_mesh().points.len() == 1);
    assert!(found.grids(&|_: Point| Tensor::IDENTITY, 3).is_empty());
}
