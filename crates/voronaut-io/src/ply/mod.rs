//! Stanford's `.ply`, as text and binary in both byte orders.

mod header;
mod strips;

use super::codec::{At, Form, Kind, Largest, Sink, Source};
use super::cutting::Polygons;
use super::document::{distinct_names, labels};
use super::{Document, Field, Fields};
use header::{Element, Property, Shape};
use std::io::{self, BufRead, Write};
use strips::Strip;
use voronaut::mesh::{Mesh, SolutionValues};
use voronaut::{Error, Result};

/// Reads a `.ply` file.
///
/// Kept are `x`, `y`, `z` and `label` of the element `vertex`; the lists `vertex_indices` (or `vertex_index`) of the element `face`,
/// cut along diagonals that suit them, with `label`; the lists of the element `tristrips`, in which -1 ends a strip; `vertex1`, `vertex2` and `label` of the element `edge`. Other properties of
/// vertices that are one number each are fields, but for normals and colours; of faces they are, where all
/// faces are triangles. All else is passed over. Memory follows the file, never a count written in it.
///
/// # Errors
///
/// [`Error::Parse`] with the line (in the head and in text) or the byte of what is not as announced: a head that
/// makes no sense, a file cut off or too long, a coordinate or a field that is not finite, a face of fewer than three vertices, a
/// vertex that does not exist. [`Error::Io`] of a file that cannot be read.
pub fn read(source: impl BufRead, place: &str) -> Result<Document> {
    let mut source = Source::verbatim(source, place);
    let elements = header::read(&mut source)?;
    let mut reader = Reader::default();
    for element in &elements {
        reader.read_element(element, &mut source)?;
    }
    source.demand_end("the file goes on behind the elements it announces", "check the counts in its head")?;
    if !elements.iter().any(|element| element.name == "vertex") {
        return Err(source.error("the file has no element vertex", "save the vertices with x, y and z"));
    }
    reader.finish(place)
}

/// Writes a mesh and fields as a `.ply` file, as text or binary (little-endian, coordinates and fields as doubles): [`read`] turns either
/// into the same bits. Edges are left out: programs that read the format stop at elements that they do not know; and some that do not
/// mind labels of faces in text fail on them in binary files. A field of several components is as many properties `NAME_0`, `NAME_1`, ...
///
/// # Errors
/// What `out` says.
pub fn write(mesh: &Mesh, fields: &Fields, form: Form, out: &mut dyn Write) -> io::Result<()> {
    let [of_vertices, of_faces] = [&fields.vertices, &fields.triangles].map(|fields| properties(fields));
    let name = if form == Form::Text { "ascii" } else { "binary_little_endian" };
    let mut sink = Sink::new(form, out);
    sink.line(format_args!(
        "ply\nformat {name} 1.0\ncomment voronaut\nelement vertex {}\nproperty double x\nproperty double y\n\
         property double z\nproperty int label\n{of_vertices}element face {}\nproperty list uchar uint vertex_indices\n\
         property int label\n{of_faces}end_header",
        mesh.points.len(),
        mesh.triangles.len()
    ))?;
    for (i, (point, label)) in mesh.points.iter().zip(labels(&mesh.point_labels)).enumerate() {
        sink.put_all(*point);
        sink.put(label);
        sink.row(fields.vertices.iter().flat_map(|field| field.values.row(i)).copied())?;
    }
    for (i, (triangle, label)) in mesh.triangles.iter().zip(labels(&mesh.triangle_labels)).enumerate() {
        sink.put(3_u8);
        sink.put_all(*triangle);
        sink.put(label);
        sink.row(fields.triangles.iter().flat_map(|field| field.values.row(i)).copied())?;
    }
    Ok(())
}

/// The properties of fields, one for each component; names have no spaces here, and are none that mean something else.
fn properties(fields: &[Field]) -> String {
    let name = |field: &Field| field.name.split_whitespace().collect::<Vec<_>>().join("_");
    let columns = |field: &Field| match field.values.components() {
        1 => vec![name(field)],
        several => (0..several).map(|i| format!("{}_{i}", name(field))).collect(),
    };
    let names =
        distinct_names(fields.iter().flat_map(columns), &[["x", "y", "z", "label"].as_slice(), &LOOKS].concat());
    names.into_iter().fold(String::new(), |text, name| text + "property double " + &name + "\n")
}

