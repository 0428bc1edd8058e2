//! Files with their arrays raw and appended: exact, compact, quick to read. Arrays go out one after the other; only their sizes
//! have to be known before.

use super::cells::types;
use crate::document::distinct_names;
use crate::{Field, Fields};
use std::io::{self, Write};
use voronaut::mesh::{Mesh, SolutionValues};

/// A type of numbers that arrays are written of, least byte first.
pub(crate) trait Number: Copy {
    /// What VTK calls it.
    const NAME: &str;
    /// In bytes.
    const SIZE: usize;

    /// Appends its bytes.
    fn put(self, bytes: &mut Vec<u8>);
}

macro_rules! numbers {
    ($($number:ty: $name:literal),*) => {$(
        impl Number for $number {
            const NAME: &str = $name;
            const SIZE: usize = size_of::<$number>();

            fn put(self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }
        }
    )*};
}

numbers!(u8: "UInt8", i32: "Int32", i64: "Int64", f64: "Float64");

type WriteOnce<'a> = dyn FnOnce(&mut dyn Write) -> io::Result<()> + 'a;

/// An array, and how its numbers are written.
pub(crate) struct Array<'a> {
    /// Its tag, up to the format.
    tag: String,
    bytes: u64,
    write: Box<WriteOnce<'a>>,
}

impl<'a> Array<'a> {
    /// An array of entries of so many numbers each.
    pub(crate) fn new<T: Number>(name: &str, components: usize, numbers: impl Iterator<Item = T> + Clone + 'a) -> Self {
        let bytes = (numbers.clone().count() * T::SIZE) as u64;
        let components = if components == 1 { String::new() } else { format!(" NumberOfComponents=\"{components}\"") };
        let tag = format!("<DataArray type=\"{}\" Name=\"{}\"{components}", T::NAME, escaped(name));
        Self { tag, bytes, write: Box::new(|out| write_numbers(numbers, out)) }
    }

    /// Bytes with the size before the numbers.
    fn length(&self) -> u64 {
        size_of::<u64>() as u64 + self.bytes
    }
}

/// A name as the value of an attribute. Control characters, which XML does not have, are replaced.
fn escaped(name: &str) -> String {
    let kept = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    quick_xml::escape::escape(name.chars().map(kept).collect::<String>()).into_owned()
}

fn write_numbers<T: Number>(numbers: impl Iterator<Item = T>, out: &mut dyn Write) -> io::Result<()> {
    const CHUNK: usize = 1 << 16;
    let mut bytes = Vec::with_capacity(CHUNK + T::SIZE);
    for number in numbers {
        number.put(&mut bytes);
        if bytes.len() >= CHUNK {
            out.write_all(&bytes)?;
            bytes.clear();
        }
    }
    out.write_all(&bytes)
}

/// What a file holds.
pub(crate) struct Grid<'a> {
    pub(crate) points: &'a [[f64; 3]],
    pub(crate) triangles: &'a [[u32; 3]],
    pub(crate) lines: Vec<&'a [u32]>,
    /// The type of the lines' cells in a `.vtu` file.
    pub(crate) line: u8,
    /// Of the points.
    pub(crate) point_data: Vec<Array<'a>>,
    /// Of the cells: triangles, then lines in a `.vtu` file, and the other way round in a `.vtp` file.
    pub(crate) cell_data: Vec<Array<'a>>,
}

impl<'a> Grid<'a> {
    /// Writes the grid as a `.vtu` file.
    ///
    /// # Errors
    /// What `out` says.
    pub(crate) fn write_unstructured(self, out: &mut dyn Write) -> io::Result<()> {
        let cells = self.triangles.len() + self.lines.len();
        let counts = format!("NumberOfPoints=\"{}\" NumberOfCells=\"{cells}\"", self.points.len());
        let all = self.triangles.iter().map(<[u32; 3]>::as_slice).chain(self.lines.clone());
        let kinds = std::iter::repeat_n(types::TRIANGLE, self.triangles.len());
        let kinds = kinds.chain(std::iter::repeat_n(self.line, self.lines.len()));
        let mut arrays = connections(all);
        arrays.push(Array::new("types", 1, kinds));
        self.write("UnstructuredGrid", &counts, vec![("Cells", arrays)], out)
    }

