//! Periodic pairs of curves: the mesh's edges on the two correspond, whatever is done to the rest of it.

mod domains;

use domains::{SLIT, aerofoil, graph, sector, square, waves};
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use voronaut::Result;
use voronaut::dual::Road;
use voronaut::geometry::{Point, Tensor};
use voronaut::manifold::domain::{Domain, from_mesh};
use voronaut::mesh::{Mesh, Periodic};
use voronaut::metric::{Expression, MetricField, Norm, Snapshot, Variables};
use voronaut::progress::Silent;
use voronaut::quality::{check, metric_quality};
use voronaut::recipe::{self, Centroid, Effort, MeshOptions, Meshed, Seeding};

fn try_to(domain: &Domain, field: &dyn MetricField, options: &MeshOptions) -> Result<Meshed> {
    recipe::mesh(domain, field, options, &Silent)
}

fn meshed(domain: &Domain, field: &dyn MetricField, periodic: &[[i32; 2]], vertices: usize) -> Meshed {
    let options = MeshOptions { periodic: periodic.to_vec(), vertices: Some(vertices), ..MeshOptions::default() };
    let meshed = try_to(domain, field, &options).unwrap();
    assert_eq!((meshed.mesh.points.len(), &meshed.notes[..]), (vertices, &[][..]));
    demand_partners(&meshed.mesh, periodic);
    meshed
}

/// The edges with a label, by their smaller and larger vertex.
fn edges(mesh: &Mesh, label: i32) -> BTreeSet<[u32; 2]> {
    let listed = mesh.edges.iter().zip(&mesh.edge_labels).filter(|(_, l)| **l == label);
    listed.map(|(&[a, b], _)| [a.min(b), a.max(b)]).collect()
}

/// Where a pair's motion brings a point, by the formula that is promised.
fn image(pair: &Periodic, [x, y, _]: [f64; 3]) -> [f64; 2] {
    let ([c, s], [u, v]) = (pair.rotation, pair.translation);
    [c * x - s * y + u, s * x + c * y + v]
}

/// Every edge of the one curve has its partner on the other, every vertex its image to the last bit, unless it is a corner.
fn demand_partners(mesh: &Mesh, asked: &[[i32; 2]]) {
    check(mesh).unwrap();
    assert_eq!(mesh.periodic.iter().map(|pair| pair.labels).collect::<Vec<_>>(), asked);
    for pair in &mesh.periodic {
        let path = |side: usize| -> BTreeSet<[u32; 2]> {
            let ends = pair.vertices.windows(2).map(|w| [w[0][side], w[1][side]]);
            ends.map(|[a, b]| [a.min(b), a.max(b)]).collect()
        };
        assert_eq!([path(0), path(1)], pair.labels.map(|label| edges(mesh, label)));
        for &[a, b] in &pair.vertices {
            let (moved, there) = (image(pair, mesh.points[a as usize]), mesh.points[b as usize]);
            let is_corner = mesh.corners.contains(&a);
            assert_eq!(is_corner, mesh.corners.contains(&b));
            let off = (moved[0] - there[0]).hypot(moved[1] - there[1]);
            assert!(if is_corner { off <= pair.off } else { off == 0.0 }, "{off:e} at {there:?}");
        }
    }
}

/// Fine at the right side of the unit square, coarse at the left one, and thin across a diagonal.
fn graded(p: Point) -> Tensor {
    Tensor::new(40.0 + 4000.0 * p.x.powi(6), 15.0, 60.0 + 900.0 * p.x.powi(4))
}

#[test]
fn an_aerofoil_s_cut_has_the_same_vertices_on_both_sides() {
    let fine = |p: Point| Tensor::isotropic(0.02 + 0.2 * (p - Point::new(0.5, 0.0)).norm());
    let meshed = meshed(&aerofoil(), &fine, &[[3, 4]], 3000);
    let pair = &meshed.mesh.periodic[0];
    assert_eq!((pair.rotation, pair.translation[0].to_bits()), ([1.0, 0.0], 0));
    assert!((pair.translation[1] + SLIT).abs() < 1e-15 && pair.off < 1e-15 && pair.vertices.len() > 15, "{pair:?}");
    for &[a, b] in &pair.vertices {
        let [upper, lower] = [a, b].map(|v| meshed.mesh.points[v as usize]);
        assert_eq!(upper[0].to_bits(), lower[0].to_bits());
    }
    let scaled = |p: Point| fine(p) * meshed.metric_scale;
    let quality = metric_quality(&meshed.mesh, &scaled).unwrap();
    assert!(quality.metric_edge_length.unit_fraction > 0.9 && quality.quality.mean > 0.9, "{quality:?}");
}

