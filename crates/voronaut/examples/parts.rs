//! Writes parts with creases, fillets, borders and materials as Medit .mesh files into a directory:
//!
//! ```sh
//! cargo run --release --example parts -- DIRECTORY
//! ```
//!
//! They are what the tests of features mesh; the table in `src/tests/parts/mod.rs` says what each of them is.

#[path = "../src/tests/parts/mod.rs"]
mod parts;

use std::path::Path;
use voronaut_io::write_mesh;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Some(directory) = std::env::args().nth(1) else { return Err("give the directory to write into".into()) };
    for part in parts::all() {
        let path = Path::new(&directory).join(format!("{}.mesh", part.name));
        write_mesh(&part.mesh, &path)?;
        let (mesh, features) = (&part.mesh, &part.features);
        println!(
            "{}: {} vertices, {} triangles, {} chains of features, {} corners, curvature up to {}; {}, {} edges listed",
            path.display(),
            mesh.points.len(),
            mesh.triangles.len(),
            features.chains.len(),
            features.corners.len(),
            part.curvature,
            if part.is_labelled() { "labelled faces" } else { "one label" },
            mesh.edges.len(),
        );
    }
    Ok(())
}
