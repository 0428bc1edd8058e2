//! Meshes of which it is known why their edges are not of unit length.

use super::super::metric_quality;
use super::super::test_meshes::{grid, lattice, mesh};
use super::*;
use crate::geometry::{Tensor, Tensor3};
use crate::manifold::Riemannian;
use crate::manifold::surface::metric::Constant;

const UNIT: fn(Point) -> Tensor = |_| Tensor::IDENTITY;

fn unmet<'a>(mesh: &Mesh, on: impl Into<Riemannian<'a>>) -> Result<Unmet> {
    super::super::unmet(mesh, on, |_| ())
}

/// How many edges there are of each cause, in order.
fn counts(found: &Unmet) -> [usize; 4] {
    Cause::ALL.map(|cause| found.figures().by_cause[&cause].count)
}

#[test]
fn a_unit_mesh_has_no_such_edges_and_neither_has_none() {
    let found = unmet(&lattice(6), &UNIT).unwrap();
    assert!(found.edges.is_empty() && found.lengths.len() == 6 * 7 * 2 + 36);
    let figures = found.figures();
    assert!(figures.edges == 0 && figures.share.abs() < 1e-15 && figures.by_cause.len() == 4);
    assert_eq!(unmet(&Mesh::default(), &UNIT).unwrap().figures(), Unmet::default().figures());
}

#[test]
fn too_few_vertices_for_a_metric_are_the_cause_everywhere() {
    let found = unmet(&lattice(12), &|_: Point| Tensor::isotropic(0.5)).unwrap();
    assert_eq!(counts(&found), [0, found.lengths.len(), 0, 0]);
    let figures = found.figures().by_cause[&Cause::Count];
    assert!(figures.long == found.lengths.len() && figures.short == 0 && (figures.share - 1.0).abs() < 1e-15);
    assert!((figures.worst.unwrap().length - 2.0).abs() < 1e-12);
    // Too many vertices: those that cut off a sharp corner of the border are too many, too.
    let found = unmet(&lattice(12), &|_: Point| Tensor::isotropic(2.0)).unwrap();
    assert_eq!(counts(&found), [0, found.lengths.len(), 0, 0]);
    assert_eq!(found.figures().by_cause[&Cause::Count].short, found.lengths.len());
}

#[test]
fn a_mesh_of_other_shapes_than_the_metric_s_is_not_one_of_too_few_vertices() {
    // Cells sixteen times as long as wide, of the area that the lattice's have.
    let found = unmet(&lattice(12), &|_: Point| Tensor::new(1.0 / 16.0, 0.0, 16.0)).unwrap();
    assert!(found.edges.len() > found.lengths.len() / 2);
    assert_eq!(counts(&found)[1..], [0, 0, found.edges.len() - counts(&found)[0]]);
}

/// Six unit triangles around a vertex, but that one vertex of the rim is two, three degrees apart.
fn split_hexagon() -> Mesh {
    let angles = [0.0_f64, 60.0, 120.0, 180.0, 240.0, 300.0, 303.0].map(f64::to_radians);
    let mut points = vec![[0.0, 0.0]];
    points.extend(angles.map(|angle| [angle.cos(), angle.sin()]));
    let triangles: Vec<[u32; 3]> = (0..7).map(|i| [0, 1 + i, 1 + (i + 1) % 7]).collect();
    mesh(&points, &triangles)
}

#[test]
fn a_short_edge_between_corners_is_the_boundary_s() {
    let found = unmet(&split_hexagon(), &UNIT).unwrap();
    let [edge] = found.edges[..] else { panic!("{found:?}") };
    assert_eq!((edge.edge, edge.cause, edge.is_short()), ([6, 7], Cause::Boundary, true));
    assert!((edge.length - 2.0 * 1.5_f64.to_radians().sin()).abs() < 1e-12);
    // Edges that end there are its doing, too: here spokes, which are too long along y.
    let stretched = unmet(&split_hexagon(), &|_: Point| Tensor::new(1.0, 0.0, 2.9)).unwrap();
    let cause = |ends: [u32; 2]| stretched.edges.iter().find(|edge| edge.edge == ends).map(|edge| edge.cause);
    assert_eq!([[0, 6], [0, 7]].map(cause), [Some(Cause::Boundary); 2]);
    assert_ne!(cause([0, 3]).or(cause([0, 2])), Some(Cause::Boundary));
}

