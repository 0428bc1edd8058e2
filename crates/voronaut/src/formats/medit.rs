//! Medit's text format for meshes, `.mesh` (Frey, INRIA RT-0253): the format of mmg, refine, bamg and `FreeFEM`.

use super::sections::{known_dimension, next_section, read_dimension, read_head, skip_section};
use super::words::{At, Largest, Shortest, Word, Words, error_at};
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use std::fmt::Write;

/// Reads a mesh as it stands in a `.mesh` text: triangles keep the orientation of the file.
///
/// Kept are `Vertices`, `Edges`, `Triangles`, `Corners`, `Ridges`, `RequiredVertices`, `RequiredEdges` and
/// `RequiredTriangles`; all other sections are passed over. Sections come in any order, keywords in any case, `End` may be
/// missing. `place` names the text in messages. Memory follows the text, never a count written in it.
///
/// # Errors
///
/// [`Error::Parse`] with the line of what is not as announced: a text cut off, a count too large or too small,
/// something that is no finite number, a vertex or edge that does not exist, a section given twice.
/// [`Error::Unsupported`] of elements other than triangles.
pub fn read(text: &str, place: &str) -> Result<Mesh> {
    let mut reader = Reader::new(text, place);
    read_head(&mut reader.words)?;
    let mut before = "MeshVersionFormatted";
    while let Some(keyword) = next_section(&mut reader.words, before)? {
        before = keyword.text;
        reader.read_section(keyword)?;
    }
    reader.finish()
}

/// Writes a mesh as a `.mesh` text of version 2 that [`read`] turns into the same mesh.
///
/// Planar meshes are written with `Dimension 2`; empty sections are left out; missing labels are written as 0.
pub fn write(mesh: &Mesh) -> String {
    let coordinates = if mesh.is_planar() { 2 } else { 3 };
    let mut out = format!("MeshVersionFormatted 2\n\nDimension {coordinates}\n");
    open_section(&mut out, "Vertices", mesh.points.len());
    for (point, label) in mesh.points.iter().zip(labels(&mesh.point_labels)) {
        for &x in &point[..coordinates] {
            push(&mut out, format_args!("{} ", Shortest(x)));
        }
        push(&mut out, format_args!("{label}\n"));
    }
    write_elements(&mut out, "Edges", &mesh.edges, &mesh.edge_labels);
    write_elements(&mut out, "Triangles", &mesh.triangles, &mesh.triangle_labels);
    write_numbers(&mut out, "Corners", &mesh.corners);
    write_numbers(&mut out, "RequiredVertices", &mesh.required_points);
    write_numbers(&mut out, "Ridges", &mesh.ridges);
    write_numbers(&mut out, "RequiredEdges", &mesh.required_edges);
    write_numbers(&mut out, "RequiredTriangles", &mesh.required_triangles);
    out.push_str("\nEnd\n");
    out
}

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
    words: Words<'a>,
    mesh: Mesh,
    dimension: Option<u8>,
    seen: Vec<&'static str>,
    vertices: Largest,
    edges: Largest,
    triangles: Largest,
}

impl<'a> Reader<'a> {
    fn new(text: &'a str, place: &'a str) -> Self {
        let [vertices, edges, triangles] = <[Largest; 3]>::default();
        let (words, mesh) = (Words::new(text, place), Mesh::default());
        Self { words, mesh, dimension: None, seen: vec![], vertices, edges, triangles }
    }

    fn read_section(&mut self, keyword: Word<'_>) -> Result<()> {
        let called = |name: &&&str| name.eq_ignore_ascii_case(keyword.text);
        if let Some(name) = FOREIGN.iter().find(called) {
            return self.refuse_elements(name);
        }
        let Some(&name) = SECTIONS.iter().find(called) else {
            skip_section(&mut self.words);
            return Ok(());
        };
        if self.seen.contains(&name) {
            let what = format!("a second section {name}");
            return Err(error_at(self.words.place(), keyword.line, what, "join both sections into one"));
        }
        self.seen.push(name);
        self.read_known(name)
    }

