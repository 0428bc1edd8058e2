//! Canvas, marching and diagram against truths: closed forms, affine Voronoi diagrams, paths around corners, recomputation.

use std::collections::BTreeSet;
use voronaut::canvas::Canvas;
use voronaut::diagram::Diagram;
use voronaut::domain::{Domain, Filling, Pslg, Segment, Side, rect};
use voronaut::geodesic::{Geodesic, Marching, Sources, Wave};
use voronaut::geometry::{Orientation, Point, Tensor, Vector, orientation};
use voronaut::metric::{MetricField, Shock, Swirl, Uniform};
use voronaut::planar::delaunay;
use voronaut::triangulation::VertexId;

/// A quasi-random sequence in the unit square (Halton, bases 2 and 3, a little shaken).
fn halton(i: u32) -> (f64, f64) {
    let radical = |mut i: u32, base: u32| {
        let (mut place, mut sum) = (1.0, 0.0);
        while i > 0 {
            place /= f64::from(base);
            sum += place * f64::from(i % base);
            i /= base;
        }
        sum
    };
    let shake = |x: f64| 1e-4 * (f64::from(i) * x).sin();
    ((radical(i, 2) + shake(1.7)).clamp(0.001, 0.999), (radical(i, 3) + shake(2.3)).clamp(0.001, 0.999))
}

fn square(half: f64) -> Domain {
    Domain::new(&rect(Point::new(-half, -half), Point::new(half, half)).unwrap()).unwrap()
}

/// Seeds in the square [-half, half]^2, no two images closer than `spacing`.
fn spaced(half: f64, tries: u32, spacing: f64, image: &dyn Fn(Point) -> Point) -> Vec<Point> {
    let mut seeds: Vec<Point> = Vec::new();
    for (x, y) in (1..tries).map(halton) {
        let p = Point::new(half * (2.0 * x - 1.0), half * (2.0 * y - 1.0));
        if seeds.iter().all(|&q| image(p).distance(image(q)) > spacing) {
            seeds.push(p);
        }
    }
    seeds
}

fn vertices(canvas: &Canvas) -> impl Iterator<Item = VertexId> {
    (0..canvas.vertex_count() as u32).map(VertexId)
}

fn longest_edge(canvas: &Canvas) -> f64 {
    let t = canvas.topology();
    t.edges().map(|h| t.length(h)).fold(0.0, f64::max)
}

/// A space that is flat: the metric is the pull-back of the Euclidean one by a map of the plane.
struct Flat {
    map: fn(Point) -> Point,
    inverse: fn(Point) -> Point,
    metric: fn(Point) -> Tensor,
}

const AFFINE: Flat = Flat {
    map: |p| Point::new(5.0 * p.x + 0.6 * p.y, 0.8 * p.y),
    inverse: |p| Point::new((p.x - 0.75 * p.y) / 5.0, p.y / 0.8),
    metric: |_| Tensor::new(25.0, 3.0, 1.0),
};

/// (x / 10, y + sin(pi x) / 4): cells ten times as long as wide that turn by up to 76 degrees.
const WAVES: Flat = Flat {
    map: |p| Point::new(0.1 * p.x, p.y + 0.25 * (std::f64::consts::PI * p.x).sin()),
    inverse: |p| Point::new(10.0 * p.x, p.y - 0.25 * (std::f64::consts::PI * 10.0 * p.x).sin()),
    metric: |p| {
        let a = 0.25 * std::f64::consts::PI * (std::f64::consts::PI * p.x).cos();
        Tensor::new(0.01 + a * a, a, 1.0)
    },
};

fn sorted(mut t: [u32; 3]) -> [u32; 3] {
    t.sort_unstable();
    t
}

/// Delaunay triangles of the seeds' images whose circumcircle lies in the image of the square [-half, half]^2; and
/// whether a triple has such a circle.
fn truth(flat: &Flat, seeds: &[Point], half: f64) -> (BTreeSet<[u32; 3]>, impl Fn([u32; 3]) -> bool) {
    let images: Vec<Point> = seeds.iter().map(|&p| (flat.map)(p)).collect();
    let exact = delaunay(&images).unwrap();
    let inverse = flat.inverse;
    let is_inside = move |t: [u32; 3]| {
        if t.iter().any(|&v| v as usize >= images.len()) {
            return false;
        }
        let [a, b, c] = t.map(|v| images[v as usize]);
        let (u, v) = (b - a, c - a);
        let x = Vector::new(u.dot(u) * v.y - v.dot(v) * u.y, v.dot(v) * u.x - u.dot(u) * v.x) * (0.5 / u.cross(v));
        (0..96).all(|i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 96.0).sin_cos();
            let q = inverse(a + x + Vector::new(cos, sin) * x.norm());
            q.x.abs() < 0.99 * half && q.y.abs() < 0.99 * half
        })
    };
    let corners = exact.topology.faces().map(|f| exact.topology.corners(f).map(|v| v.0));
    (corners.filter(|&t| is_inside(t)).map(sorted).collect(), is_inside)
}

