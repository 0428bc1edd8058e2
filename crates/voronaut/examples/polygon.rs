//! Meshes a polygon with a hole by a metric of our own: `cargo run --release --example polygon`.

use voronaut::geometry::{Point, Tensor};
use voronaut::manifold::domain::{Domain, Polygon, Polygons, Ring, from_polygons};
use voronaut::progress::Silent;
use voronaut::recipe::{self, MeshOptions};

fn main() -> voronaut::Result<()> {
    let ring =
        |corners: &[[f64; 2]], label| Ring { points: corners.iter().map(|&[x, y]| Point::new(x, y)).collect(), label };
    let plate = ring(&[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]], 1);
    let hole = ring(&[[1.0, 0.5], [2.0, 0.5], [2.0, 1.5], [1.0, 1.5]], 2);
    let polygons = vec![Polygon { feature: 1, number: 1, region: 1, rings: vec![plate, hole] }];
    let domain = Domain::new(&from_polygons(&Polygons { polygons })?)?;

    // Edges of length 0.5 along the bottom; across it 0.01 there, more above.
    let layer = |p: Point| {
        let across = 0.01 + 0.3 * p.y;
        Tensor::new(1.0 / (0.5 * 0.5), 0.0, 1.0 / (across * across))
    };
    let options = MeshOptions { vertices: Some(2000), ..MeshOptions::default() };
    let mesh = recipe::mesh(&domain, &layer, &options, &Silent)?.mesh;
    println!("{} vertices, {} triangles", mesh.points.len(), mesh.triangles.len());
    voronaut_io::write_mesh(&mesh, "plate.mesh".as_ref())
}
