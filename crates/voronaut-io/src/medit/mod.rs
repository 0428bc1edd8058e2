//! Medit's formats for meshes (Frey, INRIA RT-0253; libMeshb): `.mesh` as text and `.meshb` as binary files, those of mmg,
//! refine, bamg and `FreeFEM`.

mod curved;
mod sections;

pub use super::codec::Form;
use sections::{KEYWORDS, READ};
pub(super) use sections::{Sections, Writer};

use super::Document;
use super::codec::{At, Largest, several};
use super::curved::{Elements as Nodes, places};
use super::cutting::cut;
use super::document::{marked, marked_mut};
use super::volumes::Volumes;
use curved::{Curves, write_order};
use std::io::{self, BufRead, Write};
use voronaut::Result;
use voronaut::mesh::Mesh;

/// Reads a mesh as it stands in a file, text or binary of versions 1 to 4 in either byte order, whatever its name: triangles keep
/// the orientation of the file.
///
/// Kept are `Vertices`, `Edges`, `Triangles`, `Corners`, `Ridges`, `RequiredVertices`, `RequiredEdges` and
/// `RequiredTriangles`. `Quadrilaterals` are cut in two along their better diagonal, behind the triangles, and required like
/// `RequiredQuadrilaterals`. `Tetrahedra`, `Pyramids`, `Prisms` and `Hexahedra` are left out with a note; where there are neither
/// triangles nor quadrilaterals the mesh is their boundary, with the labels of the cells, and where labels differ what is between
/// them. `TrianglesP2` and `EdgesP2`, or those called P3, are a curved mesh: nodes are in the order of [`Curved`](voronaut::mesh::Curved)
/// behind the corners, or in that of `TrianglesP2Ordering` and its like, which give barycentric coordinates; labels of nodes inside are
/// left out. All other sections are passed over. Sections come in any order, keywords of text in any case, its `End` may
/// be missing. `place` names the file in messages. Memory follows the file, never a count written in it.
///
/// # Errors
///
/// [`Error::Parse`](voronaut::Error::Parse) with the line or the byte of what is not as announced: a file cut off, a count too large or
/// too small, something that is no finite number, a vertex or edge that does not exist, a section given twice, curved edges that are not
/// those of their triangles. [`Error::Unsupported`](voronaut::Error::Unsupported) of triangles of different orders, and of Bézier points.
/// [`Error::Io`](voronaut::Error::Io) of a file that cannot be read.
pub fn read(source: impl BufRead, place: &str) -> Result<Document> {
    let (mut sections, mut reader) = (Sections::new(source, place)?, Reader::default());
    while let Some(section) = sections.next_section()? {
        reader.read_section(&section, &mut sections)?;
    }
    reader.finish(&sections)
}

/// Writes a mesh as a file of version 2 that [`read`] turns into the same mesh, to the last bit.
///
/// Planar meshes are written with `Dimension 2`; empty sections are left out; missing labels are written as 0. Of a curved mesh
/// `Vertices` are the vertices, then the nodes with label 0; ridges and what is required number `EdgesP2` and `TrianglesP2`, or P3.
///
/// # Errors
/// What `out` says.
pub fn write(mesh: &Mesh, form: Form, out: &mut dyn Write) -> io::Result<()> {
    let nodes = Nodes::new(mesh)?;
    let coordinates = if nodes.points.iter().all(|p| p[2] == 0.0) { 2 } else { 3 };
    let elements = nodes.points.len() + mesh.triangles.len() + mesh.edges.len();
    let mut writer = Writer::new(form, coordinates, MOST_BYTES * elements as u64, out)?;
    let row = 8 * usize::from(coordinates) + 4;
    writer.section("Vertices", nodes.points.len(), row, &[])?;
    writer.sink.rows(nodes.points.len(), |row, i| {
        row.put_all(nodes.points[i][..usize::from(coordinates)].iter().copied());
        row.put(mesh.point_labels.get(i).copied().unwrap_or(0));
    })?;
    write_elements(&mut writer, &nodes, 1, &mesh.edge_labels, mesh.edges.len())?;
    write_elements(&mut writer, &nodes, 2, &mesh.triangle_labels, mesh.triangles.len())?;
    for ((name, _), numbers) in MARKS.into_iter().zip(marked(mesh)) {
        if !numbers.is_empty() {
            writer.section(name, numbers.len(), 4, &[])?;
            numbers.iter().try_for_each(|number| writer.sink.row([number + 1]))?;
        }
    }
    writer.finish()
}