/// Properties that are shown, not computed with.
const LOOKS: [&str; 7] = ["nx", "ny", "nz", "red", "green", "blue", "alpha"];

const AXES: [&str; 3] = ["x", "y", "z"];

/// What a property means.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    Coordinate(usize),
    End(usize),
    Label,
    Vertices,
    Strips,
    Field(usize),
    None,
}

#[derive(Default)]
struct Reader {
    mesh: Mesh,
    polygons: Polygons,
    /// Name and values of properties of vertices and of faces.
    fields: [Vec<(String, Vec<f64>)>; 2],
    largest: Largest,
}

impl Reader {
    fn read_element(&mut self, element: &Element, source: &mut Source<'_>) -> Result<()> {
        if element.properties.is_empty() {
            // Nothing to read, however many there are.
            return Ok(());
        }
        let roles: Vec<Role> = element.properties.iter().map(|property| self.role(&element.name, property)).collect();
        let lacks = |axis: &usize| element.name == "vertex" && !roles.contains(&Role::Coordinate(*axis));
        if let Some(axis) = (0..3).find(lacks) {
            let what = format!("the element vertex has no property {}", AXES[axis]);
            return Err(source.error(what, "save the vertices with x, y and z"));
        }
        At::rows(&element.name, element.count).try_for_each(|at| self.read_row(element, &roles, source, at))
    }

    fn role(&mut self, element: &str, property: &Property) -> Role {
        let name = property.name.as_str();
        let fields = match (element, property.shape) {
            ("face", Shape::List(..)) if header::VERTEX_LISTS.contains(&name) => return Role::Vertices,
            ("tristrips", Shape::List(..)) if header::VERTEX_LISTS.contains(&name) => return Role::Strips,
            (_, Shape::List(..)) => return Role::None,
            ("vertex" | "face" | "edge", _) if name == "label" => return Role::Label,
            ("vertex", _) => &mut self.fields[0],
            ("face", _) => &mut self.fields[1],
            ("edge", _) => {
                return ["vertex1", "vertex2"].iter().position(|end| *end == name).map_or(Role::None, Role::End);
            }
            _ => return Role::None,
        };
        match AXES.iter().position(|axis| *axis == name) {
            Some(axis) if element == "vertex" => Role::Coordinate(axis),
            _ if LOOKS.contains(&name) => Role::None,
            _ => {
                fields.push((name.to_owned(), Vec::new()));
                Role::Field(fields.len() - 1)
            }
        }
    }

    fn read_row(&mut self, element: &Element, roles: &[Role], source: &mut Source<'_>, at: At<'_>) -> Result<()> {
        let (mut point, mut ends, mut label) = ([f64::NAN; 3], [None; 2], 0);
        for (property, &role) in element.properties.iter().zip(roles) {
            let kind = match property.shape {
                Shape::Scalar(kind) => kind,
                Shape::List(counts, kind) => {
                    self.read_list(role, counts, kind, source, at)?;
                    continue;
                }
            };
            if role == Role::None {
                source.skip(1, kind, at)?;
                continue;
            }
            let value = source.any_number(kind, at)?;
            match role {
                Role::Coordinate(axis) => point[axis] = value,
                Role::Label => label = whole_label(value, source, at)?,
                Role::End(end) => ends[end] = Some(self.vertex(value, source, at)?),
                Role::Field(_) if !value.is_finite() => {
                    return Err(fault("a value is not finite", "remove or correct it", source, at));
                }
                Role::Field(field) => self.fields[usize::from(element.name == "face")][field].1.push(value),
                Role::Vertices | Role::Strips | Role::None => {}
            }
        }
        match element.name.as_str() {
            "vertex" => {
                if !point.iter().all(|x| x.is_finite()) {
                    return Err(fault("a coordinate is not finite", "remove or correct the vertex", source, at));
                }
                self.mesh.points.push(point);
                self.mesh.point_labels.push(label);
            }
            "face" => self.polygons.label(label),
            "edge" => {
                let [Some(a), Some(b)] = ends else {
                    let help = "write the properties vertex1 and vertex2";
                    return Err(fault("an edge without its ends", help, source, at));
                };
                self.mesh.edges.push([a, b]);
                self.mesh.edge_labels.push(label);
            }
            _ => {}
        }
        Ok(())
    }