#[test]
fn a_vertex_that_may_slide_is_no_corner_until_labels_make_it_one() {
    let mut halved = mesh(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [0.5, 0.75_f64.sqrt()]], &[[0, 1, 3], [1, 2, 3]]);
    let causes = |mesh: &Mesh| unmet(mesh, &UNIT).unwrap().edges.iter().map(|edge| edge.cause).collect::<Vec<_>>();
    assert_eq!(causes(&halved), [Cause::Irregular; 2]);
    halved.edges = vec![[0, 1], [2, 1]];
    halved.edge_labels = vec![1, 1];
    assert_eq!(causes(&halved), [Cause::Irregular; 2]);
    halved.edge_labels = vec![1, 2];
    assert_eq!(causes(&halved), [Cause::Boundary; 2]);
    halved.edge_labels = vec![1, 1];
    halved.required_points = vec![1];
    assert_eq!(causes(&halved), [Cause::Boundary; 2]);
}

#[test]
fn a_narrow_channel_is_the_boundary_s() {
    let mut channel = grid(10, 1);
    channel.points.iter_mut().for_each(|p| p[1] *= 0.3);
    let found = unmet(&channel, &UNIT).unwrap();
    assert_eq!(counts(&found), [11, 0, 0, 0]);
    assert!(found.edges.iter().all(|edge| (edge.length - 0.3).abs() < 1e-12));
}

#[test]
fn a_required_edge_is_the_boundary_s_however_long() {
    let mut square = grid(1, 1);
    square.points.iter_mut().for_each(|p| *p = p.map(|x| 1.3 * x));
    square.edges = vec![[3, 0]];
    square.edge_labels = vec![7];
    let cause = |mesh: &Mesh| unmet(mesh, &UNIT).unwrap().edges[0].cause;
    assert_eq!(cause(&square), Cause::Count);
    square.required_edges = vec![0];
    assert_eq!(cause(&square), Cause::Boundary);
    // Numbers of what does not exist do no harm.
    square.required_edges = vec![9];
    square.corners = vec![77];
    square.edges.push([5, 6]);
    assert_eq!(cause(&square), Cause::Count);
}

#[test]
fn straight_edges_fail_where_a_metric_changes_within_a_unit() {
    // The half-plane with sizes h at y = 1: triangles lie between 1 - h / sqrt 3 and 1 + h / sqrt 3, where lengths differ by less
    // than sqrt 2 for h = 0.5. For h = 1.7 one edge of each of the six triangles has length 1.99 or more (summed elsewhere).
    let half_plane = |h: f64| move |p: Point| Tensor::isotropic(h * (1.0 + p.y));
    for (h, fails) in [(0.01, false), (0.5, false), (1.7, true)] {
        assert_eq!(forced::straight_edges_fail(&half_plane(h)), fails, "{h}");
    }
    for anisotropy in [1.0, 1e3, 1e6] {
        let m = Tensor::from_axis(Vector::new(0.6, 0.8), 1.0, anisotropy * anisotropy);
        assert!(!forced::straight_edges_fail(&move |_: Point| m), "{anisotropy}");
    }
    // Outside the domain a metric need not be one.
    let ends = |p: Point| if p.x > 0.2 { Tensor::isotropic(f64::NAN) } else { Tensor::IDENTITY };
    assert!(!forced::straight_edges_fail(&ends));
}

