//! Nets against closed forms, and seeds that are power-protected because it was asked for.

use crate::canvas::Canvas;
use crate::diagram::{Diagram, resolve};
use crate::geometry::{Point, Tensor};
use crate::manifold::domain::Domain;
use crate::metric::{MetricField, Scaled, Uniform};
use crate::net::{Net, Simplices};
use crate::progress::Silent;
use crate::recipe::{self, MeshOptions, Meshed, Seeding};

/// Two right angles and a fourth seed: the circle of the first three is around (0.5, 0.5).
const SEEDS: [(f64, f64); 4] = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.1, 1.05)];

fn net_of(field: &dyn MetricField, seeds: &[Point], triangles: &[[u32; 3]]) -> Net {
    let found = Simplices { seeds, triangles, border: &[], is_inside: &|_, _| true };
    Net::measure(field, &found)
}

#[test]
fn a_uniform_net_is_what_it_is_by_hand_under_any_affine_map() {
    // Seeds x in the plane with the metric A'A are seeds A x in Euclid's.
    for (a, b, d, scale) in [(1.0, 0.0, 1.0, 1.0), (1.0, 0.0, 1.0, 3.0), (0.2, 0.7, 4.0, 1.0), (8.0, -3.0, 0.1, 1e-3)] {
        let seeds = SEEDS.map(|(x, y)| Point::new((x - b * y / d) / a, y / d));
        let field = move |_: Point| Tensor::new(a * a, a * b, b * b + d * d) * (scale * scale);
        let net = net_of(&field, &seeds, &[[0, 1, 2], [1, 3, 2]]);
        let first = &net.triangles[0];
        assert!((first.radius / scale - 0.5_f64.sqrt()).abs() < 1e-6, "{first:?}");
        assert!((first.power / (scale * scale) - 0.1625).abs() < 1e-6 && first.nearest == Some(3), "{first:?}");
        assert!((net.mu / scale - 1.0).abs() < 1e-6, "{}", net.mu);
        let second = &net.triangles[1];
        assert!(second.power > 0.0 && second.nearest == Some(0));
        assert!((net.epsilon - first.radius.max(second.radius)).abs() < 1e-9 * scale);
        assert!((net.delta() - first.protection().min(second.protection())).abs() < 1e-12);
    }
}

#[test]
fn circles_of_the_half_plane_have_the_powers_of_the_closed_form() {
    let field = |p: Point| Tensor::isotropic(p.y);
    let distance = |p: Point, q: Point| 2.0 * (0.5 * p.distance(q) / (p.y * q.y).sqrt()).asinh();
    let on = |angle: f64, r: f64| Point::new(0.3 + r * angle.cos(), 1.2 + r * angle.sin());
    let seeds = [on(3.5, 0.4), on(6.0, 0.4), on(1.5, 0.4), on(4.7, 0.43)];
    let net = net_of(&field, &seeds, &[[0, 1, 2], [0, 3, 1]]);
    let (centre, radius) = (Point::new(0.3, 1.28_f64.sqrt()), 0.5 * 2.0_f64.ln());
    let ball = &net.triangles[0];
    assert!((ball.radius - radius).abs() < 1e-6 && ball.centre.distance(centre) < 1e-6, "{ball:?}");
    let power = distance(centre, seeds[3]).powi(2) - radius * radius;
    assert!((ball.power - power).abs() < 1e-6, "{ball:?} {power}");
    let pairs = (0..4).flat_map(|i| (0..i).map(move |j| distance(seeds[i], seeds[j])));
    assert!((net.mu - pairs.fold(f64::INFINITY, f64::min)).abs() < 1e-6);
}

#[test]
fn the_least_power_need_not_be_that_of_an_opposite_seed() {
    // A seed beyond a thin neighbour is nearer to the circle than the neighbour's own apex.
    let seeds = [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 3.0), (1.3, 0.4)].map(|(x, y)| Point::new(x, y));
    let net = net_of(&Uniform::default(), &seeds, &[[2, 1, 0], [0, 1, 3], [1, 4, 3]]);
    let ball = &net.triangles[0];
    assert_eq!(ball.nearest, Some(4));
    assert!((ball.power - (1.69 + 0.16 - 1.0)).abs() < 1e-6, "{ball:?}");
}

fn protected(domain: &Domain, field: &dyn MetricField, vertices: usize, lloyd: usize) -> Meshed {
    let options = MeshOptions {
        vertices: Some(vertices),
        lloyd,
        seeding: Seeding::Protected,
        canvas_size: 10,
        ..MeshOptions::default()
    };
    recipe::mesh(domain, field, &options, &Silent).unwrap()
}

fn demand_protected(meshed: &Meshed, vertices: usize) {
    let net = meshed.net.as_ref().unwrap();
    assert_eq!(meshed.mesh.points.len(), vertices);
    assert_eq!(net.unmeasured, 0);
    assert!(net.delta() >= 0.2 * net.epsilon, "{} {}", net.delta(), net.epsilon);
    assert!(net.epsilon < 1.1 && net.lambda() > 0.2, "{} {}", net.epsilon, net.lambda());
}

#[test]
fn protected_seeds_are_and_the_raw_nerve_is_their_dual() {
    let square = Domain::shape("rect:0,0,1,1").unwrap();
    let layer = |p: Point| Tensor::new(1.0, 0.0, 1.0 / (0.5 + 0.6 * (p.y - 0.4 * p.x).powi(2)).powi(2));
    let disk = Domain::shape("disk:0,0,1").unwrap();
    let cases: [(&Domain, &dyn MetricField, usize, usize); 3] =
        [(&square, &Uniform::default(), 151, 0), (&disk, &layer, 121, 40), (&square, &layer, 137, 0)];
    for (domain, field, vertices, lloyd) in cases {
        let meshed = protected(domain, field, vertices, lloyd);
        demand_protected(&meshed, vertices);
        let unit = Scaled { field, factor: meshed.metric_scale };
        let seeds: Vec<Point> = meshed.mesh.points.iter().map(|p| Point::new(p[0], p[1])).collect();
        let canvas =
            resolve(Canvas::intrinsic(domain.planar(), &unit, 6000).unwrap(), &unit, &seeds, 8).unwrap().canvas;
        let diagram = Diagram::new(&canvas, &unit, &seeds).unwrap();
        let raw = recipe::dual(&diagram, crate::dual::Road::Both, &Silent).raw_nerve;
        assert_eq!((raw.missing, raw.extra), (0, 0), "{raw:?}");
        let interior = meshed.net.unwrap().interior().count();
        assert_eq!(raw.triangles, interior);
    }
}

#[test]
fn protected_seeds_do_not_depend_on_threads() {
    let domain = Domain::shape("rect:0,0,1,1").unwrap();
    let field = |p: Point| Tensor::new(1.0, 0.0, 1.0 / (0.5 + 0.6 * (p.y - 0.4 * p.x).powi(2)).powi(2));
    let with = |threads: usize| crate::test_cases::on_threads(threads, || protected(&domain, &field, 200, 2));
    let [one, three] = [1, 3].map(with);
    assert_eq!((&one.mesh, &one.net, &one.protection), (&three.mesh, &three.net, &three.protection));
}