    /// Reads a list: a face, strips, or what nobody needs.
    fn read_list(&mut self, role: Role, counts: Kind, kind: Kind, source: &mut Source<'_>, at: At<'_>) -> Result<()> {
        let length = source.any_number(counts, at)?;
        if length.is_nan() || length < 0.0 || length.fract() != 0.0 {
            return Err(fault(&format!("a list of {length} entries"), "lists begin with their length", source, at));
        }
        let (mut face, mut strip) = (Vec::new(), Strip::default());
        for _ in 0..length as u64 {
            let value = source.any_number(kind, at)?;
            match role {
                Role::Vertices => face.push(self.vertex(value, source, at)?),
                Role::Strips if value + 1.0 == 0.0 => std::mem::take(&mut strip).demand_triangles(source, at)?,
                Role::Strips => {
                    if let Some(triangle) = strip.with(self.vertex(value, source, at)?) {
                        self.polygons.push(&triangle);
                    }
                }
                _ => {}
            }
        }
        strip.demand_triangles(source, at)?;
        if role == Role::Vertices {
            if face.len() < 3 {
                let what = format!("a face of {} vertices", face.len());
                return Err(fault(&what, "a face needs three vertices or more", source, at));
            }
            self.polygons.push(&face);
        }
        Ok(())
    }

    /// Faces may stand before the vertices: whether these exist is known at the end.
    fn finish(mut self, file: &str) -> Result<Document> {
        self.largest.check("vertex", 0, self.mesh.points.len(), file)?;
        (self.mesh.triangles, self.mesh.triangle_labels) = self.polygons.cut(&self.mesh.points);
        let triangles = self.mesh.triangles.len();
        // Fields of triangles are those of faces only where each face is one.
        self.fields[1].retain(|(_, values)| values.len() == triangles);
        let field = |(name, values)| Field { name, values: SolutionValues::Scalar(values) };
        let [vertices, triangles] = self.fields.map(|fields| fields.into_iter().map(field).collect());
        Ok(Document { mesh: self.mesh, fields: Fields { vertices, triangles }, notes: Vec::new() })
    }

    fn vertex(&mut self, value: f64, source: &Source<'_>, at: At<'_>) -> Result<u32> {
        if (0.0..f64::from(u32::MAX)).contains(&value) && value.fract() == 0.0 {
            let vertex = value as u32;
            self.largest.note(vertex, source.place());
            return Ok(vertex);
        }
        Err(fault(&format!("vertex {value} does not exist"), "number vertices from 0", source, at))
    }
}

fn whole_label(value: f64, source: &Source<'_>, at: At<'_>) -> Result<i32> {
    let label = value as i32;
    if f64::from(label) - value == 0.0 {
        return Ok(label);
    }
    Err(fault(&format!("the label {value}"), "labels are whole numbers of 32 bits", source, at))
}

