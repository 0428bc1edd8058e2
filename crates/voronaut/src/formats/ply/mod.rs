//! Stanford's `.ply`, as text and binary in both byte orders.

mod header;
mod source;

use crate::error::{Error, Result};
use crate::mesh::Mesh;
use header::{Element, Header, Shape};
use source::Source;

/// Reads a `.ply` file: `x`, `y`, `z` of the element `vertex`, and the lists `vertex_indices` (or `vertex_index`) of the
/// element `face`, cut into fans around their first vertex. All other properties and elements are passed over, labels
/// are 0. Memory follows the file, never a count written in it.
///
/// # Errors
///
/// [`Error::Parse`] with the line (in the head and in text) or the byte of what is not as announced: a head that makes no
/// sense, a file cut off, a coordinate that is not finite, a face of fewer than three vertices, a vertex that does not
/// exist. [`Error::Unsupported`] of triangle strips.
pub fn read(bytes: &[u8], place: &str) -> Result<Mesh> {
    let header = Header::read(bytes, place)?;
    let mut source = Source::new(&header, bytes, place)?;
    let mut reader = Reader { mesh: Mesh::default(), place };
    for element in &header.elements {
        reader.read_element(element, &mut source)?;
    }
    let Reader { mut mesh, .. } = reader;
    if !header.elements.iter().any(|element| element.name == "vertex") {
        return Err(Error::parse(place, "the file has no element vertex", "save the vertices with x, y and z"));
    }
    check_faces(&mesh, place)?;
    mesh.point_labels = vec![0; mesh.points.len()];
    mesh.triangle_labels = vec![0; mesh.triangles.len()];
    Ok(mesh)
}

/// Writes vertices and triangles as a `.ply` file in binary form, little-endian, with coordinates as doubles: [`read`] turns it
/// into the same bits. Labels and edges are left out.
pub fn write(mesh: &Mesh) -> Vec<u8> {
    let head = format!(
        "ply\nformat binary_little_endian 1.0\ncomment voronaut\nelement vertex {}\nproperty double x\nproperty double y\n\
         property double z\nelement face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        mesh.points.len(),
        mesh.triangles.len()
    );
    let mut bytes = head.into_bytes();
    bytes.extend(mesh.points.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    for triangle in &mesh.triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|v| v.to_le_bytes()));
    }
    bytes
}

struct Reader<'a> {
    mesh: Mesh,
    place: &'a str,
}

impl Reader<'_> {
    fn read_element(&mut self, element: &Element, source: &mut Source<'_>) -> Result<()> {
        if element.name == "tristrips" && element.count > 0 {
            let what = format!("triangle strips ({})", self.place);
            return Err(Error::Unsupported { what, help: "save the faces one by one, as element face".into() });
        }
        if element.properties.is_empty() {
            // Nothing to read, however many there are.
            return Ok(());
        }
        for row in 1..=element.count {
            source.begin(&element.name, row, element.count);
            let mut point = [f64::NAN; 3];
            for property in &element.properties {
                match property.shape {
                    Shape::Scalar(kind) => {
                        let value = source.number(kind)?;
                        if let Some(axis) = ["x", "y", "z"].iter().position(|axis| *axis == property.name) {
                            point[axis] = value;
                        }
                    }
                    Shape::List(counts, kind) => {
                        let is_face = element.name == "face" && header::VERTEX_LISTS.contains(&property.name.as_str());
                        let list = read_list(source, counts, kind, is_face)?;
                        self.push_face(&list, is_face, source)?;
                    }
                }
            }
            if element.name == "vertex" {
                self.push_vertex(point, source)?;
            }
        }
        Ok(())
    }

    fn push_vertex(&mut self, point: [f64; 3], source: &Source<'_>) -> Result<()> {
        if !point.iter().all(|x| x.is_finite()) {
            return Err(source.error("a coordinate is not finite", "remove or correct the vertex"));
        }
        self.mesh.points.push(point);
        Ok(())
    }

    fn push_face(&mut self, polygon: &[u32], is_face: bool, source: &Source<'_>) -> Result<()> {
        if !is_face {
            return Ok(());
        }
        if polygon.len() < 3 {
            let what = format!("a face of {} vertices", polygon.len());
            return Err(source.error(&what, "a face needs three vertices or more"));
        }
        self.mesh.triangles.extend(polygon[1..].windows(2).map(|pair| [polygon[0], pair[0], pair[1]]));
        Ok(())
    }
}