#[test]
fn uniform_metrics_give_affine_voronoi_cells() {
    let domain = square(2.0);
    let seeds = spaced(2.0, 3000, 0.38, &AFFINE.map);
    let canvas = Canvas::intrinsic(&domain, &AFFINE.metric, 87 * seeds.len()).unwrap();
    let diagram = Diagram::new(&canvas, &AFFINE.metric, &seeds).unwrap();
    assert!(diagram.orphans().is_empty());
    let size = longest_edge(&canvas);
    let mut settled = 0;
    for v in vertices(&canvas) {
        let p = (AFFINE.map)(canvas.position(v));
        let mut distances: Vec<(f64, u32)> =
            seeds.iter().enumerate().map(|(i, &q)| ((AFFINE.map)(q).distance(p), i as u32)).collect();
        distances.sort_by(|a, b| a.0.total_cmp(&b.0));
        // A point's distance from a bisector is at least half the difference of its distances to the seeds.
        if distances[1].0 - distances[0].0 > 2.0 * size {
            assert_eq!(diagram.colour(v), Some(distances[0].1), "at {}", canvas.position(v));
            settled += 1;
        }
    }
    assert!(settled > canvas.vertex_count() / 4, "{settled} of {}", canvas.vertex_count());
}

#[test]
fn the_nerve_of_a_uniform_metric_is_exactly_delaunay() {
    let domain = square(2.0);
    let seeds = spaced(2.0, 6000, 0.25, &AFFINE.map);
    let (truth, is_inside) = truth(&AFFINE, &seeds, 2.0);
    assert!(seeds.len() > 150 && truth.len() > 200, "{} {}", seeds.len(), truth.len());
    for per_seed in [15, 60] {
        let canvas = Canvas::intrinsic(&domain, &AFFINE.metric, per_seed * seeds.len()).unwrap();
        let diagram = Diagram::new(&canvas, &AFFINE.metric, &seeds).unwrap();
        let nerve = diagram.sharp_nerve();
        let found: BTreeSet<[u32; 3]> = nerve.triangles.iter().map(|t| sorted(t.colours)).collect();
        assert_eq!(truth.difference(&found).count(), 0);
        assert!(found.iter().all(|&t| !is_inside(t) || truth.contains(&t)));
        for t in &nerve.triangles {
            let [a, b, c] = t.colours.map(|i| (AFFINE.map)(seeds[i as usize]));
            assert!(!is_inside(t.colours) || orientation(a, b, c) == Orientation::Left, "turned as the seeds are");
        }
    }
}

#[test]
fn the_nerve_of_a_turning_metric_converges_to_delaunay() {
    let domain = square(2.0);
    let seeds = spaced(2.0, 12_000, 0.045, &WAVES.map);
    let (truth, is_inside) = truth(&WAVES, &seeds, 2.0);
    let wrong = |per_seed: usize| {
        let canvas = Canvas::intrinsic(&domain, &WAVES.metric, per_seed * seeds.len()).unwrap();
        let nerve = Diagram::new(&canvas, &WAVES.metric, &seeds).unwrap().sharp_nerve();
        let found: BTreeSet<[u32; 3]> = nerve.triangles.iter().map(|t| sorted(t.colours)).collect();
        let extra = found.iter().filter(|&&t| is_inside(t) && !truth.contains(&t)).count();
        (truth.difference(&found).count() + extra) as f64 / truth.len() as f64
    };
    let [coarse, fine] = [20, 100].map(wrong);
    println!("{} seeds, {} triangles: wrong {coarse:.4} and {fine:.4}", seeds.len(), truth.len());
    assert!(coarse < 0.03 && fine < 0.003, "{coarse} {fine}");
}

/// Mean relative error of the distances from a point, away from it and from the border.
fn error(
    canvas: &Canvas,
    field: &dyn MetricField,
    wave: Wave,
    from: Point,
    exact: &dyn Fn(Point) -> Option<f64>,
) -> f64 {
    let diagram = Diagram::with_solver(canvas, field, &[from], Marching { wave }).unwrap();
    let errors: Vec<f64> = vertices(canvas)
        .filter_map(|v| exact(canvas.position(v)).map(|truth| (diagram.distance(v) / truth - 1.0).abs()))
        .collect();
    errors.iter().sum::<f64>() / errors.len() as f64
}

