//! Curved meshes: what there is of them, and what there is not.

use crate::options::{Outputs, Show, refuse};
use voronaut::mesh::{Edges, Mesh};
use voronaut::{Error, Result};
use voronaut_io::Report;

/// Refuses pictures that are of straight edges.
pub(crate) fn demand_drawable(outputs: &Outputs) -> Result<()> {
    let pictures = [
        (outputs.histograms.is_some(), "--histograms", "leave out --histograms"),
        (outputs.shows(Show::Unmet), "--show unmet", "show mesh or ellipses"),
        (outputs.need_diagram(), "--show of cells and of what belongs to them", "show mesh or ellipses"),
        (outputs.shows(Show::Protection), "--show protection", "show mesh or ellipses"),
    ];
    refuse(pictures.map(|(is_asked, what, help)| (is_asked, format!("{what} with curved triangles"), help)))
}

/// Refuses a mesh of another order than was asked for: it is never flattened without a word.
pub(crate) fn demand_made(mesh: &Mesh, order: usize) -> Result<()> {
    let found = order_of(mesh);
    if found == order {
        return Ok(());
    }
    Err(Error::unsupported(format!("a mesh of order {order} (one of order {found} was made)"), "use `order` 1"))
}

/// The order of a mesh's triangles.
pub(crate) fn order_of(mesh: &Mesh) -> usize {
    mesh.curved.as_ref().map_or(1, |curved| curved.order)
}

/// The polygons between the boundary vertices of a mesh. Straight triangles between the corners of curved ones may overlap.
pub(crate) fn outline(mesh: &Mesh) -> Mesh {
    let edges = Edges::of(&mesh.triangles).boundary().map(|side| side.ends).collect();
    Mesh { points: mesh.points.clone(), edges, ..Mesh::default() }
}

/// Says in a report what curves a mesh has.
pub(crate) fn report(report: &mut Report, mesh: &Mesh) {
    let counts = mesh.curved.as_ref().map(|curved| [("order", curved.order), ("nodes", curved.nodes.len())]);
    report.curved = counts.map(|counts| counts.into_iter().collect());
    if counts.is_some() && !mesh.is_planar() {
        let note =
            "lengths and shapes are of straight triangles between the vertices, and so are distances but `curved` ones";
        report.notes.push(note.into());
    }
}
