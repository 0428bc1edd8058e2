use super::*;
use crate::geometry::{Point, Tensor};
use crate::manifold::domain::Domain;
use crate::manifold::domain::{Pslg, from_mesh};
use crate::metric::{MetricField, Sampled};
use crate::metric::{Shock, Uniform};
use crate::progress::Silent;
use crate::quality::{metric_quality, validity};
use crate::recipe::mesh;
use crate::test_cases::plate;

fn options(vertices: usize) -> MeshOptions {
    MeshOptions { vertices: Some(vertices), effort: crate::recipe::Effort::Fast, ..MeshOptions::default() }
}

type Rounds = Vec<(&'static str, Vec<Part>)>;

/// The mesh in parts, the rounds that were made, and how many parts each had.
fn made(domain: &Domain, field: &dyn MetricField, parts: usize, options: &MeshOptions) -> Result<(Meshed, Rounds)> {
    let mut rounds = Rounds::new();
    let mut make = |round, parts: &[Part], take: &mut dyn FnMut(Mesh)| {
        rounds.push((round, parts.to_vec()));
        parts.iter().try_for_each(|part| mesh_part(part, field, None, options, &Silent).map(&mut *take))
    };
    let meshed = mesh_in_parts(domain, field, None, Some(parts), options, &mut make, &Silent)?;
    Ok((meshed, rounds))
}

/// That a mesh in parts is one of the domain: as large, with exactly so many vertices, and nothing of cuts.
fn demand_whole(domain: &Domain, meshed: &Meshed, vertices: usize) {
    let mesh = &meshed.mesh;
    let found = validity(mesh);
    assert!(found.valid && meshed.notes.is_empty(), "{:?}", meshed.notes);
    assert_eq!(mesh.points.len(), vertices);
    assert!((found.area - domain.area()).abs() < 1e-12 * domain.area(), "{} of {}", found.area, domain.area());
    assert!(!mesh.edge_labels.contains(&region::CUT));
    let pslg = domain.pslg();
    assert_eq!(mesh.corners.len(), pslg.points.len());
    assert_eq!(mesh.required_edges.len(), pslg.segments.iter().filter(|segment| segment.required).count());
    // No straight run has lost or won anything.
    let again = Domain::new(&from_mesh(mesh).unwrap()).unwrap();
    assert_eq!(again.pslg().segments.len(), pslg.segments.len());
}

#[test]
fn the_whole_is_valid_with_exactly_so_many_vertices_and_as_good_as_one_piece() {
    let (domain, field) = (Domain::shape("rect:-1,-1,1,1").unwrap(), Shock { phi: 1.0, lambda: 0.6 });
    let (meshed, rounds) = made(&domain, &field, 4, &options(6000)).unwrap();
    demand_whole(&domain, &meshed, 6000);
    assert_eq!(rounds.iter().map(|round| round.0).collect::<Vec<_>>(), ["parts", "strips", "junctions"]);
    assert_eq!(rounds[0].1.len(), 4);
    let figures = |mesh: &Mesh, factor: f64| {
        let scaled = |p: Point| MetricField::at(&field, p) * factor;
        let found = metric_quality(mesh, &scaled).unwrap();
        (found.metric_edge_length.unit_fraction, found.quality.mean)
    };
    let one = mesh(&domain, &field, &options(6000), &Silent).unwrap();
    let ((unit, quality), (least_unit, least)) =
        (figures(&meshed.mesh, meshed.metric_scale), figures(&one.mesh, one.metric_scale));
    assert!(
        unit > least_unit - 0.005 && quality > least - 0.005,
        "{unit} {quality}, in one piece {least_unit} {least}"
    );
    assert!((meshed.metric_scale / one.metric_scale - 1.0).abs() < 0.01);
}

/// Cuts are sampled once, for both sides.
#[test]
fn parts_meet_at_the_same_points() {
    let (domain, field) = (Domain::shape("rect:-1,-1,1,1").unwrap(), Shock { phi: 1.0, lambda: 0.6 });
    let (_, rounds) = made(&domain, &field, 3, &options(4000)).unwrap();
    let cuts = |part: &Part| {
        let ends = part.domain.edges.iter().zip(&part.domain.edge_labels).filter(|(_, label)| **label == region::CUT);
        let place = |v: u32| part.domain.points[v as usize].map(f64::to_bits);
        ends.map(|(ends, _)| crate::lists::in_order(ends.map(place))).collect::<Vec<_>>()
    };
    let mut all: Vec<_> = rounds[0].1.iter().flat_map(cuts).collect();
    all.sort_unstable();
    assert!(all.len() > 20 && all.chunks(2).all(|pair| pair[0] == pair[1]), "each is of two parts");
    assert!(all.windows(3).all(|edges| edges[0] != edges[2]));
}

#[test]
fn an_island_that_is_cut_stays_an_island() {
    let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    let domain = plate(&[&square, &[[1.0, 1.5], [3.0, 1.5], [3.0, 2.5], [1.0, 2.5]]]);
    for parts in [2, 3] {
        let (meshed, _) = made(&domain, &Uniform(Tensor::IDENTITY), parts, &options(3000)).unwrap();
        demand_whole(&domain, &meshed, 3000);
    }
}

/// A square of two regions with a required edge between them, and a crack.
fn regions() -> Pslg {
    let points = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (0.0, 1.0), (1.0, 0.4), (1.0, 0.6)];
    let corners = vec![[0, 1, 6], [0, 6, 7], [0, 7, 5], [7, 4, 5], [1, 2, 6], [2, 3, 6], [3, 7, 6], [3, 4, 7]];
    let mesh = Mesh {
        points: points.map(|(x, y)| [x, y, 0.0]).to_vec(),
        triangle_labels: vec![1, 1, 1, 1, 2, 2, 2, 2],
        triangles: corners,
        edges: vec![[1, 6], [6, 7], [7, 4], [0, 1], [1, 2]],
        edge_labels: vec![7, 8, 7, 3, 3],
        required_edges: vec![1],
        ..Mesh::default()
    };
    from_mesh(&mesh).unwrap()
}

