//! Seeds on surfaces that are power-protected because it was asked for; their nets against closed forms.

use crate::geometry::{Point3, Tensor3, Vector3};
use crate::manifold::surface::FeatureOptions;
use crate::manifold::surface::metric::Constant;
use crate::manifold::{Manifold, Place};
use crate::mesh::Mesh;
use crate::net::Net;
use crate::progress::Silent;
use crate::quality::validity;
use crate::recipe::{MeshOptions, Meshed, Seeding, mesh_surface};

/// Not relaxed: there is something to do.
fn options(vertices: usize) -> MeshOptions {
    let usual = MeshOptions::default();
    MeshOptions { vertices: Some(vertices), lloyd: 0, seeding: Seeding::Protected, canvas_size: 10, ..usual }
}

fn meshed(manifold: &Manifold, options: &MeshOptions) -> Meshed {
    let meshed = mesh_surface(manifold, &Constant(Tensor3::IDENTITY), None, options, &Silent).unwrap();
    assert!(validity(&meshed.mesh).valid);
    meshed
}

fn net(meshed: &Meshed) -> &Net<Place> {
    meshed.surface_net.as_ref().unwrap()
}

/// Protected, where some triangles were not, and all of them measured.
fn demand_protected(meshed: &Meshed, share: f64) {
    let (net, account) = (net(meshed), meshed.protection.unwrap());
    assert!(account.unprotected == 0 && account.unprotected_before > 0 && account.moves > 0, "{account:?}");
    assert!(net.unmeasured == 0 && net.delta() >= share * net.epsilon, "{} {}", net.delta(), net.epsilon);
    assert!(!meshed.notes.iter().any(|note| note.contains("less power-protected")), "{:?}", meshed.notes);
}

/// Every circle is the one through its corners and has the power of the seed that is nearest to its centre, where the metric is lengths times
/// the root of a factor; a centre is found by `circle` with its radius.
fn demand_circles(
    meshed: &Meshed,
    circle: impl Fn([Point3; 3]) -> (Point3, f64),
    distance: impl Fn(Point3, Point3) -> f64,
) {
    let (mesh, factor) = (&meshed.mesh, meshed.metric_scale);
    for ball in net(meshed).interior() {
        let (centre, radius) = circle(ball.corners.map(|v| mesh.position(v)));
        assert!((ball.radius / factor.sqrt() - radius).abs() < 1e-4 * radius, "{} {radius}", ball.radius);
        assert!(ball.centre.position.distance(centre) < 1e-4 * radius, "{ball:?} {centre:?}");
        let others = (0..mesh.points.len() as u32).filter(|v| !ball.corners.contains(v));
        let nearest = others.map(|v| distance(centre, mesh.position(v))).fold(f64::INFINITY, f64::min);
        let power = nearest.powi(2) - radius.powi(2);
        assert!((ball.power / factor - power).abs() < 1e-3 * radius.powi(2), "{ball:?} {power}");
    }
}

fn flat_circle([a, b, c]: [Point3; 3]) -> (Point3, f64) {
    let (u, v) = (b - a, c - a);
    let normal = u.cross(v);
    let to_centre = (normal.cross(u) * v.dot(v) + v.cross(normal) * u.dot(u)) * (0.5 / normal.dot(normal));
    (a + to_centre, to_centre.norm())
}

