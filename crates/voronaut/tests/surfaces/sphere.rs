//! On a sphere with its own metric the Riemannian Delaunay triangulation is the convex hull.

use std::collections::HashSet;
use voronaut::canvas::{Canvas, Kind};
use voronaut::diagram::Diagram;
use voronaut::geodesic::Method;
use voronaut::geometry::{Point3, Tensor3};
use voronaut::surface::metric::Constant;
use voronaut::rdt::{OnSurface, Rdt, Start};
use voronaut::surface::{Place, read};

/// Random points of the unit sphere.
pub fn seeds(count: usize) -> Vec<Point3> {
    let mut state = 88_172_645_463_325_252_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut point = || {
        let (z, angle) = (2.0 * random() - 1.0, std::f64::consts::TAU * random());
        let r = (1.0 - z * z).sqrt();
        Point3::new(r * angle.cos(), r * angle.sin(), z)
    };
    (0..count).map(|_| point()).collect()
}

fn is_on_hull(seeds: &[Point3], [a, b, c]: [u32; 3]) -> bool {
    let [p, q, r] = [a, b, c].map(|i| seeds[i as usize]);
    let normal = (q - p).cross(r - p);
    (0..).zip(seeds).all(|(i, &s)| [a, b, c].contains(&i) || normal.dot(s - p) < 0.0)
}

#[test]
fn sharp_nerve() {
    for (n, per) in [(3000, 180_000), (3000, 60_000), (300, 18_000), (40, 10_000), (12, 5000)] {
    let input = read("sphere:1", None).unwrap();
    let metric = Constant(Tensor3::IDENTITY);
    let seeds = seeds(n);
    let places: Vec<Place> = seeds.iter().map(|&p| input.closest(p).unwrap()).collect();
    let t = std::time::Instant::now();
    let (canvas, at) = Canvas::on_surface(Kind::Intrinsic, &input, &metric, per, &places).unwrap();
    println!("canvas {:?} {:?}", canvas.figures(), t.elapsed());
    let diagram = Diagram::on_surface(&canvas, &at, Method::March).unwrap();
    println!("diagram {:?}", t.elapsed());
    for nerve in [diagram.nerve(), diagram.sharp_nerve()] {
        let found: HashSet<[u32; 3]> = nerve.triangles.iter().map(|t| t.colours).collect();
        let right = found.iter().filter(|&&t| is_on_hull(&seeds, t)).count();
        println!("{} triangles, {right} on the hull of {}, {:?}", found.len(), 2 * seeds.len() - 4, t.elapsed());
    }
    for nerve in [diagram.nerve(), diagram.sharp_nerve()] {
    let start = Start::from_nerve(&nerve);
    let rdt = Rdt::judged(OnSurface::new(&diagram), seeds.len(), &start);
    let found: HashSet<[u32; 3]> = rdt.triangles().into_iter().collect();
    let right = found.iter().filter(|&&t| is_on_hull(&seeds, t)).count();
    println!("{} triangles, {right} on the hull, {:?} {:?}", found.len(), rdt.counters(), t.elapsed());
    let (mut worst, mut over): (f64, f64) = (0.0, 0.0);
    for e in rdt.edges() {
        let Some(margin) = e.margin else { println!("border {:?} {:?}", e, e.ends.map(|i| seeds[i as usize])); continue };
        let [a, b] = e.ends;
        let [c, d] = e.apexes.map(|x| x.unwrap_or(0));
        let normal = (seeds[b as usize] - seeds[a as usize]).cross(seeds[c as usize] - seeds[a as usize]);
        let truth = -2.0 * normal.dot(seeds[d as usize] - seeds[a as usize]);
        let scale = [(a, c), (b, c), (a, d), (b, d)].map(|(i, j)| seeds[i as usize].distance(seeds[j as usize])).iter().product::<f64>();
        let truth = truth / scale;
        worst = worst.max((truth - margin.value).abs());
        over = over.max((truth - margin.value).abs() / margin.error);
        if truth < 0.0 { println!("{truth:.3e} {:.3e} {:.3e}", margin.value, margin.error); }
    }
    println!("worst {worst:.3e} of error {over:.3}");
    }
    }
}