#[test]
fn distances_converge_in_flat_space() {
    let domain = square(1.0);
    let from = Point::new(0.1, -0.2);
    let exact = |p: Point| {
        let truth = (WAVES.map)(p).distance((WAVES.map)(from));
        // Straight paths in the image stay in the domain if they pass clear of its border.
        (p.x.abs() < 0.7 && p.y.abs() < 0.45 && truth > 0.1).then_some(truth)
    };
    for (wave, best, order) in [(Wave::Circular, 5e-4, 0.9), (Wave::Plane, 1e-2, 0.3)] {
        let errors = [1000, 4000, 16_000].map(|n| {
            let canvas = Canvas::intrinsic(&domain, &WAVES.metric, n).unwrap();
            error(&canvas, &WAVES.metric, wave, from, &exact)
        });
        println!("{wave:?}: {errors:?}");
        assert!((errors[0] / errors[2]).log2() / 2.0 > order && errors[2] < best, "{wave:?} {errors:?}");
    }
}

#[test]
fn distances_converge_in_the_half_plane() {
    let domain = Domain::new(&rect(Point::new(-2.0, 0.5), Point::new(2.0, 3.0)).unwrap()).unwrap();
    let half_plane = |p: Point| Tensor::isotropic(p.y);
    let from = Point::new(0.2, 1.3);
    let exact = |p: Point| {
        let d2 = (p - from).dot(p - from);
        let inside = p.x.abs() < 1.2 && p.y > 0.7 && p.y < 2.2 && d2 > 0.04;
        inside.then(|| (1.0 + d2 / (2.0 * p.y * from.y)).acosh())
    };
    for (wave, best, order) in [(Wave::Circular, 5e-4, 0.9), (Wave::Plane, 1.5e-2, 0.3)] {
        let errors = [1000, 4000, 16_000].map(|n| {
            let canvas = Canvas::intrinsic(&domain, &half_plane, n).unwrap();
            error(&canvas, &half_plane, wave, from, &exact)
        });
        println!("{wave:?}: {errors:?}");
        assert!((errors[0] / errors[2]).log2() / 2.0 > order && errors[2] < best, "{wave:?} {errors:?}");
    }
}

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
        let canvas = Canvas::intrinsic(&domain, field, 20_000).unwrap();
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
    let canvas = Canvas::intrinsic(&domain, &field, 500).unwrap();
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

/// A rectangle with two holes that leave a passage of 0.02 between them.
fn passage() -> (Domain, Vec<Vec<Point>>) {
    let corners = |x0: f64, y0: f64, x1: f64, y1: f64| -> Vec<Point> {
        [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| Point::new(x, y)).to_vec()
    };
    let outlines = vec![corners(0.0, 0.0, 4.0, 2.0), corners(1.9, 0.0625, 2.1, 1.0), corners(1.9, 1.02, 2.1, 1.9375)];
    let mut pslg: Pslg = rect(Point::new(0.0, 0.0), Point::new(1.0, 1.0)).unwrap();
    (pslg.points, pslg.segments) = (Vec::new(), Vec::new());
    for outline in &outlines {
        let first = pslg.points.len() as u32;
        pslg.points.extend(outline);
        pslg.segments.extend((0..4).map(|i| Segment {
            ends: [first + i, first + (i + 1) % 4],
            label: 1,
            required: false,
            left: Side::Unknown,
            right: Side::Unknown,
        }));
    }
    pslg.point_labels = vec![0; pslg.points.len()];
    pslg.filling = Filling::EvenOdd;
    (Domain::new(&pslg).unwrap(), outlines[1..].to_vec())
}

/// Whether the straight way between two points crosses no hole (convex quadrilaterals).
fn is_free(a: Point, b: Point, holes: &[Vec<Point>]) -> bool {
    let inside = |p: Point, hole: &[Point]| {
        (0..4).all(|i| {
            let (u, v) = (hole[i], hole[(i + 1) % 4]);
            (v - u).cross(p - u) > 1e-12
        })
    };
    holes.iter().all(|hole| (1..400).all(|i| !inside(a.lerp(b, f64::from(i) / 400.0), hole)))
}

