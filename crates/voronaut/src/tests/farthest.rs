//! Farthest-point refinement: the heap against a scan, the count, holes in the way, work.

use crate::Error;
use crate::canvas::Canvas;
use crate::diagram::Diagram;
use crate::dual::{Dual, Moving};
use crate::geometry::{Point, Tensor};
use crate::manifold::domain::{Domain, Poly, from_poly};
use crate::metric::{MetricField, Scaled, Shock, Swirl, Uniform};
use crate::progress::Silent;
use crate::quality::metric_quality;
use crate::recipe::{self, MeshOptions, Meshed, Seeding};
use crate::sampling::{Farthest, Fill, Plan, Target, refine_farthest, sample_segments};
use crate::triangulation::VertexId;

fn meshed(domain: &Domain, field: &dyn MetricField, vertices: usize, more: &MeshOptions) -> Meshed {
    let options = MeshOptions { vertices: Some(vertices), seeding: Seeding::Farthest, ..more.clone() };
    recipe::mesh(domain, field, &options, &Silent).unwrap()
}

#[test]
fn the_heap_gives_what_a_scan_gives() {
    let domain = Domain::shape("rect:-1,-1,1,1").unwrap();
    let field = Swirl::default();
    let canvas = Canvas::intrinsic(domain.planar(), &field, 3000).unwrap();
    let mut diagram = Diagram::new(&canvas, &field, &[Point::new(0.1, 0.2)]).unwrap();
    let mut farthest = Farthest::new(&diagram, |_| true);
    for _ in 0..200 {
        let (v, distance) = farthest.pop(&diagram).unwrap();
        let (_, truth) = diagram.farthest().unwrap();
        assert!(distance <= truth && distance > 0.99 * truth, "{distance} {truth}");
        diagram.insert_at_vertex(v);
    }
}

#[test]
fn seeds_are_as_far_apart_as_any_point_is_from_them() {
    let domain = Domain::shape("rect:0,0,1,1").unwrap();
    let field = Uniform::default();
    let options = MeshOptions { lloyd: 0, ..MeshOptions::default() };
    let meshed = meshed(&domain, &field, 600, &options);
    assert_eq!(meshed.mesh.points.len(), 600);
    let unit = |p: Point| field.at(p) * meshed.metric_scale;
    let figures = metric_quality(&meshed.mesh, &unit).unwrap();
    // Covering radius R, spacing R: Delaunay triangles have edges from R to 2 R and angles of at least 30 degrees.
    let lengths = figures.metric_edge_length;
    assert!(lengths.unit_fraction > 0.97 && lengths.max < 2.1 * lengths.min, "{lengths:?}");
    assert!(figures.angle.min > 28.0, "{:?}", figures.angle);
    assert!(meshed.canvas.unwrap().vertices >= 60_000);
    assert_eq!(meshed.diagram.unwrap().orphans, 0);
}

/// Two holes that share a corner, and an inner segment.
fn touching_holes() -> Domain {
    let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
    let left = [(1.0, 2.0), (1.5, 1.5), (2.0, 2.0), (1.5, 2.5)];
    let right = [(2.5, 1.5), (3.0, 2.0), (2.5, 2.5), (0.5, 0.5), (3.5, 0.7)];
    let points = [&corners[..], &left, &right].concat().into_iter().map(|(x, y)| Point::new(x, y)).collect();
    let ring = |ids: [u32; 4]| [[ids[0], ids[1]], [ids[1], ids[2]], [ids[2], ids[3]], [ids[3], ids[0]]];
    let mut segments = [ring([0, 1, 2, 3]), ring([4, 5, 6, 7]), ring([6, 8, 9, 10])].concat();
    segments.push([11, 12]);
    let holes = vec![Point::new(1.5, 2.0), Point::new(2.5, 2.0)];
    let none = |count: usize| vec![0; count];
    let (point_markers, segment_markers) = (none(13), none(segments.len()));
    let poly = Poly { points, point_markers, first: 1, segments, segment_markers, holes, regions: Vec::new() };
    Domain::new(&from_poly(&poly).unwrap()).unwrap()
}

#[test]
fn the_count_is_met_on_any_canvas_and_domain() {
    let holes = touching_holes();
    let disk = Domain::shape("disk:0.3,0.1,1").unwrap();
    for (domain, canvas_size) in [(&holes, 1), (&holes, 60), (&disk, 20)] {
        for field in [&Swirl::default() as &dyn MetricField, &Shock { phi: 10.0, lambda: 0.06 }] {
            let options = MeshOptions { canvas_size, lloyd: 3, ..MeshOptions::default() };
            assert_eq!(meshed(domain, field, 400, &options).mesh.points.len(), 400);
        }
    }
}