/// A square that stands askew, of two triangles.
fn square() -> Manifold {
    let points = vec![[0.0, 0.0, 0.0], [0.8, 0.0, 0.6], [0.8, 1.0, 0.6], [0.0, 1.0, 0.0]];
    let mesh = Mesh { points, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    Manifold::of(&mesh).unwrap().cut(&FeatureOptions::default()).unwrap()
}

#[test]
fn seeds_of_a_square_in_space_are_protected_as_in_the_plane() {
    let meshed = meshed(&square(), &MeshOptions { protection: 0.5, ..options(150) });
    demand_protected(&meshed, 0.5);
    demand_circles(&meshed, flat_circle, Point3::distance);
}

fn unit(p: Point3) -> Vector3 {
    (p - Point3::default()).unit().unwrap()
}

fn arc(p: Point3, q: Point3) -> f64 {
    unit(p).cross(unit(q)).norm().atan2(unit(p).dot(unit(q)))
}

#[test]
fn seeds_of_a_sphere_are_protected_and_their_net_is_that_of_spherical_geometry() {
    let manifold = Manifold::shape("sphere:1", Some(0.1)).unwrap();
    for protection in [0.45, 0.55] {
        let meshed = meshed(&manifold, &MeshOptions { protection, ..options(200) });
        demand_protected(&meshed, protection);
        assert_eq!((meshed.mesh.points.len(), net(&meshed).interior().count()), (200, 396));
        let circle = |[a, b, c]: [Point3; 3]| {
            let centre = Point3::default() + (b - a).cross(c - a).unit().unwrap();
            (centre, arc(centre, a))
        };
        demand_circles(&meshed, circle, arc);
        // The mesh is the one that was measured.
        let corners: Vec<[u32; 3]> = net(&meshed).triangles.iter().map(|ball| ball.corners).collect();
        assert_eq!(corners, meshed.mesh.triangles);
    }
}

/// More than most meshes have: what is left is counted, and said.
#[test]
fn what_cannot_be_had_is_noted() {
    let meshed = meshed(&square(), &MeshOptions { protection: 1.5, ..options(9) });
    let account = meshed.protection.unwrap();
    assert!(account.unprotected > 0 && account.unprotected <= account.unprotected_before, "{account:?}");
    let said = format!("{} simplices are less power-protected than by 1.5 epsilon", account.unprotected);
    assert!(meshed.notes.contains(&said), "{:?}", meshed.notes);
    let least = 1.5 * net(&meshed).epsilon;
    assert_eq!(net(&meshed).interior().filter(|ball| ball.protection() < least).count(), account.unprotected);
}

fn cube() -> Manifold {
    let points = (0..8_u32).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = Mesh { points, triangles, ..Mesh::default() };
    Manifold::of(&mesh).unwrap().cut(&FeatureOptions::default()).unwrap()
}

/// Features have their vertices where they have them without, and triangles the numbers of the mesh's vertices.
#[test]
fn seeds_on_features_stay() {
    let manifold = cube();
    let protected = meshed(&manifold, &options(300));
    demand_protected(&protected, 0.2);
    demand_circles_of_mesh(&protected);
    let plain = meshed(&manifold, &MeshOptions { seeding: Seeding::Sizing, net: true, ..options(300) });
    demand_circles_of_mesh(&plain);
    assert!(plain.protection.is_none() && net(&plain).delta() < net(&protected).delta());
    assert_eq!(plain.mesh.edges, protected.mesh.edges);
    for v in plain.mesh.edges.as_flattened() {
        let bits = |mesh: &Mesh| mesh.points[*v as usize].map(f64::to_bits);
        assert_eq!(bits(&plain.mesh), bits(&protected.mesh));
    }
}

fn demand_circles_of_mesh(meshed: &Meshed) {
    let sides = net(meshed).triangles.iter().map(|ball| ball.corners);
    assert!(sides.eq(meshed.mesh.triangles.iter().copied()));
    for ball in net(meshed).interior() {
        let (_, radius) = flat_circle(ball.corners.map(|v| meshed.mesh.position(v)));
        assert!((ball.radius / meshed.metric_scale.sqrt() - radius).abs() < 1e-4 * radius);
    }
}

#[test]
fn protection_on_surfaces_does_not_depend_on_threads() {
    let manifold = Manifold::shape("sphere:1", Some(0.1)).unwrap();
    let options = MeshOptions { protection: 0.5, ..options(150) };
    let with = |threads: usize| crate::test_cases::on_threads(threads, || meshed(&manifold, &options));
    let [one, three] = [1, 3].map(with);
    assert_eq!((&one.mesh, &one.surface_net, &one.protection), (&three.mesh, &three.surface_net, &three.protection));
}
