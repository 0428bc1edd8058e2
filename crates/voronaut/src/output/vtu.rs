//! What VTK's `.vtu` files hold besides meshes: coloured canvases, and duals with geodesic edges.

use crate::formats::vtk::{Appended, Cells, LABEL, POLY_LINE, bytes, labels};
use crate::mesh::Mesh;
use crate::realisation::Realisation;

const COLOUR: &str = r#"<DataArray type="Int32" Name="colour""#;
const SEEDS: &str = r#"<DataArray type="Int32" Name="seeds" NumberOfComponents="3""#;

/// A canvas with its distances: point data `colour` and `distance`.
pub(super) fn diagram(canvas: &Mesh, distances: &[f64]) -> Vec<u8> {
    let mut file = Appended::default();
    let mut points = file.array(COLOUR, &bytes(labels(&canvas.point_labels, canvas.points.len()), i32::to_le_bytes));
    let distance = r#"<DataArray type="Float64" Name="distance""#;
    points += &file.array(distance, &bytes(distances.iter().copied(), f64::to_le_bytes));
    file.finish_mesh(&points, canvas)
}

/// A realisation as the bytes of a `.vtu` file: the triangles that its regions are cut into, then its edges as polyline
/// cells; cell data `label`, `seeds` and `length`.
pub(super) fn curved(realisation: &Realisation) -> Vec<u8> {
    let (mesh, lines) = (realisation.to_mesh(), realisation.lines());
    let edges = &realisation.edges;
    let labels = mesh.triangle_labels.iter().copied().chain((1..).take(edges.len()));
    let of_triangles = mesh.triangle_labels.iter().map(|&label| realisation.triangles[label as usize - 1]);
    let seeds = of_triangles.map(|t| t.map(u32::cast_signed));
    let seeds = seeds.chain(edges.iter().map(|e| [e.ends[0].cast_signed(), e.ends[1].cast_signed(), -1]));
    let lengths = mesh.triangles.iter().map(|_| 0.0).chain(edges.iter().map(|e| e.length));
    let mut file = Appended::default();
    let points = file.array(LABEL, &bytes(mesh.point_labels.iter().copied(), i32::to_le_bytes));
    let cells = [
        file.array(LABEL, &bytes(labels, i32::to_le_bytes)),
        file.array(SEEDS, &bytes(seeds.flatten(), i32::to_le_bytes)),
        file.array(r#"<DataArray type="Float64" Name="length""#, &bytes(lengths, f64::to_le_bytes)),
    ];
    let lines = lines.iter().map(Vec::as_slice).collect();
    let all = Cells { points: &mesh.points, triangles: &mesh.triangles, lines, line: POLY_LINE };
    file.finish([&points, &cells.concat()], &all)
}