#[test]
fn the_side_that_asks_for_more_decides() {
    let square = square();
    let meshed = meshed(&square, &graded, &[[4, 2], [1, 3]], 700);
    let pair = &meshed.mesh.periodic[0];
    let fine = |p: Point| graded(Point::new(1.0, p.y)) * meshed.metric_scale;
    let ends = pair.vertices.windows(2).map(|w| [w[0][1], w[1][1]].map(|v| meshed.mesh.point(v)));
    let lengths: Vec<f64> = ends.map(|[p, q]| fine(p.lerp(q, 0.5)).length(q - p)).collect();
    assert!(lengths.iter().all(|length| (0.8..1.25).contains(length)), "{lengths:?}");
    assert_eq!(meshed.mesh.periodic.iter().map(|pair| pair.off.to_bits()).collect::<Vec<_>>(), [0, 0]);
}

#[test]
fn nothing_that_is_done_to_the_mesh_parts_them() {
    let usual = MeshOptions { periodic: vec![[4, 2]], vertices: Some(300), ..MeshOptions::default() };
    for (name, options) in [
        ("no relaxation", MeshOptions { lloyd: 0, ..usual.clone() }),
        ("much relaxation", MeshOptions { effort: Effort::Best, lloyd: 200, ..usual.clone() }),
        ("centroids on a canvas", MeshOptions { centroid: Centroid::Canvas, lloyd: 8, ..usual.clone() }),
        ("a diagram decides", MeshOptions { dual: Road::Canvas, ..usual.clone() }),
        ("farthest points", MeshOptions { seeding: Seeding::Farthest, ..usual.clone() }),
        ("protection", MeshOptions { seeding: Seeding::Protected, ..usual.clone() }),
        ("places are picked", MeshOptions { seeding: Seeding::Protected, lloyd: 0, ..usual.clone() }),
        ("by complexity", MeshOptions { vertices: None, complexity: Some(200.0), ..usual.clone() }),
        ("as it is", MeshOptions { vertices: None, ..usual.clone() }),
    ] {
        let meshed = try_to(&square(), &graded, &options).unwrap_or_else(|error| panic!("{name}: {error}"));
        demand_partners(&meshed.mesh, &[[4, 2]]);
        assert!(options.vertices.is_none_or(|n| n == meshed.mesh.points.len()), "{name}");
    }
}

#[test]
fn polishing_leaves_them_alone() {
    let function = Expression::parse("tanh(20*(y - 0.3*x^2 - 0.2))", Variables::Plane);
    let function = Snapshot::from(function.unwrap());
    let domain = square();
    let at = recipe::GradedAt::of(Some(500), None);
    let metric = recipe::metric_of_function(&function, domain.planar(), &recipe::MetricOptions::default(), at).unwrap();
    let options = MeshOptions { periodic: vec![[4, 2]], vertices: Some(500), ..MeshOptions::default() };
    let aim = metric.aim(Norm::default());
    let made = recipe::mesh_for(&domain, metric.field.as_ref(), aim, &options, &Silent).unwrap();
    assert!(made.polished.unwrap().moves > 0 && made.mesh.points.len() == 500);
    demand_partners(&made.mesh, &[[4, 2]]);
}

#[test]
fn counts_are_met_however_few() {
    for vertices in [4, 5, 9, 17, 60] {
        let made = meshed(&square(), &graded, &[[4, 2]], vertices);
        assert!(made.mesh.periodic[0].vertices.len() >= 2);
    }
}

#[test]
fn sectors_are_turned() {
    let even = |_: Point| Tensor::isotropic(0.1);
    let exact = meshed(&sector(TAU / 12.0, [0, 0], |x| x), &even, &[[1, 2]], 400);
    let pair = &exact.mesh.periodic[0];
    assert!(
        (pair.rotation[1] - 0.5).abs() < 1e-15 && pair.translation.map(f64::to_bits) == [0; 2] && pair.off < 1e-15,
        "{pair:?}"
    );
    // A right angle is exact.
    let quarter = meshed(&sector(TAU / 4.0, [0, 0], |x| x), &even, &[[1, 2]], 400);
    assert_eq!((quarter.mesh.periodic[0].rotation, quarter.mesh.periodic[0].translation), ([0.0, 1.0], [0.0; 2]));
}

