//! Certificates: what is certified is so, and random seeds are not certified.

use std::collections::BTreeSet;
use voronaut::canvas::Canvas;
use voronaut::certificate::{Certificate, Constants, Outcome};
use voronaut::diagram::Diagram;
use voronaut::domain::Domain;
use voronaut::dual::Road;
use voronaut::geometry::{Point, Tensor, Vector};
use voronaut::metric::{MetricField, Uniform};
use voronaut::net::{Ball, Net};
use voronaut::planar::delaunay;
use voronaut::recipe;

/// Numbers from 0 to 1, the same on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// A linear map (a, b; 0, d): lengths of images are those of the metric F'F.
#[derive(Clone, Copy)]
struct Map([f64; 3]);

impl Map {
    fn metric(self) -> Tensor {
        let [a, b, d] = self.0;
        Tensor::new(a * a, a * b, b * b + d * d)
    }

    fn image(self, p: Point) -> Point {
        let [a, b, d] = self.0;
        Point::new(a * p.x + b * p.y, d * p.y)
    }

    fn back(self, q: Point) -> Point {
        let [a, b, d] = self.0;
        let y = q.y / d;
        Point::new((q.x - b * y) / a, y)
    }
}

/// Seeds in the unit square: images of a triangular lattice with spacing 1, turned and shifted, each moved by up to `jitter`.
fn lattice(map: Map, jitter: f64, random: &mut Random) -> Vec<Point> {
    let (sin, cos) = random.between(0.0, 1.1).sin_cos();
    let shift = Vector::new(random.next(), random.next());
    let mut seeds = Vec::new();
    for i in -40..=40 {
        for j in -40..=40 {
            let (x, y) = (f64::from(i) + 0.5 * f64::from(j), 0.75_f64.sqrt() * f64::from(j));
            let (r, angle) = (jitter * random.next().sqrt(), random.between(0.0, std::f64::consts::TAU));
            let moved = Vector::new(x + r * angle.cos(), y + r * angle.sin()) + shift;
            let p = map.back(Point::new(cos * moved.x - sin * moved.y + 8.0, sin * moved.x + cos * moved.y + 8.0));
            if p.x > 0.0 && p.x < 1.0 && p.y > 0.0 && p.y < 1.0 {
                seeds.push(p);
            }
        }
    }
    seeds
}

fn sorted(mut triangle: [u32; 3]) -> [u32; 3] {
    triangle.sort_unstable();
    triangle
}

/// The net of seeds in the unit square, and their Delaunay triangles, by the images: exact but for rounding.
fn net_by_hand(map: Map, seeds: &[Point], farthest: f64) -> (Net, Vec<[u32; 3]>) {
    let images: Vec<Point> = seeds.iter().map(|&p| map.image(p)).collect();
    let planar = delaunay(&images).unwrap();
    let all = planar.topology.faces().map(|f| planar.topology.corners(f).map(|v| v.0));
    let exact: Vec<[u32; 3]> = all.filter(|t| t.iter().all(|&v| (v as usize) < images.len())).collect();
    let ball = |&corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|i| images[i as usize]);
        let (u, v) = (b - a, c - a);
        let x = Vector::new(u.dot(u) * v.y - v.dot(v) * u.y, v.dot(v) * u.x - u.dot(u) * v.x) * (0.5 / u.cross(v));
        let others = (0..seeds.len() as u32).filter(|i| !corners.contains(i));
        let power = |i: u32| images[i as usize].distance(a + x).powi(2) - x.dot(x);
        let nearest = others.min_by(|&i, &j| power(i).total_cmp(&power(j)));
        let centre = map.back(a + x);
        let is_interior = centre.x > 0.0 && centre.x < 1.0 && centre.y > 0.0 && centre.y < 1.0;
        Ball { corners, centre, radius: x.norm(), power: nearest.map_or(f64::INFINITY, power), nearest, is_interior }
    };
    let triangles: Vec<Ball<3>> = exact.iter().map(ball).collect();
    let apart = |t: &[u32; 3]| [(0, 1), (1, 2), (2, 0)].map(|(i, j)| images[t[i] as usize].distance(images[t[j] as usize]));
    let mu = exact.iter().flat_map(apart).fold(f64::INFINITY, f64::min);
    let epsilon = triangles.iter().filter(|ball| ball.is_interior).map(|ball| ball.radius).fold(farthest, f64::max);
    (Net { triangles, mu, epsilon, ..Net::default() }, exact)
}

