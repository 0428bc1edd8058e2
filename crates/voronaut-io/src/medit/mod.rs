//! Medit's formats for meshes (Frey, INRIA RT-0253; libMeshb): `.mesh` as text and `.meshb` as binary files, those of mmg,
//! refine, bamg and `FreeFEM`.

mod keywords;
mod sink;
mod source;

pub use sink::Form;
pub(super) use sink::Sink;
pub(super) use source::Source;

use super::Document;
use super::cutting::cut;
use super::volumes::{Solid, Volumes};
use super::words::{At, Largest};
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
/// them. All other sections are passed over. Sections come in any order, keywords of text in any case, its `End` may
/// be missing. `place` names the file in messages. Memory follows the file, never a count written in it.
///
/// # Errors
///
/// [`Error::Parse`](voronaut::Error::Parse) with the line or the byte of what is not as announced: a file cut off, a count too large or
/// too small, something that is no finite number, a vertex or edge that does not exist, a section given twice.
/// [`Error::Io`](voronaut::Error::Io) of a file that cannot be read.
pub fn read(source: impl BufRead, place: &str) -> Result<Document> {
    let mut reader = Reader::new(Source::new(source, place)?);
    let mut before = "the head of the file".to_owned();
    while let Some(section) = reader.source.next_section(&before)? {
        reader.read_section(&section)?;
        before = section;
    }
    reader.finish()
}

/// Writes a mesh as a file of version 2 that [`read`] turns into the same mesh, to the last bit.
///
/// Planar meshes are written with `Dimension 2`; empty sections are left out; missing labels are written as 0.
///
/// # Errors
/// What `out` says.
pub fn write(mesh: &Mesh, form: Form, out: &mut dyn Write) -> io::Result<()> {
    let coordinates = if mesh.is_planar() { 2 } else { 3 };
    let elements = mesh.points.len() + mesh.triangles.len() + mesh.edges.len();
    let mut sink = Sink::new(form, coordinates, MOST_BYTES * elements as u64, out)?;
    let row = 8 * usize::from(coordinates) + 4;
    sink.section("Vertices", mesh.points.len(), row, &[])?;
    for (point, label) in mesh.points.iter().zip(labels(&mesh.point_labels)) {
        point[..usize::from(coordinates)].iter().try_for_each(|&x| sink.number(x))?;
        sink.label(label)?;
        sink.end_row()?;
    }
    write_elements(&mut sink, "Edges", &mesh.edges, &mesh.edge_labels)?;
    write_elements(&mut sink, "Triangles", &mesh.triangles, &mesh.triangle_labels)?;
    write_numbers(&mut sink, "Corners", &mesh.corners)?;
    write_numbers(&mut sink, "RequiredVertices", &mesh.required_points)?;
    write_numbers(&mut sink, "Ridges", &mesh.ridges)?;
    write_numbers(&mut sink, "RequiredEdges", &mesh.required_edges)?;
    write_numbers(&mut sink, "RequiredTriangles", &mesh.required_triangles)?;
    sink.finish()
}

/// More bytes than a vertex, an edge or a triangle takes in a binary file, with all that refers to it.
const MOST_BYTES: u64 = 40;

/// Sections that are read; any other is passed over.
const SECTIONS: [&str; 15] = [
    "Dimension",
    "Vertices",
    "Edges",
    "Triangles",
    "Corners",
    "Ridges",
    "RequiredVertices",
    "RequiredEdges",
    "RequiredTriangles",
    "Quadrilaterals",
    "RequiredQuadrilaterals",
    "Tetrahedra",
    "Pyramids",
    "Prisms",
    "Hexahedra",
];

/// What else programs call these sections in texts.
const OTHER_NAMES: [(&str, &str); 2] = [("Pentahedra", "Prisms"), ("Hexaedra", "Hexahedra")];

