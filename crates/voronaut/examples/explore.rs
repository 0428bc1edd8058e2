use std::time::Instant;
use voronaut::canvas::Canvas;
use voronaut::diagram::Diagram;
use voronaut::domain::{Domain, rect};
use voronaut::geodesic::{Marching, Wave};
use voronaut::geometry::{Point, Tensor, Vector};
use voronaut::metric::{MetricField, Swirl, Shock, Uniform};
use voronaut::triangulation::VertexId;

fn phi(p: Point) -> Vector { Vector::new((p.x) * 0.1, p.y + 0.5 * (std::f64::consts::PI * p.x).sin()) }
fn pulled(p: Point) -> Tensor {
    let a = 0.5 * std::f64::consts::PI * (std::f64::consts::PI * p.x).cos();
    // J = [[.1,0],[a,1]]; M=J'J
    Tensor::new(0.01 + a * a, a, 1.0)
}
fn main() {
    let domain = Domain::new(&rect(Point::new(-2.0, -2.0), Point::new(2.0, 2.0)).unwrap()).unwrap();
    let args: Vec<String> = std::env::args().collect();
    let n: usize = args.get(1).map_or(1_000_000, |s| s.parse().unwrap());
    if n > 0 { for (name, field) in [("uniform", &Uniform(Tensor::new(4.0, 1.0, 1.0)) as &dyn MetricField), ("swirl", &Swirl::default()), ("shock", &Shock::default())] {
        let t = Instant::now();
        let canvas = Canvas::intrinsic(&domain, field, n).unwrap();
        let t1 = t.elapsed();
        canvas.topology().check().unwrap();
        let lengths: Vec<f64> = canvas.topology().edges().map(|h| canvas.topology().length(h)).collect();
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        let max = lengths.iter().copied().fold(0.0, f64::max);
        println!("{name}: canvas {} in {t1:?} {:?} mean edge {mean:.5} max {max:.5}", canvas.vertex_count(), canvas.counters());
        let seeds: Vec<Point> = halton(4000).map(|(x, y)| Point::new(4.0 * x - 2.0, 4.0 * y - 2.0)).collect();
        let t = Instant::now();
        let d = Diagram::new(&canvas, field, &seeds).unwrap();
        println!("   diagram {:?} {:?}", t.elapsed(), d.counters());
        let t = Instant::now();
        let nerve = d.nerve();
        println!("   nerve {:?}: {} {} {} orphans {}", t.elapsed(), nerve.vertices.len(), nerve.edges.len(), nerve.triangles.len(), d.orphans().len());
    }
    }
    // accuracy
    let p0 = Point::new(0.3, -0.2);
    for wave in [Wave::Circular, Wave::Plane] {
        for k in [0, 1, 2, 3] {
            let t = Instant::now(); let n = 2500 * 4_usize.pow(k);
            let canvas = Canvas::intrinsic(&domain, &pulled, n).unwrap();
            let d = Diagram::with_solver(&canvas, &pulled, &[p0], Marching { wave }).unwrap();
            let (mut worst, mut sum) = (0.0_f64, 0.0);
            let far = canvas.vertex_count() as u32;
            let mut m = 0;
            for v in (0..far).map(VertexId) {
                let e = (phi(canvas.position(v)) - phi(p0)).norm();
                if e < 0.2 { continue }
                // boundary may cut straight lines in phi-space; restrict to a strip
                if canvas.position(v).x.abs() > 1.0 || canvas.position(v).y.abs() > 1.2 { continue }
                let r = (d.distance(v) / e - 1.0).abs();
                worst = worst.max(r); sum += r; m += 1;
            }
            println!("{wave:?} {n} {:?} {:?} max {worst:.2e} mean {:.2e}", t.elapsed(), canvas.counters(), sum / m as f64);
        }
    }
}
fn halton(n: u32) -> impl Iterator<Item = (f64, f64)> {
    (1..=n).map(|i| (radical(i, 2), radical(i, 3)))
}
fn radical(mut i: u32, b: u32) -> f64 {
    let (mut f, mut r) = (1.0, 0.0);
    while i > 0 { f /= f64::from(b); r += f * f64::from(i % b); i /= b; }
    r
}
