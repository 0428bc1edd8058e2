//! Star sets as canvases: against affine Delaunay triangulations, on shapes with holes, by laws of scale and threads.

use crate::canvas::{Canvas, Kind, StarSet};
use crate::geometry::{Point, Tensor, in_circle, signed_area};
use crate::manifold::domain::Domain;
use crate::metric::{Shock, Swirl, Uniform};
use crate::test_cases::plate;
use crate::triangulation::VertexId;
use std::collections::BTreeSet;

fn holed() -> Domain {
    plate(&[&[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]], &[[1.0, 0.5], [2.0, 0.5], [2.0, 1.5], [1.0, 1.5]]])
}

fn framed(tensor: Tensor, p: Point) -> Point {
    let [a, b, c] = tensor.cholesky();
    Point::new(a * p.x + b * p.y, c * p.y)
}

fn stars(canvas: &Canvas) -> &StarSet {
    canvas.stars().expect("it is a star set")
}

fn vertices(canvas: &Canvas) -> impl Iterator<Item = VertexId> + use<> {
    (0..canvas.vertex_count() as u32).map(VertexId)
}

/// Twice the area of a simplex of a star.
fn area(canvas: &Canvas, v: VertexId, [a, b]: [VertexId; 2]) -> f64 {
    signed_area(canvas.position(v), canvas.position(a), canvas.position(b))
}

fn euclidean_area(canvas: &Canvas) -> f64 {
    let all = vertices(canvas).flat_map(|v| stars(canvas).star(v).map(move |ends| area(canvas, v, ends)));
    all.sum::<f64>() / 6.0
}

#[test]
fn in_a_uniform_metric_stars_are_those_of_the_affine_delaunay_triangulation() {
    let domain = Domain::shape("rect:0,0,2,1").unwrap();
    for tensor in [Tensor::isotropic(1.0), Tensor::new(30.0, 5.0, 1.0), Tensor::new(1.0, 9.0, 100.0)] {
        let canvas = Canvas::new(Kind::StarSet, domain.planar(), &Uniform(tensor), 600).unwrap();
        let figures = *stars(&canvas).figures();
        assert_eq!((figures.vertices, figures.inconsistencies, figures.unsettled), (600, 0, 0), "{tensor:?}");
        assert!((euclidean_area(&canvas) - 2.0).abs() < 1e-12, "{tensor:?}");
        let at = |v: VertexId| framed(tensor, canvas.position(v));
        for v in vertices(&canvas) {
            for [a, b] in stars(&canvas).star(v).filter(|[a, b]| v < *a && v < *b) {
                let inside = |&w: &VertexId| ![v, a, b].contains(&w) && in_circle(at(v), at(a), at(b), at(w)) > 0.0;
                assert_eq!(vertices(&canvas).find(inside), None, "{tensor:?}: {v:?} {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn stars_keep_to_the_domain_and_neighbours_are_reciprocal() {
    let domain = holed();
    let field = Shock { phi: 10.0, lambda: 0.6 };
    let canvas = Canvas::new(Kind::StarSet, domain.planar(), &field, 2000).unwrap();
    let figures = stars(&canvas).figures();
    assert!(figures.unsettled == 0 && figures.inconsistencies > 0, "{figures:?}");
    let graph = canvas.graph(&field);
    for v in vertices(&canvas) {
        let list = graph.neighbours(v);
        assert!(list.len() >= 2 && list.is_sorted());
        for &u in list {
            assert!(graph.neighbours(u).contains(&v));
            let [p, q] = [v, u].map(|v| canvas.position(v));
            let middle = p.midpoint(q);
            let is_in_hole = (middle.x - 1.5).abs() < 0.499_999 && (middle.y - 1.0).abs() < 0.499_999;
            assert!(!is_in_hole, "{p} {q}");
        }
        assert!(stars(&canvas).star(v).all(|ends| area(&canvas, v, ends) > 0.0));
        assert!(stars(&canvas).star(v).flatten().all(|u| list.contains(&u)));
    }
}

#[test]
fn an_affine_map_takes_star_sets_to_star_sets() {
    // Powers of two: the map is exact.
    let make = |sx: f64, sy: f64| {
        let domain = Domain::shape(&format!("rect:0,0,{},{sy}", 2.0 * sx)).unwrap();
        let field = move |p: Point| {
            let (x, y) = (p.x / sx, p.y / sy);
            Tensor::new((4.0 + x) / (sx * sx), 0.5 * y / (sx * sy), (1.0 + 8.0 * y * y) / (sy * sy))
        };
        Canvas::new(Kind::StarSet, domain.planar(), &field, 900).unwrap()
    };
    let (one, scaled, stretched) = (make(1.0, 1.0), make(64.0, 64.0), make(4.0, 0.5));
    let [one, scaled, stretched] = [&one, &scaled, &stretched].map(stars);
    assert_eq!(one.pairs().collect::<BTreeSet<_>>(), scaled.pairs().collect());
    assert!((one.figures().radius - scaled.figures().radius).abs() < 1e-12);
    assert!(one.figures().radius / stretched.figures().radius < 1.5);
    assert_eq!(one.figures().vertices, stretched.figures().vertices);
}

#[test]
fn threads_do_not_change_a_star() {
    let domain = Domain::shape("rect:-2,-2,2,2").unwrap();
    let with = |threads: usize| {
        crate::test_cases::on_threads(threads, || {
            Canvas::new(Kind::StarSet, domain.planar(), &Swirl::default(), 6000).unwrap()
        })
    };
    let (one, two) = (with(1), with(2));
    assert_eq!(one.embedded().positions, two.embedded().positions);
    assert_eq!(stars(&one).figures(), stars(&two).figures());
    assert!(vertices(&one).all(|v| stars(&one).star(v).eq(stars(&two).star(v))));
}

#[test]
fn inconsistencies_fall_with_size() {
    let domain = Domain::shape("rect:-2,-2,2,2").unwrap();
    let share = |vertices| {
        let canvas = Canvas::new(Kind::StarSet, domain.planar(), &Swirl::default(), vertices).unwrap();
        let figures = stars(&canvas).figures();
        figures.inconsistencies as f64 / figures.simplices as f64
    };
    let (coarse, fine) = (share(1000), share(16_000));
    assert!(fine < 0.7 * coarse, "{coarse} {fine}");
}

#[test]
fn a_metric_that_is_none_is_an_error() {
    let field = |p: Point| Tensor::isotropic(if p.x > 0.5 { f64::NAN } else { 1.0 });
    let error = Canvas::new(Kind::StarSet, Domain::shape("rect:0,0,1,1").unwrap().planar(), &field, 100).unwrap_err();
    assert!(error.to_string().starts_with("invalid metric"), "{error}");
}
