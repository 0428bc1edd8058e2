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
use crate::error::Result;
use crate::mesh::Mesh;
use std::io::{self, BufRead, Write};

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
/// [`Error::Parse`](crate::Error::Parse) with the line or the byte of what is not as announced: a file cut off, a count too large or
/// too small, something that is no finite number, a vertex or edge that does not exist, a section given twice.
/// [`Error::Io`](crate::Error::Io) of a file that cannot be read.
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
mod tests {
    use super::*;

    const HEAD: &str = "MeshVersionFormatted 2\nDimension\n2\nVertices\n3\n0 0 1\n1 0 2 # right\n0 1.D0 3\n";

    fn sample(z: f64) -> Mesh {
        Mesh {
            points: vec![[0.1, -1e-300, 0.0], [1.0 / 3.0, 0.0, z], [0.0, 1e22, 0.0], [1.0, 1.0, 0.0]],
            point_labels: vec![1, -2, 0, 7],
            triangles: vec![[0, 1, 2], [3, 2, 1]],
            triangle_labels: vec![5, i32::MIN],
            edges: vec![[0, 1], [2, 0]],
            edge_labels: vec![9, 8],
            corners: vec![2],
            required_points: vec![0, 3],
            ridges: vec![0, 1],
            required_edges: vec![1],
            required_triangles: vec![1],
        }
    }

    fn message(body: &str) -> String {
        let error = read(format!("{HEAD}{body}").as_bytes(), "a.mesh").unwrap_err();
        assert!(!error.help().is_empty(), "{error}");
        error.to_string()
    }

    fn written(mesh: &Mesh, form: Form) -> Vec<u8> {
        let mut out = Vec::new();
        write(mesh, form, &mut out).unwrap();
        out
    }

    #[test]
    fn what_is_written_reads_back() {
        for mesh in [sample(0.0), sample(2.5)] {
            for form in [Form::Text, Form::Binary] {
                assert_eq!(read(written(&mesh, form).as_slice(), "a.mesh").unwrap().mesh, mesh);
            }
        }
        let bare = Mesh { points: vec![[1.0, 2.0, 0.0]], ..Mesh::default() };
        let text = String::from_utf8(written(&bare, Form::Text)).unwrap();
        assert_eq!(text, "MeshVersionFormatted 2\n\nDimension 2\n\nVertices\n1\n1 2 0\n\nEnd\n");
    }

    /// A binary file of one triangle, each number written as its version has it.
    fn binary(version: i32, big_endian: bool) -> Vec<u8> {
        let mut file = Vec::new();
        let mut push = |bytes: &[u8]| {
            let mut bytes = bytes.to_vec();
            if big_endian {
                bytes.reverse();
            }
            file.extend(bytes);
            i64::try_from(file.len()).unwrap()
        };
        let integer = |x: i64| if version == 4 { x.to_le_bytes().to_vec() } else { (x as i32).to_le_bytes().to_vec() };
        let position = |x: i64| if version < 3 { (x as i32).to_le_bytes().to_vec() } else { x.to_le_bytes().to_vec() };
        let real = |x: f64| if version == 1 { (x as f32).to_le_bytes().to_vec() } else { x.to_le_bytes().to_vec() };
        let (wide, long) = (if version < 3 { 4 } else { 8 }, if version == 4 { 8 } else { 4 });
        push(&1_i32.to_le_bytes());
        push(&version.to_le_bytes());
        push(&3_i32.to_le_bytes());
        push(&position(8 + 4 + wide + 4));
        let mut end = push(&2_i32.to_le_bytes());
        let float = if version == 1 { 4 } else { 8 };
        push(&4_i32.to_le_bytes());
        push(&position(end + 4 + wide + long + 3 * (2 * float + long)));
        end = push(&integer(3));
        for (x, y, label) in [(0.5, 0.0, -1), (1.0, 0.25, 2), (0.0, 1.0, 3)] {
            push(&real(x));
            push(&real(y));
            end = push(&integer(label));
        }
        push(&6_i32.to_le_bytes());
        push(&position(end + 4 + wide + long + 4 * long));
        for number in [1, 1, 2, 3, 7] {
            push(&integer(number));
        }
        push(&54_i32.to_le_bytes());
        push(&position(0));
        file
    }

