//! Files with their arrays raw and appended: exact, compact, quick to read. Arrays go out one after the other; only their sizes
//! have to be known before.

use super::cells::types;
use crate::codec::Number;
use crate::curved::{Elements, places};
use crate::document::{distinct_names, labels};
use crate::{Field, Fields};
use std::borrow::Cow;
use std::io::{self, Write};
use voronaut::mesh::Mesh;

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
        let bytes = (numbers.clone().count() * T::KIND.size()) as u64;
        let components = if components == 1 { String::new() } else { format!(" NumberOfComponents=\"{components}\"") };
        let tag = format!("<DataArray type=\"{}\" Name=\"{}\"{components}", T::KIND, escaped(name));
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
    let mut bytes = Vec::with_capacity(CHUNK + T::KIND.size());
    for number in numbers {
        number.put_bytes(&mut bytes);
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
    /// The points of all triangles, one triangle after the other.
    pub(crate) triangles: &'a [u32],
    /// The order of the triangles, 1 to 3.
    pub(crate) order: usize,
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
        let triangles = self.triangles();
        let cells = triangles.len() + self.lines.len();
        let counts = format!("NumberOfPoints=\"{}\" NumberOfCells=\"{cells}\"", self.points.len());
        let kinds = std::iter::repeat_n(types::TRIANGLES[self.order - 1], triangles.len());
        let all = triangles.chain(self.lines.clone());
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
        let (points, lines, triangles) = (self.points.len(), self.lines.len(), self.triangles().len());
        let counts = format!(
            "NumberOfPoints=\"{points}\" NumberOfVerts=\"0\" NumberOfLines=\"{lines}\" NumberOfStrips=\"0\" \
             NumberOfPolys=\"{triangles}\""
        );
        let lines = connections(self.lines.clone().into_iter());
        let triangles = connections(self.triangles());
        self.write("PolyData", &counts, vec![("Lines", lines), ("Polys", triangles)], out)
    }

    fn triangles(&self) -> std::slice::ChunksExact<'a, u32> {
        self.triangles.chunks_exact(places(self.order).len())
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

/// The cells of a mesh by their points.
pub(super) struct Cells<'a> {
    mesh: &'a Mesh,
    elements: &'a Elements<'a>,
    triangles: Cow<'a, [u32]>,
    edges: Cow<'a, [u32]>,
}

impl<'a> Cells<'a> {
    pub(super) fn new(mesh: &'a Mesh, elements: &'a Elements<'a>) -> Self {
        if elements.order == 1 {
            let [triangles, edges] = [mesh.triangles.as_flattened(), mesh.edges.as_flattened()].map(Cow::Borrowed);
            return Self { mesh, elements, triangles, edges };
        }
        let all = |dimension, count: usize| {
            let nodes = (0..count as u32).flat_map(|i| elements.nodes(dimension, &i).collect::<Vec<_>>());
            Cow::Owned(nodes.collect())
        };
        Self { mesh, elements, triangles: all(2, mesh.triangles.len()), edges: all(1, mesh.edges.len()) }
    }

    /// A mesh with all it holds, and fields; its edges as lines. `first`: the cells that the first triangle and the first edge are.
    pub(super) fn grid(&'a self, fields: &'a Fields, first: [usize; 2]) -> Grid<'a> {
        let (mesh, order, points) = (self.mesh, self.elements.order, &*self.elements.points);
        let is_planar = points.iter().all(|p| p[2] == 0.0);
        Grid {
            points,
            triangles: &self.triangles,
            order,
            lines: self.edges.chunks_exact(order + 1).collect(),
            line: types::EDGES[order - 1],
            point_data: point_data(mesh, points.len(), &fields.vertices, is_planar),
            cell_data: cell_data(mesh, &fields.triangles, is_planar, first),
        }
    }
}

fn point_data<'a>(mesh: &'a Mesh, count: usize, fields: &'a [Field], is_planar: bool) -> Vec<Array<'a>> {
    let marked = [("corner", &mesh.corners), ("required", &mesh.required_points)];
    let marked = marked.map(|(name, marked)| (name, marked.iter().map(|&i| i as usize).collect()));
    let label = Array::new(
        "label",
        1,
        labels(&mesh.point_labels[..mesh.points.len().min(mesh.point_labels.len())]).take(count),
    );
    let fields = field_arrays(fields, is_planar, (0..count).map(Some));
    std::iter::once(label).chain(mark_arrays(marked, count)).chain(fields).collect()
}

fn cell_data<'a>(mesh: &'a Mesh, fields: &'a [Field], is_planar: bool, first: [usize; 2]) -> Vec<Array<'a>> {
    let ([first_triangle, first_edge], triangles) = (first, mesh.triangles.len());
    let count = triangles + mesh.edges.len();
    // The triangle that each cell is, or else none.
    let triangles = (0..count).map(move |cell| cell.checked_sub(first_triangle).filter(|&i| i < triangles));
    let label = |labels: &[i32], i: usize| labels.get(i).copied().unwrap_or(0);
    let labels = triangles.clone().enumerate().map(move |(cell, triangle)| match triangle {
        Some(i) => label(&mesh.triangle_labels, i),
        None => label(&mesh.edge_labels, cell - first_edge),
    });
    let required = mesh.required_triangles.iter().map(|&i| first_triangle + i as usize);
    let of_edges = |marked: &[u32]| marked.iter().map(|&i| first_edge + i as usize).collect::<Vec<_>>();
    let required = required.chain(of_edges(&mesh.required_edges)).collect();
    let marks = mark_arrays([("required", required), ("ridge", of_edges(&mesh.ridges))], count);
    let fields = field_arrays(fields, is_planar, triangles);
    std::iter::once(Array::new("label", 1, labels)).chain(marks).chain(fields).collect()
}

/// Arrays that are 1 at what is listed and 0 elsewhere, where anything is.
fn mark_arrays(marked: [(&str, Vec<usize>); 2], count: usize) -> impl Iterator<Item = Array<'_>> {
    marked.into_iter().filter(|(_, listed)| !listed.is_empty()).map(move |(name, listed)| {
        let mut marks = vec![0_u8; count];
        for i in listed {
            marks[i] = 1;
        }
        Array::new(name, 1, marks.into_iter())
    })
}

/// The arrays of fields, by the entry that each point or cell has there; NaN where it has none.
fn field_arrays<'a>(
    fields: &'a [Field],
    is_planar: bool,
    entries: impl Iterator<Item = Option<usize>> + Clone + 'a,
) -> impl Iterator<Item = Array<'a>> {
    // Names are not those of labels and marks.
    let names =
        distinct_names(fields.iter().map(|field| field.name.clone()), &["label", "corner", "required", "ridge"]);
    fields.iter().zip(names).map(move |(field, name)| {
        let width = field.width(is_planar);
        let row =
            move |entry: Option<usize>| (0..width).map(move |k| entry.map_or(f64::NAN, |entry| field.number(entry, k)));
        Array::new(&name, width, entries.clone().flat_map(row))
    })
}