#[test]
fn labels_along_a_cut_are_kept() {
    let domain = Domain::new(&regions()).unwrap();
    let (meshed, rounds) = made(&domain, &Uniform(Tensor::IDENTITY), 2, &options(2500)).unwrap();
    demand_whole(&domain, &meshed, 2500);
    let on_label = |part: &Part| part.domain.edge_labels.iter().filter(|&&label| label == 7).count();
    assert!(rounds[0].1.iter().map(on_label).max() > Some(4), "the domain is cut along its middle");
    let mesh = &meshed.mesh;
    let area = |label| -> f64 {
        let of = mesh.triangles.iter().zip(&mesh.triangle_labels).filter(|(_, it)| **it == label);
        of.map(|(&corners, _)| 0.5 * mesh.double_area(corners)).sum()
    };
    assert!((area(1) - 1.0).abs() < 1e-12 && (area(2) - 1.0).abs() < 1e-12);
    let length = |label| -> f64 {
        let of = mesh.edges.iter().zip(&mesh.edge_labels).filter(|(_, it)| **it == label);
        of.map(|(&[a, b], _)| (mesh.point(b) - mesh.point(a)).norm()).sum()
    };
    assert!((length(7) - 0.8).abs() < 1e-12 && (length(8) - 0.2).abs() < 1e-12);
    assert_eq!(mesh.edge_labels.iter().filter(|&&label| label == 8).count(), 1, "the required edge is whole");
}

/// Channels with next to no vertices inside, and a metric in which all of the area is in one corner.
#[test]
fn parts_without_interior_and_parts_of_a_corner() {
    let channel = Domain::shape("rect:0,0,1,4e-4").unwrap();
    let (meshed, _) = made(&channel, &Uniform(Tensor::IDENTITY), 2, &options(4000)).unwrap();
    demand_whole(&channel, &meshed, 4000);
    let square = Domain::shape("rect:0,0,1,1").unwrap();
    let corner = |p: Point| Tensor::isotropic(1.0 / (1e-3 + p.x + p.y).powi(2));
    let (meshed, _) = made(&square, &corner, 3, &options(4000)).unwrap();
    demand_whole(&square, &meshed, 4000);
}