    #[test]
    fn binary_files_of_all_versions() {
        for version in 1..=4 {
            for big_endian in [false, true] {
                let mesh = read(binary(version, big_endian).as_slice(), "a.meshb").unwrap().mesh;
                assert_eq!(mesh.points, [[0.5, 0.0, 0.0], [1.0, 0.25, 0.0], [0.0, 1.0, 0.0]], "{version}");
                assert_eq!((mesh.point_labels, mesh.triangles), (vec![-1, 2, 3], vec![[0, 1, 2]]));
                assert_eq!(mesh.triangle_labels, [7]);
            }
        }
        let own = Mesh {
            points: vec![[0.5, 0.0, 0.0], [1.0, 0.25, 0.0], [0.0, 1.0, 0.0]],
            point_labels: vec![-1, 2, 3],
            triangles: vec![[0, 1, 2]],
            triangle_labels: vec![7],
            ..Mesh::default()
        };
        assert_eq!(written(&own, Form::Binary), binary(2, false));
    }

    #[test]
    fn damaged_binary_files() {
        let message = |at: usize, number: i32| {
            let mut file = binary(2, false);
            file[at..at + 4].copy_from_slice(&number.to_le_bytes());
            read(file.as_slice(), "a.meshb").unwrap_err().to_string()
        };
        for (at, number, expected) in [
            (28, 2, "a.meshb, byte 72: Vertices ends here, and the file says that the next section begins at byte 92"),
            (28, i32::MAX, "a.meshb, byte 128: the file ends in row 5 of 2147483647 of Vertices"),
            (28, -1, "a.meshb, byte 32: '-1' is out of range (the head of Vertices)"),
            (104, 4, "a.meshb, byte 108: vertex 4 does not exist: the file lists 3"),
            (104, 0, "a.meshb, byte 108: vertex 0 does not exist (row 1 of 1 of Triangles)"),
            (16, 4, "a.meshb, byte 20: Dimension 4, where 2 or 3 is expected"),
            (20, 8, "a.meshb, byte 36: vertex 0 does not exist (row 1 of 3 of Tetrahedra)"),
        ] {
            let message = message(at, number);
            assert!(message.starts_with(expected) || message.contains(expected), "{message}");
        }
        let whole = binary(2, false);
        for length in 0..whole.len() - 8 {
            assert!(read(&whole[..length], "a.meshb").is_err(), "{length}");
        }
    }

    #[test]
    fn other_sections_are_passed_over() {
        let body = "Normals 2 0 0 1\n-1.e0 0 .5\nRidges 1 1\nQuadrilaterals\n0\nFuture\n9 9\nEDGES 1 1 2 4\nEnd\nrest";
        let mesh = read(format!("{HEAD}{body}").as_bytes(), "a.mesh").unwrap().mesh;
        assert_eq!(mesh.point(2), crate::geometry::Point::new(0.0, 1.0));
        assert_eq!((mesh.edges, mesh.edge_labels), (vec![[0, 1]], vec![4]));
        assert_eq!(mesh.point_labels, [1, 2, 3]);
    }

    const CUBE: &str = "MeshVersionFormatted 2 Dimension 3 Vertices 9 0 0 0 1 1 0 0 1 1 1 0 1 0 1 0 1 0 0 1 1 1 0 1 1 \
                        1 1 1 1 0 1 1 1 5 5 5 5\n";

    #[test]
    fn quadrilaterals_are_cut_behind_the_triangles() {
        let body =
            "RequiredQuadrilaterals 1 2 Quadrilaterals 2 2 3 4 1 8 5 6 7 8 9 Triangles 1 1 2 6 7 RequiredTriangles 1 1";
        let found = read(format!("{CUBE}{body}").as_bytes(), "a.mesh").unwrap();
        let mesh = found.mesh;
        assert_eq!(mesh.triangles, [[0, 1, 5], [2, 3, 0], [2, 0, 1], [4, 5, 6], [4, 6, 7]]);
        assert_eq!((mesh.triangle_labels, mesh.required_triangles), (vec![7, 8, 8, 9, 9], vec![0, 3, 4]));
        assert!(found.notes.is_empty());
    }

