//! Geomview's `.off` in text form.

use super::codec::{At, Form, Kind, Sink, Source, several};
use super::cutting::cut;
use super::document::labelled;
use std::io::{self, BufRead, Write};
use voronaut::Result;
use voronaut::mesh::Mesh;

/// Reads an `.off` text: vertices, and faces, cut along diagonals that suit them, quadrilaterals along the better one.
///
/// The head may be `OFF` or, with more columns, `COFF`, `NOFF` and their like, or missing; what follows the coordinates and
/// the faces' vertices on their rows (colours, normals) is passed over; a row may go on below. Labels are 0. Memory follows the text, never a
/// count written in it.
///
/// # Errors
///
/// [`voronaut::Error::Parse`] with the line of another head, of what is no finite number, of a row that is too short or
/// missing, of rows left over, and of a vertex that does not exist.
pub fn read(source: impl BufRead, place: &str) -> Result<Mesh> {
    let mut source = Source::new(source, place);
    let [vertices, faces] = read_counts(&mut source)?;
    let mut mesh = Mesh::default();
    for at in At::rows("the vertices", vertices) {
        mesh.points.push(source.numbers(Kind::Float(8), at)?);
        source.skip_row();
    }
    for at in At::rows("the faces", faces) {
        cut(&mesh.points, &read_face(&mut source, at, vertices)?, &mut mesh.triangles);
    }
    source.demand_end("more rows than the counts in the file announce", "check the counts of vertices and faces")?;
    Ok(labelled(mesh))
}

/// Writes vertices and triangles as an `.off` text that [`read`] turns into the same; labels and edges have no place there.
///
/// # Errors
/// What `out` says.
pub(crate) fn write(mesh: &Mesh, out: &mut dyn Write) -> io::Result<()> {
    let mut sink = Sink::new(Form::Text, out);
    sink.line(format_args!("OFF\n{} {} 0", mesh.points.len(), mesh.triangles.len()))?;
    mesh.points.iter().try_for_each(|point| sink.row(*point))?;
    mesh.triangles.iter().try_for_each(|&[a, b, c]| sink.row([3, a, b, c]))
}

/// Dialects whose vertices begin with their three coordinates.
const HEADS: [&str; 7] = ["OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF"];

/// The numbers of vertices and faces; that of edges may follow and means nothing.
fn read_counts(source: &mut Source<'_>) -> Result<[u64; 2]> {
    let at = At::head("the file");
    let first = source.word(at)?;
    if first.text.starts_with(|c: char| c.is_ascii_digit()) {
        source.unread();
    } else if !HEADS.iter().any(|head| head.eq_ignore_ascii_case(first.text)) {
        let what = format!("the file begins with '{}', not with OFF", first.quoted());
        return Err(first.place.error(what, "give a file in the text form of .off"));
    }
    let next = source.word(at)?;
    if next.text.eq_ignore_ascii_case("BINARY") {
        return Err(next.place.error("a binary .off file", "save it as text, or as .ply or .stl"));
    }
    source.unread();
    let counts = several(|| source.word(at)?.whole(at))?;
    source.skip_row();
    Ok(counts)
}

/// The vertices of a face.
fn read_face(source: &mut Source<'_>, at: At<'_>, vertices: u64) -> Result<Vec<u32>> {
    let word = source.word(at)?;
    let (place, count) = (word.place, word.whole::<u64>(at)?);
    if count < 3 {
        return Err(place.error(format!("a face of {count} vertices ({at})"), "a face needs three vertices or more"));
    }
    let face = (0..count).map(|_| source.word(at)?.vertex(0, vertices, at)).collect();
    source.skip_row();
    face
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dialects() {
        for text in [
            "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n",
            "COFF 4 1 5 # counts\n\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n1 1 0 0 0 0 0\n0 1 0 9 9 9 9\n4 0 1 2 3",
            "4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
            "OFF\n4 1 0\n0 0 0\n1\n0 0\n1 1 0\n0 1 0\n4\n0 \n1\n2 3 255\n",
        ] {
            let mesh = read(text.as_bytes(), "a.off").unwrap();
            assert_eq!(mesh.points[2].map(f64::to_bits), [1.0_f64, 1.0, 0.0].map(f64::to_bits));
            assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        }
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
        let mut out = Vec::new();
        write(&mesh, &mut out).unwrap();
        assert_eq!(read(out.as_slice(), "a.off").unwrap(), mesh);
    }

    #[test]
    fn errors_say_what_and_where() {
        for (text, expected) in [
            ("", "a.off:1: the text ends in the head of the file"),
            ("solid\n", "a.off:1: the file begins with 'solid', not with OFF"),
            ("OFF BINARY\n", "a.off:1: a binary .off file"),
            ("OFF\n3", "a.off:2: the text ends in the head of the file"),
            ("OFF\n9000000000000000000 1 0\n0 0 0", "a.off:3: the text ends in row 2 of 9000000000000000000 of the v"),
            ("OFF\n1 1 0\n0 0\n", "a.off:3: the text ends in row 1 of 1 of the vertices"),
            ("OFF\n1 1 0\n0 0 inf\n", "a.off:3: 'inf' is not a finite number (row 1 of 1 of the vertices)"),
            ("OFF\n1 1 0\n0 0 0\n2 0 0", "a.off:4: a face of 2 vertices (row 1 of 1 of the faces)"),
            ("OFF\n1 1 0\n0 0 0\n3 0 0 1", "a.off:4: vertex 1 does not exist (row 1 of 1 of the faces)"),
            ("OFF\n1 1 0\n0 0 0\n3 0 0 -1", "a.off:4: '-1' is out of range"),
            ("OFF\n1 1 0\n0 0 0\n4000000000 0 0 0", "a.off:4: the text ends in row 1 of 1 of the faces"),
            ("OFF\n1 1 0\n0 0 0\n3 0 0 0\n1 1 1\n", "a.off:5: more rows than the counts in the file announce"),
            ("OFF\n1 2 0\n0 0 0\n3 0 0 0", "a.off:4: the text ends in row 2 of 2 of the faces"),
        ] {
            let error = read(text.as_bytes(), "a.off").unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }
}
