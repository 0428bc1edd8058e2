//! VTK's XML format for unstructured grids (`.vtu`), with its arrays raw and appended: exact, compact, quick to read.

use super::Fields;
use crate::mesh::Mesh;
use std::io::{self, Write};

/// VTK's cell types.
pub(crate) const LINE: u8 = 3;
pub(crate) const POLY_LINE: u8 = 4;
const TRIANGLE: u8 = 5;

pub(crate) const LABEL: &str = r#"<DataArray type="Int32" Name="label""#;

/// Writes a mesh as a `.vtu` file.
///
/// # Errors
/// What `out` says.
pub(crate) fn write(mesh: &Mesh, _fields: &Fields, out: &mut dyn Write) -> io::Result<()> {
    let mut file = Appended::default();
    let points = file.array(LABEL, &bytes(labels(&mesh.point_labels, mesh.points.len()), i32::to_le_bytes));
    out.write_all(&file.finish_mesh(&points, mesh))
}

/// What an unstructured grid consists of.
pub(crate) struct Cells<'a> {
    pub(crate) points: &'a [[f64; 3]],
    pub(crate) triangles: &'a [[u32; 3]],
    pub(crate) lines: Vec<&'a [u32]>,
    /// The type of the lines' cells.
    pub(crate) line: u8,
}

/// The raw section of the file: each array behind its length in bytes.
#[derive(Default)]
pub(crate) struct Appended {
    data: Vec<u8>,
}

impl Appended {
    /// Appends an array and gives the element that refers to it.
    pub(crate) fn array(&mut self, element: &str, bytes: &[u8]) -> String {
        let offset = self.data.len();
        self.data.extend((bytes.len() as u64).to_le_bytes());
        self.data.extend(bytes);
        format!("        {element} format=\"appended\" offset=\"{offset}\"/>\n")
    }

    /// The file of a mesh, with the elements of point data that are appended already.
    pub(crate) fn finish_mesh(mut self, points: &str, mesh: &Mesh) -> Vec<u8> {
        let cells = self.array(LABEL, &bytes(cell_labels(mesh), i32::to_le_bytes));
        let lines: Vec<&[u32]> = mesh.edges.iter().map(<[u32; 2]>::as_slice).collect();
        self.finish([points, &cells], &Cells { points: &mesh.points, triangles: &mesh.triangles, lines, line: LINE })
    }

    /// The file, with the elements of point and cell data that are appended already.
    pub(crate) fn finish(mut self, [point_data, cell_data]: [&str; 2], cells: &Cells) -> Vec<u8> {
        let positions = r#"<DataArray type="Float64" Name="Points" NumberOfComponents="3""#;
        let points = self.array(positions, &bytes(cells.points.iter().flatten().copied(), f64::to_le_bytes));
        let connectivity = bytes(cells.connectivity(), i64::to_le_bytes);
        let cell_arrays = [
            self.array(r#"<DataArray type="Int64" Name="connectivity""#, &connectivity),
            self.array(r#"<DataArray type="Int64" Name="offsets""#, &bytes(cells.offsets(), i64::to_le_bytes)),
            self.array(r#"<DataArray type="UInt8" Name="types""#, &cells.types()),
        ]
        .concat();
        let (count, number) = (cells.points.len(), cells.triangles.len() + cells.lines.len());
        let head = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             \x20 <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{number}\">\n\
             \x20     <PointData>\n{point_data}      </PointData>\n\
             \x20     <CellData Scalars=\"label\">\n{cell_data}      </CellData>\n\
             \x20     <Points>\n{points}      </Points>\n      <Cells>\n{cell_arrays}      </Cells>\n\
             \x20   </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_"
        );
        [head.as_bytes(), &self.data, b"\n  </AppendedData>\n</VTKFile>\n"].concat()
    }
}

impl Cells<'_> {
    fn connectivity(&self) -> impl Iterator<Item = i64> {
        let lines = self.lines.iter().copied().flatten();
        self.triangles.as_flattened().iter().chain(lines).copied().map(i64::from)
    }

    /// Where each cell ends in the connectivity.
    fn offsets(&self) -> impl Iterator<Item = i64> {
        let sizes =
            self.triangles.iter().map(|_| 3).chain(self.lines.iter().map(|line| line.len().cast_signed() as i64));
        sizes.scan(0, |end, size| {
            *end += size;
            Some(*end)
        })
    }

    fn types(&self) -> Vec<u8> {
        [vec![TRIANGLE; self.triangles.len()], vec![self.line; self.lines.len()]].concat()
    }
}

pub(crate) fn bytes<T, const N: usize>(
    values: impl IntoIterator<Item = T>,
    to_bytes: impl Fn(T) -> [u8; N],
) -> Vec<u8> {
    values.into_iter().flat_map(to_bytes).collect()
}

/// So many labels, 0 where there are none.
pub(crate) fn labels(labels: &[i32], count: usize) -> impl Iterator<Item = i32> {
    labels.iter().copied().chain(std::iter::repeat(0)).take(count)
}

fn cell_labels(mesh: &Mesh) -> impl Iterator<Item = i32> {
    labels(&mesh.triangle_labels, mesh.triangles.len()).chain(labels(&mesh.edge_labels, mesh.edges.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_lie_where_the_header_says() {
        let mesh = Mesh {
            points: vec![[0.0, 0.5, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
            point_labels: vec![3, 4, 5],
            triangles: vec![[0, 1, 2]],
            triangle_labels: vec![-1],
            edges: vec![[2, 0]],
            edge_labels: vec![9],
            ..Mesh::default()
        };
        let mut file = Vec::new();
        write(&mesh, &Fields::default(), &mut file).unwrap();
        let raw = file.windows(2).position(|pair| pair == b"\n_").unwrap() + 2;
        let head = std::str::from_utf8(&file[..raw]).unwrap();
        let array = |index: usize| {
            let offset: usize =
                head.split("offset=\"").nth(index + 1).unwrap().split('"').next().unwrap().parse().unwrap();
            let size = u64::from_le_bytes(file[raw + offset..][..8].try_into().unwrap()) as usize;
            &file[raw + offset + 8..][..size]
        };
        assert_eq!(array(0), bytes([3, 4, 5], i32::to_le_bytes));
        assert_eq!(array(1), bytes([-1, 9], i32::to_le_bytes));
        assert_eq!(array(2)[8..16], 0.5_f64.to_le_bytes());
        assert_eq!(array(3), bytes([0, 1, 2, 2, 0], i64::to_le_bytes));
        assert_eq!(array(4), bytes([3, 5], i64::to_le_bytes));
        assert_eq!(array(5), [5, 3]);
        assert!(file.ends_with(b"</VTKFile>\n"));
    }
}