    #[test]
    fn volumes_are_left_out_beside_triangles_and_have_a_boundary_without() {
        let cells = "Hexahedra 1 1 2 3 4 5 6 7 8 3 Tetrahedra 1 5 6 7 9 4 RequiredTetrahedra 1 1 ";
        let found = read(format!("{CUBE}{cells}Triangles 1 1 2 3 7 End").as_bytes(), "a.mesh").unwrap();
        assert_eq!((found.mesh.triangles, found.mesh.points.len()), (vec![[0, 1, 2]], 9));
        let told = "1 tetrahedron, 1 hexahedron left out: the surface is the 1 triangle that the file lists";
        assert_eq!(found.notes, [told]);
        let found = read(format!("{CUBE}{cells}").as_bytes(), "a.mesh").unwrap();
        assert_eq!(found.mesh.triangles.len(), 16);
        assert_eq!(found.mesh.triangle_labels.iter().filter(|label| **label == 3).count(), 12);
        assert!(found.notes[0].starts_with("of 1 tetrahedron, 1 hexahedron the boundary was taken"));
    }

    #[test]
    fn triangles_may_come_before_vertices() {
        let text = "MeshVersionFormatted 1 Dimension 3 Triangles 1 3 2 1 6 Vertices 3 0 0 0 0 1 0 0 0 0 1 0 0";
        assert_eq!(read(text.as_bytes(), "a.mesh").unwrap().mesh.triangles, [[2, 1, 0]]);
    }

    #[test]
    fn errors_say_what_and_where() {
        for (body, expected) in [
            ("Triangles 1\n1 2 4 0", "a.mesh:10: vertex 4 does not exist: the file lists 3"),
            ("Triangles 1\n1 2 0 0", "a.mesh:10: vertex 0 does not exist (row 1 of 1 of Triangles)"),
            ("Triangles 1\n1 2 -3 0", "a.mesh:10: '-3' is out of range (row 1 of 1 of Triangles)"),
            ("Edges 1\n1 2 0.5", "a.mesh:10: '0.5' is not a whole number (row 1 of 1 of Edges)"),
            ("Edges 1\n1 99999999999 0", "a.mesh:10: '99999999999' is out of range (row 1 of 1 of Edges)"),
            ("Edges\n1\n1 2 0\nRequiredEdges\n1\n2", "a.mesh:14: edge 2 does not exist: the file lists 1"),
            (
                "Triangles 1000000000000000000\n1 2 3 0\n",
                "a.mesh:10: the text ends in row 2 of 1000000000000000000 of Triangles",
            ),
            ("Triangles 1e18", "a.mesh:9: '1e18' is not a whole number (the head of Triangles)"),
            ("Triangles", "a.mesh:9: the text ends in the head of Triangles"),
            (
                "Triangles 1\n1 2 3 0\n1 2 3 0",
                "a.mesh:11: '1' where the next section should begin: Triangles is longer",
            ),
            ("Triangles 2\n1 2 3 0\nEnd", "a.mesh:11: 'End' is not a whole number (row 2 of 2 of Triangles)"),
            ("Vertices 0", "a.mesh:9: a second section Vertices"),
            ("Tetrahedra 1\n1 2 3 4 0", "a.mesh:10: vertex 4 does not exist: the file lists 3"),
            ("Hexahedra 1\n1 2 3 1 2 3 1", "a.mesh:10: the text ends in row 1 of 1 of Hexahedra"),
            (
                "Quadrilaterals 1\n1 2 3 3 0\nRequiredQuadrilaterals 1 2",
                "a.mesh:11: quadrilateral 2 does not exist: the file lists 1",
            ),
        ] {
            let message = message(body);
            assert!(message.contains(expected), "{message}");
        }
    }

    #[test]
    fn bad_beginnings() {
        for (text, expected) in [
            ("", "a.mesh:1: the text ends in the head of MeshVersionFormatted"),
            ("solid cube", "a.mesh:1: the file begins with 'solid', not with MeshVersionFormatted"),
            ("MeshVersionFormatted 9", "a.mesh:1: MeshVersionFormatted 9 does not exist"),
            ("MeshVersionFormatted 2\nDimension 4", "a.mesh:2: Dimension 4, where 2 or 3 is expected"),
            ("MeshVersionFormatted 2\nVertices 1", "a.mesh:2: Vertices comes before Dimension"),
            ("MeshVersionFormatted 2\nDimension 2\nEnd", "a.mesh:3: the file has no section Vertices"),
            (
                "MeshVersionFormatted 2\nDimension 2\nVertices 1\n0 nan 0",
                "a.mesh:4: 'nan' is not a finite number (row 1 of 1 of Vertices)",
            ),
            (
                "MeshVersionFormatted 2\nDimension 3\nVertices 2\n0 0 0\n1 1 0\n",
                "a.mesh:5: the text ends in row 2 of 2 of Vertices",
            ),
        ] {
            let error = read(text.as_bytes(), "a.mesh").unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }
}
