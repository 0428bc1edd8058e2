use super::bezier::bernstein;
use super::*;
use crate::geometry::{Tensor, Vector};
use crate::manifold::domain::{Domain, shape};
use crate::metric::Scaled;
use crate::progress::Silent;
use crate::recipe::{MeshOptions, mesh};
use crate::test_cases::on_threads;

/// The unit square in n by n cells of two triangles each.
fn square(n: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let at = |i: u32, j: u32| j * (n + 1) + i;
    for (j, i) in (0..=n).flat_map(|j| (0..=n).map(move |i| (j, i))) {
        mesh.points.push([f64::from(i) / f64::from(n), f64::from(j) / f64::from(n), 0.0]);
    }
    mesh.point_labels = vec![0; mesh.points.len()];
    for (j, i) in (0..n).flat_map(|j| (0..n).map(move |i| (j, i))) {
        mesh.triangles.extend([[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]);
    }
    mesh.triangle_labels = vec![7; mesh.triangles.len()];
    for i in 0..n {
        mesh.edges.extend([
            [at(i, 0), at(i + 1, 0)],
            [at(n, i), at(n, i + 1)],
            [at(i + 1, n), at(i, n)],
            [at(0, i + 1), at(0, i)],
        ]);
        mesh.edge_labels.extend([1, 2, 3, 4]);
    }
    mesh.corners = vec![at(0, 0), at(n, 0), at(0, n), at(n, n)];
    mesh
}

/// Where the waves' metric is the Euclidean one: its geodesics are straight there.
fn flat(p: Point) -> Point {
    Point::new(p.x, p.y + 0.15 * (5.0 * p.x).sin())
}

fn waves(p: Point) -> Tensor {
    let slope = 0.75 * (5.0 * p.x).cos();
    Tensor::new(1.0 + slope * slope, slope, 1.0)
}

fn unit(n: u32) -> f64 {
    let vertices = f64::from((n + 1) * (n + 1));
    vertices * 0.75_f64.sqrt()
}

fn curve(mesh: &Mesh, half_edge: usize) -> Vec<Point> {
    let (points, order) = bezier_points(mesh, half_edge / 3);
    side(order, half_edge % 3).map(|i| points[i]).collect()
}

fn length(curve: &[Point], metric: &dyn MetricField) -> f64 {
    let at = |t: f64| {
        let (p, slope) = curve_at(curve, t);
        metric.at(p).length(slope)
    };
    let parts = 64;
    (0..parts).map(|i| at((f64::from(i) + 0.5) / f64::from(parts)) / f64::from(parts)).sum()
}

fn assert_sound(mesh: &Mesh) {
    mesh.check_numbers().unwrap();
    let mut area = 0.0;
    for t in 0..mesh.triangles.len() {
        let (points, order) = bezier_points(mesh, t);
        let found = bound(&points[..exponents(order).len()], order, HALVINGS);
        assert!(found.is_valid() && found.is_decided, "{t} {found:?}");
        area += found.area;
    }
    assert!((area - 1.0).abs() < 1e-12, "{area}");
    let on_border = |p: &[f64; 3]| p[..2].iter().any(|x| [0.0, 1.0].contains(x));
    assert!(mesh.edges.iter().flatten().all(|&v| on_border(&mesh.points[v as usize])));
    assert_eq!(mesh.corners.len(), 4);
    assert!(mesh.triangle_labels.iter().all(|&label| label == 7));
}

/// How much longer the sides inside are than the shortest ways between their ends, in the mean, and the share of sides of unit length.
fn excess(mesh: &Mesh, factor: f64) -> (f64, f64) {
    let metric = Scaled { field: &waves, factor };
    let edges = crate::mesh::Edges::of(&mesh.triangles);
    let (mut inside, mut lengths) = (Vec::new(), Vec::new());
    for sides in edges.iter() {
        let curve = curve(mesh, sides[0].half_edge as usize);
        let length = length(&curve, &metric);
        lengths.push(length);
        if sides.len() == 2 {
            let shortest = flat(curve[0]).distance(flat(curve[curve.len() - 1])) * factor.sqrt();
            inside.push(length / shortest - 1.0);
        }
    }
    let is_unit = |l: &&f64| (0.5_f64.sqrt()..=2.0_f64.sqrt()).contains(*l);
    let unit = lengths.iter().filter(is_unit).count() as f64 / lengths.len() as f64;
    (inside.iter().sum::<f64>() / inside.len() as f64, unit)
}

#[test]
fn sides_follow_the_geodesics_of_waves() {
    let n = 9;
    let mesh = square(n);
    let metric = Scaled { field: &waves, factor: unit(n) };
    let made = [2, 3].map(|order| curved(&mesh, None, &metric, order, &Silent).unwrap().0);
    let [quadratic, cubic] = made.each_ref().map(|mesh| {
        assert_sound(mesh);
        assert_eq!(mesh.points.len(), 100);
        excess(mesh, unit(n))
    });
    assert!(quadratic.0 < 5e-3 && cubic.0 < 5e-3, "{quadratic:?} {cubic:?}");
    assert!(quadratic.1 > 0.9 && cubic.1 > 0.9, "{quadratic:?} {cubic:?}");
}

/// A metric whose geodesics are known, and how far a point is from the one between two others, in the metric, nearly.
struct Known {
    name: &'static str,
    metric: fn(Point) -> Tensor,
    away: fn([Point; 2], Point) -> f64,
}

fn from_line([a, b]: [Point; 2], p: Point) -> f64 {
    ((b - a).cross(p - a) / (b - a).norm()).abs()
}

/// The square turned around its middle, the more the farther out.
fn untwisted(p: Point) -> Point {
    let q = p - Point::new(0.5, 0.5);
    let (sin, cos) = (1.5 * q.dot(q)).sin_cos();
    Point::new(cos * q.x - sin * q.y, sin * q.x + cos * q.y)
}

fn twist(p: Point) -> Tensor {
    let q = p - Point::new(0.5, 0.5);
    let mixed = Tensor::new(-2.0 * q.x * q.y, q.x * q.x - q.y * q.y, 2.0 * q.x * q.y);
    Tensor::IDENTITY + mixed * 3.0 + Tensor::square(q) * (9.0 * q.dot(q))
}

/// Geodesics of the half-plane y > 0 are circles around points of its border, here one below the square.
fn from_half_circle([a, b]: [Point; 2], p: Point) -> f64 {
    let [a, b, p] = [a, b, p].map(|p| Vector::new(p.x, p.y + 1.0));
    let half = |v: Vector| 0.5 * v.dot(v);
    // Where the border is as far from both ends; of ends one above the other it is at infinity.
    let middle = (half(b) - half(a)) / (b.x - a.x);
    let radius = |v: Vector| Vector::new(v.x - middle, v.y).norm();
    let away = if middle.abs() < 1e6 { radius(p) - radius(a) } else { p.x - a.x };
    away.abs() / p.y
}

/// The sphere by its projection from a pole onto the plane.
fn on_sphere(p: Point) -> [f64; 3] {
    let square = p.x * p.x + p.y * p.y;
    [2.0 * p.x, 2.0 * p.y, square - 1.0].map(|x| x / (1.0 + square))
}

fn from_great_circle(ends: [Point; 2], p: Point) -> f64 {
    let [a, b] = ends.map(|p| crate::geometry::Point3::from(on_sphere(p)) - crate::geometry::Point3::default());
    let normal = a.cross(b).unit().unwrap();
    (crate::geometry::Point3::from(on_sphere(p)) - crate::geometry::Point3::default()).dot(normal).abs()
}

const KNOWN: [Known; 4] = [
    Known { name: "waves", metric: waves, away: |ends, p| from_line(ends.map(flat), flat(p)) },
    Known { name: "twist", metric: twist, away: |ends, p| from_line(ends.map(untwisted), untwisted(p)) },
    Known { name: "half-plane", metric: |p| Tensor::IDENTITY * (p.y + 1.0).powi(-2), away: from_half_circle },
    Known {
        name: "sphere",
        metric: |p| Tensor::IDENTITY * (4.0 / (1.0 + p.x * p.x + p.y * p.y).powi(2)),
        away: from_great_circle,
    },
];

/// How far nine sides of ten inside are from the geodesics between their ends at most.
fn away_from_geodesics(known: &Known, vertices: usize, order: usize) -> f64 {
    let domain = Domain::new(&shape("rect:0,0,1,1").unwrap().unwrap()).unwrap();
    let options = MeshOptions { vertices: Some(vertices), order, ..MeshOptions::default() };
    let mesh = mesh(&domain, &known.metric, &options, &Silent).unwrap().mesh;
    let edges = crate::mesh::Edges::of(&mesh.triangles);
    let of_side = |half_edge: usize| {
        let curve = curve(&mesh, half_edge);
        let ends = [curve[0], curve[order]];
        (1..16).map(|i| (known.away)(ends, curve_at(&curve, f64::from(i) / 16.0).0)).fold(0.0, f64::max)
    };
    let inside = edges.iter().filter(|sides| sides.len() == 2).map(|sides| of_side(sides[0].half_edge as usize));
    let mut away: Vec<f64> = inside.collect();
    away.sort_by(f64::total_cmp);
    away[away.len() * 9 / 10]
}

#[test]
fn sides_are_as_near_to_geodesics_as_polynomials_of_their_order() {
    for known in &KNOWN {
        for order in [2, 3] {
            let [coarse, fine] = [100, 400].map(|vertices| away_from_geodesics(known, vertices, order));
            let observed = (coarse / fine).log2();
            assert!(observed >= order as f64 + 1.0, "{} {order}: {observed} of {coarse} and {fine}", known.name);
        }
    }
}

/// Round a corner of the square, over an eighth of its width.
const FRONT: &str = "tanh(16*(sqrt((x + 0.1)^2 + (y + 0.1)^2) - 0.7))";

fn for_front(order: usize, norm: Norm) -> (Mesh, Polished) {
    let front: crate::metric::Snapshot =
        crate::metric::Expression::parse(FRONT, crate::metric::Variables::Plane).unwrap().into();
    let patience = Patience { steps: 12, gain: 2e-3 };
    let metric = |_: Point| Tensor::IDENTITY * unit(8);
    let (mesh, away, polished) =
        interpolating(&square(8), None, &metric, order, (&front, norm), patience, &Silent).unwrap();
    assert_eq!(away, None);
    (mesh, polished)
}

#[test]
fn curved_triangles_follow_a_function() {
    for (order, p, least) in [(2, 2.0, 20.0), (3, 2.0, 20.0), (2, 1.0, 20.0), (2, 8.0, 5.0)] {
        let (mesh, polished) = for_front(order, Norm::new(p).unwrap());
        assert_sound(&mesh);
        assert_eq!(mesh.points.len(), 81);
        let [first, .., last] = polished.error[..] else { panic!("no sweeps") };
        assert!(first > least * last, "{order} {p}: {:?}", polished.error);
        let front: crate::metric::Snapshot =
            crate::metric::Expression::parse(FRONT, crate::metric::Variables::Plane).unwrap().into();
        let found = crate::quality::interpolation_error(&mesh, &front, Norm::new(p).unwrap()).unwrap();
        assert!((found.norm / last - 1.0).abs() < 0.25, "{order} {p}: {found:?} {last}");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let mesh = square(7);
    let turning = |p: Point| {
        let angle = 2.0 * p.x + p.y;
        Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), 1200.0, 15.0)
    };
    let with = |threads| on_threads(threads, || curved(&mesh, None, &turning, 3, &Silent).unwrap().0);
    let one = with(1);
    assert_sound(&one);
    assert_eq!(one, with(2));
    let [one, two] = [1, 2].map(|threads| on_threads(threads, || for_front(2, Norm::default()).0));
    assert_eq!(one, two);
}

