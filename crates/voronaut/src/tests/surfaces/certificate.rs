//! Nets on the unit sphere, whose circles are known in closed form; what is certified of them, and of a torus that is thin.

use super::random::Random;
use crate::canvas::{Canvas, Draped, Kind};
use crate::certificate::{Certificate, Constants, Outcome, Verdict};
use crate::diagram::SurfaceDiagram;
use crate::dual::Road;
use crate::geodesic::Method;
use crate::geometry::{Point3, Tensor3, Vector3};
use crate::manifold::surface::metric::Constant;
use crate::manifold::surface::sphere;
use crate::manifold::{Manifold, Place};
use crate::net::Net;
use crate::progress::Silent;
use crate::recipe::{dual, net};
use std::f64::consts::{PI, TAU};

/// Canvas vertices for each seed.
const PER_SEED: usize = 20;

fn with_diagram<T>(
    manifold: &Manifold,
    seeds: &[Point3],
    each: impl Fn(&SurfaceDiagram, &[[u32; 3]], Net<Place>) -> T,
) -> T {
    let metric = Constant(Tensor3::IDENTITY);
    let places: Vec<Place> = seeds.iter().map(|&p| manifold.closest(p).unwrap()).collect();
    let (canvas, at): (Canvas<Draped>, _) =
        Canvas::on_surface(Kind::Intrinsic, manifold, &metric, PER_SEED * seeds.len(), &places).unwrap();
    let diagram = SurfaceDiagram::on_surface(&canvas, &at, Method::March).unwrap();
    let exact = dual(&diagram, Road::Geodesic, &Silent).exact;
    let net = net(&diagram, &exact);
    each(&diagram, &exact, net)
}

fn certified(manifold: &Manifold, seeds: &[Point3]) -> Certificate {
    with_diagram(manifold, seeds, |diagram, exact, net| {
        Certificate::on_surface(diagram, exact, &net, Constants::Corrected)
    })
}

fn verdict<'a>(certificate: &'a Certificate, theorem: &str) -> &'a Verdict {
    certificate.verdict(theorem).unwrap()
}

fn unit(p: Point3) -> Vector3 {
    (p - Point3::default()).unit().unwrap()
}

fn arc(u: Vector3, v: Vector3) -> f64 {
    u.cross(v).norm().atan2(u.dot(v))
}

fn random_on_sphere(count: usize) -> Vec<Point3> {
    let mut random = Random(88_172_645_463_325_252);
    let mut point = || {
        let (z, angle) = (2.0 * random.next() - 1.0, TAU * random.next());
        let r = (1.0 - z * z).sqrt();
        Point3::new(r * angle.cos(), r * angle.sin(), z)
    };
    (0..count).map(|_| point()).collect()
}