struct Reader<'a> {
    source: Source<'a>,
    mesh: Mesh,
    quadrilaterals: Vec<[u32; 4]>,
    quadrilateral_labels: Vec<i32>,
    required_quadrilaterals: Vec<u32>,
    volumes: Volumes,
    dimension: Option<u8>,
    seen: Vec<&'static str>,
    /// Of vertices, edges, triangles and quadrilaterals.
    largest: [Largest; 4],
}

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

impl<'a> Reader<'a> {
    fn new(source: Source<'a>) -> Self {
        Self {
            source,
            mesh: Mesh::default(),
            quadrilaterals: Vec::new(),
            quadrilateral_labels: Vec::new(),
            required_quadrilaterals: Vec::new(),
            volumes: Volumes::default(),
            dimension: None,
            seen: Vec::new(),
            largest: <[Largest; 4]>::default(),
        }
    }

    fn read_section(&mut self, section: &str) -> Result<()> {
        let other = OTHER_NAMES.iter().find(|(other, _)| other.eq_ignore_ascii_case(section));
        let section = other.map_or(section, |(_, name)| name);
        let Some(&name) = SECTIONS.iter().find(|name| **name == section) else {
            return self.source.skip_section(section);
        };
        if self.seen.contains(&name) {
            return Err(self.source.error(format!("a second section {name}"), "join both sections into one"));
        }
        self.seen.push(name);
        self.read_known(name)
    }

    fn read_known(&mut self, name: &'static str) -> Result<()> {
        match name {
            "Dimension" => self.dimension = Some(self.source.dimension()?),
            "Vertices" => self.read_vertices()?,
            "Edges" => (self.mesh.edges, self.mesh.edge_labels) = self.read_elements(name)?,
            "Triangles" => (self.mesh.triangles, self.mesh.triangle_labels) = self.read_elements(name)?,
            "Corners" => self.mesh.corners = self.read_numbers(name, Of::Vertices)?,
            "RequiredVertices" => self.mesh.required_points = self.read_numbers(name, Of::Vertices)?,
            "Ridges" => self.mesh.ridges = self.read_numbers(name, Of::Edges)?,
            "RequiredEdges" => self.mesh.required_edges = self.read_numbers(name, Of::Edges)?,
            "RequiredTriangles" => self.mesh.required_triangles = self.read_numbers(name, Of::Triangles)?,
            "Quadrilaterals" => {
                (self.quadrilaterals, self.quadrilateral_labels) = self.read_elements(name)?;
            }
            "RequiredQuadrilaterals" => {
                self.required_quadrilaterals = self.read_numbers(name, Of::Quadrilaterals)?;
            }
            "Tetrahedra" => self.read_solids::<4>(name, Solid::Tetrahedron)?,
            "Pyramids" => self.read_solids::<5>(name, Solid::Pyramid)?,
            "Prisms" => self.read_solids::<6>(name, Solid::Prism)?,
            _ => self.read_solids::<8>(name, Solid::Hexahedron)?,
        }
        Ok(())
    }

    fn read_vertices(&mut self) -> Result<()> {
        let section = "Vertices";
        let source = &mut self.source;
        let dimension = source.known_dimension(self.dimension, section)?;
        let count = source.count(section)?;
        for at in At::rows(section, count) {
            let (x, y) = (source.number(at)?, source.number(at)?);
            let z = if dimension == 3 { source.number(at)? } else { 0.0 };
            self.mesh.points.push([x, y, z]);
            self.mesh.point_labels.push(source.whole(at)?);
        }
        Ok(())
    }

    fn read_elements<const N: usize>(&mut self, section: &str) -> Result<(Vec<[u32; N]>, Vec<i32>)> {
        let count = self.source.count(section)?;
        let (mut elements, mut labels) = (Vec::new(), Vec::new());
        for at in At::rows(section, count) {
            let mut element = [0; N];
            for vertex in &mut element {
                *vertex = self.reference(at, Of::Vertices)?;
            }
            elements.push(element);
            labels.push(self.source.whole(at)?);
        }
        Ok((elements, labels))
    }

