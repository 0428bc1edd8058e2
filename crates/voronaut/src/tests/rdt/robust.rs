//! Starts that are poor, ties, holes, threads, and metrics without a closed form.

use super::models::{Model, Random, SQUARE, check, pulled_back, straight_delaunay};
use crate::canvas::Canvas;
use crate::diagram::Diagram;
use crate::geodesic::{Fineness, Margin, Paths, margin_by_power};
use crate::geometry::{Point, Tensor};
use crate::manifold::domain::{Domain, rect};
use crate::metric::{Formula, MetricField, Scaled, Shock, Swirl};
use crate::rdt::{Edge, Rdt, Start, Trust};

/// Seeds at unit spacing in a metric, by throwing darts with the tensor halfway.
fn darts(field: &dyn MetricField, [low, high]: [Point; 2], tries: usize) -> Vec<Point> {
    let mut random = Random(7);
    let mut seeds: Vec<Point> = Vec::new();
    for _ in 0..tries {
        let p = Point::new(low.x + (high.x - low.x) * random.next(), low.y + (high.y - low.y) * random.next());
        if seeds.iter().all(|&q| field.at(p.midpoint(q)).length(q - p) > 1.0) {
            seeds.push(p);
        }
    }
    seeds
}

/// The margin by the definition, at its finest; `None` where that does not tell.
fn by_definition(field: &dyn MetricField, paths: &Paths, seeds: &[Point], edge: &Edge) -> Option<Margin> {
    let ([Some(c), Some(d)], [a, b]) = (edge.apexes, edge.ends) else { return None };
    let at = |i: u32| seeds[i as usize];
    let length = |i: u32, j: u32| paths.length(field, at(i), at(j), Fineness::FINEST).map_or(f64::NAN, |l| l.value);
    let lengths = [length(a, b), length(a, c), length(b, c), length(a, d), length(b, d)];
    if lengths.iter().any(|l| l.is_nan() || *l > 2.5) {
        return None;
    }
    let margin = margin_by_power(paths, field, [a, b, c, d].map(at), lengths, Fineness::FINEST);
    (margin.error < 1e-6).then_some(margin)
}

/// Where no closed form is known the tests are held against the definition.
#[test]
fn margins_agree_with_the_definition_where_curvature_varies() {
    let bump = |p: Point| {
        let f = 1.2 * (-4.0 * (p.x * p.x + p.y * p.y)).exp();
        let (gx, gy) = (-8.0 * p.x * f, -8.0 * p.y * f);
        Tensor::new(1.0 + gx * gx, gx * gy, 1.0 + gy * gy)
    };
    let formula = "1 + 40 * exp(-abs(x) * 2) * cos(y) ^ 2; 1.5 * sin(x * y); 4 + 20 * exp(-y ^ 2 * 8)";
    let hessian = Formula::planar(formula).unwrap();
    let (swirl, shock) = (Swirl::default(), Shock { phi: 1.0, lambda: 0.6 });
    let wide = [Point::new(-2.0, -2.0), Point::new(2.0, 2.0)];
    let all: [(&str, &dyn MetricField, f64, [Point; 2]); 4] = [
        ("bump", &bump, 120.0, SQUARE),
        ("swirl", &swirl, 500.0, wide),
        ("shock", &shock, 60.0, SQUARE),
        ("hessian", &hessian, 20.0, SQUARE),
    ];
    for (name, field, factor, corners) in all {
        let unit = Scaled { field, factor };
        let seeds = darts(&unit, corners, 12_000);
        let domain = Domain::new(&rect(corners[0], corners[1]).unwrap()).unwrap();
        let canvas = Canvas::intrinsic(domain.planar(), &unit, 40 * seeds.len()).unwrap();
        let nerve = Diagram::new(&canvas, &unit, &seeds).unwrap().sharp_nerve();
        let rdt = Rdt::new(&unit, &seeds, &Start::from_nerve(&nerve), Trust::default());
        let paths = Paths::default();
        let pair = |e: &Edge| Some((e.margin?, by_definition(&unit, &paths, &seeds, e)?));
        let pairs: Vec<(Margin, Margin)> = rdt.edges().iter().filter_map(pair).collect();
        let off = pairs.iter().filter(|(m, truth)| (m.value - truth.value).abs() > m.error + truth.error).count();
        let wrong = |m: &Margin, truth: &Margin| m.is_certain() && truth.is_certain() && m.value * truth.value < 0.0;
        let wrong_sign = pairs.iter().filter(|(m, truth)| wrong(m, truth)).count();
        println!("{name}: {} seeds, {} compared, {off} off, {:?}", seeds.len(), pairs.len(), rdt.counters());
        assert!(wrong_sign == 0 && off * 500 <= pairs.len() && pairs.len() > 2 * seeds.len() * 3 / 4, "{name}");
    }
}

