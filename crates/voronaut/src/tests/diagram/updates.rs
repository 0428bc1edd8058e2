//! Local insertion, removal and moves against recomputation, and the work they take.

use super::common::{halton, square, vertices};
use crate::canvas::Canvas;
use crate::diagram::{Care, Diagram};
use crate::geodesic::Method;
use crate::geometry::{Point, Tensor};
use crate::manifold::domain::Domain;
use crate::metric::{MetricField, Shock, Swirl, Uniform};
use crate::progress::Silent;
use crate::recipe::{MeshOptions, mesh};
use crate::test_cases::plate;
use crate::triangulation::VertexId;

fn assert_as_made_anew(diagram: &Diagram, field: &dyn MetricField) {
    let canvas = diagram.canvas();
    // Removed seeds leave gaps in the numbering: the new diagram counts without them, in the same order.
    let kept: Vec<u32> = (0..diagram.colours() as u32).filter(|&c| diagram.seed(c).is_some()).collect();
    let seeds: Vec<Point> = kept.iter().filter_map(|&c| diagram.seed(c)).collect();
    let anew = Diagram::new(canvas, field, &seeds).unwrap();
    for v in vertices(canvas) {
        let colour = anew.colour(v).map(|c| kept[c as usize]);
        assert_eq!((diagram.colour(v), diagram.parent(v)), (colour, anew.parent(v)), "{v:?}");
        assert_eq!(diagram.distance(v).to_bits(), anew.distance(v).to_bits(), "{v:?}");
    }
}

#[test]
fn local_changes_equal_recomputation_to_the_last_bit() {
    let domain = square(2.0);
    for field in [&Swirl::default() as &dyn MetricField, &Shock::default()] {
        let canvas = Canvas::intrinsic(domain.planar(), field, 20_000).unwrap();
        let point = |i: u32| {
            let (x, y) = halton(i);
            Point::new(4.0 * x - 2.0, 4.0 * y - 2.0)
        };
        let seeds: Vec<Point> = (1..400).map(point).collect();
        let mut diagram = Diagram::new(&canvas, field, &seeds).unwrap();
        let before = diagram.counters().settled;
        for i in 0..600_u32 {
            let colour = (i * 7919) % diagram.colours() as u32;
            match i % 3 {
                0 => _ = diagram.insert(point(1000 + i)).unwrap(),
                1 => _ = diagram.remove(colour),
                _ if diagram.seed(colour).is_some() => diagram.move_to(colour, point(3000 + i)).unwrap(),
                _ => _ = diagram.insert_at_vertex(VertexId(colour * 17)),
            }
            if i % 100 == 99 {
                assert_as_made_anew(&diagram, field);
            }
        }
        let work = (diagram.counters().settled - before) as f64 / 600.0;
        println!("{work} vertices settled in a change, {:?}", diagram.counters());
        assert!(work < 1000.0, "local: {work} of 20,000 vertices");
        assert!(diagram.orphans().is_empty());
    }
}

#[test]
fn removing_all_seeds_leaves_nothing() {
    let domain = square(1.0);
    let field = Uniform::default();
    let canvas = Canvas::intrinsic(domain.planar(), &field, 500).unwrap();
    let mut diagram = Diagram::new(&canvas, &field, &[]).unwrap();
    assert!(vertices(&canvas).all(|v| diagram.colour(v).is_none() && diagram.distance(v).is_infinite()));
    let a = diagram.insert(Point::new(0.1, 0.2)).unwrap();
    let twin = diagram.insert(Point::new(0.1, 0.2)).unwrap();
    assert!(vertices(&canvas).all(|v| diagram.colour(v) == Some(a)), "of equal seeds the first");
    assert!(diagram.remove(a) && !diagram.remove(a) && !diagram.remove(99));
    assert!(vertices(&canvas).all(|v| diagram.colour(v) == Some(twin)));
    assert!(diagram.move_to(a, Point::new(0.0, 0.0)).is_err() && diagram.move_to(twin, Point::new(9.0, 0.0)).is_err());
    assert!(diagram.remove(twin));
    assert!(vertices(&canvas).all(|v| diagram.colour(v).is_none() && diagram.parent(v).is_none()));
    assert_eq!(diagram.sharp_nerve().triangles.len(), 0);
    for bad in [Point::new(1.5, 0.0), Point::new(f64::NAN, 0.0), Point::new(f64::INFINITY, 0.0)] {
        assert!(diagram.insert(bad).is_err());
    }
}

/// Seeds as meshes have them: the boundary at unit length, the interior by the metric.
fn sized_seeds(domain: &Domain, field: &dyn MetricField, vertices: usize) -> Vec<Point> {
    let options = MeshOptions { vertices: Some(vertices), lloyd: 0, ..MeshOptions::default() };
    mesh(domain, field, &options, &Silent).unwrap().mesh.points.iter().map(|p| Point::new(p[0], p[1])).collect()
}

