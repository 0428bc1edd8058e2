use voronaut::recipe::{MeshOptions, mesh_surface};
use voronaut::surface::{metric, read};
use voronaut::metric::Bounds;
use voronaut::progress::Silent;
use voronaut::geometry::{Point3};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let input = read(&args[1], None).unwrap();
    let m = metric::field(&metric::Spec::parse(&args[2]).unwrap(), &input, Bounds::default()).unwrap();
    let n: usize = args[3].parse().unwrap();
    let lloyd = args.get(5).map_or(40, |l| l.parse().unwrap());
    let options = MeshOptions { vertices: Some(n), lloyd, ..MeshOptions::default() };
    let meshed = match mesh_surface(&input, m.as_ref(), &options, &Silent) { Ok(m) => m, Err(e) => { println!("{e}"); return; } };
    println!("{} vertices {} triangles, scale {:.4e}, flips {} held {} taken back {} stalled {} steps {} energy {:?}", meshed.mesh.points.len(), meshed.mesh.triangles.len(), meshed.metric_scale,
        meshed.relaxation.flips, meshed.relaxation.held, meshed.relaxation.taken_back, meshed.relaxation.stalled, meshed.relaxation.moves.len(), [meshed.relaxation.energy.first(), meshed.relaxation.energy.last()]);
    println!("{:?} notes {:?}", meshed.seconds, meshed.notes);
    println!("blocked {} uncertain {} disagreements {} tests {:?}", meshed.dual.blocked_flips, meshed.dual.uncertain, meshed.dual.disagreements.len(), meshed.dual.geodesic_tests);
    // quality
    let places: Vec<_> = meshed.mesh.points.iter().map(|&p| input.closest(p.into()).unwrap()).collect();
    let tensors: Vec<_> = places.iter().map(|p| m.at(p)).collect();
    let mut q = Vec::new(); let mut unit = 0; let mut edges = 0; let mut folded = 0;
    for t in &meshed.mesh.triangles {
        let [a, b, c] = t.map(|i| Point3::from(meshed.mesh.points[i as usize]));
        let n = (b - a).cross(c - a);
        if t.iter().any(|&i| input.normal(&places[i as usize]).dot(n) < 0.0) { folded += 1; }
        let plane = voronaut::geometry::TangentPlane::new(n.unit().unwrap());
        let mm = t.iter().map(|&i| plane.restrict(tensors[i as usize]).log()).fold(voronaut::geometry::Tensor::default(), |s, l| s + l) * (1.0 / 3.0);
        let mm = mm.exp() * meshed.metric_scale;
        let [x, y, z] = [b - a, c - b, a - c].map(|e| plane.flatten(e));
        let area = 0.5 * x.cross(y) * mm.determinant().sqrt();
        q.push(4.0 * 3f64.sqrt() * area / (mm.dot(x, x) + mm.dot(y, y) + mm.dot(z, z)));
        for e in [x, y, z] { let l = mm.length(e); edges += 1; unit += usize::from((0.7071..1.4142).contains(&l)); }
    }
    let min = q.iter().copied().fold(1.0, f64::min);
    println!("quality mean {:.4} min {:.4} unit {:.4} folded {folded}", q.iter().sum::<f64>() / q.len() as f64, min, unit as f64 / edges as f64);
    let mut worst: Vec<(f64, usize)> = q.iter().copied().zip(0..).collect();
    worst.sort_by(|a, b| a.0.total_cmp(&b.0));
    for &(q, t) in &worst[..5.min(worst.len())] { let t = meshed.mesh.triangles[t]; println!("  {q:.4} {:?} lengths {:?} eig {:?}", meshed.mesh.points[t[0] as usize].map(|x| (x * 1e3).round() / 1e3),
        [(0, 1), (1, 2), (2, 0)].map(|(i, j)| { let e = Point3::from(meshed.mesh.points[t[j] as usize]) - Point3::from(meshed.mesh.points[t[i] as usize]); [t[i], t[j]].map(|v| ((tensors[v as usize] * meshed.metric_scale).length(e) * 100.0).round() / 100.0) }),
        t.map(|v| (tensors[v as usize] * meshed.metric_scale).eigen().values.map(|x| (1e3 / x.sqrt()).round() / 1e3))); }
    let ours = voronaut::surface::Surface::new(&meshed.mesh).unwrap();
    let one = |from: &voronaut::surface::Surface, to: &voronaut::surface::Surface| {
        let near = voronaut::surface::Nearest::new(to);
        let k = (400_000 / from.topology().face_count()).max(3) as f64; let k = k.sqrt().ceil() as i32;
        let (mut sum, mut area, mut most) = (0.0, 0.0, 0.0_f64);
        for f in from.topology().faces() {
            let a = 0.5 * from.area_vector(f).norm();
            let mut cnt = 0.0; let mut s = 0.0;
            for i in 0..k { for j in 0..k - i { let w = [(i as f64 + 1.0 / 3.0) / k as f64, (j as f64 + 1.0 / 3.0) / k as f64]; 
                let p = Point3::weighted(from.triangle(f), [1.0 - w[0] - w[1], w[0], w[1]]);
                let d = near.closest(to, p).unwrap().distance; s += d * d; cnt += 1.0; most = most.max(d); } }
            sum += a * s / cnt; area += a;
        }
        ((sum / area).sqrt(), most)
    };
    let d = input.surface.bounds().diagonal();
    let (a, b) = (one(&ours, &input.surface), one(&input.surface, &ours));
    println!("rms {:.3e} {:.3e} hausdorff {:.3e} {:.3e} (of diagonal)", a.0 / d, b.0 / d, a.1 / d, b.1 / d);
    if let Some(out) = args.get(4) { voronaut::output::write_mesh(&meshed.mesh, std::path::Path::new(out)).unwrap(); }
}