/// An error at the number read last, with its element and row.
fn fault(what: &str, help: &str, source: &Source<'_>, at: At<'_>) -> Error {
    source.error(format!("{what} ({at})"), help)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "comment by hand\nobj_info none\nelement vertex 4\nproperty float x\nproperty uchar shade\nproperty \
                        double y\nproperty float z\nelement face 2\nproperty list uchar int vertex_indices\nproperty list \
                        ushort short extra\nelement nothing 4000000000\n";

    fn text(body: &str) -> Vec<u8> {
        format!("ply\nformat ascii 1.0\n{HEAD}end_header\n{body}").into_bytes()
    }

    const BODY: &str = "0 9 0 0\n1 9 0 0\n1 9 1 0\n0 9 1 0.5\n4 0 1 2 3 1 -7\n3 2 1 0 0\n";

    fn binary(big: bool) -> Vec<u8> {
        let order = |bytes: &mut Vec<u8>, mut value: Vec<u8>| {
            if big {
                value.reverse();
            }
            bytes.extend(value);
        };
        let name = if big { "big" } else { "little" };
        let mut bytes = format!("ply\r\nformat binary_{name}_endian 1.0\r\n{HEAD}end_header\n").into_bytes();
        for [x, y, z] in [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.5_f32]] {
            order(&mut bytes, x.to_le_bytes().into());
            bytes.push(9);
            order(&mut bytes, f64::from(y).to_le_bytes().into());
            order(&mut bytes, z.to_le_bytes().into());
        }
        for (face, extra) in [(vec![0_i32, 1, 2, 3], vec![-7_i16]), (vec![2, 1, 0], vec![])] {
            bytes.push(face.len() as u8);
            for v in face {
                order(&mut bytes, v.to_le_bytes().into());
            }
            order(&mut bytes, (extra.len() as u16).to_le_bytes().into());
            for v in extra {
                order(&mut bytes, v.to_le_bytes().into());
            }
        }
        bytes
    }

    #[test]
    fn text_and_both_byte_orders_say_the_same() {
        let mesh = read(text(BODY).as_slice(), "a.ply").unwrap().mesh;
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [2, 1, 0]]);
        assert_eq!(mesh.points[3].map(f64::to_bits), [0.0_f64, 1.0, 0.5].map(f64::to_bits));
        assert_eq!(read(binary(false).as_slice(), "a.ply").unwrap().mesh, mesh);
        assert_eq!(read(binary(true).as_slice(), "a.ply").unwrap().mesh, mesh);
    }

    #[test]
    fn what_is_written_reads_back() {
        let mesh = Mesh {
            points: vec![[0.1, -1e-300, 1e22], [1.0 / 3.0, 0.0, -2.5], [0.0, 1.0, f64::MIN_POSITIVE]],
            point_labels: vec![0, -5, i32::MAX],
            triangles: vec![[0, 1, 2], [2, 1, 0]],
            triangle_labels: vec![7, i32::MIN],
            ..Mesh::default()
        };
        let field = |name: &str, values: Vec<f64>| Field { name: name.into(), values: SolutionValues::Scalar(values) };
        let vertices = vec![field("u", vec![0.1, 0.2, -1e99]), field("h", vec![1.0; 3])];
        let fields = Fields { vertices, triangles: vec![field("error", vec![0.5, 1.5])] };
        let document = Document { fields, ..mesh.into() };
        let mut out = Vec::new();
        for form in [Form::Text, Form::Binary] {
            out.clear();
            write(&document.mesh, &document.fields, form, &mut out).unwrap();
            assert_eq!(read(out.as_slice(), "a.ply").unwrap(), document);
        }
        let values = SolutionValues::Tensor(vec![[1.0, 0.5, 2.0]; 3]);
        let tensors = Fields { vertices: vec![Field { name: "my metric".into(), values }], triangles: vec![] };
        out.clear();
        write(&document.mesh, &tensors, Form::Text, &mut out).unwrap();
        let again = read(out.as_slice(), "a.ply").unwrap();
        let names: Vec<_> = again.fields.vertices.iter().map(|field| field.name.as_str()).collect();
        assert_eq!(names, ["my_metric_0", "my_metric_1", "my_metric_2"]);
        let clashing = ["x", "label", ""].map(|name| field(name, vec![7.0; 3]));
        let clashing = Fields { vertices: clashing.to_vec(), triangles: vec![] };
        out.clear();
        write(&document.mesh, &clashing, Form::Binary, &mut out).unwrap();
        let again = read(out.as_slice(), "a.ply").unwrap();
        assert_eq!((&again.mesh, again.fields.vertices.len()), (&document.mesh, 3));
    }

    const ONE: &str = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";

    #[test]
    fn values_of_faces_that_are_not_one_triangle_each_are_left_out() {
        let list = "property list uchar int vertex_index\n";
        for (lists, row, triangles) in [("", "0.5", 0), (list, "0.5 3 0 0 0", 1), (list, "0.5 4 0 0 0 0", 2)] {
            let text = format!("{ONE}element face 1\nproperty float u\n{lists}end_header\n0 0 0\n{row}\n");
            let found = read(text.as_bytes(), "a.ply").unwrap();
            assert_eq!((found.mesh.triangles.len(), found.fields.triangles.len()), (triangles, triangles % 2), "{row}");
        }
    }

    #[test]
    fn labels_are_whole_numbers() {
        for label in ["0.5", "3e9", "-2147483649"] {
            let text = format!("{ONE}property double label\nend_header\n0 0 0 {label}\n");
            assert!(message(text.as_bytes()).starts_with("a.ply:9: the label "), "{label}");
        }
        let text = format!("{ONE}property double label\nend_header\n0 0 0 -2147483648\n");
        assert_eq!(read(text.as_bytes(), "a.ply").unwrap().mesh.point_labels, [i32::MIN]);
    }

    fn message(bytes: &[u8]) -> String {
        let error = read(bytes, "a.ply").unwrap_err();
        assert!(!error.help().is_empty());
        error.to_string()
    }

    #[test]
    fn errors_in_the_body_say_what_and_where() {
        for (body, expected) in [
            (&BODY[..9], "a.ply:16: the text ends in row 2 of 4 of vertex"),
            ("0 9 0 nan", "a.ply:15: 'nan' is not a finite number (row 1 of 4 of vertex)"),
            ("0 9 0 0 0 9 0 0 0 9 0 0 0 9 0 0\n2 0 1 0", "a.ply:16: a face of 2 vertices (row 1 of 2 of face)"),
            ("0 9 0 0 0 9 0 0 0 9 0 0 0 9 0 0\n3 0 1 -1", "a.ply:16: vertex -1 does not exist (row 1 of 2 of face)"),
            (
                "0 9 0 0 0 9 0 0 0 9 0 0 0 9 0 0\n3 0 1 4 0\n3 0 1 2 0",
                "a.ply:16: vertex 4 does not exist: the file lists 4, from 0",
            ),
            ("0 9 0 0 0 9 0 0 0 9 0 0 0 9 0 0\n1e18 0 1", "a.ply:16: the text ends in row 1 of 2 of face"),
            ("0 9 0 0 0 9 0 0 0 9 0 0 0 9 0 0\n3 0 1 2 0\n3 0 1 2 0\n7", "a.ply:18: the file goes on behind"),
            ("0 9 0 0 0 9 0 0 0 9 0 0 0 9 0 0\n-1", "a.ply:16: a list of -1 entries (row 1 of 2 of face)"),
        ] {
            let message = message(&text(body));
            assert!(message.starts_with(expected), "{message}");
        }
        let whole = binary(true);
        let first = whole.len() - 2 - 13 - 4 - 17 - 4 * 17;
        assert_eq!(
            message(&whole[..first + 20]),
            format!("a.ply, byte {}: the file ends in row 2 of 4 of vertex", first + 17)
        );
        let mut bad = whole;
        bad[first + 17..first + 21].copy_from_slice(&f32::NAN.to_be_bytes());
        assert_eq!(
            message(&bad),
            format!("a.ply, byte {}: a coordinate is not finite (row 2 of 4 of vertex)", first + 34)
        );
    }

    #[test]
    fn errors_in_the_head_name_their_line() {
        for (text, expected) in [
            ("", "a.ply:1: the file does not begin with ply"),
            ("plywood\n", "a.ply:1: the file does not begin with ply"),
            ("ply\nformat ascii 1.0\nelement vertex 1\n", "a.ply:3: the head has no end_header"),
            ("ply\nformat ascii 2.0\nend_header\n", "a.ply:2: format 'ascii 2.0' is not known"),
            ("ply\nformat\nend_header\n", "a.ply:2: format '' is not known"),
            ("ply\nelement vertex 0\nend_header\n", "a.ply:3: the head has no line format"),
            ("ply\nformat ascii 1.0\nproperty float x\nend_header\n", "a.ply:3: a property before any element"),
            ("ply\nformat ascii 1.0\nelement vertex -1\nend_header\n", "a.ply:3: '-1' is out of range"),
            ("ply\nformat ascii 1.0\nelement vertex\nend_header\n", "a.ply:3: an element without name and count"),
            ("ply\nformat ascii 1.0\nelement face 1\nelement face 1\n", "a.ply:4: a second element 'face'"),
            (
                "ply\nformat ascii 1.0\nelement face 0\nproperty quad q\nend_header\n",
                "a.ply:4: 'property quad q' is not",
            ),
            (
                "ply\nformat ascii 1.0\nelement vertex 0\nproperty int u\nproperty int u\nend_header\n",
                "a.ply:5: a second property 'u'",
            ),
            ("ply\nformat ascii 1.0\nfoo\nend_header\n", "a.ply:3: 'foo' has no place in the head"),
            (
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty int y\nend_header\n0 0\n",
                "a.ply:6: the element vertex has no property z",
            ),
            ("ply\nformat ascii 1.0\nelement face 0\nend_header\n", "a.ply:4: the file has no element vertex"),
        ] {
            let message = message(text.as_bytes());
            assert!(message.starts_with(expected), "{message}");
        }
        assert!(message(b"ply\nformat ascii 1.0\n\xff\nend_header\n").starts_with("a.ply:3: the head is no text"));
    }
}