    /// Writes the grid as a `.vtp` file.
    ///
    /// # Errors
    /// What `out` says.
    pub(crate) fn write_poly_data(self, out: &mut dyn Write) -> io::Result<()> {
        let (points, lines, triangles) = (self.points.len(), self.lines.len(), self.triangles.len());
        let counts = format!(
            "NumberOfPoints=\"{points}\" NumberOfVerts=\"0\" NumberOfLines=\"{lines}\" NumberOfStrips=\"0\" \
             NumberOfPolys=\"{triangles}\""
        );
        let lines = connections(self.lines.clone().into_iter());
        let triangles = connections(self.triangles.iter().map(<[u32; 3]>::as_slice));
        self.write("PolyData", &counts, vec![("Lines", lines), ("Polys", triangles)], out)
    }

    fn write(
        self,
        kind: &str,
        counts: &str,
        cells: Vec<(&str, Vec<Array<'a>>)>,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        let points = Array::new("Points", 3, self.points.iter().flatten().copied());
        let mut sections = vec![("PointData", self.point_data), ("CellData", self.cell_data), ("Points", vec![points])];
        sections.extend(cells);
        write!(
            out,
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             \x20 <{kind}>\n    <Piece {counts}>\n"
        )?;
        // The last array stands first: meshio (5.3.5) gives arrays that it has read new offsets and takes the first tag with the
        // offset it looks for; so tags before that one must be of arrays it has not read.
        let mut offset: u64 = sections.iter().flat_map(|(_, arrays)| arrays).map(Array::length).sum();
        for (section, arrays) in &sections {
            // Labels are what is shown first.
            let shown = if *section == "CellData" { " Scalars=\"label\"" } else { "" };
            writeln!(out, "      <{section}{shown}>")?;
            for array in arrays {
                offset -= array.length();
                writeln!(out, "        {} format=\"appended\" offset=\"{offset}\"/>", array.tag)?;
            }
            writeln!(out, "      </{section}>")?;
        }
        write!(out, "    </Piece>\n  </{kind}>\n  <AppendedData encoding=\"raw\">\n_")?;
        for array in sections.into_iter().flat_map(|(_, arrays)| arrays).rev() {
            out.write_all(&array.bytes.to_le_bytes())?;
            (array.write)(out)?;
        }
        out.write_all(b"\n  </AppendedData>\n</VTKFile>\n")
    }
}

/// The vertices of cells, and where each cell ends among them.
fn connections<'a>(cells: impl Iterator<Item = &'a [u32]> + Clone + 'a) -> Vec<Array<'a>> {
    let ends = cells.clone().scan(0, |end, cell| {
        *end += cell.len().cast_signed() as i64;
        Some(*end)
    });
    let vertices = cells.flatten().copied().map(i64::from);
    vec![Array::new("connectivity", 1, vertices), Array::new("offsets", 1, ends)]
}

/// So many labels, 0 where there are none.
pub(crate) fn labels(labels: &[i32], count: usize) -> impl Iterator<Item = i32> + Clone {
    labels.iter().copied().chain(std::iter::repeat(0)).take(count)
}

/// Which cells come first.
#[derive(Clone, Copy)]
pub(super) enum First {
    Triangles,
    Lines,
}

/// A mesh with all it holds, and fields; its edges as lines.
pub(super) fn grid<'a>(mesh: &'a Mesh, fields: &'a Fields, first: First) -> Grid<'a> {
    let order = Order { triangles: mesh.triangles.len(), edges: mesh.edges.len(), first };
    let lines = mesh.edges.iter().map(<[u32; 2]>::as_slice).collect();
    let is_planar = mesh.is_planar();
    let point_data = point_data(mesh, &fields.vertices, is_planar);
    let cell_data = cell_data(mesh, &fields.triangles, is_planar, order);
    Grid { points: &mesh.points, triangles: &mesh.triangles, lines, line: types::LINE, point_data, cell_data }
}

fn point_data<'a>(mesh: &'a Mesh, fields: &'a [Field], is_planar: bool) -> Vec<Array<'a>> {
    let count = mesh.points.len();
    let mut arrays = vec![Array::new("label", 1, labels(&mesh.point_labels, count))];
    for (name, marked) in [("corner", &mesh.corners), ("required", &mesh.required_points)] {
        if !marked.is_empty() {
            arrays.push(Array::new(name, 1, marks(marked, count).into_iter()));
        }
    }
    arrays.extend(fields.iter().zip(names(fields)).map(|(field, name)| {
        let (values, width) = (&field.values, width(&field.values, is_planar));
        let numbers = (0..count * width).map(move |i| number(values, i / width, i % width));
        Array::new(&name, width, numbers)
    }));
    arrays
}

fn cell_data<'a>(mesh: &'a Mesh, fields: &'a [Field], is_planar: bool, order: Order) -> Vec<Array<'a>> {
    let label = |labels: &[i32], i: usize| labels.get(i).copied().unwrap_or(0);
    let labels = order.cells().map(move |cell| match cell {
        Cell::Triangle(i) => label(&mesh.triangle_labels, i),
        Cell::Edge(i) => label(&mesh.edge_labels, i),
    });
    let mut arrays = vec![Array::new("label", 1, labels)];
    let none = &Vec::new();
    for (name, of_triangles, of_edges) in
        [("required", &mesh.required_triangles, &mesh.required_edges), ("ridge", none, &mesh.ridges)]
    {
        if !(of_triangles.is_empty() && of_edges.is_empty()) {
            let (of_triangles, of_edges) = (marks(of_triangles, order.triangles), marks(of_edges, order.edges));
            let all = order.cells().map(move |cell| match cell {
                Cell::Triangle(i) => of_triangles[i],
                Cell::Edge(i) => of_edges[i],
            });
            arrays.push(Array::new(name, 1, all));
        }
    }
    arrays.extend(fields.iter().zip(names(fields)).map(|(field, name)| {
        let (values, width) = (&field.values, width(&field.values, is_planar));
        let numbers = order.cells().flat_map(move |cell| {
            (0..width).map(move |k| match cell {
                Cell::Triangle(i) => number(values, i, k),
                Cell::Edge(_) => f64::NAN,
            })
        });
        Array::new(&name, width, numbers)
    }));
    arrays
}

/// What the arrays of fields are called: not as labels and marks are.
fn names(fields: &[Field]) -> Vec<String> {
    distinct_names(fields.iter().map(|field| field.name.clone()), &["label", "corner", "required", "ridge"])
}

/// Cells in their order.
#[derive(Clone, Copy)]
struct Order {
    triangles: usize,
    edges: usize,
    first: First,
}

#[derive(Clone, Copy)]
enum Cell {
    Triangle(usize),
    Edge(usize),
}

impl Order {
    fn cells(self) -> impl Iterator<Item = Cell> + Clone {
        (0..self.triangles + self.edges).map(move |i| match self.first {
            First::Triangles if i < self.triangles => Cell::Triangle(i),
            First::Triangles => Cell::Edge(i - self.triangles),
            First::Lines if i < self.edges => Cell::Edge(i),
            First::Lines => Cell::Triangle(i - self.edges),
        })
    }
}

/// 1 of those that are listed, 0 of others.
fn marks(listed: &[u32], count: usize) -> Vec<u8> {
    let mut marks = vec![0; count];
    for &i in listed {
        marks[i as usize] = 1;
    }
    marks
}

/// Numbers of an entry in the file: tensors are whole matrices, and vectors of a plane get a third coordinate, for VTK has but
/// vectors of three.
fn width(values: &SolutionValues, is_planar: bool) -> usize {
    match values {
        SolutionValues::Tensor(_) | SolutionValues::Tensor3(_) => 9,
        SolutionValues::Vector { components: 2, .. } if is_planar => 3,
        others => others.components(),
    }
}

/// Number `k` of entry `i` in the file.
fn number(values: &SolutionValues, i: usize, k: usize) -> f64 {
    const IN_SPACE: [usize; 9] = [0, 1, 3, 1, 2, 4, 3, 4, 5];
    const IN_PLANE: [usize; 9] = [0, 1, 3, 1, 2, 3, 3, 3, 3];
    let place = match values {
        SolutionValues::Tensor(_) => IN_PLANE[k],
        SolutionValues::Tensor3(_) => IN_SPACE[k],
        _ => k,
    };
    values.row(i).get(place).copied().unwrap_or(0.0)
}
