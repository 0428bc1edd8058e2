//! Star sets as canvases: against affine Delaunay triangulations, on shapes with holes, by laws of scale and threads.

use voronaut::canvas::StarSet;
use voronaut::domain::{Domain, from_geojson};
use voronaut::formats::geojson;
use voronaut::geometry::{Point, Tensor, in_circle, signed_area};
use voronaut::metric::{MetricField, Shock, Swirl, Uniform};

fn plate() -> Domain {
    let text = r#"{ "type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 2], [0, 2], [0, 0]],
        [[1, 0.5], [2, 0.5], [2, 1.5], [1, 1.5], [1, 0.5]]] }"#;
    Domain::new(&from_geojson(&geojson::read(text, "plate").unwrap()).unwrap()).unwrap()
}

fn framed(tensor: Tensor, p: Point) -> Point {
    let [a, b, c] = tensor.cholesky();
    Point::new(a * p.x + b * p.y, c * p.y)
}

fn euclidean_area(set: &StarSet) -> f64 {
    let area = |v: u32, [a, b]: [u32; 2]| signed_area(set.position(v), set.position(a), set.position(b));
    let stars = (0..set.figures().vertices as u32).flat_map(|v| set.star(v).map(move |ends| area(v, ends)));
    stars.sum::<f64>() / 6.0
}

#[test]
fn in_a_uniform_metric_stars_are_those_of_the_affine_delaunay_triangulation() {
    let domain = Domain::read("rect:0,0,2,1").unwrap();
    for tensor in [Tensor::isotropic(1.0), Tensor::new(30.0, 5.0, 1.0), Tensor::new(1.0, 9.0, 100.0)] {
        let set = StarSet::new(&domain, &Uniform(tensor), 600).unwrap();
        let figures = *set.figures();
        assert_eq!((figures.vertices, figures.inconsistencies, figures.unsettled), (600, 0, 0), "{tensor:?}");
        assert!((euclidean_area(&set) - 2.0).abs() < 1e-12, "{tensor:?}");
        let at = |v: u32| framed(tensor, set.position(v));
        for v in 0..600 {
            for [a, b] in set.star(v).filter(|[a, b]| v < *a && v < *b) {
                let inside = |&w: &u32| ![v, a, b].contains(&w) && in_circle(at(v), at(a), at(b), at(w)) > 0.0;
                assert_eq!((0..600).find(inside), None, "{tensor:?}: {v} {a} {b}");
            }
        }
    }
}

#[test]
fn stars_keep_to_the_domain_and_neighbours_are_reciprocal() {
    let domain = plate();
    let field = Shock { phi: 10.0, lambda: 0.6 };
    let set = StarSet::new(&domain, &field, 2000).unwrap();
    assert!(set.figures().unsettled == 0 && set.figures().inconsistencies > 0, "{:?}", set.figures());
    let neighbours = set.neighbours();
    for (v, list) in (0..).zip(&neighbours) {
        assert!(list.len() >= 2 && list.is_sorted());
        for &u in list {
            assert!(neighbours[u as usize].contains(&v));
            let middle = set.position(v).midpoint(set.position(u));
            let is_in_hole = (middle.x - 1.5).abs() < 0.499_999 && (middle.y - 1.0).abs() < 0.499_999;
            assert!(!is_in_hole, "{} {}", set.position(v), set.position(u));
        }
        let area = |[a, b]: [u32; 2]| signed_area(set.position(v), set.position(a), set.position(b));
        assert!(set.star(v).all(|ends| area(ends) > 0.0));
    }
    let (positions, tensors, lists) = set.into_graph();
    assert!(positions.len() == 2000 && tensors[77] == field.at(positions[77]) && lists == neighbours);
}

#[test]
fn an_affine_map_takes_star_sets_to_star_sets() {
    // Powers of two: the map is exact.
    let make = |sx: f64, sy: f64| {
        let domain = Domain::read(&format!("rect:0,0,{},{sy}", 2.0 * sx)).unwrap();
        let field = move |p: Point| {
            let (x, y) = (p.x / sx, p.y / sy);
            Tensor::new((4.0 + x) / (sx * sx), 0.5 * y / (sx * sy), (1.0 + 8.0 * y * y) / (sy * sy))
        };
        StarSet::new(&domain, &field, 900).unwrap()
    };
    let (one, scaled, stretched) = (make(1.0, 1.0), make(64.0, 64.0), make(4.0, 0.5));
    assert_eq!(one.neighbours(), scaled.neighbours());
    assert!((one.figures().radius - scaled.figures().radius).abs() < 1e-12);
    assert!(one.figures().radius / stretched.figures().radius < 1.5);
    assert_eq!(one.figures().vertices, stretched.figures().vertices);
}

#[test]
fn threads_do_not_change_a_star() {
    let domain = Domain::read("rect:-2,-2,2,2").unwrap();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| StarSet::new(&domain, &Swirl::default(), 6000).unwrap())
    };
    let (one, two) = (with(1), with(2));
    assert_eq!(one.figures(), two.figures());
    assert!((0..6000).all(|v| one.position(v) == two.position(v) && one.star(v).eq(two.star(v))));
}

#[test]
fn inconsistencies_fall_with_size() {
    let domain = Domain::read("rect:-2,-2,2,2").unwrap();
    let share = |vertices| {
        let figures = *StarSet::new(&domain, &Swirl::default(), vertices).unwrap().figures();
        figures.inconsistencies as f64 / figures.simplices as f64
    };
    let (coarse, fine) = (share(1000), share(16_000));
    assert!(fine < 0.7 * coarse, "{coarse} {fine}");
}

#[test]
fn a_metric_that_is_none_is_an_error() {
    let field = |p: Point| Tensor::isotropic(if p.x > 0.5 { f64::NAN } else { 1.0 });
    let error = StarSet::new(&Domain::read("rect:0,0,1,1").unwrap(), &field, 100).unwrap_err();
    assert!(error.to_string().starts_with("invalid metric"), "{error}");
}