/// More bytes than a vertex, an edge or a triangle, of order 3 at most, takes in a binary file, with all that refers to it.
const MOST_BYTES: u64 = 64;

/// What else programs call some sections in texts.
const OTHER_NAMES: [(&str, &str); 2] = [("Pentahedra", "Prisms"), ("Hexaedra", "Hexahedra")];

/// The sections of what is marked, in the order of [`marked`], and what they number.
const MARKS: [(&str, Of); 5] = [
    ("Corners", Of::Vertices),
    ("RequiredVertices", Of::Vertices),
    ("Ridges", Of::Edges),
    ("RequiredEdges", Of::Edges),
    ("RequiredTriangles", Of::Triangles),
];

#[derive(Default)]
struct Reader {
    mesh: Mesh,
    quadrilaterals: Elements<4>,
    required_quadrilaterals: Vec<u32>,
    volumes: Volumes,
    curves: Curves,
    seen: Vec<&'static str>,
    /// Of vertices, edges, triangles and quadrilaterals.
    largest: [Largest; 4],
}

/// Elements by their vertices, and a label each.
type Elements<const N: usize> = (Vec<[u32; N]>, Vec<i32>);

/// What the file refers to by numbers.
#[derive(Clone, Copy)]
enum Of {
    Vertices,
    Edges,
    Triangles,
    Quadrilaterals,
}

impl Of {
    fn name(self) -> &'static str {
        ["vertex", "edge", "triangle", "quadrilateral"][self as usize]
    }
}

impl Reader {
    fn read_section(&mut self, section: &str, from: &mut Sections<'_>) -> Result<()> {
        let other = OTHER_NAMES.iter().find(|(other, _)| other.eq_ignore_ascii_case(section));
        let section = other.map_or(section, |(_, name)| name);
        let Some(&(_, name)) = KEYWORDS[..READ].iter().find(|(_, name)| *name == section) else {
            return from.skip_section();
        };
        if self.seen.contains(&name) {
            return Err(from.source.error(format!("a second section {name}"), "join both sections into one"));
        }
        self.seen.push(name);
        match name {
            "Dimension" => from.read_dimension()?,
            "Vertices" => self.read_vertices(from)?,
            "Edges" => (self.mesh.edges, self.mesh.edge_labels) = self.read_elements(name, from)?,
            "Triangles" => (self.mesh.triangles, self.mesh.triangle_labels) = self.read_elements(name, from)?,
            "Quadrilaterals" => self.quadrilaterals = self.read_elements(name, from)?,
            "RequiredQuadrilaterals" => {
                self.required_quadrilaterals = self.read_numbers(name, Of::Quadrilaterals, from)?;
            }
            "Tetrahedra" => self.read_solids::<4>(name, from)?,
            "Pyramids" => self.read_solids::<5>(name, from)?,
            "Prisms" => self.read_solids::<6>(name, from)?,
            "Hexahedra" => self.read_solids::<8>(name, from)?,
            "BezierBasis" => self.read_curved(name, from)?,
            name if name.contains("P2") || name.contains("P3") => self.read_curved(name, from)?,
            _ => {
                let mark = MARKS.iter().position(|(known, _)| *known == name).expect("all others are marks");
                *marked_mut(&mut self.mesh)[mark] = self.read_numbers(name, MARKS[mark].1, from)?;
            }
        }
        Ok(())
    }

    fn read_vertices(&mut self, from: &mut Sections<'_>) -> Result<()> {
        let dimension = from.known_dimension()?;
        let count = from.count()?;
        for at in At::rows("Vertices", count) {
            let [x, y] = from.numbers(at)?;
            let [z] = if dimension == 3 { from.numbers(at)? } else { [0.0] };
            self.mesh.points.push([x, y, z]);
            self.mesh.point_labels.push(from.whole(at)?);
        }
        Ok(())
    }

