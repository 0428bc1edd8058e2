//! How long one evaluation of each metric field takes, and the integral of sqrt(det M):
//! `cargo bench -p voronaut --bench metric`. Timings are read by people, never asserted.

use std::hint::black_box;
use std::time::Instant;
use voronaut::geometry::{Point, Tensor};
use voronaut::mesh::Mesh;
use voronaut::metric::{
    Boundary, BoundarySizes, Bounded, Bounds, Formula, MetricField, Sampled, Scaled, Shock, Swirl, SwirlField, Uniform,
    complexity,
};

fn main() {
    fields();
    boundaries();
    wrapped_fields();
    complexities();
}

fn points() -> Vec<Point> {
    let at = |i: u32| Point::new((f64::from(i) * 0.618_034).fract(), (f64::from(i) * 0.414_214).fract());
    (0..100_000).map(at).map(|p| Point::new(4.0 * p.x - 2.0, 4.0 * p.y - 2.0)).collect()
}

fn report(name: &str, field: &dyn MetricField) {
    let points = points();
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        for &p in &points {
            black_box(field.at(black_box(p)));
        }
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!("{name:>24} {:7.0} ns", 1e9 * best / points.len() as f64);
}

/// A wavy closed curve, inside the square of side 4.
fn coast(count: u32) -> Vec<(Point, Point)> {
    let at = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        let r = 1.6 + 0.25 * (9.0 * angle).sin() + 0.05 * (113.0 * angle).sin();
        Point::new(r * angle.cos(), r * angle.sin())
    };
    (0..count).map(|i| (at(i), at((i + 1) % count))).collect()
}

fn background(n: u32) -> Mesh {
    let corner = |k: u32| {
        let place = |i: u32| 4.0 * f64::from(i) / f64::from(n) - 2.0;
        [place(k % (n + 1)), place(k / (n + 1)), 0.0]
    };
    let cell = |k: u32| {
        let a = k % n + k / n * (n + 1);
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    Mesh {
        points: (0..(n + 1) * (n + 1)).map(corner).collect(),
        triangles: (0..n * n).flat_map(cell).collect(),
        ..Mesh::default()
    }
}

fn fields() {
    report("uniform", &Uniform::default());
    report("swirl authors", &Swirl::default());
    report("swirl printed", &Swirl { field: SwirlField::Printed, ..Swirl::default() });
    report("shock", &Shock::default());
    for text in ["1; 0; 1", "1/(0.1+x^2)^2; 0; 4", "100*exp(-50*x^2)+1; 0.1*sin(3*x)*y; if(y<0, 10, 10+90*y)"] {
        report(text, &Formula::planar(text).expect("three expressions"));
    }
    for n in [30, 300] {
        let mesh = background(n);
        let tensors: Vec<Tensor> = (0..mesh.points.len() as u32).map(|v| Shock::default().at(mesh.point(v))).collect();
        report(&format!("sampled on {} triangles", 2 * n * n), &Sampled::new(&mesh, &tensors).expect("a metric"));
    }
}

fn boundaries() {
    for count in [400, 8_000, 100_000] {
        report(&format!("boundary of {count}"), &boundary(count));
    }
}

fn wrapped_fields() {
    let bounds = Bounds { h_min: Some(0.05), h_max: Some(0.5), a_max: Some(5.0) };
    report("shock, bounded", &Bounded::new(Shock::default(), bounds).expect("sensible bounds"));
    report("shock, scaled", &Scaled { field: &Shock::default(), factor: 3.0 });
}

fn complexities() {
    let corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)].map(|(x, y)| Point::new(x, y));
    let triangles = [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    for (name, field) in [("shock", &Shock::default() as &dyn MetricField), ("boundary of 8000", &boundary(8_000))] {
        let start = Instant::now();
        let value = complexity(field, &triangles).expect("a metric");
        println!("complexity of {name}: {value:.6} in {:.1} ms", 1e3 * start.elapsed().as_secs_f64());
    }
}

fn boundary(count: u32) -> Boundary {
    let sizes =
        BoundarySizes { aspect: 5.0, ..BoundarySizes { h0: 0.001, growth: 1.2, aspect: 1.0, h_max: f64::INFINITY } };
    Boundary::new(&coast(count), sizes).expect("a boundary")
}
