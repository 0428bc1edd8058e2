//! Geodesic edges and Riemannian triangles on a sphere, where both are known in closed form, in its own metric and in that of the plane.

use super::random::Random;
use crate::canvas::{Canvas, Kind};
use crate::diagram::SurfaceDiagram;
use crate::dual::Road;
use crate::geodesic::Method;
use crate::geometry::{Point, Point3, Tensor3};
use crate::manifold::surface::metric::{Constant, SurfaceMetric};
use crate::manifold::{Manifold, Place};
use crate::mesh::Mesh;
use crate::progress::Silent;
use crate::quality::{Meetings, validity_on};
use crate::realisation::Realisation;
use crate::recipe;

/// Canvas vertices for each seed.
const PER_SEED: usize = 80;

fn realised<T>(
    seeds: &[Point3],
    metric: &dyn SurfaceMetric,
    each: impl Fn(&SurfaceDiagram, Realisation<Point3>) -> T,
) -> T {
    let manifold = Manifold::shape("sphere:1", None).unwrap();
    let places: Vec<Place> = seeds.iter().map(|&p| manifold.closest(p).unwrap()).collect();
    let size = PER_SEED * seeds.len();
    let (canvas, at) = Canvas::on_surface(Kind::Intrinsic, &manifold, metric, size, &places).unwrap();
    let diagram = SurfaceDiagram::on_surface(&canvas, &at, Method::March).unwrap();
    let triangles = recipe::dual(&diagram, Road::Both, &Silent).triangles;
    each(&diagram, Realisation::on_surface(&diagram, &triangles))
}

/// Random points of the unit sphere below a height.
fn seeds(count: usize, below: f64) -> Vec<Point3> {
    let mut random = Random(88_172_645_463_325_252);
    let mut point = || {
        let (z, angle) = ((1.0 + below) * random.next() - 1.0, std::f64::consts::TAU * random.next());
        let r = (1.0 - z * z).sqrt();
        Point3::new(r * angle.cos(), r * angle.sin(), z)
    };
    (0..count).map(|_| point()).collect()
}

#[test]
fn regions_on_a_sphere_are_a_mesh_of_it() {
    let seeds = seeds(150, 1.0);
    realised(&seeds, &Constant(Tensor3::IDENTITY), |_, found| {
        assert!(found.crossing.is_empty() && found.open() == 0, "{:?} {}", found.crossing, found.open());
        for edge in &found.edges {
            let [p, q] = edge.ends.map(|i| seeds[i as usize]);
            let arc = 2.0 * (0.5 * p.distance(q)).asin();
            assert!((edge.length / arc - 1.0).abs() < 1e-3, "{edge:?} {arc}");
            let pole = (p - Point3::default()).cross(q - Point3::default());
            let off = |at: &Point3| pole.dot(*at - Point3::default()).abs();
            assert!(edge.points.iter().all(|at| off(at) < 0.02 * arc), "a great circle: {edge:?}");
        }
        let mesh = found.to_mesh();
        let outcome = validity_on(&mesh, &Meetings::of(Mesh::default()));
        assert!(outcome.valid, "{outcome:?}");
        let area = |t: &[u32; 3]| {
            let [a, b, c] = mesh.positions_of(*t);
            0.5 * (b - a).cross(c - a).norm()
        };
        let sphere = 4.0 * std::f64::consts::PI;
        let share = mesh.triangles.iter().map(area).sum::<f64>() / sphere;
        assert!((0.98..1.02).contains(&share), "{share}");
    });
}

/// Stereographic projection from the north pole, in whose metric the sphere is a plane, but for a cap.
#[test]
fn edges_in_the_metric_of_the_plane_are_straight_there() {
    let seeds = seeds(150, 0.3);
    let flat = |p: Point3| Tensor3::IDENTITY * (1.0 - p.z.min(0.6)).powi(-2);
    let projected = |p: Point3| Point::new(p.x / (1.0 - p.z), p.y / (1.0 - p.z));
    realised(&seeds, &flat, |_, found| {
        // Beyond the seeds edges lead around the cap, and shortest ways do not.
        let ends = |i: u32| found.edges[i as usize].ends.map(|v| projected(seeds[v as usize]));
        let is_inside = |i: u32| ends(i).iter().all(|p| p.distance(Point::default()) < 1.0);
        let inside: Vec<u32> = (0..found.edges.len() as u32).filter(|&i| is_inside(i)).collect();
        assert!(inside.len() > 250);
        let told = |&i: &u32| {
            let ([p, q], edge) = (ends(i), &found.edges[i as usize]);
            (edge.length / p.distance(q) - 1.0).abs() / edge.error
        };
        let worst = inside.iter().map(told).fold(0.0, f64::max);
        let crossing = found.crossing.iter().filter(|pair| pair.iter().all(|&i| is_inside(i))).count();
        assert!(worst < 1.0 && crossing == 0, "{worst} {crossing}");
    });
}

/// The middle of an eighth of the sphere is as far from its three corners, and the middles of its sides are halfway.
#[test]
fn grids_on_an_octant_have_its_middle() {
    let seeds: Vec<Point3> =
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]
            .map(Point3::from)
            .to_vec();
    realised(&seeds, &Constant(Tensor3::IDENTITY), |diagram, found| {
        assert_eq!((found.triangles.len(), found.open()), (8, 0));
        let grids = found.grids_on_surface(diagram, 6);
        for (triangle, grid) in found.triangles.iter().zip(&grids) {
            let grid = grid.as_ref().unwrap();
            let unit = |corners: &[u32]| {
                let sum =
                    corners.iter().fold(Point3::default(), |sum, &i| sum + (seeds[i as usize] - Point3::default()));
                Point3::default() + (sum - Point3::default()).unit().unwrap()
            };
            let [a, b, c] = *triangle;
            for (at, truth) in
                [(grid.at(2, 2), unit(&[a, b, c])), (grid.at(3, 0), unit(&[a, b])), (grid.at(0, 3), unit(&[a, c]))]
            {
                assert!(at.distance(truth) < 0.02, "{at} {truth}");
            }
        }
    });
}
