//! Stereolithography `.stl`, as text and binary: triangles without shared vertices.

use super::codec::{At, Form, Kind, Order, Sink, Source};
use super::document::labelled;
use std::collections::HashMap;
use std::io::{self, BufRead, Write};
use voronaut::Result;
use voronaut::mesh::Mesh;

/// Reads an `.stl` file. Corners with exactly the same coordinates become one vertex, in the order of the file (the
/// format has no other way to say that triangles are neighbours); nothing else is joined. Normals, names and attributes
/// are passed over, labels are 0.
///
/// A file is text if it begins with `solid` and goes on as text, else binary. Memory follows the file, never a count written in it.
///
/// # Errors
///
/// [`Error::Parse`](voronaut::Error::Parse) with the line or the byte of what is not as announced: a file cut off or longer than its count of triangles, a
/// coordinate that is no finite number, words out of place. [`Error::Io`](voronaut::Error::Io) of a file that cannot be read.
pub fn read(source: impl BufRead, place: &str) -> Result<Mesh> {
    let mut source = Source::new(source, place);
    if is_text(source.ahead()?) {
        return read_text(source);
    }
    source.be_binary(Order::Little);
    read_binary(source)
}

/// Writes triangles as a binary `.stl` file. The format has single precision: corners are rounded, and
/// those that come to lie on each other are one vertex when the file is read. It has no shared vertices, no labels, no edges.
///
/// # Errors
/// What `out` says; [`io::ErrorKind::InvalidInput`] of coordinates beyond 3e38.
pub(crate) fn write(mesh: &Mesh, out: &mut dyn Write) -> io::Result<()> {
    write!(out, "{:HEAD$}", "voronaut")?;
    let mut sink = Sink::new(Form::Binary, out);
    sink.row([mesh.triangles.len() as u32])?;
    for &triangle in &mesh.triangles {
        let corners = mesh.positions_of(triangle);
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).unit().unwrap_or_default();
        let numbers = [normal.x, normal.y, normal.z].into_iter().chain(corners.iter().flat_map(|p| p.to_array()));
        if corners.iter().flat_map(|p| p.to_array()).any(|x| !(x as f32).is_finite()) {
            let what = "a coordinate beyond 3e38, the range of single precision";
            return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
        }
        sink.put_all(numbers.map(|x| x as f32));
        sink.row([0_u8; 2])?;
    }
    Ok(())
}

/// The head of a binary file: 80 bytes of anything. The number of triangles follows.
const HEAD: usize = 80;
/// A binary triangle: normal, three corners, an attribute of two bytes.
const TRIANGLE: usize = 50;

/// Whether a file that begins like this is text. Heads of binary files may begin with `solid`, too, but have zeros or numbers soon.
fn is_text(start: &[u8]) -> bool {
    let start = start.trim_ascii_start();
    let seen = &start[..start.len().min(2 * (HEAD + TRIANGLE))];
    let is_readable = |byte: &u8| !byte.is_ascii_control() || byte.is_ascii_whitespace();
    start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) && seen.iter().all(is_readable)
}

fn read_binary(mut source: Source<'_>) -> Result<Mesh> {
    let head = At::head("the file (neither text nor a whole binary file)");
    source.skip_bytes(HEAD as u64, head)?;
    let count = source.whole(Kind::Unsigned(4), head)?;
    let mut corners = Corners::default();
    for at in At::rows("the triangles", count) {
        // Some programs write nan for the normals of thin triangles; nobody needs them.
        source.skip(3, Kind::Float(4), at)?;
        for _ in 0..3 {
            corners.push(source.numbers(Kind::Float(4), at)?);
        }
        source.skip(1, Kind::Unsigned(2), at)?;
    }
    let what = format!("the file goes on behind the {count} triangles that it announces");
    source.demand_end(&what, "give an .stl file as text ('solid ...') or binary; this one may be damaged")?;
    Ok(corners.into_mesh())
}

fn read_text(mut source: Source<'_>) -> Result<Mesh> {
    let (mut corners, mut facets, mut is_open) = (Corners::default(), 0, false);
    while let Some(word) = source.next_word()? {
        match word.text.to_ascii_lowercase().as_str() {
            keyword @ ("solid" | "endsolid") => {
                is_open = keyword == "solid";
                // Names of solids are any words on their lines.
                source.skip_row();
            }
            "facet" => {
                facets += 1;
                read_facet(&mut source, facets, &mut corners)?;
            }
            _ => {
                let what = format!("'{}' where a facet or endsolid should be", word.quoted());
                return Err(word.place.error(what, "check the end of the facet before"));
            }
        }
    }
    if is_open {
        return Err(source.error("the text ends without endsolid", "the file is cut off: write it again"));
    }
    Ok(corners.into_mesh())
}

fn read_facet(source: &mut Source<'_>, number: u64, corners: &mut Corners) -> Result<()> {
    let at = At { section: "the facets", row: number, rows: number };
    expect(source, &["normal"], at)?;
    // Some programs write nan for the normals of thin triangles; nobody needs them.
    source.skip(3, Kind::Float(4), at)?;
    expect(source, &["outer", "loop"], at)?;
    for _ in 0..3 {
        expect(source, &["vertex"], at)?;
        corners.push(source.numbers(Kind::Float(4), at)?);
    }
    expect(source, &["endloop", "endfacet"], at)
}