struct Case {
    certificate: Certificate,
    /// Covered triangles that the canvas shows, and those of the exact dual.
    raw: BTreeSet<[u32; 3]>,
    exact: BTreeSet<[u32; 3]>,
}

fn compared(diagram: &Diagram, certificate: Certificate, exact: Vec<[u32; 3]>) -> Case {
    let covered = |triangles: Vec<[u32; 3]>| -> BTreeSet<[u32; 3]> {
        triangles.into_iter().filter(|&t| certificate.covers(t)).map(sorted).collect()
    };
    let raw = covered(diagram.nerve().triangles.iter().map(|t| t.colours).collect());
    let exact = covered(exact);
    Case { certificate, raw, exact }
}

/// Seeds in the unit square with a map's metric.
fn uniform(map: Map, seeds: &[Point], canvas: &Canvas) -> Case {
    let field = Uniform(map.metric());
    let diagram = Diagram::new(canvas, &field, seeds).unwrap();
    let (net, exact) = net_by_hand(map, seeds, diagram.farthest().unwrap().1);
    let certificate = Certificate::new(&diagram, &field, &exact, &net, Constants::Corrected);
    compared(&diagram, certificate, exact)
}

/// Seeds in any metric, as the program certifies them.
fn varied(field: &dyn MetricField, seeds: &[Point], canvas: &Canvas) -> Case {
    let diagram = Diagram::new(canvas, field, seeds).unwrap();
    let dual = recipe::dual(&diagram, field, Road::Both);
    let net = recipe::net(&diagram, field, &dual.exact);
    let certificate = Certificate::new(&diagram, field, &dual.exact, &net, Constants::Corrected);
    compared(&diagram, certificate, dual.exact)
}

fn outcomes(certificate: &Certificate) -> Vec<(&'static str, Outcome)> {
    certificate.verdicts.iter().map(|verdict| (verdict.theorem, verdict.outcome)).collect()
}

fn holds(certificate: &Certificate, theorem: &str) -> bool {
    certificate.verdict(theorem).unwrap().outcome == Outcome::Holds
}

fn demand_witnesses(case: &Case) {
    let walks = &case.certificate.walks;
    assert!(walks.started >= case.exact.len() && walks.found == walks.started, "{walks:?}");
}

#[test]
fn what_is_certified_in_a_uniform_metric_is_the_exact_dual() {
    let square = Domain::read("rect:0,0,1,1").unwrap();
    let mut random = Random(2026);
    let (mut certified, mut compared, mut different) = (0, 0, 0);
    for round in 0..500 {
        // Every fourth is Euclidean, every tenth has a canvas that is too coarse.
        let map = if round % 4 == 0 {
            Map([15.0, 0.0, 15.0])
        } else {
            Map([random.between(14.0, 17.0), random.between(-4.0, 4.0), random.between(14.0, 17.0)])
        };
        let (jitter, share) = (random.between(0.0, 0.1), random.between(0.5, 1.0));
        let seeds = lattice(map, jitter, &mut random);
        let vertices = if round % 10 == 9 { 900 } else { (9000.0 * share) as usize };
        let canvas = Canvas::intrinsic(&square, &Uniform(map.metric()), vertices).unwrap();
        let found = uniform(map, &seeds, &canvas);
        let is_certified = holds(&found.certificate, "9.1") || holds(&found.certificate, "9.9");
        assert_eq!(holds(&found.certificate, "9.1"), is_certified && round % 4 == 0);
        different += usize::from(found.raw != found.exact);
        if is_certified {
            assert_eq!(found.raw, found.exact, "round {round}");
            demand_witnesses(&found);
            certified += 1;
            compared += found.exact.len();
        }
    }
    assert!(certified > 150 && certified < 450 && different > 10, "{certified} certified, {different} differ");
    assert!(compared > 5 * certified, "{compared} triangles in {certified} cases");
}
