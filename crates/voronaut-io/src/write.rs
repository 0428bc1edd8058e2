//! What is written, by the endings of names.

use super::codec::Form;
use super::document::labels;
use super::files::{ending, order};
use super::vtk::{Array, Grid, LINE, POLY_LINE};
use super::{Fields, Format, sol, write_with};
use std::io::{self, Write};
use std::path::Path;
use voronaut::mesh::{Mesh, Solution, Solutions};
use voronaut::realisation::Realisation;
use voronaut::{Error, Result};

/// Writes a mesh in the format its name ends in, as a whole or not at all.
///
/// # Errors
/// [`Error::Unsupported`] for other endings, and of curved triangles in formats that have no place for them, [`Error::Io`] where the file cannot be written.
pub fn write_mesh(mesh: &Mesh, path: &Path) -> Result<()> {
    write_document(mesh, &Fields::default(), path)
}

/// Writes a mesh and fields in the format its name ends in, as far as the format can hold them, as a whole or not at all.
///
/// # Errors
/// As of [`write_mesh`].
pub fn write_document(mesh: &Mesh, fields: &Fields, path: &Path) -> Result<()> {
    let format = Format::from_path(path)?;
    format.demand_order(order(mesh))?;
    write_with(path, |out| format.write(mesh, fields, out))
}

/// Writes a solution as text, or as a binary file if its name ends in `.solb`, as a whole or not at all.
///
/// # Errors
/// [`Error::Io`] where the file cannot be written, or the format cannot hold the values.
pub fn write_solution(solution: &Solution, path: &Path) -> Result<()> {
    write_with(path, |out| sol::write(solution, Form::of_solution(path), out))
}

/// As [`write_solution`], of any number of solutions.
///
/// # Errors
/// As of [`write_solution`].
pub fn write_solutions(solutions: &Solutions, path: &Path) -> Result<()> {
    write_with(path, |out| sol::write_all(solutions, Form::of_solution(path), out))
}

/// Writes a realisation of a dual with geodesic edges in the format its name ends in, as a whole or not at all: what
/// [`Realisation::to_mesh`] holds, in a `.vtu` with each edge as one polyline cell, and with cell data `label` (number of the
/// triangle or the edge, from 1), `seeds` (from 0; the third is -1 for edges) and `length` (0 for triangles).
///
/// # Errors
/// As for [`write_mesh`].
pub fn write_realisation<P: Copy + Into<[f64; 3]> + Send + Sync>(
    realisation: &Realisation<P>,
    path: &Path,
) -> Result<()> {
    match Format::from_path(path)? {
        Format::Vtu => write_with(path, |out| write_curved(realisation, out)),
        _ => write_mesh(&realisation.to_mesh(), path),
    }
}

/// Writes a coloured canvas as `.vtu`, as a whole or not at all: point data `colour` and `distance`.
///
/// # Errors
/// [`Error::Unsupported`] for other endings, [`Error::Io`] where the file cannot be written.
pub fn write_diagram(canvas: &Mesh, distances: &[f64], path: &Path) -> Result<()> {
    demand_diagram(path)?;
    write_with(path, |out| write_canvas(canvas, distances, out))
}

/// Refuses names that do not end like a diagram.
///
/// # Errors
/// [`Error::Unsupported`] for other endings than `.vtu`.
pub fn demand_diagram(path: &Path) -> Result<()> {
    if ending(path).as_deref() == Some("vtu") {
        return Ok(());
    }
    let what = format!("a diagram in {}", path.display());
    Err(Error::unsupported(what, "end the name of the diagram in .vtu"))
}

/// Writes a canvas with its distances: point data `colour` and `distance`.
fn write_canvas(canvas: &Mesh, distances: &[f64], out: &mut dyn Write) -> io::Result<()> {
    let lines: Vec<&[u32]> = canvas.edges.iter().map(<[u32; 2]>::as_slice).collect();
    let cells = labels(&canvas.triangle_labels).take(canvas.triangles.len());
    let cells = cells.chain(labels(&canvas.edge_labels).take(lines.len()));
    let colours = labels(&canvas.point_labels).take(canvas.points.len());
    let grid = Grid {
        points: &canvas.points,
        triangles: canvas.triangles.as_flattened(),
        order: 1,
        lines,
        line: LINE,
        point_data: vec![Array::new("colour", 1, colours), Array::new("distance", 1, distances.iter().copied())],
        cell_data: vec![Array::new("label", 1, cells)],
    };
    grid.write_unstructured(out)
}

/// Writes a realisation as a `.vtu` file: the triangles that its regions are cut into, then its edges as polyline cells; cell
/// data `label`, `seeds` and `length`.
fn write_curved<P: Copy + Into<[f64; 3]> + Send + Sync>(
    realisation: &Realisation<P>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let (mesh, lines) = (realisation.to_mesh(), realisation.lines());
    let edges = &realisation.edges;
    let cells = mesh.triangle_labels.iter().copied().chain((1..).take(edges.len()));
    let of_triangles = mesh.triangle_labels.iter().map(|&label| realisation.triangles[label as usize - 1]);
    let seeds = of_triangles.map(|t| t.map(u32::cast_signed));
    let seeds = seeds.chain(edges.iter().map(|e| [e.ends[0].cast_signed(), e.ends[1].cast_signed(), -1]));
    let lengths = mesh.triangles.iter().map(|_| 0.0).chain(edges.iter().map(|e| e.length));
    let grid = Grid {
        points: &mesh.points,
        triangles: mesh.triangles.as_flattened(),
        order: 1,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_name_formats() {
        let format = |name: &str| Format::from_path(Path::new(name));
        assert_eq!(format("a.b/c.MESH").unwrap(), Format::Medit(Form::Text));
        assert_eq!(format("c.vtu").unwrap(), Format::Vtu);
        for wrong in ["c.sol", "c", "", "mesh", "c.svg"] {
            let error = format(wrong).unwrap_err();
            assert!(error.help().contains(".mesh"), "{wrong}: {error}");
        }
    }

    #[test]
    fn surfaces_read_back_from_every_format_that_is_read() {
        let directory = tempfile::tempdir().unwrap();
        let mesh = voronaut::manifold::surface::torus(2.0, 0.7, 0.4).unwrap().to_mesh();
        for (ending, tolerance) in [
            ("mesh", 0.0),
            ("meshb", 0.0),
            ("msh", 0.0),
            ("vtu", 0.0),
            ("vtp", 0.0),
            ("obj", 0.0),
            ("off", 0.0),
            ("ply", 0.0),
            ("stl", 1e-6),
        ] {
            let path = directory.path().join(format!("torus.{ending}"));
            write_mesh(&mesh, &path).unwrap();
            let again = crate::read(&path).unwrap().mesh;
            assert_eq!((again.points.len(), again.triangles.len()), (mesh.points.len(), mesh.triangles.len()));
            for (&found, &truth) in again.triangles.iter().zip(&mesh.triangles) {
                for (p, q) in again.positions_of(found).into_iter().zip(mesh.positions_of(truth)) {
                    assert!(p.distance(q) <= tolerance, "{ending}: {p} {q}");
                }
            }
            if ending != "stl" {
                assert_eq!(again.triangles, mesh.triangles, "{ending}");
            }
            assert_eq!(again.triangle_labels[0], i32::from(ending != "off" && ending != "stl"), "{ending}");
        }
    }
}