#[test]
fn poor_starts_end_in_the_same_triangulation() {
    let turn = |r2: f64| 2.2 * (1.0 - 0.5 * r2);
    let map = move |p: Point| {
        let (sin, cos) = turn(p.x * p.x + p.y * p.y).sin_cos();
        Point::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y)
    };
    let metric = pulled_back(move |p| {
        let (angle, slope) = (turn(p.x * p.x + p.y * p.y), -2.2);
        let (sin, cos) = angle.sin_cos();
        let (x, y) = (cos * p.x - sin * p.y, sin * p.x + cos * p.y);
        [cos - y * slope * p.x, -sin - y * slope * p.y, sin + x * slope * p.x, cos + x * slope * p.y]
    });
    let model = Model { name: "vortex", corners: SQUARE, map: &map, metric: &metric, curvature: 0.0 };
    let seeds = model.seeds(20_000, 0.05, 3);
    check(&model, &seeds, &straight_delaunay(&seeds));
    let canvas = Canvas::intrinsic(model.domain().planar(), &metric, 10 * seeds.len()).unwrap();
    let nerve = Diagram::new(&canvas, &metric, &seeds).unwrap().nerve();
    check(&model, &seeds, &Start::from_nerve(&nerve)).demand();
    // Every tenth triangle missing, another tenth there twice, turned.
    let mut start = Start::from_nerve(&Diagram::new(&canvas, &metric, &seeds).unwrap().sharp_nerve());
    let turned: Vec<[u32; 3]> = start.triangles.iter().skip(5).step_by(10).map(|&[a, b, c]| [b, a, c]).collect();
    let mut n = 0;
    start.triangles.retain(|_| {
        n += 1;
        n % 10 != 0
    });
    start.triangles.extend(turned);
    start.triangles.extend([[0, 0, 1], [0, 1, u32::MAX]]);
    // At the border nothing tells that a triangle is missing.
    let damaged = check(&model, &seeds, &start);
    assert!(damaged.wrong_sign == 0 && damaged.wrong * 100 < damaged.interior, "{}", damaged.wrong);
}

#[test]
fn lattices_are_ties_and_cost_nothing() {
    let seeds: Vec<Point> =
        (0..60 * 60).map(|i| Point::new(f64::from(i % 60) * 0.3 - 9.0, f64::from(i / 60) * 0.3 - 9.0)).collect();
    for metric in [Tensor::IDENTITY, Tensor::new(1.0, 0.0, 9.0)] {
        let field = move |_: Point| metric;
        let rdt = Rdt::new(&field, &seeds, &straight_delaunay(&seeds), Trust::default());
        println!("lattice: {:?}", rdt.counters());
        assert_eq!((rdt.counters().flips, rdt.counters().circling, rdt.triangles().len()), (0, 0, 2 * 59 * 59));
    }
    // The same on a turned cylinder: geodesics are not straight, squares are squares up to rounding.
    let field = pulled_back(|p| [1.0, 0.0, 0.25 * (0.5 * p.x).cos(), 1.0]);
    let bent: Vec<Point> = seeds.iter().map(|p| Point::new(p.x, p.y - 0.5 * (0.5 * p.x).sin())).collect();
    let rdt = Rdt::new(&field, &bent, &straight_delaunay(&seeds), Trust::default());
    println!("bent lattice: {:?}", rdt.counters());
    let margins: Vec<f64> = rdt.edges().iter().filter_map(|e| Some(e.margin?.value)).collect();
    assert!(!margins.is_empty() && margins.iter().all(|&m| m > -1e-6));
}

#[test]
fn the_reference_vetoes_what_goes_through_a_hole() {
    // A wall between two rows of seeds: distances across it are those around its far end.
    let seeds: Vec<Point> =
        (0..12).map(|i| Point::new(f64::from(i % 6), 0.4 * f64::from(i / 6) + 0.01 * f64::from(i))).collect();
    let field = |_: Point| Tensor::IDENTITY;
    let start = straight_delaunay(&seeds);
    let free = Rdt::new(&field, &seeds, &start, Trust::default());
    let around = |i: u32, j: u32| {
        let (p, q) = (seeds[i as usize], seeds[j as usize]);
        // Less than the straight way: a tunnel.
        let shorter = if (i < 6) == (j < 6) { 1.0 } else { 0.5 };
        Some((shorter * p.distance(q), 1e-3))
    };
    let vetoed = Rdt::new(&field, &seeds, &start, Trust { reference: Some(&around), ..Trust::default() });
    assert_eq!(free.counters().vetoed, 0);
    assert!(vetoed.counters().vetoed > 0, "{:?}", vetoed.counters());
    assert!((vetoed.length(0, 6).unwrap().value - 0.5 * seeds[0].distance(seeds[6])).abs() < 1e-12);
}

#[test]
fn threads_do_not_change_a_bit() {
    let field = Scaled { field: &Shock { phi: 1.0, lambda: 0.6 }, factor: 100.0 };
    let seeds = darts(&field, SQUARE, 5000);
    let start = straight_delaunay(&seeds);
    let of = |threads: usize| {
        let rdt = crate::test_cases::on_threads(threads, || Rdt::new(&field, &seeds, &start, Trust::default()));
        (rdt.triangles(), rdt.edges(), *rdt.counters())
    };
    let one = of(1);
    assert_eq!(one, of(3));
}
