//! VTK's XML formats for triangles: unstructured grids (`.vtu`) and polygons (`.vtp`), those of VTK, `ParaView` and meshio.
//!
//! # What a file holds, and what becomes of it
//!
//! - Cells: triangles. Quadrilaterals, polygons and triangle strips are cut into triangles, the former along diagonals that suit
//!   them. Lines and polylines are the mesh's labelled edges. Vertices are passed over. Tetrahedra, voxels, hexahedra, wedges and
//!   pyramids are left out with a note; the mesh of a piece that has no flat cells is their boundary, with their labels and values, and
//!   where labels differ what is between them. Quadratic triangles and edges, and Lagrange triangles and curves of order 2 and 3, are
//!   a curved mesh; values on their inner nodes are left out. All others are refused.
//! - Labels: whole numbers on points and cells that are called `label`, `medit:ref`, `gmsh:physical`, `CellEntityIds`, `Material` or
//!   `ref`; where there are several, the first of this list.
//! - Marks: numbers of type `UInt8` called `corner` and `required` on points, `required` and `ridge` on cells; not 0 where it is so.
//!   They are this library's own.
//! - Fields: all other numbers on points and cells. Values on lines are passed over; triangles cut from a polygon repeat its values.
//!   Three numbers in a mesh with z = 0 are a vector of the plane if the third is 0 everywhere. Nine are a symmetric tensor, row
//!   by row, if they are symmetric everywhere, and one of the plane if the mesh has z = 0 and they say nothing of x z and y z; else
//!   they stay nine numbers. Six numbers stay six: VTK's order of a symmetric tensor, XX YY ZZ XY YZ XZ, is not Medit's, and nothing
//!   tells whether they are one.

mod assemble;
mod base64;
mod cells;
mod characters;
mod data;
mod grid;
mod stored;
mod tags;
#[cfg(test)]
mod tests;
mod write;

pub(crate) use cells::types::{LINE, POLY_LINE};
pub(crate) use write::{Array, Grid};

use super::curved::Elements;
use super::{Document, Fields};
use std::io::{self, BufRead, Write};
use voronaut::Result;
use voronaut::mesh::Mesh;
use write::Cells;

/// Reads a `.vtu` or a `.vtp` file: which one it is says the file itself.
///
/// Read are arrays as text, in base64 and raw, between the tags and appended, of both byte orders and sizes of heads, uncompressed
/// and compressed by zlib; all pieces, joined, in their order; of several time steps the first. Bytes of names that are not UTF-8
/// are Latin-1. The file is read in one pass, and never more of it is in memory than the arrays that are needed; no more is
/// decompressed than the counts of its pieces ask for.
///
/// # Errors
///
/// [`Error::Parse`](voronaut::Error::Parse) with array and byte of what is not as announced: a file cut off, arrays that are too long or
/// too short, begin elsewhere or hold what is no number, points and fields that are not finite, cells of points that do not exist,
/// pieces with different fields. [`Error::Unsupported`](voronaut::Error::Unsupported) of other types of files, of cells of other
/// types and of compressors but zlib. [`Error::Limit`](voronaut::Error::Limit) of data on polygons that would take far more memory than
/// the file. [`Error::Io`](voronaut::Error::Io) of a file that cannot be read.
pub fn read(source: impl BufRead, place: &str) -> Result<Document> {
    assemble::assemble(tags::read(source, place)?)
}

/// Writes a mesh with all it holds, and fields, as a `.vtu` file that [`read`] turns into the same, to the last bit: triangles, then
/// edges as lines. Lists of corners, ridges and what is required come back in ascending order.
///
/// Arrays are raw, appended, little-endian and uncompressed. Tensors are whole 3 x 3 matrices, with zeros for the third axis of
/// those of the plane; vectors of the plane have the third coordinate 0 in a mesh with z = 0. On lines, where fields have no
/// values, they are NaN. Missing labels are written as 0.
///
/// Of a curved mesh cells are quadratic, or Lagrange's of order 3, and points are its vertices and then its nodes, with label 0 and
/// values between those at vertices.
///
/// # Errors
/// What `out` says; labelled edges of a curved mesh that no triangle has.
pub fn write_vtu(mesh: &Mesh, fields: &Fields, out: &mut dyn Write) -> io::Result<()> {
    let elements = Elements::new(mesh)?;
    let (cells, fields) = (Cells::new(mesh, &elements), elements.fields(fields));
    cells.grid(&fields, [0, mesh.triangles.len()]).write_unstructured(out)
}

/// As [`write_vtu`], as a `.vtp` file: edges as lines, then triangles as polygons. It has no place for curves: their corners are written.
///
/// # Errors
/// What `out` says.
pub fn write_vtp(mesh: &Mesh, fields: &Fields, out: &mut dyn Write) -> io::Result<()> {
    let elements = Elements::of_corners(mesh);
    Cells::new(mesh, &elements).grid(fields, [mesh.edges.len(), 0]).write_poly_data(out)
}