/// The entries of a list; those of lists that nobody needs are passed over.
fn read_list(source: &mut Source<'_>, counts: header::Kind, kind: header::Kind, keep: bool) -> Result<Vec<u32>> {
    let length = source.number(counts)?;
    if length < 0.0 || length.fract() != 0.0 {
        return Err(source.error(&format!("a list of {length} entries"), "lists begin with their length"));
    }
    let mut list = Vec::new();
    for _ in 0..length as u64 {
        let value = source.number(kind)?;
        if !keep {
            continue;
        }
        if value < 0.0 || value.fract() != 0.0 || value >= f64::from(u32::MAX) {
            return Err(source.error(&format!("vertex {value} does not exist"), "number vertices from 0"));
        }
        list.push(value as u32);
    }
    Ok(list)
}

/// Faces may stand before the vertices: whether these exist is known at the end.
fn check_faces(mesh: &Mesh, place: &str) -> Result<()> {
    let count = mesh.points.len();
    let Some(vertex) = mesh.triangles.as_flattened().iter().find(|&&v| v as usize >= count) else { return Ok(()) };
    let what = format!("a face with vertex {vertex}, which does not exist: the file lists {count}, from 0");
    Err(Error::parse(place, what, "check the faces, and that the file is whole"))
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
        let mesh = read(&text(BODY), "a.ply").unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [2, 1, 0]]);
        assert_eq!(mesh.points[3].map(f64::to_bits), [0.0_f64, 1.0, 0.5].map(f64::to_bits));
        assert_eq!(read(&binary(false), "a.ply").unwrap(), mesh);
        assert_eq!(read(&binary(true), "a.ply").unwrap(), mesh);
    }

    #[test]
    fn what_is_written_reads_back() {
        let mesh = Mesh {
            points: vec![[0.1, -1e-300, 1e22], [1.0 / 3.0, 0.0, -2.5], [0.0, 1.0, f64::MIN_POSITIVE]],
            point_labels: vec![0; 3],
            triangles: vec![[0, 1, 2], [2, 1, 0]],
            triangle_labels: vec![0; 2],
            ..Mesh::default()
        };
        assert_eq!(read(&write(&mesh), "a.ply").unwrap(), mesh);
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
            ("0 9 0 0 0 9 0 0 0 9 0 0 0 9 0 0\n3 0 1 4 0\n3 0 1 2 0", "a.ply: a face with vertex 4, which does not"),
            ("0 9 0 0 0 9 0 0 0 9 0 0 0 9 0 0\n1e18 0 1", "a.ply:16: the text ends in row 1 of 2 of face"),
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
            (
                "ply\nformat ascii 1.0\nelement face 0\nproperty quad q\nend_header\n",
                "a.ply:4: 'property quad q' is not",
            ),
            ("ply\nformat ascii 1.0\nfoo\nend_header\n", "a.ply:3: 'foo' has no place in the head"),
            ("ply\nformat ascii 1.0\nelement face 0\nend_header\n", "a.ply: the file has no element vertex"),
        ] {
            let message = message(text.as_bytes());
            assert!(message.starts_with(expected), "{message}");
        }
        assert!(message(b"ply\nformat ascii 1.0\n\xff\nend_header\n").starts_with("a.ply: the head is no text"));
        let bytes = b"ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n";
        assert_eq!(message(bytes), "not supported: triangle strips (a.ply)");
    }
}