#[test]
fn distances_go_around_holes_and_through_the_passage() {
    let (domain, holes) = passage();
    let from = Point::new(0.7, 0.9);
    for tensor in [Tensor::IDENTITY, Tensor::new(1.0, 0.5, 4.0)] {
        // With a uniform metric shortest paths are straight between the holes' corners: a graph of sight.
        let nodes: Vec<Point> = std::iter::once(from).chain(holes.iter().flatten().copied()).collect();
        let mut to = vec![f64::INFINITY; nodes.len()];
        to[0] = 0.0;
        for _ in 0..nodes.len() {
            for i in 0..nodes.len() {
                for j in 0..nodes.len() {
                    if is_free(nodes[i], nodes[j], &holes) {
                        to[j] = to[j].min(to[i] + tensor.length(nodes[j] - nodes[i]));
                    }
                }
            }
        }
        let field = Uniform(tensor);
        let canvas = Canvas::intrinsic(&domain, &field, 20_000).unwrap();
        let diagram = Diagram::new(&canvas, &field, &[from]).unwrap();
        let mut behind = 0;
        for v in vertices(&canvas).step_by(23) {
            let p = canvas.position(v);
            let ways = nodes.iter().zip(&to).filter(|(n, _)| is_free(**n, p, &holes));
            let exact = ways.map(|(n, d)| d + tensor.length(p - *n)).fold(f64::INFINITY, f64::min);
            assert!((diagram.distance(v) - exact).abs() < 0.01 * exact + 0.01, "{p}: {} {exact}", diagram.distance(v));
            behind += usize::from(!is_free(from, p, &holes));
        }
        assert!(behind > 100, "most of the right half is out of sight");
    }
}

#[test]
fn seeds_are_found_behind_holes() {
    let (domain, holes) = passage();
    let canvas = Canvas::intrinsic(&domain, &Uniform::default(), 3000).unwrap();
    for (x, y) in (1..500).map(halton) {
        let p = Point::new(4.2 * x - 0.1, 2.2 * y - 0.1);
        let inside = p.x >= 0.0 && p.x <= 4.0 && p.y >= 0.0 && p.y <= 2.0;
        let in_hole = holes.iter().any(|h| p.x > h[0].x && p.x < h[2].x && p.y > h[0].y && p.y < h[2].y);
        assert_eq!(canvas.locate(p).is_some(), inside && !in_hole, "{p}");
    }
}

#[test]
fn work_is_linear_in_the_canvas() {
    let domain = square(2.0);
    let field = Swirl::default();
    let per_vertex = [1000, 5000, 20_000].map(|seeds: u32| {
        let canvas = Canvas::intrinsic(&domain, &field, 6 * seeds as usize).unwrap();
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
fn threads_do_not_change_a_bit() {
    let domain = square(2.0);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let field = Shock::default();
            let canvas = Canvas::intrinsic(&domain, &field, 5000).unwrap();
            let seeds: Vec<Point> =
                (1..300).map(|i| Point::new(4.0 * halton(i).0 - 2.0, 4.0 * halton(i).1 - 2.0)).collect();
            let diagram = Diagram::new(&canvas, &field, &seeds).unwrap();
            let distances: Vec<u64> = vertices(&canvas).map(|v| diagram.distance(v).to_bits()).collect();
            (*canvas.counters(), distances, diagram.sharp_nerve())
        })
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn wild_metrics_and_canvases_of_a_few_vertices_are_survived() {
    let domain = square(1.0);
    let jump = |p: Point| if p.x + 0.3 * p.y > 0.1 { Tensor::new(1e6, 0.0, 1.0) } else { Tensor::new(1.0, 0.0, 1e4) };
    let spike = |p: Point| Tensor::isotropic(1e-6 + p.x.hypot(p.y));
    for field in [&jump as &dyn MetricField, &spike] {
        for n in [0, 5, 50, 3000] {
            let canvas = Canvas::intrinsic(&domain, field, n).unwrap();
            canvas.topology().check().unwrap();
            canvas.embedded().topology.check().unwrap();
            assert!(canvas.embedded().is_embedded());
            let seeds: Vec<Point> =
                (1..40).map(|i| Point::new(2.0 * halton(i).0 - 1.0, 2.0 * halton(i).1 - 1.0)).collect();
            let diagram = Diagram::new(&canvas, field, &seeds).unwrap();
            assert!(vertices(&canvas).all(|v| diagram.distance(v).is_finite()));
            let _ = diagram.sharp_nerve();
        }
    }
    let nan = |p: Point| Tensor::new(1.0, 0.0, 1.0 - p.x - p.y);
    assert!(Canvas::intrinsic(&domain, &nan, 100).is_err());
}

#[test]
fn solvers_share_one_interface() {
    let domain = square(1.0);
    let canvas = Canvas::straight(&domain, &Uniform::default(), 400).unwrap();
    let mut sources = Sources::new(canvas.vertex_count());
    sources.add(VertexId(3), 0.5, 8);
    let solver: &dyn Geodesic = &Marching { wave: Wave::Plane };
    let found = solver.propagate(canvas.topology(), &sources);
    assert!(found.labels().iter().all(|l| l.colour == 8 && l.distance >= 0.5));
}