/// Two triangles that touch in a point: the cut may go through it.
#[test]
fn a_domain_that_touches_itself_in_a_point_is_cut() {
    let points = [(0.0, 0.0), (1.0, 1.0), (0.0, 2.0), (2.0, 2.0), (2.0, 0.0)].map(|(x, y)| [x, y, 0.0]).to_vec();
    let mesh = Mesh { points, triangles: vec![[0, 1, 2], [1, 4, 3]], ..Mesh::default() };
    let domain = Domain::new(&from_mesh(&mesh).unwrap()).unwrap();
    let (meshed, _) = made(&domain, &Uniform(Tensor::IDENTITY), 2, &options(2500)).unwrap();
    demand_whole(&domain, &meshed, 2500);
}

#[test]
fn what_is_of_the_whole_is_refused_by_name() {
    let (domain, field) = (Domain::shape("rect:0,0,1,1").unwrap(), Uniform(Tensor::IDENTITY));
    let message = |parts, options: &MeshOptions| made(&domain, &field, parts, options).unwrap_err();
    let of = options(4000);
    for (options, expected) in [
        (MeshOptions { net: true, ..of.clone() }, "the net of a mesh in parts"),
        (MeshOptions { periodic: vec![[1, 2]], ..of.clone() }, "periodic boundaries of a mesh in parts"),
        (MeshOptions { mesher: Mesher::StarSet, ..of.clone() }, "star sets of a mesh in parts"),
        (MeshOptions { seeding: Seeding::Farthest, ..of.clone() }, "seeding other than by sizes of a mesh in parts"),
    ] {
        assert!(message(2, &options).to_string().contains(expected), "{}", message(2, &options));
    }
    assert!(message(5, &of).to_string().contains("4000 vertices in 5 parts"));
}

#[test]
fn a_metric_that_is_none_in_one_part_is_an_error_with_the_place() {
    let domain = Domain::shape("rect:0,0,1,1").unwrap();
    let field = |p: Point| if p.x > 0.9 && p.y > 0.9 { Tensor::isotropic(f64::NAN) } else { Tensor::IDENTITY };
    let error = made(&domain, &field, 2, &options(4000)).unwrap_err();
    assert!(matches!(error, Error::Metric { .. }) && error.to_string().contains("(0.9"), "{error}");
}

/// What fails in a part ends the work.
#[test]
fn a_part_that_fails_is_the_error() {
    let (domain, field) = (Domain::shape("rect:0,0,1,1").unwrap(), Uniform(Tensor::IDENTITY));
    let mut make =
        |round: &'static str, _: &[Part], _: &mut dyn FnMut(Mesh)| Err(Error::limit(format!("{round} 1"), "try again"));
    let error = mesh_in_parts(&domain, &field, None, Some(2), &options(4000), &mut make, &Silent).unwrap_err();
    assert_eq!(error.to_string(), "limit exceeded: parts 1");
}

/// A metric that is interpolated in a mesh goes to parts as far as they need it, and no other is asked for.
#[test]
fn parts_come_with_their_own_metric() {
    let (domain, shock) = (Domain::shape("rect:-1,-1,1,1").unwrap(), Shock { phi: 1.0, lambda: 0.6 });
    let background = mesh(&domain, &shock, &options(8000), &Silent).unwrap().mesh;
    let tensors: Vec<Tensor> =
        (0..background.points.len() as u32).map(|v| MetricField::at(&shock, background.point(v))).collect();
    let field = Sampled::new(&background, &tensors).unwrap();
    let nowhere = |_: Point| -> Tensor { panic!("the metric as a whole was asked for") };
    let mut largest = 0;
    let mut make = |round, parts: &[Part], take: &mut dyn FnMut(Mesh)| {
        let sizes = parts.iter().map(|part| part.metric.as_ref().map_or(usize::MAX, |metric| metric.1.len()));
        // Strips are long, and of few vertices much of the whole.
        largest = sizes.filter(|_| round == "parts").fold(largest, usize::max);
        parts.iter().try_for_each(|part| mesh_part(part, &nowhere, None, &options(4000), &Silent).map(&mut *take))
    };
    let meshed = mesh_in_parts(&domain, &field, None, Some(4), &options(4000), &mut make, &Silent).unwrap();
    demand_whole(&domain, &meshed, 4000);
    assert!(largest < 4000, "{largest} of 8,000");
    let by_shock = |p: Point| MetricField::at(&shock, p) * meshed.metric_scale;
    assert!(metric_quality(&meshed.mesh, &by_shock).unwrap().metric_edge_length.unit_fraction > 0.97);
}
