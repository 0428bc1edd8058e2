//! What `mesh` and `dual` have in common on surfaces: what is refused, drawn and written.

use crate::files;
use crate::options::{Outputs, Show};
use std::path::Path;
use voronaut::diagram::SurfaceDiagram;
use voronaut::geometry::Point3;
use voronaut::mesh::Mesh;
use voronaut::surface::{Input, Place};
use voronaut::triangulation::VertexId;
use voronaut::{Error, Result};
use voronaut_draw::{Scene, Shade, Stroke, View};
use voronaut_io::Report;

/// Writes a mesh, a picture of it and the report, each if it is wanted.
pub(crate) fn write(
    picture: Option<(&Path, String)>,
    outputs: &Outputs,
    mesh: &Mesh,
    out: &Path,
    report: &Report,
) -> Result<()> {
    voronaut_io::write_mesh(mesh, out)?;
    picture.map(|(path, svg)| files::write_picture(&svg, path)).transpose()?;
    files::write_report(outputs, report)
}

/// The vertices of a mesh on the surface.
pub(crate) fn places(input: &Input, mesh: &Mesh) -> Result<Vec<Place>> {
    mesh.points.iter().map(|&p| input.closest(p.into())).collect()
}

/// A mesh, the cells of its vertices, its edges as geodesics.
pub(crate) fn drawn(outputs: &Outputs, diagram: &SurfaceDiagram, mesh: &Mesh) -> Result<String> {
    let shows = |what| outputs.show.contains(&what);
    let draped = diagram.canvas().draped();
    let is_of_canvas = shows(Show::Cells) || shows(Show::Geodesics);
    let mut scene =
        if is_of_canvas { coloured(diagram, shows(Show::Cells)) } else { Scene::of_mesh(mesh, Shade::Size) };
    let edges = edges(mesh);
    if shows(Show::Geodesics) {
        scene = scene.with(edges.iter().filter_map(|&ends| geodesic(diagram, ends)), Stroke::Geodesic);
    } else if shows(Show::Mesh) && is_of_canvas {
        scene = scene.with(edges.iter().map(|ends| ends.map(|v| mesh.position(v)).to_vec()), Stroke::Edge);
    }
    let view = View { pixels: outputs.pixels, ..View::of(draped.input().surface.bounds()) };
    voronaut_draw::draw_surface(&scene, &view)
}

fn coloured(diagram: &SurfaceDiagram, are_cells: bool) -> Scene {
    let draped = diagram.canvas().draped();
    let vertices = || (0..diagram.vertex_count() as u32).map(VertexId);
    let positions: Vec<Point3> = vertices().map(|v| draped.position(v)).collect();
    let topology = draped.topology();
    let triangles: Vec<[u32; 3]> = topology.faces().map(|f| topology.corners(f).map(|v| v.0)).collect();
    let colours: Vec<Option<u32>> = vertices().map(|v| diagram.colour(v).filter(|_| are_cells)).collect();
    Scene::of_canvas(&positions, &triangles, &colours)
}

/// The edges of a mesh, in order, the smaller vertex first.
fn edges(mesh: &Mesh) -> Vec<[u32; 2]> {
    let sides = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut edges: Vec<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// The points of the geodesic between two seeds.
fn geodesic(diagram: &SurfaceDiagram, ends: [u32; 2]) -> Option<Vec<Point3>> {
    let [from, to] = ends.map(|colour| diagram.seed(colour));
    diagram.canvas().draped().geodesic(from?, to?).map(|way| way.points)
}

/// A mesh with the points of its geodesic edges behind the seeds, and their segments as edges, labelled with the number of the
/// edge from 1.
pub(crate) fn with_geodesics(diagram: &SurfaceDiagram, mesh: &Mesh) -> Mesh {
    let mut all = Mesh { edges: Vec::new(), edge_labels: Vec::new(), ..mesh.clone() };
    for (label, ends) in (1..).zip(edges(mesh)) {
        let Some(points) = geodesic(diagram, ends) else { continue };
        let mut before = ends[0];
        for p in &points[1..points.len() - 1] {
            all.points.push(p.to_array());
            all.point_labels.push(0);
            let here = all.points.len() as u32 - 1;
            all.edges.push([before, here]);
            before = here;
        }
        all.edges.push([before, ends[1]]);
        all.edge_labels.resize(all.edges.len(), label);
    }
    all
}

/// Refuses what is not there for surfaces.
pub(crate) fn demand_supported(outputs: &Outputs) -> Result<()> {
    let is_shown = |show: &Show| matches!(show, Show::Mesh | Show::Cells | Show::Geodesics);
    let refused = [
        (outputs.histograms.is_some(), "--histograms"),
        (outputs.window.is_some(), "--window"),
        (!outputs.show.iter().all(is_shown), "--show of anything but mesh, cells and geodesics"),
    ];
    refused.into_iter().find(|refused| refused.0).map_or(Ok(()), |(_, what)| Err(unsupported(what)))
}

pub(crate) fn unsupported(what: &str) -> Error {
    Error::Unsupported { what: format!("{what} on a surface"), help: format!("leave out {what}") }
}