    fn read_solids<const N: usize>(&mut self, section: &str, solid: Solid) -> Result<()> {
        let (cells, labels) = self.read_elements::<N>(section)?;
        cells.iter().zip(labels).for_each(|(cell, label)| self.volumes.push(solid, cell, label));
        Ok(())
    }

    fn read_numbers(&mut self, section: &str, of: Of) -> Result<Vec<u32>> {
        let count = self.source.count(section)?;
        At::rows(section, count).map(|at| self.reference(at, of)).collect()
    }

    /// A number that refers to something: from 1 in the file, from 0 in the mesh.
    fn reference(&mut self, at: At<'_>, of: Of) -> Result<u32> {
        let number: u32 = self.source.whole(at)?;
        if number == 0 {
            let what = format!("{} 0 does not exist ({at})", of.name());
            return Err(self.source.error(what, "number from 1, as Medit does"));
        }
        self.largest[of as usize].note(number.into(), self.source.position());
        Ok(number - 1)
    }

    fn finish(mut self) -> Result<Document> {
        if !self.seen.contains(&"Vertices") {
            let what = "the file has no section Vertices";
            return Err(self.source.error(what, "check that the file is a whole Medit mesh"));
        }
        for (of, count) in [
            (Of::Vertices, self.mesh.points.len()),
            (Of::Edges, self.mesh.edges.len()),
            (Of::Triangles, self.mesh.triangles.len()),
            (Of::Quadrilaterals, self.quadrilaterals.len()),
        ] {
            self.source.check(&self.largest[of as usize], of.name(), count)?;
        }
        self.cut_quadrilaterals();
        let note = self.volumes.note(self.mesh.triangles.len());
        if self.mesh.triangles.is_empty() {
            let skin = self.volumes.skin(&self.mesh.points);
            (self.mesh.triangles, self.mesh.triangle_labels) = (skin.triangles, skin.labels);
        }
        Ok(Document { notes: note.into_iter().collect(), ..self.mesh.into() })
    }

    /// Appends the halves of all quadrilaterals to the triangles.
    fn cut_quadrilaterals(&mut self) {
        let mesh = &mut self.mesh;
        let first = mesh.triangles.len() as u32;
        for (quadrilateral, label) in self.quadrilaterals.iter().zip(&self.quadrilateral_labels) {
            cut(&mesh.points, quadrilateral, &mut mesh.triangles);
            mesh.triangle_labels.extend([*label; 2]);
        }
        let halves = |i: &u32| [0, 1].map(|half| first + 2 * i + half);
        mesh.required_triangles.extend(self.required_quadrilaterals.iter().flat_map(halves));
    }
}

fn write_elements<const N: usize>(
    sink: &mut Sink<'_>,
    name: &str,
    elements: &[[u32; N]],
    element_labels: &[i32],
) -> io::Result<()> {
    if elements.is_empty() {
        return Ok(());
    }
    sink.section(name, elements.len(), 4 * N + 4, &[])?;
    for (element, label) in elements.iter().zip(labels(element_labels)) {
        element.iter().try_for_each(|&vertex| sink.reference(vertex))?;
        sink.label(label)?;
        sink.end_row()?;
    }
    Ok(())
}

fn write_numbers(sink: &mut Sink<'_>, name: &str, numbers: &[u32]) -> io::Result<()> {
    if numbers.is_empty() {
        return Ok(());
    }
    sink.section(name, numbers.len(), 4, &[])?;
    for &number in numbers {
        sink.reference(number)?;
        sink.end_row()?;
    }
    Ok(())
}

fn labels(labels: &[i32]) -> impl Iterator<Item = i32> {
    labels.iter().copied().chain(std::iter::repeat(0))
}

#[cfg(test)]
mod tests;
