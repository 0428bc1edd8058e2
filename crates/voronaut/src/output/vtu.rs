//! VTK's XML format for unstructured grids (`.vtu`), with its arrays raw and appended: exact, compact, quick to read.

use crate::mesh::Mesh;

/// VTK's cell types.
const LINE: u8 = 3;
const TRIANGLE: u8 = 5;

/// A mesh as the bytes of a `.vtu` file: its triangles, then its labelled edges as line cells; point and cell data
/// `label`, and point data `distance` if given. Little endian on every machine.
pub(super) fn vtu(mesh: &Mesh, distances: Option<&[f64]>) -> Vec<u8> {
    let cells = mesh.triangles.len() + mesh.edges.len();
    let mut file = Appended::default();
    let label = r#"<DataArray type="Int32" Name="label""#;
    let points = format!(
        "      <PointData Scalars=\"label\">\n{}{}      </PointData>\n\
         \x20     <CellData Scalars=\"label\">\n{}      </CellData>\n\
         \x20     <Points>\n{}      </Points>\n",
        file.array(label, &bytes(labels(&mesh.point_labels, mesh.points.len()), i32::to_le_bytes)),
        distances.map_or_else(String::new, |distances| {
            let distance = r#"<DataArray type="Float64" Name="distance""#;
            file.array(distance, &bytes(distances.iter().copied(), f64::to_le_bytes))
        }),
        file.array(label, &bytes(cell_labels(mesh), i32::to_le_bytes)),
        file.array(
            r#"<DataArray type="Float64" Name="Points" NumberOfComponents="3""#,
            &bytes(mesh.points.iter().flatten().copied(), f64::to_le_bytes)
        ),
    );
    let cell_arrays = format!(
        "      <Cells>\n{}{}{}      </Cells>\n",
        file.array(r#"<DataArray type="Int64" Name="connectivity""#, &bytes(connectivity(mesh), i64::to_le_bytes)),
        file.array(r#"<DataArray type="Int64" Name="offsets""#, &bytes(offsets(mesh), i64::to_le_bytes)),
        file.array(r#"<DataArray type="UInt8" Name="types""#, &types(mesh)),
    );
    let count = mesh.points.len();
    let head = format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         \x20 <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{cells}\">\n\
         {points}{cell_arrays}    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_"
    );
    [head.as_bytes(), &file.data, b"\n  </AppendedData>\n</VTKFile>\n"].concat()
}

/// The raw section of the file: each array behind its length in bytes.
#[derive(Default)]
struct Appended {
    data: Vec<u8>,
}

impl Appended {
    /// Appends an array and gives the element that refers to it.
    fn array(&mut self, element: &str, bytes: &[u8]) -> String {
        let offset = self.data.len();
        self.data.extend((bytes.len() as u64).to_le_bytes());
        self.data.extend(bytes);
        format!("        {element} format=\"appended\" offset=\"{offset}\"/>\n")
    }
}

fn bytes<T, const N: usize>(values: impl IntoIterator<Item = T>, to_bytes: impl Fn(T) -> [u8; N]) -> Vec<u8> {
    values.into_iter().flat_map(to_bytes).collect()
}

/// So many labels, 0 where there are none.
fn labels(labels: &[i32], count: usize) -> impl Iterator<Item = i32> {
    labels.iter().copied().chain(std::iter::repeat(0)).take(count)
}

fn cell_labels(mesh: &Mesh) -> impl Iterator<Item = i32> {
    labels(&mesh.triangle_labels, mesh.triangles.len()).chain(labels(&mesh.edge_labels, mesh.edges.len()))
}

fn connectivity(mesh: &Mesh) -> impl Iterator<Item = i64> {
    mesh.triangles.as_flattened().iter().chain(mesh.edges.as_flattened()).copied().map(i64::from)
}

/// Where each cell ends in the connectivity.
fn offsets(mesh: &Mesh) -> impl Iterator<Item = i64> {
    let sizes = mesh.triangles.iter().map(|_| 3).chain(mesh.edges.iter().map(|_| 2));
    sizes.scan(0, |end, size| {
        *end += size;
        Some(*end)
    })
}

fn types(mesh: &Mesh) -> Vec<u8> {
    [vec![TRIANGLE; mesh.triangles.len()], vec![LINE; mesh.edges.len()]].concat()
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
        let file = vtu(&mesh, None);
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