/// The Euclidean plane under waves, and the lattice in it whose geodesic edges all have length 1.
fn waves(height: f64) -> (Mesh, impl Fn(Point) -> Tensor + Sync) {
    let mut mesh = lattice(20);
    mesh.points.iter_mut().for_each(|p| p[1] -= height * (2.0 * p[0]).sin());
    let metric = move |p: Point| {
        let slope = 2.0 * height * (2.0 * p.x).cos();
        Tensor::new(1.0 + slope * slope, slope, 1.0)
    };
    (mesh, metric)
}

#[test]
fn what_only_curved_edges_can_do_is_the_metric_s() {
    let (gentle, metric) = waves(0.1);
    assert!(unmet(&gentle, &metric).unwrap().edges.is_empty());
    let (wild, metric) = waves(4.0);
    let found = unmet(&wild, &metric).unwrap();
    // Straight edges are never shorter than geodesics.
    assert!(found.edges.len() > found.lengths.len() / 4 && found.edges.iter().all(|edge| !edge.is_short()));
    assert!(counts(&found)[2] > 9 * found.edges.len() / 10, "{:?} of {}", counts(&found), found.lengths.len());
}

/// The same with quadratic sides through the middles of geodesics.
fn bent(height: f64) -> (Mesh, impl Fn(Point) -> Tensor + Sync) {
    let (mut mesh, metric) = waves(height);
    let rise = |x: f64| height * (2.0 * x).sin();
    let flat = |v: u32| mesh.point(v) + Vector::new(0.0, rise(mesh.point(v).x));
    let ends: Vec<[u32; 2]> = Edges::of(&mesh.triangles).ends().collect();
    let middles = ends.iter().map(|&[a, b]| flat(a).midpoint(flat(b))).map(|p| [p.x, p.y - rise(p.x), 0.0]);
    let nodes = middles.collect();
    let of = |side: [u32; 2]| ends.iter().position(|&ends| ends == in_order(side)).expect("an edge") as u32;
    let triangles = mesh.triangles.iter().flat_map(|&t| edges_of(t).map(of)).collect();
    mesh.curved = Some(crate::mesh::Curved { order: 2, nodes, triangles });
    (mesh, metric)
}

#[test]
fn sides_of_curved_triangles_are_measured_along_their_curves() {
    let height = 1.5;
    let ((straight, metric), (curved, _)) = (waves(height), bent(height));
    let (before, found) = (unmet(&straight, &metric).unwrap(), unmet(&curved, &metric).unwrap());
    assert!(
        before.edges.len() > found.lengths.len() / 20 && found.edges.is_empty(),
        "{} {}",
        before.edges.len(),
        found.edges.len()
    );
    assert_eq!(found.quality, Some(metric_quality(&curved, &metric).unwrap()));
    let coarse = unmet(&curved, &|p: Point| metric.at(p) * 9.0).unwrap();
    assert_eq!(counts(&coarse)[1], coarse.lengths.len());
    let (wild, metric) = bent(4.0);
    let found = unmet(&wild, &metric).unwrap();
    assert!(found.edges.len() > 10 && counts(&found)[2] > found.edges.len() / 2, "{:?}", counts(&found));
}

#[test]
fn surfaces_have_the_same_causes() {
    let flat = lattice(12);
    let surface = Manifold::of(&flat).unwrap();
    let fine = Constant(Tensor3::isotropic(0.5));
    let found = unmet(&flat, (&surface, &fine)).unwrap();
    assert_eq!(counts(&found), [0, found.lengths.len(), 0, 0]);
    assert_eq!(found.edges[0].at.coordinates().len(), 3);
    let (wild, planar) = waves(4.0);
    let metric = |p: Point3| {
        let m = planar(Point::new(p.x, p.y));
        Tensor3::from_disk([m.xx, m.xy, m.yy, 0.0, 0.0, 1.0])
    };
    let truth = unmet(&wild, &planar).unwrap();
    let found = unmet(&wild, (&Manifold::of(&wild).unwrap(), &metric)).unwrap();
    assert_eq!(found.edges.len(), truth.edges.len());
    // Off the sheet its metric is that of its rim.
    let differ = found.edges.iter().zip(&truth.edges).filter(|(a, b)| a.cause != b.cause).count();
    assert!(differ < truth.edges.len() / 10, "{differ}: {:?} {:?}", counts(&found), counts(&truth));
}