#[test]
fn two_thousand_seeds_leave_no_orphans_and_change_as_if_made_anew() {
    for (field, half) in [(&Swirl::default() as &dyn MetricField, 2.0), (&Shock::default(), 1.0)] {
        let domain = square(half);
        let seeds = sized_seeds(&domain, field, 2000);
        let canvas = Canvas::intrinsic(domain.planar(), field, 25 * seeds.len()).unwrap();
        let mut diagram = Diagram::new(&canvas, field, &seeds).unwrap();
        assert_eq!((seeds.len(), diagram.orphans().len()), (2000, 0));
        let point = |i: u32| Point::new(half * (2.0 * halton(i).0 - 1.0), half * (2.0 * halton(i).1 - 1.0));
        for i in 0..100_u32 {
            diagram.insert(point(1 + i)).unwrap();
            diagram.remove(i * 19 + 3);
            diagram.move_to(i * 19 + 7, point(3000 + i)).unwrap();
        }
        assert_as_made_anew(&diagram, field);
        assert_eq!(diagram.orphans().len(), 0);
    }
}

#[test]
fn work_is_linear_in_the_canvas() {
    let domain = square(2.0);
    let field = Swirl::default();
    let per_vertex = [1000, 4000, 10_000].map(|seeds: u32| {
        let canvas = Canvas::intrinsic(domain.planar(), &field, 6 * seeds as usize).unwrap();
        let at = |i| Point::new(4.0 * halton(i).0 - 2.0, 4.0 * halton(i).1 - 2.0);
        let points: Vec<Point> = (1..=seeds).map(at).collect();
        let diagram = Diagram::new(&canvas, &field, &points).unwrap();
        let counters = *diagram.counters();
        assert_eq!((counters.settled, counters.withdrawn), (canvas.vertex_count() as u64, 0), "each vertex once");
        (counters.crossings + canvas.counters().planar_flips + canvas.counters().flips) as f64 / f64::from(seeds)
    });
    println!("{per_vertex:?}");
    assert!(per_vertex[2] < 1.2 * per_vertex[0], "{per_vertex:?}");
}

#[test]
fn removal_leaves_nothing_where_edges_lead_around_a_hole_and_back() {
    let square = |half: f64| [[-half, -half], [half, -half], [half, half], [-half, half]];
    let domain = plate(&[&square(1.0), &square(0.02)]);
    let mut loops = 0;
    for i in 0..40_u32 {
        let (angle, aspect) = (0.2 * f64::from(i), 3.0 + f64::from(i % 40));
        let field = move |p: Point| {
            let (s, c) = (angle + 3.0 * (p.x + p.y)).sin_cos();
            let k = aspect * aspect;
            Tensor::new(c * c + k * s * s, c * s * (1.0 - k), s * s + k * c * c)
        };
        let canvas = Canvas::intrinsic(domain.planar(), &field, 12 + (i % 30) as usize).unwrap();
        let topology = canvas.topology();
        loops += topology.edges().filter(|&h| topology.origin(h) == topology.target(h)).count();
        let mut diagram = Diagram::new(&canvas, &field, &[Point::new(0.9, 0.9)]).unwrap();
        for v in vertices(&canvas) {
            let colour = diagram.insert_at_vertex(v);
            diagram.remove(colour);
            assert!(vertices(&canvas).all(|v| diagram.colour(v) == Some(0)), "{i}");
        }
    }
    println!("{loops} loops");
    assert!(loops > 0);
}

#[test]
fn a_seed_where_holes_touch_belongs_to_both_sides() {
    // Two holes from wall to wall but for the point in which they touch.
    let domain = plate(&[
        &[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]],
        &[[1.0, 2.0], [1.5, 1.5], [2.0, 2.0], [1.5, 2.5]],
        &[[2.0, 2.0], [2.5, 1.5], [3.0, 2.0], [2.5, 2.5]],
    ]);
    let field = Uniform::default();
    let canvas = Canvas::intrinsic(domain.planar(), &field, 4000).unwrap();
    let touching = Point::new(2.0, 2.0);
    let far = |diagram: &Diagram, p: Point| {
        vertices(&canvas)
            .filter(|&v| canvas.position(v).distance(p) < 0.3)
            .map(|v| diagram.distance(v))
            .fold(0.0, f64::max)
    };
    let sides = [Point::new(2.0, 2.3), Point::new(2.0, 1.7)];
    let mut diagram = Diagram::new(&canvas, &field, &[touching]).unwrap();
    assert!(sides.iter().all(|&p| far(&diagram, p) < 0.61), "straight to both sides");
    diagram.remove(0);
    diagram.insert(touching).unwrap();
    assert!(sides.iter().all(|&p| far(&diagram, p) < 0.61));
    // As vertices of a mesh the two copies have a side each.
    let diagram = Diagram::of_vertices(&canvas, &field, &[touching, touching], Method::March, Care::Full).unwrap();
    let sizes = diagram.cell_sizes();
    assert!(sizes.iter().all(|&size| size > 1500), "{sizes:?}");
}