#[test]
fn more_seeds_than_canvas_vertices_are_found_otherwise() {
    let domain = Domain::shape("rect:0,0,1,1").unwrap();
    let options = MeshOptions { canvas_size: 1, lloyd: 0, ..MeshOptions::default() };
    assert_eq!(meshed(&domain, &Uniform::default(), 30_000, &options).mesh.points.len(), 30_000);
}

#[test]
fn metrics_used_as_they_are_decide_the_count() {
    let domain = Domain::shape("rect:0,0,1,1").unwrap();
    let options = MeshOptions { seeding: Seeding::Farthest, ..MeshOptions::default() };
    let field = |_: Point| Tensor::isotropic(0.05);
    let found = recipe::mesh(&domain, &field, &options, &Silent).unwrap().mesh.points.len();
    // 2 / sqrt(3) seeds per unit area.
    assert!((430..560).contains(&found), "{found}");
}

#[test]
fn a_canvas_beyond_the_memory_limit_is_refused() {
    let domain = Domain::shape("rect:0,0,1,1").unwrap();
    let options = MeshOptions { vertices: Some(100_000), memory_limit: 1 << 30, ..MeshOptions::default() };
    let with = |seeding| MeshOptions { seeding, lloyd: 0, ..options.clone() };
    let refused = recipe::mesh(&domain, &Uniform::default(), &with(Seeding::Farthest), &Silent);
    assert!(matches!(&refused, Err(error @ Error::Limit { .. }) if error.help().contains("`canvas_size`")));
    assert!("protected".parse::<Seeding>().is_ok() && "nearest".parse::<Seeding>().is_err());
    assert_eq!("farthest".parse::<Seeding>().unwrap().to_string(), "farthest");
}

#[test]
fn work_grows_no_faster_than_n_log_n() {
    let domain = Domain::shape("rect:-2,-2,2,2").unwrap();
    let field = Swirl::default();
    let work = |seeds: usize| {
        let plan = Plan::new(domain.clone(), Vec::new(), &field, Target::Vertices(seeds)).unwrap();
        let (count, factor) = plan.start(Target::Vertices(seeds), u64::MAX).unwrap();
        let canvas = Canvas::intrinsic(domain.planar(), &field, 10 * seeds).unwrap();
        let mut dual = Dual::new(domain.corners(), Scaled { field: &field, factor }).unwrap();
        sample_segments(&mut dual, &plan.edges, &plan.arcs, factor, 0);
        let border: Vec<Point> = dual.topology().vertices().map(|v| dual.position(v)).collect();
        let mut diagram = Diagram::new(&canvas, &field, &border).unwrap();
        refine_farthest(&mut dual, &mut diagram, Fill::Exactly(count), &Silent).unwrap();
        assert_eq!(dual.vertex_count(), seeds);
        let (march, canvas) = (diagram.counters(), canvas.counters());
        let diagram = march.settled + march.crossings + march.reconsidered;
        (diagram + canvas.splits + canvas.planar_flips + canvas.flips) as f64
    };
    let per_seed = [1000, 4000, 12_000].map(|seeds: usize| work(seeds) / (seeds as f64 * (seeds as f64).ln()));
    println!("work / (N ln N): {per_seed:?}");
    // Of few seeds more are on the border, which the diagram starts with.
    assert!(per_seed[1] < 1.08 * per_seed[0] && per_seed[2] < 1.04 * per_seed[1], "{per_seed:?}");
}

#[test]
fn no_seed_is_reached_by_no_front() {
    let domain = Domain::shape("rect:0,0,1,1").unwrap();
    let field = Uniform::default();
    let canvas = Canvas::intrinsic(domain.planar(), &field, 50).unwrap();
    let diagram = Diagram::new(&canvas, &field, &[]).unwrap();
    assert_eq!(Farthest::new(&diagram, |_| true).pop(&diagram), Some((VertexId(0), f64::INFINITY)));
    assert_eq!(Farthest::new(&diagram, |_| false).pop(&diagram), None);
}

#[test]
fn flat_faces_of_a_canvas_are_not_split_down_to_where_numbers_end() {
    // At the wall on the left edges were halved until their lengths vanished.
    let canvas = Canvas::intrinsic(touching_holes().planar(), &Shock { phi: 10.0, lambda: 0.06 }, 70_000).unwrap();
    let least = canvas.embedded().positions.iter().map(|p| p.x).filter(|&x| x > 0.0).fold(1.0, f64::min);
    assert!(least > 1e-20, "{least}");
}