#[test]
fn raising_the_order_and_halving_change_no_map() {
    let mut elements = Elements::of(&square(2));
    for (i, p) in elements.points.iter_mut().enumerate().skip(9) {
        *p = *p + Vector::new(0.02 * (i as f64).sin(), 0.03 * (i as f64).cos());
    }
    let raised = elements.raised();
    let image = |e: &Elements, t: usize, at: [f64; 3]| {
        let (points, values) = (e.of_triangle(&e.points, t), bernstein(e.order, at));
        let count = e.count();
        bezier::blend(&points[..count], &values[..count])
    };
    for t in 0..8 {
        let at = [0.2, 0.5, 0.3];
        assert!(image(&elements, t, at).distance(image(&raised, t, at)) < 1e-15);
    }
    let whole = raised.loose()[3];
    let [first, second] = exchange::halves(&whole, 3);
    let of = |points: &[Point], at: [f64; 3]| bezier::blend(&points[..10], &bernstein(3, at));
    assert!(of(&first.points, [0.2, 0.5, 0.3]).distance(of(&whole.points, [0.45, 0.25, 0.3])) < 1e-15);
    assert!(of(&second.points, [0.2, 0.5, 0.3]).distance(of(&whole.points, [0.1, 0.6, 0.3])) < 1e-15);
}