#[test]
fn nets_on_the_sphere_are_those_of_spherical_geometry() {
    let manifold = Manifold::shape("sphere:1", Some(0.1)).unwrap();
    for seeds in [sphere(1.0, 0.3).unwrap().positions().to_vec(), random_on_sphere(200)] {
        let net = with_diagram(&manifold, &seeds, |_, _, net| net);
        let at: Vec<Vector3> = seeds.iter().map(|&p| unit(p)).collect();
        assert_eq!((net.triangles.len(), net.unmeasured), (2 * seeds.len() - 4, 0));
        for ball in &net.triangles {
            let [a, b, c] = ball.corners.map(|i| at[i as usize]);
            let centre = (b - a).cross(c - a).unit().unwrap();
            let radius = arc(centre, a);
            assert!((ball.radius - radius).abs() < 1e-4 * radius, "{} {radius}", ball.radius);
            assert!(arc(unit(ball.centre.position), centre) < 1e-4 * radius);
            let others = (0..seeds.len()).filter(|&i| !ball.corners.contains(&(i as u32)));
            let nearest = others.map(|i| arc(centre, at[i])).fold(f64::INFINITY, f64::min);
            let power = nearest.powi(2) - radius.powi(2);
            assert!((ball.power - power).abs() < 1e-3 * radius.powi(2), "{} {power}", ball.power);
        }
        let pairs = (0..seeds.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let mu = pairs.map(|(i, j)| arc(at[i], at[j])).fold(f64::INFINITY, f64::min);
        assert!((net.mu / mu - 1.0).abs() < 1e-4, "{} {mu}", net.mu);
        let epsilon = net.triangles.iter().map(|ball| ball.radius).fold(0.0, f64::max);
        assert!(net.epsilon >= epsilon && net.epsilon < 1.02 * epsilon, "{} {epsilon}", net.epsilon);
    }
}

#[test]
fn a_protected_net_of_the_sphere_has_an_embedded_dual_and_a_random_one_is_not_known_to() {
    let manifold = Manifold::shape("sphere:1", Some(0.1)).unwrap();
    let even = certified(&manifold, sphere(1.0, 0.3).unwrap().positions());
    // K = 1, and the injectivity radius is pi: estimated from below.
    let convexity = even.convexity;
    assert!(
        (convexity.curvature - 1.0).abs() < 0.01 && (convexity.total / (4.0 * PI) - 1.0).abs() < 0.02,
        "{convexity:?}"
    );
    let injectivity = convexity.injectivity.unwrap();
    assert!(injectivity < PI && injectivity > 0.8 * PI && convexity.radius <= 0.5 * PI, "{convexity:?}");
    let found = verdict(&even, "10.20");
    assert_eq!(found.outcome, Outcome::Holds, "{found:#?}");
    let straight = verdict(&even, "11.2");
    assert!(straight.outcome == Outcome::NotMeasured && straight.not_measured.as_ref().unwrap().contains("section 12"));
    // A parallel projection shortens by the cosine of the angle, whose sine is the distance from the seed there.
    let finer = certified(&manifold, sphere(1.0, 0.2).unwrap().positions());
    let psi = 1.0 / (1.0 - (6.0 * finer.net.epsilon).powi(2)).sqrt();
    assert!(finer.psi >= psi && finer.psi < 1.1 * psi, "{} {psi}", finer.psi);
    for theorem in ["9.1", "9.4", "9.9", "9.10"] {
        assert_eq!(verdict(&finer, theorem).outcome, Outcome::Fails, "{theorem}");
    }
    assert!(finer.walks.started > 0 && finer.walks.found == finer.walks.started, "{:?}", finer.walks);
    let random = certified(&manifold, &random_on_sphere(160));
    let found = verdict(&random, "10.20");
    assert!(found.outcome == Outcome::Fails && found.factor > 1.5, "{found:#?}");
    assert!(found.conditions[0].measured > found.conditions[0].limit, "{found:#?}");
}

/// Curvature alone would allow disks of radius pi / (2 sqrt K) = 0.52, but the way around the tube is 0.63 only.
#[test]
fn short_ways_around_a_thin_torus_are_seen() {
    let (manifold, r) = (Manifold::shape("torus:1,0.1", Some(0.08)).unwrap(), 0.1);
    let [around, across] = [80_u32, 8];
    let seed = |k: u32| {
        let (i, j) = (k / across, k % across);
        let u = TAU * (f64::from(i) + 0.5 * f64::from(j % 2)) / f64::from(around);
        let v = TAU * f64::from(j) / f64::from(across);
        let from_axis = 1.0 + r * v.cos();
        Point3::new(from_axis * u.cos(), from_axis * u.sin(), r * v.sin())
    };
    let seeds: Vec<Point3> = (0..around * across).map(seed).collect();
    let found = certified(&manifold, &seeds);
    let convexity = found.convexity;
    let curvature = 1.0 / (r * (1.0 + r));
    assert!((convexity.curvature / curvature - 1.0).abs() < 0.03, "{convexity:?} {curvature}");
    let injectivity = convexity.injectivity.unwrap();
    assert!(injectivity < PI * r && injectivity > 0.3 * PI * r, "{convexity:?}");
    let found = verdict(&found, "10.20");
    assert!(found.outcome == Outcome::Fails && found.conditions[0].limit < PI * r / 12.0, "{found:#?}");
}

#[test]
fn triangles_without_an_equation_are_not_certified() {
    let surface = sphere(1.0, 0.2).unwrap();
    let found = certified(&Manifold::new(surface, None), sphere(1.0, 1.0).unwrap().positions());
    let found = verdict(&found, "10.20");
    assert!(
        found.outcome != Outcome::Holds && found.not_measured.as_ref().unwrap().contains("no equation"),
        "{found:#?}"
    );
}
