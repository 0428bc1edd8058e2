//! What every method of computing distances must do on every canvas, and how accurate each is against closed forms.

mod cases;
mod ladder;

use voronaut::canvas::{Canvas, Kind};
use voronaut::diagram::{Diagram, Distances};
use voronaut::domain::{Domain, from_poly};
use voronaut::formats::poly;
use voronaut::geodesic::{Method, STVD_WINDOW};
use voronaut::geometry::{Point, Tensor};
use voronaut::metric::{MetricField, Swirl};
use voronaut::triangulation::VertexId;

/// By how much distances by a method may err, as a share, on the canvases of these tests.
fn tolerance(method: Method) -> f64 {
    match method {
        Method::March => 0.03,
        Method::Stvd { .. } => 0.15,
        Method::Konukoglu => 0.1,
        Method::Dijkstra | Method::Heat => 0.2,
        // Where a metric turns within its stencils.
        Method::Lbr => 0.35,
    }
}

/// Points well apart in the square around the origin.
fn points(half: f64) -> Vec<Point> {
    let corners = [(-0.62, -0.55), (0.7, -0.31), (0.13, 0.66), (-0.71, 0.4), (0.05, -0.04)];
    corners.map(|(x, y)| Point::new(half * x, half * y)).to_vec()
}

/// Every method on every kind of canvas.
fn pairs() -> impl Iterator<Item = (Kind, Method)> {
    Kind::ALL.into_iter().flat_map(|kind| Method::ALL.map(|method| (kind, method)))
}

/// A canvas of each kind.
fn canvases(domain: &Domain, field: &dyn MetricField, vertices: usize) -> [Canvas; 3] {
    Kind::ALL.map(|kind| Canvas::new(kind, domain, field, vertices).unwrap())
}

fn square(half: f64) -> Domain {
    Domain::read(&format!("rect:{},{},{half},{half}", -half, -half)).unwrap()
}

/// The distances between points, each row by one run.
fn table(canvas: &Canvas, field: &dyn MetricField, method: Method, points: &[Point]) -> Vec<Vec<f64>> {
    let row = |&from: &Point| {
        let found = Distances::new(canvas, field, &[from], method).unwrap();
        points.iter().map(|&p| found.at(p).unwrap()).collect()
    };
    points.iter().map(row).collect()
}

#[test]
fn distances_are_symmetric_and_obey_the_triangle_inequality() {
    // Mild, so that every method is in its range: anisotropy up to 2.6.
    let turning = |p: Point| {
        let slope = (1.5 * p.x).cos();
        Tensor::new(1.0 + slope * slope, slope, 1.0)
    };
    let (domain, points) = (square(2.0), points(2.0));
    let canvases = canvases(&domain, &turning, 6000);
    for (canvas, method) in canvases.iter().flat_map(|canvas| Method::ALL.map(|method| (canvas, method))) {
        let (d, tolerance) = (table(canvas, &turning, method, &points), 0.5 * tolerance(method));
        let method = format!("{method} on {}", canvas.kind());
        let n = points.len();
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).filter(|(i, j)| i != j) {
            assert!((d[i][j] / d[j][i] - 1.0).abs() < tolerance, "{method}: {} and {}", d[i][j], d[j][i]);
            for k in 0..n {
                assert!(d[i][j] < (d[i][k] + d[k][j]) * (1.0 + tolerance), "{method}: {i} {k} {j}");
            }
        }
        assert!((0..n).all(|i| d[i][i] == 0.0), "{method}: {d:?}");
    }
}

#[test]
fn scaling_the_metric_scales_distances() {
    let (domain, swirl, points) = (square(2.0), Swirl::default(), points(2.0));
    // Powers of two, so that nothing is rounded otherwise.
    let factors = [1.0, 2.0_f64.powi(30), 2.0_f64.powi(-30)];
    for (kind, method) in pairs() {
        let [unit, large, small] = factors.map(|factor| {
            let field = move |p: Point| swirl.at(p) * factor;
            let canvas = Canvas::new(kind, &domain, &field, 1500).unwrap();
            let found = Distances::new(&canvas, &field, &points[..2], method).unwrap();
            found.values().iter().map(|d| d / factor.sqrt()).collect::<Vec<f64>>()
        });
        assert!(unit.len() == large.len() && unit.len() == small.len());
        for ((a, b), c) in unit.iter().zip(&large).zip(&small) {
            assert!((a - b).abs() <= 1e-9 * a && (a - c).abs() <= 1e-9 * a, "{method} on {kind}: {a} {b} {c}");
        }
    }
}

