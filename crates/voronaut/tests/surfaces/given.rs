//! Surfaces as the world has them: the smallest of each kind that was once refused, or meshed badly.

use voronaut::manifold::Manifold;
use voronaut::manifold::surface::metric::{Spec, field};
use voronaut::manifold::surface::{FeatureOptions, RepairOptions, Surface, repaired};
use voronaut::mesh::Mesh;
use voronaut::metric::Bounds;
use voronaut::progress::Silent;
use voronaut::quality::{Meetings, metric_quality, validity_on};
use voronaut::recipe::{MeshOptions, Meshed, mesh_surface};

fn manifold(points: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Manifold {
    let mesh = Mesh { points, triangle_labels: vec![0; triangles.len()], triangles, ..Mesh::default() };
    Manifold::of(&mesh).unwrap()
}

/// Meshes by a metric; the mesh meets itself where the surface does at most.
fn meshed(manifold: &Manifold, metric: &str, count: usize) -> Meshed {
    let field = field(&Spec::parse(metric).unwrap(), manifold, Bounds::default()).unwrap();
    let options = MeshOptions { vertices: Some(count), ..MeshOptions::default() };
    let meshed = mesh_surface(manifold, field.as_ref(), None, &options, &Silent).unwrap();
    let found = validity_on(&meshed.mesh, &Meetings::of(manifold.whole_mesh()));
    assert!(found.valid, "{:?}", found.first_fault);
    meshed
}

/// Borders with many vertices on few triangles begin as fans of needles.
#[test]
fn two_triangles_become_unit_triangles() {
    let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.0, 1.0, 0.0]];
    let manifold = manifold(points, vec![[0, 1, 2], [1, 3, 2]]);
    let found = meshed(&manifold, "uniform", 1000);
    let metric = field(&Spec::Uniform, &manifold, Bounds::default()).unwrap();
    let quality = metric_quality(&found.mesh, (&manifold, metric.as_ref())).unwrap().quality;
    assert!(found.mesh.points.len() == 1000 && quality.mean > 0.95 && quality.min > 0.4, "{quality:?}");
}

/// In the plane z = 0 a surface may face down; its mesh is no planar one.
#[test]
fn flat_surfaces_face_either_way() {
    let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    for triangles in [vec![[0, 1, 2], [0, 2, 3]], vec![[0, 2, 1], [0, 3, 2]]] {
        let found = meshed(&manifold(points.clone(), triangles), "uniform", 100);
        assert_eq!(found.mesh.points.len(), 100);
    }
}

/// A cone of height 100 over a ring of radius 1: at its tip normals are of no use, and curvature has no bound.
#[test]
fn a_thin_tip_has_a_metric() {
    let n = 24;
    let ring = |k: u32, height: f64, r: f64| {
        let angle = f64::from(k) * std::f64::consts::TAU / f64::from(n);
        [r * angle.cos(), r * angle.sin(), height]
    };
    let mut points: Vec<[f64; 3]> =
        (0..n).map(|k| ring(k, 0.0, 1.0)).chain((0..n).map(|k| ring(k, 50.0, 0.5))).collect();
    points.extend([[0.0, 0.0, 100.0], [0.0, 0.0, 0.0]]);
    let mut triangles = Vec::new();
    for k in 0..n {
        let next = (k + 1) % n;
        triangles.extend([[k, next, n + k], [next, n + next, n + k], [n + k, n + next, 2 * n], [next, k, 2 * n + 1]]);
    }
    let found = meshed(&manifold(points, triangles), "curvature", 400);
    assert!(found.mesh.points.len().abs_diff(400) <= 4, "{:?}", found.notes);
}

/// Spikes side by side, twelve high and a sixth wide: where nothing coarser is a mesh, the surface's own triangles are.
#[test]
fn spikes_have_a_mesh() {
    let n = 6_u32;
    for frequency in [3.7, 5.1] {
        let at = |k: u32| [k / (n + 1), k % (n + 1)].map(|i| f64::from(i) / f64::from(n));
        let height = |k: u32| 6.0 * (frequency * f64::from(k)).sin();
        let points = (0..(n + 1) * (n + 1)).map(|k| [at(k)[0], at(k)[1], height(k)]).collect();
        let cells = (0..n).flat_map(|i| (0..n).map(move |j| i * (n + 1) + j));
        let triangles = cells.flat_map(|a| [[a, a + n + 1, a + n + 2], [a, a + n + 2, a + 1]]).collect();
        let found = meshed(&manifold(points, triangles), "uniform", 300);
        assert!(found.notes.iter().any(|note| note.starts_with("made anew")), "{:?}", found.notes);
    }
}

/// A square of so many by so many labels.
fn labelled_square(labels: u32) -> Manifold {
    let n = 20;
    let points = (0..=n).flat_map(|j| (0..=n).map(move |i| [f64::from(i) / 20.0, f64::from(j) / 20.0, 0.0])).collect();
    let (mut triangles, mut triangle_labels) = (Vec::new(), Vec::new());
    for j in 0..n {
        for i in 0..n {
            let at = j * (n + 1) + i;
            triangles.extend([[at, at + 1, at + n + 2], [at, at + n + 2, at + n + 1]]);
            triangle_labels.extend([(j * labels / n * labels + i * labels / n).cast_signed(); 2]);
        }
    }
    let mesh = Mesh { points, triangles, triangle_labels, ..Mesh::default() };
    Manifold::of(&mesh).unwrap().cut(&FeatureOptions::default()).unwrap()
}

