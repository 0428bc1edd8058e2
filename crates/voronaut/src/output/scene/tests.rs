//! Pictures of scenes as wholes.
use super::*;
use crate::surface;

const SPOTS: [&str; 5] = ["../../data/spot.obj", "../../data/bob_small.obj", "chair", "torus:2,0.7", "sphere:1"];

#[test]
#[ignore]
fn look() {
    let out = std::env::var("LOOK").unwrap();
    for (spec, name) in SPOTS.iter().zip(["spot", "bob", "chair", "torus", "sphere"]) {
        let Ok(input) = surface::read(spec, None) else { continue };
        let s = &input.surface;
        let t = s.topology();
        let positions = s.positions();
        let used: Vec<u32> = t.vertices().map(|v| v.0).collect();
        let mut r = 12345_u64;
        let seeds: Vec<Point3> = (0..150).map(|_| { r = r.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); positions[used[(r >> 33) as usize % used.len()] as usize] }).collect();
        let colours: Vec<Option<u32>> = positions.iter().map(|p| (0..seeds.len()).min_by(|&a, &b| p.distance(seeds[a]).total_cmp(&p.distance(seeds[b]))).map(|i| i as u32)).collect();
        let triangles: Vec<[u32; 3]> = t.faces().map(|f| t.corners(f).map(|v| v.0)).collect();
        let view = View::of(s.bounds());
        let clock = std::time::Instant::now();
        let canvas = Scene::of_canvas(positions, &triangles, &colours).with(seeds.iter().map(|&p| vec![p]), Stroke::Seed);
        let mesh = crate::mesh::Mesh { points: positions.iter().map(|p| p.to_array()).collect(), triangles: triangles.clone(), ..Default::default() };
        for (kind, scene) in [("canvas", canvas), ("plain", Scene::of_surface(s)), ("mesh", Scene::of_mesh(&mesh, crate::output::Shade::Size))] {
            let svg = draw_surface(&scene, &view).unwrap();
            println!("{name} {kind} {} triangles {} bytes {:?}", triangles.len(), svg.len(), clock.elapsed());
            crate::output::write_picture(&svg, std::path::Path::new(&format!("{out}/{name}-{kind}.svg"))).unwrap();
            crate::output::write_picture(&svg, std::path::Path::new(&format!("{out}/{name}-{kind}.png"))).unwrap();
        }
    }
}