    fn read_known(&mut self, name: &'static str) -> Result<()> {
        match name {
            "Dimension" => self.dimension = Some(read_dimension(&mut self.words)?),
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
        let dimension = known_dimension(self.dimension, &self.words, section)?;
        let count = self.words.whole(At::head(section))?;
        for at in At::rows(section, count) {
            let (x, y) = (self.words.number(at)?, self.words.number(at)?);
            let z = if dimension == 3 { self.words.number(at)? } else { 0.0 };
            self.mesh.points.push([x, y, z]);
            self.mesh.point_labels.push(self.words.whole(at)?);
        }
        Ok(())
    }

    fn read_elements<const N: usize>(&mut self, section: &str) -> Result<(Vec<[u32; N]>, Vec<i32>)> {
        let count = self.words.whole(At::head(section))?;
        let (mut elements, mut labels) = (Vec::new(), Vec::new());
        for at in At::rows(section, count) {
            let mut element = [0; N];
            for vertex in &mut element {
                *vertex = self.reference(at, "vertex")?;
            }
            elements.push(element);
            labels.push(self.words.whole(at)?);
        }
        Ok((elements, labels))
    }

    fn read_numbers(&mut self, section: &str, of: &str) -> Result<Vec<u32>> {
        let count = self.words.whole(At::head(section))?;
        At::rows(section, count).map(|at| self.reference(at, of)).collect()
    }

    /// A number that refers to a vertex or an edge: from 1 in the file, from 0 in the mesh.
    fn reference(&mut self, at: At<'_>, of: &str) -> Result<u32> {
        let number: u32 = self.words.whole(at)?;
        let line = self.words.line();
        if number == 0 {
            let help = "number from 1, as Medit does";
            return Err(error_at(self.words.place(), line, format!("{of} 0 does not exist ({at})"), help));
        }
        let largest = match of {
            "edge" => &mut self.edges,
            "triangle" => &mut self.triangles,
            _ => &mut self.vertices,
        };
        largest.note(number, line);
        Ok(number - 1)
    }

    fn refuse_elements(&mut self, section: &str) -> Result<()> {
        let count: u64 = self.words.whole(At::head(section))?;
        if count == 0 {
            return Ok(());
        }
        let what = format!("{count} {section} ({}:{})", self.words.place(), self.words.line());
        Err(Error::Unsupported { what, help: "give a mesh of triangles only: split or remove these elements".into() })
    }

    fn finish(self) -> Result<Mesh> {
        let place = self.words.place();
        if !self.seen.contains(&"Vertices") {
            let what = "the file has no section Vertices";
            return Err(error_at(place, self.words.line(), what, "check that the file is a whole Medit mesh"));
        }
        self.vertices.check("vertex", self.mesh.points.len(), place)?;
        self.edges.check("edge", self.mesh.edges.len(), place)?;
        self.triangles.check("triangle", self.mesh.triangles.len(), place)?;
        Ok(self.mesh)
    }
}

fn open_section(out: &mut String, name: &str, count: usize) {
    push(out, format_args!("\n{name}\n{count}\n"));
}

fn write_elements<const N: usize>(out: &mut String, name: &str, elements: &[[u32; N]], element_labels: &[i32]) {
    if elements.is_empty() {
        return;
    }
    open_section(out, name, elements.len());
    for (element, label) in elements.iter().zip(labels(element_labels)) {
        for &vertex in element {
            push(out, format_args!("{} ", u64::from(vertex) + 1));
        }
        push(out, format_args!("{label}\n"));
    }
}

fn write_numbers(out: &mut String, name: &str, numbers: &[u32]) {
    if numbers.is_empty() {
        return;
    }
    open_section(out, name, numbers.len());
    for &number in numbers {
        push(out, format_args!("{}\n", u64::from(number) + 1));
    }
}

fn labels(labels: &[i32]) -> impl Iterator<Item = i32> {
    labels.iter().copied().chain(std::iter::repeat(0))
}

fn push(out: &mut String, text: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = out.write_fmt(text);
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
        let error = read(&format!("{HEAD}{body}"), "a.mesh").unwrap_err();
        assert!(!error.help().is_empty(), "{error}");
        error.to_string()
    }

    #[test]
    fn what_is_written_reads_back() {
        for mesh in [sample(0.0), sample(2.5)] {
            assert_eq!(read(&write(&mesh), "a.mesh").unwrap(), mesh);
        }
        let bare = Mesh { points: vec![[1.0, 2.0, 0.0]], ..Mesh::default() };
        assert_eq!(write(&bare), "MeshVersionFormatted 2\n\nDimension 2\n\nVertices\n1\n1 2 0\n\nEnd\n");
    }

    #[test]
    fn other_sections_are_passed_over() {
        let body = "Normals 2 0 0 1\n-1.e0 0 .5\nRidges 1 1\nQuadrilaterals\n0\nFuture\n9 9\nEDGES 1 1 2 4\nEnd\nrest";
        let mesh = read(&format!("{HEAD}{body}"), "a.mesh").unwrap();
        assert_eq!(mesh.point(2), crate::geometry::Point::new(0.0, 1.0));
        assert_eq!((mesh.edges, mesh.edge_labels), (vec![[0, 1]], vec![4]));
        assert_eq!(mesh.point_labels, [1, 2, 3]);
    }

    #[test]
    fn triangles_may_come_before_vertices() {
        let text = "MeshVersionFormatted 1 Dimension 3 Triangles 1 3 2 1 6 Vertices 3 0 0 0 0 1 0 0 0 0 1 0 0";
        assert_eq!(read(text, "a.mesh").unwrap().triangles, [[2, 1, 0]]);
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
            let error = read(text, "a.mesh").unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }
}