fn expect(source: &mut Source<'_>, words: &[&str], at: At<'_>) -> Result<()> {
    for expected in words {
        let word = source.word(at)?;
        if !word.text.eq_ignore_ascii_case(expected) {
            let what = format!("'{}' where '{expected}' should be ({at})", word.quoted());
            let help = "write facets as 'facet normal', 'outer loop', three times 'vertex'";
            return Err(word.place.error(what, help));
        }
    }
    Ok(())
}

/// Corners joined into vertices as they come.
#[derive(Default)]
struct Corners {
    known: HashMap<[u64; 3], u32>,
    points: Vec<[f64; 3]>,
    vertices: Vec<u32>,
}

impl Corners {
    fn push(&mut self, point: [f64; 3]) {
        // Adding zero makes -0 equal to 0 in its bits, too.
        let key = point.map(|x| (x + 0.0).to_bits());
        let vertex = *self.known.entry(key).or_insert_with(|| {
            self.points.push(point);
            self.points.len() as u32 - 1
        });
        self.vertices.push(vertex);
    }

    fn into_mesh(self) -> Mesh {
        let triangles = self.vertices.as_chunks().0.to_vec();
        labelled(Mesh { points: self.points, triangles, ..Mesh::default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid a facet of life\n facet normal nan 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   \
                        vertex 0 1 0\n  endloop\n endfacet\nfacet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\n\
                        vertex -0 1 0\nendloop\nendfacet\nendsolid a facet of life\n";

    fn binary(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = b"solid, says a binary file".to_vec();
        bytes.resize(80, b' ');
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn text_and_binary_say_the_same() {
        let mesh = read(TEXT.as_bytes(), "a.stl").unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
        let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        assert_eq!(read(binary(&[[a, b, c], [b, d, c]]).as_slice(), "a.stl").unwrap(), mesh);
    }

    #[test]
    fn what_is_written_has_the_same_triangles() {
        let mesh = Mesh {
            points: vec![[0.1, 0.0, 0.5], [1.0 / 3.0, 2.0, -2.5], [0.0, 1e7, 3.0], [7.0, 8.0, 9.0]],
            triangles: vec![[3, 1, 2], [2, 1, 0]],
            ..Mesh::default()
        };
        let mut out = Vec::new();
        write(&mesh, &mut out).unwrap();
        let again = read(out.as_slice(), "a.stl").unwrap();
        assert_eq!((again.points.len(), again.triangles.len()), (4, 2));
        for (found, truth) in again.triangles.iter().zip(&mesh.triangles) {
            let rounded = mesh.positions_of(*truth).map(|p| p.to_array().map(|x| f64::from(x as f32).to_bits()));
            assert_eq!(again.positions_of(*found).map(|p| p.to_array().map(f64::to_bits)), rounded);
        }
        let normal = &out[HEAD + 4 + TRIANGLE..][..12];
        assert!(normal.iter().any(|&byte| byte != 0), "normals are written");
    }

    #[test]
    fn errors_say_what_and_where() {
        let message = |bytes: &[u8]| {
            let error = read(bytes, "a.stl").unwrap_err();
            assert!(!error.help().is_empty());
            error.to_string()
        };
        assert_eq!(message(b"solid a\n\nendsolid\nsolid b\n"), "a.stl:4: the text ends without endsolid");
        let whole = binary(&[[[0.0; 3]; 3]; 2]);
        let neither = "(neither text nor a whole binary file)";
        assert_eq!(message(&[]), format!("a.stl, byte 0: the file ends in the head of the file {neither}"));
        assert!(message(b"solid x\nfacet normal 0 0 1 inner").starts_with("a.stl:2: 'inner' where 'outer' should be"));
        let cut = &whole[..whole.len() - 1];
        assert_eq!(message(cut), "a.stl, byte 182: the file ends in row 2 of 2 of the triangles");
        let more = [&whole, [0].as_slice()].concat();
        assert_eq!(message(&more), "a.stl, byte 184: the file goes on behind the 2 triangles that it announces");
        let mut lying = whole;
        lying[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        assert_eq!(message(&lying), "a.stl, byte 184: the file ends in row 3 of 4294967295 of the triangles");
        let bad = binary(&[[[0.0; 3]; 3], [[0.0, f32::NAN, 0.0]; 3]]);
        assert_eq!(message(&bad), "a.stl, byte 150: NaN is not a finite number (row 2 of 2 of the triangles)");
        for (from, to, expected) in [
            ("vertex 1 1 0", "vertex 1 1", "a.stl:13: 'vertex' is not a number (row 2 of 2 of the facets)"),
            ("endloop\nendfacet\nends", "", "a.stl:14: 'olid' where 'endloop' should be"),
            ("endsolid", "facets", "a.stl:16: 'facets' where a facet or endsolid should be"),
            ("vertex -0", "vertex inf", "a.stl:13: 'inf' is not a finite number"),
        ] {
            assert!(message(TEXT.replace(from, to).as_bytes()).starts_with(expected), "{expected}");
        }
    }
}
