//! Remeshes a surface by its curvature, with vertices where mesh and surface are closest: `cargo run --release --example surface --
//! data/spot.obj spot.obj`.

use voronaut::manifold::surface::metric::{Spec, field};
use voronaut::manifold::surface::{FeatureOptions, RepairOptions};
use voronaut::metric::Bounds;
use voronaut::progress::Silent;
use voronaut::recipe::{self, MeshOptions};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [from, to] = &words[..] else { return Err("surface FROM TO".into()) };
    let (surface, mended) = voronaut_io::read_surface(from, RepairOptions::default())?;
    mended.sentences().for_each(|sentence| eprintln!("note: {sentence}"));

    // Creases, borders and labels stay.
    let patches = surface.cut(&FeatureOptions::default())?;
    let curvature = field(&Spec::Curvature(None), &patches, Bounds::default())?;
    let options = MeshOptions { vertices: Some(1000), fit: true, ..MeshOptions::default() };
    let meshed = recipe::mesh_surface(&patches, curvature.as_ref(), None, &options, &Silent)?;
    let fidelity = meshed.fidelity.ok_or("a fitted mesh is measured")?;
    println!("{} vertices, RMS distance {:.1e} of the diagonal", meshed.mesh.points.len(), fidelity.both.rms_share);
    Ok(voronaut_io::write_mesh(&meshed.mesh, to.as_ref())?)
}