#[test]
fn a_new_side_that_would_fold_is_untangled() {
    let p = |x: f64, y: f64| Point::new(x, y);
    // Beside the middle side, from the first vertex to the second, the third corner leans over to the right.
    let vertices = [p(0.0, 0.0), p(1.0, 0.0), p(0.5, 1.0), p(0.5, -1.0)];
    let vertices = vertices.map(|place| elements::Vertex { place, hold: elements::Hold::Free, source: 0 });
    let triangle = |corners: [u32; 3], inner: [Point; 3]| {
        let mut points = [Point::default(); bezier::MOST];
        points[..3].copy_from_slice(&corners.map(|v| vertices[v as usize].place));
        points[3..6].copy_from_slice(&inner);
        elements::Loose { corners, points, sides: [elements::Side::FREE; 3], label: 0 }
    };
    let pair = [
        triangle([0, 1, 2], [p(0.5, 0.0), p(1.2, 0.7), p(0.75, 0.55)]),
        triangle([1, 0, 3], [p(0.5, 0.0), p(0.25, -0.5), p(0.75, -0.5)]),
    ];
    let quadratic = Elements::assembled(2, &vertices, &pair);
    let aim = Aim { metric: &|_: Point| Tensor::IDENTITY, lengths: 0.0, least: 0.0, target: None };
    for elements in [quadratic.raised(), quadratic] {
        assert!((0..2).all(|t| elements.bound(&elements.points, t).is_valid()));
        let rule = Rule::of(elements.order);
        let mut flip = local::Local::of(&elements, &aim, &rule, pair::Pair::of(&elements, 0));
        assert!(!flip.is_valid());
        assert!(flip.untangle() && flip.is_valid() && flip.energy().is_finite());
    }
}
