//! Medit's formats for meshes (Frey, INRIA RT-0253; libMeshb): `.mesh` as text and `.meshb` as binary files, those of mmg,
//! refine, bamg and `FreeFEM`.

mod keywords;
mod sink;
mod source;

pub use sink::Form;
pub(super) use sink::Sink;
pub(super) use source::Source;

use super::words::{At, Largest};
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use std::io::{self, BufRead, Write};

/// Reads a mesh as it stands in a file, text or binary of versions 1 to 4 in either byte order, whatever its name: triangles keep
/// the orientation of the file.
///
/// Kept are `Vertices`, `Edges`, `Triangles`, `Corners`, `Ridges`, `RequiredVertices`, `RequiredEdges` and
/// `RequiredTriangles`; all other sections are passed over. Sections come in any order, keywords of text in any case, its `End` may
/// be missing. `place` names the file in messages. Memory follows the file, never a count written in it.
///
/// # Errors
///
/// [`Error::Parse`] with the line or the byte of what is not as announced: a file cut off, a count too large or too small,
/// something that is no finite number, a vertex or edge that does not exist, a section given twice.
/// [`Error::Unsupported`] of elements other than triangles. [`Error::Io`] of a file that cannot be read.
pub fn read(source: impl BufRead, place: &str) -> Result<Mesh> {
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
const SECTIONS: [&str; 9] = [
    "Dimension",
    "Vertices",
    "Edges",
    "Triangles",
    "Corners",
    "Ridges",
    "RequiredVertices",
    "RequiredEdges",
    "RequiredTriangles",
];

/// Sections of elements that a triangle mesh cannot hold.
const FOREIGN: [&str; 5] = ["Quadrilaterals", "Tetrahedra", "Hexahedra", "Prisms", "Pyramids"];

struct Reader<'a> {
    source: Source<'a>,
    mesh: Mesh,
    dimension: Option<u8>,
    seen: Vec<&'static str>,
    vertices: Largest,
    edges: Largest,
    triangles: Largest,
}

impl<'a> Reader<'a> {
    fn new(source: Source<'a>) -> Self {
        let [vertices, edges, triangles] = <[Largest; 3]>::default();
        Self { source, mesh: Mesh::default(), dimension: None, seen: vec![], vertices, edges, triangles }
    }

    fn read_section(&mut self, section: &str) -> Result<()> {
        if FOREIGN.contains(&section) {
            return self.refuse_elements(section);
        }
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
            "Corners" => self.mesh.corners = self.read_numbers(name, "vertex")?,
            "RequiredVertices" => self.mesh.required_points = self.read_numbers(name, "vertex")?,
            "Ridges" => self.mesh.ridges = self.read_numbers(name, "edge")?,
            "RequiredEdges" => self.mesh.required_edges = self.read_numbers(name, "edge")?,
            _ => self.mesh.required_triangles = self.read_numbers(name, "triangle")?,
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
                *vertex = self.reference(at, "vertex")?;
            }
            elements.push(element);
            labels.push(self.source.whole(at)?);
        }
        Ok((elements, labels))
    }

    fn read_numbers(&mut self, section: &str, of: &str) -> Result<Vec<u32>> {
        let count = self.source.count(section)?;
        At::rows(section, count).map(|at| self.reference(at, of)).collect()
    }

    /// A number that refers to a vertex or an edge: from 1 in the file, from 0 in the mesh.
    fn reference(&mut self, at: At<'_>, of: &str) -> Result<u32> {
        let number: u32 = self.source.whole(at)?;
        if number == 0 {
            return Err(self.source.error(format!("{of} 0 does not exist ({at})"), "number from 1, as Medit does"));
        }
        let largest = match of {
            "edge" => &mut self.edges,
            "triangle" => &mut self.triangles,
            _ => &mut self.vertices,
        };
        largest.note(number.into(), self.source.position());
        Ok(number - 1)
    }

    fn refuse_elements(&mut self, section: &str) -> Result<()> {
        let count = self.source.count(section)?;
        if count == 0 {
            return Ok(());
        }
        let what = format!("{count} {section} ({})", self.source.here());
        Err(Error::Unsupported { what, help: "give a mesh of triangles only: split or remove these elements".into() })
    }

    fn finish(self) -> Result<Mesh> {
        if !self.seen.contains(&"Vertices") {
            let what = "the file has no section Vertices";
            return Err(self.source.error(what, "check that the file is a whole Medit mesh"));
        }
        self.source.check(&self.vertices, "vertex", self.mesh.points.len())?;
        self.source.check(&self.edges, "edge", self.mesh.edges.len())?;
        self.source.check(&self.triangles, "triangle", self.mesh.triangles.len())?;
        Ok(self.mesh)
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
                assert_eq!(read(written(&mesh, form).as_slice(), "a.mesh").unwrap(), mesh);
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
                let mesh = read(binary(version, big_endian).as_slice(), "a.meshb").unwrap();
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
            (20, 8, "not supported: 3 Tetrahedra (a.meshb, byte 32)"),
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
        let mesh = read(format!("{HEAD}{body}").as_bytes(), "a.mesh").unwrap();
        assert_eq!(mesh.point(2), crate::geometry::Point::new(0.0, 1.0));
        assert_eq!((mesh.edges, mesh.edge_labels), (vec![[0, 1]], vec![4]));
        assert_eq!(mesh.point_labels, [1, 2, 3]);
    }

    #[test]
    fn triangles_may_come_before_vertices() {
        let text = "MeshVersionFormatted 1 Dimension 3 Triangles 1 3 2 1 6 Vertices 3 0 0 0 0 1 0 0 0 0 1 0 0";
        assert_eq!(read(text.as_bytes(), "a.mesh").unwrap().triangles, [[2, 1, 0]]);
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
            ("Tetrahedra 1\n1 2 3 4 0", "not supported: 1 Tetrahedra (a.mesh:9)"),
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