#[test]
fn labels_do_not_change_the_number_of_vertices() {
    let count = |labels: u32| {
        let manifold = labelled_square(labels);
        let field = field(&Spec::parse("formula:400;0;400;0;0;400").unwrap(), &manifold, Bounds::default()).unwrap();
        mesh_surface(&manifold, field.as_ref(), None, &MeshOptions::default(), &Silent).unwrap().mesh.points.len()
    };
    let [one, many] = [1, 4].map(count);
    assert!(one.abs_diff(many) * 50 <= one, "{one} {many}");
}

#[test]
fn a_number_that_features_exceed_is_noted() {
    let found = meshed(&labelled_square(4), "uniform", 20);
    let note = found.notes.iter().find(|note| note.contains("vertices where 20 were asked for"));
    assert!(note.is_some_and(|note| note.contains("are on features")), "{:?}", found.notes);
}

/// Two cubes with a common edge, and two with a common corner: cut into sheets that meet there, and meshed as they are.
#[test]
fn cubes_that_share_an_edge_or_a_corner_are_meshed_once_repaired() {
    let corner = |i: u32| [f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)];
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves: Vec<[u32; 3]> = sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    for offset in [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0]] {
        let mut points: Vec<[f64; 3]> = Vec::new();
        let mut number = |p: [f64; 3]| {
            let at = points.iter().position(|q| q.map(f64::to_bits) == p.map(f64::to_bits)).unwrap_or(points.len());
            points.extend((at == points.len()).then_some(p));
            at as u32
        };
        let moved = |p: [f64; 3]| [0, 1, 2].map(|k| p[k] + offset[k]);
        let mut triangles: Vec<[u32; 3]> = halves.iter().map(|t| t.map(|i| number(corner(i)))).collect();
        triangles.extend(halves.iter().map(|t| t.map(|i| number(moved(corner(i))))));
        let mesh = Mesh { points, triangle_labels: vec![0; triangles.len()], triangles, ..Mesh::default() };
        assert!(repaired(&mesh, RepairOptions::default()).and_then(|(mesh, _)| Surface::new(&mesh)).is_err());
        let (mesh, _) = repaired(&mesh, RepairOptions { repair: true }).unwrap();
        let manifold = Manifold::of(&mesh).unwrap().cut(&FeatureOptions::default()).unwrap();
        assert_eq!(meshed(&manifold, "uniform", 300).mesh.points.len(), 300);
    }
}

/// Two balls pushed into each other: the mesh meets itself where they do.
#[test]
fn what_meets_itself_is_meshed_and_told() {
    let ball = Manifold::shape("sphere:1", Some(0.3)).unwrap().whole_mesh();
    let n = ball.points.len() as u32;
    let points =
        ball.points.iter().copied().chain(ball.points.iter().map(|p| [p[0] + 1.2, p[1] + 0.01, p[2]])).collect();
    let triangles = ball.triangles.iter().copied().chain(ball.triangles.iter().map(|t| t.map(|v| v + n))).collect();
    let manifold = manifold(points, triangles);
    let found = meshed(&manifold, "uniform", 500);
    let excused = validity_on(&found.mesh, &Meetings::of(manifold.whole_mesh())).meetings;
    assert!(excused.count > 0 && excused.first.is_some(), "{excused:?}");
}

/// Sheets through one point, which triangles cannot keep apart.
#[test]
fn an_equation_whose_triangles_meet_is_refused_with_the_place() {
    let manifold = Manifold::shape("implicit:(x^2+y^2-z^2)*z;-1,-1,-1,1,1,1", None).unwrap();
    let field = field(&Spec::Uniform, &manifold, Bounds::default()).unwrap();
    let error = mesh_surface(&manifold, field.as_ref(), None, &MeshOptions::default(), &Silent).unwrap_err();
    assert!(error.to_string().contains("triangles of f = 0 meet"), "{error}");
}

/// A cliff of one triangle: two creases between the same corners, one straight, one over the top. Sampled coarsely they were one line,
/// with triangles of no area between.
#[test]
fn a_patch_between_two_creases_keeps_its_area() {
    let points = [[-3.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 0.05, 1.0], [-6.0, 10.0, 0.0], [6.0, 10.0, 0.0]];
    let points = [&points[..], &[[-6.0, -10.0, 0.0], [6.0, -10.0, 0.0]]].concat();
    let triangles = vec![[0, 1, 2], [0, 2, 3], [2, 4, 3], [1, 4, 2], [0, 5, 1], [5, 6, 1]];
    let manifold = manifold(points, triangles).cut(&FeatureOptions::default()).unwrap();
    let found = meshed(&manifold, "uniform", 14).mesh;
    let metric = field(&Spec::Uniform, &manifold, Bounds::default()).unwrap();
    let quality = metric_quality(&found, (&manifold, metric.as_ref())).unwrap().quality;
    assert!(quality.min > 0.1 && found.points.iter().any(|p| p[2] > 0.5), "{quality:?}");
}