    fn read_elements<const N: usize>(&mut self, section: &str, from: &mut Sections<'_>) -> Result<Elements<N>> {
        let (mut elements, mut labels) = Elements::default();
        for at in At::rows(section, from.count()?) {
            elements.push(several(|| self.reference(Of::Vertices, from, at))?);
            labels.push(from.whole(at)?);
        }
        Ok((elements, labels))
    }

    fn read_solids<const N: usize>(&mut self, section: &str, from: &mut Sections<'_>) -> Result<()> {
        let (cells, labels) = self.read_elements::<N>(section, from)?;
        for (cell, label) in cells.iter().zip(labels) {
            self.volumes.push(cell, label, 0);
        }
        Ok(())
    }

    fn read_numbers(&mut self, section: &str, of: Of, from: &mut Sections<'_>) -> Result<Vec<u32>> {
        At::rows(section, from.count()?).map(|at| self.reference(of, from, at)).collect()
    }

    /// A number that refers to something: from 1 in the file, from 0 in the mesh.
    fn reference(&mut self, of: Of, from: &mut Sections<'_>, at: At<'_>) -> Result<u32> {
        let number: u32 = from.whole(at)?;
        if number == 0 {
            let what = format!("{} 0 does not exist ({at})", of.name());
            return Err(from.source.error(what, "number from 1, as Medit does"));
        }
        self.largest[of as usize].note(number - 1, from.source.place());
        Ok(number - 1)
    }

    fn finish(mut self, from: &Sections<'_>) -> Result<Document> {
        if !self.seen.contains(&"Vertices") {
            let what = "the file has no section Vertices";
            return Err(from.source.error(what, "check that the file is a whole Medit mesh"));
        }
        for (of, count) in [
            (Of::Vertices, self.mesh.points.len()),
            (Of::Edges, self.mesh.edges.len() + self.curves.count(1)),
            (Of::Triangles, self.mesh.triangles.len() + self.curves.count(2)),
            (Of::Quadrilaterals, self.quadrilaterals.0.len()),
        ] {
            self.largest[of as usize].check(of.name(), 1, count, from.source.file())?;
        }
        self.cut_quadrilaterals();
        let raised = self.curves.take(&mut self.mesh, from.source.file())?;
        let note = self.volumes.note(self.mesh.triangles.len());
        if self.mesh.triangles.is_empty() {
            let skin = self.volumes.skin(&self.mesh.points);
            (self.mesh.triangles, self.mesh.triangle_labels) = (skin.triangles, skin.labels);
        }
        let mut document = Document { notes: note.into_iter().collect(), ..self.mesh.into() };
        raised.finish(&mut document, from.source.place())?;
        Ok(document)
    }

    /// Appends the halves of all quadrilaterals to the triangles.
    fn cut_quadrilaterals(&mut self) {
        let mesh = &mut self.mesh;
        let first = mesh.triangles.len() as u32;
        for (quadrilateral, label) in self.quadrilaterals.0.iter().zip(&self.quadrilaterals.1) {
            cut(&mesh.points, quadrilateral, &mut mesh.triangles);
            mesh.triangle_labels.extend([*label; 2]);
        }
        let halves = |i: &u32| [0, 1].map(|half| first + 2 * i + half);
        mesh.required_triangles.extend(self.required_quadrilaterals.iter().flat_map(halves));
    }
}

/// Writes all elements of a dimension.
fn write_elements(
    writer: &mut Writer<'_>,
    nodes: &Nodes<'_>,
    dimension: u8,
    element_labels: &[i32],
    count: usize,
) -> io::Result<()> {
    const NAMES: [[&str; 3]; 2] = [["Edges", "EdgesP2", "EdgesP3"], ["Triangles", "TrianglesP2", "TrianglesP3"]];
    if count == 0 {
        return Ok(());
    }
    let name = NAMES[usize::from(dimension) - 1][nodes.order - 1];
    let width = if dimension == 1 { nodes.order + 1 } else { places(nodes.order).len() };
    writer.section(name, count, 4 * width + 4, &[])?;
    writer.sink.rows(count, |row, element| {
        row.put_all(nodes.nodes(dimension, &(element as u32)).map(|point| point + 1));
        row.put(element_labels.get(element).copied().unwrap_or(0));
    })?;
    write_order(writer, dimension, nodes.order)
}

#[cfg(test)]
mod tests;
