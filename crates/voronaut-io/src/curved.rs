//! What VTK's `.vtu` files hold besides meshes: coloured canvases, and duals with geodesic edges.

use crate::document::labels;
use crate::vtk::{Array, Grid, LINE, POLY_LINE};
use std::io::{self, Write};
use voronaut::mesh::Mesh;
use voronaut::realisation::Realisation;

/// Writes a canvas with its distances: point data `colour` and `distance`.
pub(super) fn write_diagram(canvas: &Mesh, distances: &[f64], out: &mut dyn Write) -> io::Result<()> {
    let lines: Vec<&[u32]> = canvas.edges.iter().map(<[u32; 2]>::as_slice).collect();
    let cells = labels(&canvas.triangle_labels).take(canvas.triangles.len());
    let cells = cells.chain(labels(&canvas.edge_labels).take(lines.len()));
    let colours = labels(&canvas.point_labels).take(canvas.points.len());
    let grid = Grid {
        points: &canvas.points,
        triangles: &canvas.triangles,
        lines,
        line: LINE,
        point_data: vec![Array::new("colour", 1, colours), Array::new("distance", 1, distances.iter().copied())],
        cell_data: vec![Array::new("label", 1, cells)],
    };
    grid.write_unstructured(out)
}

/// Writes a realisation as a `.vtu` file: the triangles that its regions are cut into, then its edges as polyline cells; cell
/// data `label`, `seeds` and `length`.
pub(super) fn write_curved(realisation: &Realisation, out: &mut dyn Write) -> io::Result<()> {
    let (mesh, lines) = (realisation.to_mesh(), realisation.lines());
    let edges = &realisation.edges;
    let cells = mesh.triangle_labels.iter().copied().chain((1..).take(edges.len()));
    let of_triangles = mesh.triangle_labels.iter().map(|&label| realisation.triangles[label as usize - 1]);
    let seeds = of_triangles.map(|t| t.map(u32::cast_signed));
    let seeds = seeds.chain(edges.iter().map(|e| [e.ends[0].cast_signed(), e.ends[1].cast_signed(), -1]));
    let lengths = mesh.triangles.iter().map(|_| 0.0).chain(edges.iter().map(|e| e.length));
    let grid = Grid {
        points: &mesh.points,
        triangles: &mesh.triangles,
        lines: lines.iter().map(Vec::as_slice).collect(),
        line: POLY_LINE,
        point_data: vec![Array::new("label", 1, mesh.point_labels.iter().copied())],
        cell_data: vec![
            Array::new("label", 1, cells),
            Array::new("seeds", 3, seeds.flatten()),
            Array::new("length", 1, lengths),
        ],
    };
    grid.write_unstructured(out)
}