#[test]
fn distances_are_those_of_the_affine_image() {
    // (x, y) to (4 x + y, y): a square, and its image as a domain of its own.
    let image = |p: Point| Point::new(4.0 * p.x + p.y, p.y);
    let field = |_: Point| Tensor::new(16.0, 4.0, 2.0);
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| image(Point::new(x, y)));
    let [a, b, c, d] = corners.map(|p| format!("{} {}", p.x, p.y));
    let text = format!("4 2 0 0\n1 {a}\n2 {b}\n3 {c}\n4 {d}\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n");
    let mapped = Domain::new(&from_poly(&poly::read(&text, "image").unwrap()).unwrap()).unwrap();
    let euclidean = |_: Point| Tensor::IDENTITY;
    let [here, there] = [(&square(1.0), &field as &dyn MetricField), (&mapped, &euclidean)]
        .map(|(domain, field)| Canvas::intrinsic(domain, field, 4000).unwrap());
    let points = points(1.0);
    let images: Vec<Point> = points.iter().map(|&p| image(p)).collect();
    for method in Method::ALL {
        let (one, other) = (table(&here, &field, method, &points), table(&there, &euclidean, method, &images));
        for (i, j) in (0..points.len()).flat_map(|i| (0..i).map(move |j| (i, j))) {
            let (a, b, exact) = (one[i][j], other[i][j], images[i].distance(images[j]));
            assert!((a / b - 1.0).abs() < tolerance(method), "{method}: {a} {b}");
            assert!((a / exact - 1.0).abs() < tolerance(method), "{method}: {a} {exact}");
        }
    }
}

#[test]
fn distances_grow_from_parents_and_paths_lead_back() {
    let (domain, swirl, from) = (square(2.0), Swirl::default(), points(2.0));
    for (kind, method) in pairs() {
        // As fine everywhere as the metric's finest direction takes more.
        let vertices = if kind == Kind::Isotropic { 30_000 } else { 5000 };
        let canvas = Canvas::new(kind, &domain, &swirl, vertices).unwrap();
        let found = Distances::new(&canvas, &swirl, &from, method).unwrap();
        for v in (0..canvas.vertex_count() as u32).map(VertexId) {
            if let Some(parent) = found.parent(v) {
                assert!(found.values()[parent.index()] < found.values()[v.index()], "{method}: {v:?}");
            }
        }
        // Not the one in the middle of the swirl, where the metric turns within a canvas edge.
        for to in points(1.9)[..4].iter().map(|p| Point::new(p.y, -p.x)) {
            let Ok(path) = found.path(to) else {
                // Without parents a way down ends in any hollow of the distances.
                assert!(!method.drives_diagrams() && kind == Kind::Isotropic, "{method} on {kind}: no way from {to}");
                continue;
            };
            let (first, last) = (path.points[0], path.points[path.points.len() - 1]);
            assert!(first == to && from.contains(&last), "{method}: {first} {last}");
            let distance = found.at(to).unwrap();
            let method_on = format!("{method} on {kind}");
            // No path is shorter than the distance, but for the method's error.
            assert!(path.length > distance * (1.0 - tolerance(method)), "{method_on}: {} {distance}", path.length);
            assert!(
                path.length < distance * (1.0 + 4.0 * tolerance(method)),
                "{method_on}: {} {distance}",
                path.length
            );
        }
    }
}

#[test]
fn diagrams_by_every_method_change_as_if_made_anew() {
    let (domain, swirl) = (square(2.0), Swirl::default());
    let seed = |i: u32| Point::new((1.7 * f64::from(i)).sin() * 1.9, (2.3 * f64::from(i)).cos() * 1.9);
    for (kind, method) in pairs().filter(|pair| pair.1.drives_diagrams()) {
        let canvas = Canvas::new(kind, &domain, &swirl, 1500).unwrap();
        let mut seeds: Vec<Point> = (1..=30).map(seed).collect();
        let mut diagram = Diagram::by_method(&canvas, &swirl, &seeds, method).unwrap();
        for i in 0..12 {
            seeds.push(seed(100 + i));
            assert_eq!(diagram.insert(seeds[seeds.len() - 1]).unwrap() as usize, seeds.len() - 1);
            seeds[i as usize] = seed(200 + i);
            diagram.move_to(i, seeds[i as usize]).unwrap();
        }
        diagram.insert(seed(500)).unwrap();
        assert!(diagram.remove(seeds.len() as u32));
        let anew = Diagram::by_method(&canvas, &swirl, &seeds, method).unwrap();
        for v in (0..canvas.vertex_count() as u32).map(VertexId) {
            assert_eq!(diagram.label(v), anew.label(v), "{method} on {kind}: {v:?}");
        }
        assert!(diagram.cell_sizes()[..seeds.len()].iter().all(|&size| size > 0), "{method}");
    }
    let canvas = Canvas::intrinsic(&domain, &swirl, 1500).unwrap();
    for method in [Method::Lbr, Method::Heat] {
        let error = Diagram::by_method(&canvas, &swirl, &[seed(1)], method).err().unwrap();
        assert_eq!(error.to_string(), format!("not supported: a diagram by {method}, which gives distances alone"));
        assert_eq!(error.help(), "use one of march, stvd, dijkstra, konukoglu");
    }
}

#[test]
fn points_outside_the_domain_are_refused() {
    let (domain, swirl) = (square(1.0), Swirl::default());
    let canvas = Canvas::intrinsic(&domain, &swirl, 300).unwrap();
    for method in Method::ALL {
        let error = Distances::new(&canvas, &swirl, &[Point::new(3.0, 0.0)], method).err().unwrap();
        assert!(error.to_string().contains("outside the domain at seed 1 (3, 0)"), "{error}");
        let found = Distances::new(&canvas, &swirl, &[Point::new(0.3, 0.1)], method).unwrap();
        assert!(found.at(Point::new(3.0, 0.0)).is_none() && found.path(Point::new(3.0, 0.0)).is_err());
    }
    assert_eq!(Method::Stvd { window: STVD_WINDOW }.to_string(), "stvd");
}
