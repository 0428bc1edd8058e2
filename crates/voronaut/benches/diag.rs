#[path = "../tests/geodesics/cases.rs"]
mod cases;
use std::f64::consts::PI;
use voronaut::canvas::Canvas;
use voronaut::diagram::Distances;
use voronaut::geodesic::Method;
use voronaut::geometry::Point;
fn main() {
    for k in [10.0, 40.0] {
        for n in [10201, 40804] {
            let case = cases::turning(k, 0.5);
            let image = |p: Point| Point::new(p.x / k, p.y + 0.5 * (PI * p.x).sin());
            let start = std::time::Instant::now();
            let canvas = Canvas::intrinsic(&case.domain(), &case.metric, n).unwrap();
            println!("{:.1} ms", 1e3 * start.elapsed().as_secs_f64());
            let e = canvas.embedded();
            let t = &e.topology;
            let mut bad = [0; 5];
            let (mut sum, mut count) = (0.0, 0);
            for h in t.edges() {
                let [p, q] = e.ends(h);
                let err = (t.length(h) / image(p).distance(image(q)) - 1.0).abs();
                for (b, lim) in bad.iter_mut().zip([1e-4, 1e-3, 1e-2, 1e-1, 1.0]) {
                    *b += (err > lim) as usize;
                }
                sum += err;
                count += 1;
            }
            let (mut inv, mut invb, mut near, mut faces) = (0, 0, 0, 0);
            for f in t.faces() {
                let [a, b, c] = t.corners(f).map(|v| image(e.position(v)));
                faces += 1;
                let area = (b - a).cross(c - a);
                if area <= 0.0 {
                    inv += 1;
                    invb += f.half_edges().iter().any(|&h| t.twin(h).is_none()) as usize;
                }
                if area < 0.05 * a.distance(b).max(b.distance(c)).max(c.distance(a)).powi(2) { near += 1; }
            }
            let mut shown = 0;
            for h in t.edges() {
                let [p, q] = e.ends(h);
                let exact = image(p).distance(image(q));
                let r = |l: f64| l / exact - 1.0;
                let b = r(voronaut::geodesic::bowed_chord(&case.metric, p, q));
                if b.abs() > 5e-3 && n == 10201 && shown % 400 == 0 {
                    let m = [8, 16, 32].map(|m| r(voronaut::geodesic::path_energy(&case.metric, p, q, m).value));
                    println!("  ({:.3},{:.3}) d ({:.3},{:.3}) exact {exact:.4} chord {:.3} bowed {b:.4} canvas {:.4} paths {m:.4?}", p.x, p.y, q.x-p.x, q.y-p.y, r(voronaut::geodesic::chord(&case.metric, p, q)), r(t.length(h)));
                }
                shown += (b.abs() > 5e-3) as usize;
            }
            println!("k {k} n {n}: edges {count} err>1e-4.. {bad:?} mean {:.2e}; faces {faces} inverted {inv} ({invb} at border) thin {near}; {:?}", sum / count as f64, canvas.counters());
            for method in [Method::March, Method::Heat] {
                let found = Distances::new(&canvas, &case.metric, &[case.from], method).unwrap();
                println!("  {method} {:?}", case.errors(&canvas, &found));
                let mut worst: Vec<(f64, Point)> = e.positions.iter().zip(found.values()).filter_map(|(&p, &d)| {let x=(case.exact)(p)?; (x>0.08).then_some((d / x - 1.0, p))}).collect();
                worst.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
                for w in worst.iter().step_by(40).take(8) { print!(" {:.4}@({:.2},{:.2})", w.0, w.1.x, w.1.y); }
                println!();
            }
        }
    }
}