#[test]
fn quality_is_what_is_measured_alone() {
    let (wild, planar) = waves(4.0);
    assert_eq!(unmet(&wild, &planar).unwrap().quality, Some(metric_quality(&wild, &planar).unwrap()));
    let (surface, metric) = (Manifold::of(&wild).unwrap(), Constant(Tensor3::IDENTITY));
    let alone = metric_quality(&wild, (&surface, &metric)).unwrap();
    assert_eq!(unmet(&wild, (&surface, &metric)).unwrap().quality, Some(alone));
    assert_eq!(unmet(&Mesh::default(), &UNIT).unwrap().quality, None);
}

#[test]
fn faults_are_errors_and_threads_do_not_matter() {
    let bad = |p: Point| if p.x > 3.5 { Tensor::new(1.0, 2.0, 1.0) } else { Tensor::IDENTITY };
    assert!(matches!(unmet(&grid(4, 4), &bad), Err(crate::Error::Metric { .. })));
    assert!(matches!(unmet(&mesh(&[[0.0, 0.0]], &[[0, 1, 2]]), &UNIT), Err(crate::Error::Mesh { .. })));
    let (wild, metric) = waves(4.0);
    let with = |threads| crate::test_cases::on_threads(threads, || unmet(&wild, &metric).unwrap());
    assert_eq!(with(1), with(3));
}

#[test]
fn needles_are_forced_where_all_their_corners_are_on_borders() {
    // A vertex next to a side of the triangle that it is in.
    let points = [[0.0, 0.0], [1.0, 0.0], [0.5, 1e-3], [0.5, 0.9]];
    let inner = mesh(&points, &[[0, 1, 2], [0, 2, 3], [2, 1, 3]]);
    let needles = |mesh: &Mesh| unmet(mesh, &UNIT).unwrap().figures().needles;
    let told = |found: &Needles| (found.count, found.forced, found.poorest[0].is_forced);
    assert_eq!(told(&needles(&inner)), (1, 0, false));
    assert_eq!(told(&needles(&Mesh { required_points: vec![2], ..inner })), (1, 1, true));
}

#[test]
fn needles_on_a_short_edge_that_is_kept_are_forced() {
    // A spoke's triangle on the rim of a hexagon, two corners of which are next to each other.
    let hexagon = |degrees: f64| {
        let angles = [0.0_f64, 60.0, 120.0, 180.0, 240.0, 300.0, 300.0 + degrees].map(f64::to_radians);
        let mut points = vec![[0.0, 0.0]];
        points.extend(angles.map(|angle| [angle.cos(), angle.sin()]));
        mesh(&points, &(0..7).map(|i| [0, 1 + i, 1 + (i + 1) % 7]).collect::<Vec<[u32; 3]>>())
    };
    let needles = |mesh: &Mesh| unmet(mesh, &UNIT).unwrap().figures().needles;
    let told = |found: &Needles| (found.count, found.forced);
    assert_eq!(told(&needles(&hexagon(3.0))), (0, 0));
    assert_eq!(told(&needles(&hexagon(1.0))), (1, 1));
    // The same triangle where nothing has to be kept: its tip is beside the middle of a side that is no feature.
    let inside = mesh(&[[0.0, 0.0], [1.0, 0.0], [0.5, 0.0125], [0.5, 0.9]], &[[0, 1, 2], [0, 2, 3], [2, 1, 3]]);
    assert_eq!(told(&needles(&inside)), (1, 0));
}
