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
    if let Some(out) = args.get(4) { voronaut::output::write_mesh(&meshed.mesh, std::path::Path::new(out)).unwrap(); }
}