#[test]
fn straight_sides_may_be_cut_differently_and_rounded() {
    let even = |_: Point| Tensor::isotropic(0.1);
    let six_digits = |x: f64| (x * 1e6).round() / 1e6;
    let made = meshed(&sector(TAU / 10.0, [3, 4], six_digits), &even, &[[2, 1]], 400);
    let pair = &made.mesh.periodic[0];
    assert!((1e-8..2e-6).contains(&pair.off) && pair.vertices.len() > 8, "{pair:?}");
}

#[test]
fn curves_are_simplified_in_step() {
    let even = |_: Point| Tensor::isotropic(0.05);
    let options =
        MeshOptions { periodic: vec![[1, 3]], vertices: Some(500), hausd: Some(2e-3), ..MeshOptions::default() };
    let made = try_to(&waves(400, 0.5), &even, &options).unwrap();
    demand_partners(&made.mesh, &[[1, 3]]);
    let count = made.mesh.periodic[0].vertices.len();
    assert!(made.mesh.points.len() == 500 && (10..60).contains(&count), "{count}");
}

#[test]
fn meshes_of_ours_are_domains_again() {
    let made = meshed(&sector(TAU / 10.0, [0, 0], |x| x), &|_: Point| Tensor::isotropic(0.1), &[[1, 2]], 300);
    let again = Domain::new(&from_mesh(&made.mesh).unwrap()).unwrap();
    meshed(&again, &|p: Point| Tensor::isotropic(0.05 * p.x), &[[1, 2]], 500);
}

#[test]
fn what_does_not_fit_is_told_with_its_place() {
    let fault = |domain: &Domain, periodic: &[[i32; 2]]| {
        let options = MeshOptions { periodic: periodic.to_vec(), vertices: Some(100), ..MeshOptions::default() };
        let error = try_to(domain, &graded, &options).unwrap_err();
        assert!(!error.help().is_empty());
        error.to_string()
    };
    let has = |text: String, words: &str| assert!(text.contains(words), "{text}");
    has(fault(&square(), &[[4, 7]]), "no boundary has label 7");
    has(fault(&square(), &[[4, 4]]), "label 4 twice");
    has(fault(&square(), &[[4, 2], [1, 2]]), "label 2 twice");
    let bent =
        domains::polygon(&[(0.0, 0.0, 1), (1.0, 0.0, 2), (1.25, 0.5, 2), (1.0, 1.0, 3), (0.0, 1.0, 4), (0.26, 0.5, 4)]);
    has(fault(&bent, &[[4, 2]]), "a corner of label 4 has no partner on label 2: it is 1.000e-2 off");
    let longer = domains::polygon(&[(0.0, 0.0, 1), (1.0, 0.0, 2), (1.0, 1.1, 3), (0.0, 1.0, 4)]);
    has(fault(&longer, &[[4, 2]]), "the curves with labels 4 and 2 have lengths 1 and 1.1");
    let closed = Domain::shape("disk:0,0,1").unwrap();
    has(fault(&closed, &[[1, 2]]), "label");
    let pieces = domains::polygon(&[(0.0, 0.0, 1), (1.0, 0.0, 2), (1.0, 1.0, 1), (0.0, 1.0, 4)]);
    has(fault(&pieces, &[[1, 2]]), "the segments with label 1 are in 2 pieces");
}

#[test]
fn cuts_of_no_width_are_no_domains() {
    // Both sides of the cut from (1, 0) to (2, 0) have the same points.
    let slit = graph(&[
        (2.0, 0.0, 2),
        (0.0, 2.0, 2),
        (-2.0, 0.0, 2),
        (0.0, -2.0, 2),
        (2.0, 0.0, 4),
        (1.0, 0.0, 1),
        (0.0, -1.0, 1),
        (-1.0, 0.0, 1),
        (0.0, 1.0, 1),
        (1.0, 0.0, 3),
    ]);
    let error = Domain::new(&slit).unwrap_err().to_string();
    assert!(error.contains("two points have the same position"), "{error}");
}
