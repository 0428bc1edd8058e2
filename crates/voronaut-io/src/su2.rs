//! SU2's native `.su2` text: elements, points, and markers, which are boundaries with names. What counts is what SU2's own reader
//! (`CSU2ASCIIMeshReader`) takes.

use super::Document;
use super::codec::{At, Form, Largest, Shortest, Sink, Source, Text};
use super::cutting::cut;
use super::document::{labelled, labels};
use super::volumes::Volumes;
use std::collections::BTreeMap;
use std::io::{self, BufRead, Write};
use voronaut::Result;
use voronaut::mesh::{Edges, Mesh, Periodic};

/// Reads a mesh: sections `NDIME=`, `NELEM=`, `NPOIN=` and `NMARK=` with `MARKER_TAG=` and `MARKER_ELEMS=`, in any order after the
/// first; `%` begins a comment. Other sections are passed over; numbers behind the vertices of an element and the coordinates of
/// a point mean nothing there.
///
/// Triangles are those of the elements, quadrilaterals are cut along their better diagonal, and lines of markers are edges with the
/// marker's label: its tag where that is a whole number that no other has, else the next free number from 1, which a note tells. In three dimensions triangles and
/// quadrilaterals of markers are the surface, with the marker's label; cells are left out with a note, and where there are
/// no triangles the mesh is their boundary. Memory follows the text, never a count written in it.
///
/// # Errors
/// [`voronaut::Error::Parse`] with the line of what is not as announced: a count that is none, a row that is too short, an element
/// of another kind, a point that does not exist, more than one zone.
pub fn read(source: impl BufRead, place: &str) -> Result<Document> {
    let mut source = Source::with_comments(source, place, b'%');
    let mut reader = Reader::default();
    while let Some(row) = source.next_row()? {
        let Some((key, value)) = row.text.split_once('=') else {
            if reader.is_foreign {
                continue;
            }
            let help = "each section begins with KEYWORD= VALUE; check the count of the section before";
            let text = Text { text: row.text.trim(), ..row };
            return Err(row.place.error(format!("'{}' where a section should begin", text.quoted()), help));
        };
        let (key, value) = (key.trim().to_owned(), value.trim().to_owned());
        reader.section(&key, &value, &mut source)?;
    }
    reader.finish(&source)
}

/// Writes a mesh as a text that [`read`] turns into the same points, triangles and labels of the boundary.
///
/// In the plane the markers are the labels of the edges that have one triangle: these are what SU2 calls boundaries, and one that has no label
/// is in marker 0. In space SU2 knows no lines: the markers are the labels of the triangles, and there are no cells.
///
/// Curves that correspond are told in a comment at the end, which is the option `MARKER_PERIODIC` of SU2's configuration: since version 7 SU2
/// looks for periodic boundaries there, and refuses a section `NPERIODIC` in the mesh.
///
/// # Errors
/// What `out` says.
pub(crate) fn write(mesh: &Mesh, out: &mut dyn Write) -> io::Result<()> {
    let mut sink = Sink::new(Form::Text, out);
    let is_planar = mesh.is_planar();
    let elements = if is_planar { &mesh.triangles[..] } else { &[] };
    sink.line(format_args!("NDIME= {}\nNELEM= {}", if is_planar { 2 } else { 3 }, elements.len()))?;
    (0..).zip(elements).try_for_each(|(i, &[a, b, c])| sink.row([TRIANGLE, a, b, c, i]))?;
    sink.line(format_args!("NPOIN= {}", mesh.points.len()))?;
    for (i, point) in (0_u32..).zip(&mesh.points) {
        sink.put_all(point[..if is_planar { 2 } else { 3 }].iter().copied());
        sink.row([i])?;
    }
    if is_planar {
        write_markers(&mut sink, &boundary(mesh), |&ends| [LINE, ends[0], ends[1]])?;
        write_periodic(&mut sink, &mesh.periodic)
    } else {
        let mut markers: BTreeMap<i32, Vec<[u32; 3]>> = BTreeMap::new();
        for (&triangle, label) in mesh.triangles.iter().zip(labels(&mesh.triangle_labels)) {
            markers.entry(label).or_default().push(triangle);
        }
        write_markers(&mut sink, &markers, |&[a, b, c]| [TRIANGLE, a, b, c])
    }
}

/// Of a mesh's edges, those inside: SU2 has no place for them.
pub(super) fn inner_edges(mesh: &Mesh) -> usize {
    let edges = Edges::of(&mesh.triangles);
    mesh.edges.iter().filter(|&&ends| edges.at(ends).len() != 1).count()
}

/// Kinds of elements, as VTK numbers them.
const VERTEX: u32 = 1;
const LINE: u32 = 3;
const TRIANGLE: u32 = 5;
const QUADRILATERAL: u32 = 9;
/// Every kind, and how many points it has: those, then tetrahedra, hexahedra, prisms and pyramids.
const KINDS: [(u32, usize); 8] =
    [(VERTEX, 1), (LINE, 2), (TRIANGLE, 3), (QUADRILATERAL, 4), (10, 4), (12, 8), (13, 6), (14, 5)];

fn write_markers<T, const N: usize>(
    sink: &mut Sink<'_>,
    markers: &BTreeMap<i32, Vec<T>>,
    row: impl Fn(&T) -> [u32; N],
) -> io::Result<()> {
    sink.line(format_args!("NMARK= {}", markers.len()))?;
    for (label, elements) in markers {
        sink.line(format_args!("MARKER_TAG= {label}\nMARKER_ELEMS= {}", elements.len()))?;
        elements.iter().try_for_each(|element| sink.row(row(element)))?;
    }
    Ok(())
}

/// Each pair as SU2 has it: its markers, the centre of a rotation and its angles (degrees), a translation. It is one or the other, for SU2 goes
/// back by both with the other sign.
fn write_periodic(sink: &mut Sink<'_>, pairs: &[Periodic]) -> io::Result<()> {
    let told = |pair: &Periodic| {
        let ([a, b], [c, s], [u, v]) = (pair.labels, pair.rotation, pair.translation);
        let half = 0.5 * if c > 0.0 { (1.0 + c) / s } else { s / (1.0 - c) };
        let is_turned = half.is_finite();
        let angle = if is_turned { s.atan2(c).to_degrees() } else { 0.0 };
        let centre = if is_turned { [0.5 * u - half * v, 0.5 * v + half * u] } else { [0.0; 2] };
        let by = if is_turned { [0.0; 2] } else { [u, v] };
        let ([x, y], [u, v]) = (centre.map(Shortest), by.map(Shortest));
        format!("{a}, {b}, {x}, {y}, 0, 0, 0, {}, {u}, {v}, 0", Shortest(angle))
    };
    if pairs.is_empty() {
        return Ok(());
    }
    let pairs: Vec<String> = pairs.iter().map(told).collect();
    sink.line(format_args!("% MARKER_PERIODIC= ( {} )", pairs.join(", ")))
}

/// The edges of one triangle by their labels, in the order and direction of the triangles.
fn boundary(mesh: &Mesh) -> BTreeMap<i32, Vec<[u32; 2]>> {
    let sorted = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let listed: BTreeMap<[u32; 2], i32> =
        mesh.edges.iter().map(|&ends| sorted(ends)).zip(labels(&mesh.edge_labels)).collect();
    let edges = Edges::of(&mesh.triangles);
    let mut markers: BTreeMap<i32, Vec<[u32; 2]>> = BTreeMap::new();
    for &[a, b, c] in &mesh.triangles {
        for ends in [[a, b], [b, c], [c, a]].into_iter().filter(|&ends| edges.at(ends).len() == 1) {
            markers.entry(listed.get(&sorted(ends)).copied().unwrap_or(0)).or_default().push(ends);
        }
    }
    markers
}

#[derive(Default)]
struct Reader {
    dimension: Option<usize>,
    mesh: Mesh,
    /// Triangles and quadrilaterals, which are cut once all points are there, with their labels.
    faces: Vec<(Vec<u32>, i32)>,
    volumes: Volumes,
    /// The tags of markers, with their labels.
    tags: Vec<(String, i32)>,
    largest: Largest,
    /// Whether the section that was read last means nothing here.
    is_foreign: bool,
    /// Whether the marker that was named last is no boundary.
    is_sent: bool,
}

impl Reader {
    fn section(&mut self, key: &str, value: &str, source: &mut Source<'_>) -> Result<()> {
        let count = |source: &Source<'_>| {
            let first = value.split_whitespace().next().unwrap_or_default();
            Text { place: source.place(), text: first }.whole::<u64>(At::head(key))
        };
        self.is_foreign = false;
        match key {
            "NDIME" => self.dimension = Some(dimension(count(source)?, source)?),
            "NZONE" if count(source)? > 1 => {
                return Err(source.error("more than one zone", "give each zone in a file of its own"));
            }
            "NPOIN" => self.points(count(source)?, source)?,
            "NELEM" => self.elements(At::rows("the elements", count(source)?), 0, source)?,
            // Points that SU2 sends from one part of an older mesh to another: no boundary, and their rows begin with SEND_TO=.
            "MARKER_TAG" | "MARKERTAG" if value == "SEND_RECEIVE" => self.is_sent = true,
            // SU2 does not look at how the word is spelled.
            "MARKER_TAG" | "MARKERTAG" => {
                self.is_sent = false;
                let label = self.label(value);
                self.tags.push((value.to_owned(), label));
            }
            "MARKER_ELEMS" if self.is_sent => self.is_foreign = true,
            "MARKER_ELEMS" => {
                let Some(&(_, label)) = self.tags.last() else {
                    return Err(source.error("MARKER_ELEMS= before any MARKER_TAG=", "name the marker first"));
                };
                self.elements(At::rows("the marker", count(source)?), label, source)?;
            }
            _ => self.is_foreign = true,
        }
        Ok(())
    }

    fn points(&mut self, count: u64, source: &mut Source<'_>) -> Result<()> {
        let Some(dimension) = self.dimension else {
            return Err(source.error("NPOIN= before NDIME=", "begin the file with NDIME= 2 or NDIME= 3"));
        };
        for at in At::rows("the points", count) {
            let mut point = [0.0; 3];
            for x in &mut point[..dimension] {
                *x = source.word(at)?.number(at)?;
            }
            self.mesh.points.push(point);
            source.skip_row();
        }
        Ok(())
    }

    /// Elements, of a marker if they have a label other than 0 or are lines.
    fn elements<'a>(&mut self, rows: impl Iterator<Item = At<'a>>, label: i32, source: &mut Source<'_>) -> Result<()> {
        for at in rows {
            let word = source.word(at)?;
            let (place, kind) = (word.place, word.whole::<u32>(at)?);
            let Some(&(_, size)) = KINDS.iter().find(|(known, _)| *known == kind) else {
                let help = "SU2 knows lines (3), triangles (5), quadrilaterals (9), tetrahedra (10), hexahedra (12), prisms (13) and pyramids (14)";
                return Err(place.error(format!("an element of kind {kind} ({at})"), help));
            };
            let mut points = Vec::with_capacity(size);
            for _ in 0..size {
                let word = source.word(at)?;
                let point: u32 = word.whole(at)?;
                self.largest.note(point, word.place);
                points.push(point);
            }
            source.skip_row();
            match kind {
                VERTEX => {}
                LINE => {
                    self.mesh.edges.push([points[0], points[1]]);
                    self.mesh.edge_labels.push(label);
                }
                TRIANGLE | QUADRILATERAL => self.faces.push((points, label)),
                _ => drop(self.volumes.push(&points, label, 0)),
            }
        }
        Ok(())
    }

    /// The label of a marker.
    fn label(&self, tag: &str) -> i32 {
        let is_free = |label: &i32| self.tags.iter().all(|(_, taken)| taken != label);
        let own = tag.parse().ok().filter(is_free);
        own.or_else(|| (1..=i32::MAX).find(is_free)).unwrap_or(i32::MAX)
    }

    fn finish(mut self, source: &Source<'_>) -> Result<Document> {
        if self.dimension.is_none() {
            let help = "an .su2 file begins with NDIME= 2 or NDIME= 3";
            return Err(source.error("the file has no NDIME=", help));
        }
        self.largest.check("point", 0, self.mesh.points.len(), source.file())?;
        for (points, label) in &self.faces {
            cut(&self.mesh.points, points, &mut self.mesh.triangles);
            self.mesh.triangle_labels.resize(self.mesh.triangles.len(), *label);
        }
        let mut notes: Vec<String> = self.volumes.note(self.mesh.triangles.len()).into_iter().collect();
        if self.mesh.triangles.is_empty() {
            let skin = self.volumes.skin(&self.mesh.points);
            (self.mesh.triangles, self.mesh.triangle_labels) = (skin.triangles, skin.labels);
        }
        let renamed = self.tags.iter().filter(|(tag, label)| *tag != label.to_string());
        let renamed: Vec<String> = renamed.map(|(tag, label)| format!("{tag} is {label}")).collect();
        if !renamed.is_empty() {
            notes.push(format!("markers are labels: {}", renamed.join(", ")));
        }
        Ok(Document { mesh: labelled(self.mesh), notes, ..Document::default() })
    }
}

fn dimension(found: u64, source: &Source<'_>) -> Result<usize> {
    match found {
        2 | 3 => Ok(found as usize),
        _ => Err(source.error(format!("NDIME= {found}"), "a mesh has two dimensions or three")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As in SU2's description of its format: a square, with what its own programs write beside.
    const SQUARE: &str = "% a square\nNDIME= 2\nNELEM=2\n5 0 1 2 0\n5 0 2 3 1\nNPOIN= 4 4\n0 0 0\n1 0 1\n1 1 2 % corner\n0 1 3\n\
                          NMARK= 2\nMARKER_TAG= lower\nMARKER_ELEMS= 1\n3 0 1 0\nMARKER_TAG= 7\nMARKER_ELEMS = 3\n3 1 2\n3 2 3\n3 3 0\n";

    #[test]
    fn a_square_with_markers() {
        let Document { mesh, notes, .. } = read(SQUARE.as_bytes(), "a.su2").unwrap();
        assert_eq!((&mesh.triangles[..], mesh.points.len()), (&[[0, 1, 2], [0, 2, 3]][..], 4));
        assert_eq!((&mesh.edges[1..2], &mesh.edge_labels[..]), (&[[1, 2]][..], &[1, 7, 7, 7][..]));
        assert_eq!(notes, ["markers are labels: lower is 1"]);
    }

    #[test]
    fn tags_that_are_taken_get_other_labels() {
        let text =
            SQUARE.replace("MARKER_TAG= 7", "MARKER_TAG= 1").replace("MARKER_TAG= lower", "MARKER_TAG= far field");
        let Document { mesh, notes, .. } = read(text.as_bytes(), "a.su2").unwrap();
        assert_eq!(mesh.edge_labels, [1, 2, 2, 2]);
        assert_eq!(notes, ["markers are labels: far field is 1, 1 is 2"]);
    }

    #[test]
    fn what_is_written_reads_back() {
        let mesh = read(SQUARE.as_bytes(), "a.su2").unwrap().mesh;
        let mut out = Vec::new();
        write(&Mesh { points: vec![[0.1, 1e-300, 0.0]; 4], ..mesh.clone() }, &mut out).unwrap();
        let Document { mesh: again, notes, .. } = read(out.as_slice(), "a.su2").unwrap();
        assert_eq!(again.points[3].map(f64::to_bits), [0.1, 1e-300, 0.0].map(f64::to_bits));
        assert_eq!((again.triangles, again.edges, again.edge_labels), (mesh.triangles, mesh.edges, mesh.edge_labels));
        assert!(notes.is_empty());
    }

    #[test]
    fn boundaries_without_a_label_are_in_a_marker_and_what_is_inside_is_in_none() {
        let mut mesh = read(SQUARE.as_bytes(), "a.su2").unwrap().mesh;
        (mesh.edges, mesh.edge_labels) = (vec![[2, 0], [1, 0]], vec![3, -4]);
        assert_eq!(inner_edges(&mesh), 1);
        let mut out = Vec::new();
        write(&mesh, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        let markers =
            "NMARK= 2\nMARKER_TAG= -4\nMARKER_ELEMS= 1\n3 0 1\nMARKER_TAG= 0\nMARKER_ELEMS= 3\n3 1 2\n3 2 3\n3 3 0\n";
        assert!(text.ends_with(markers), "{text}");
    }

    #[test]
    fn surfaces_are_markers_or_the_boundary_of_cells() {
        let cell = "NDIME= 3\nNELEM= 1\n10 0 1 2 3 0\nNPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
        let Document { mesh, notes, .. } = read(cell.as_bytes(), "a.su2").unwrap();
        assert!(mesh.triangles.len() == 4 && notes[0].starts_with("of 1 tetrahedron the boundary"), "{notes:?}");
        let marked = format!("{cell}NMARK= 1\nMARKER_TAG= 5\nMARKER_ELEMS= 2\n5 0 1 3\n9 0 2 1 3\n");
        let Document { mesh, notes, .. } = read(marked.as_bytes(), "a.su2").unwrap();
        assert_eq!((mesh.triangles.len(), &mesh.triangle_labels[..]), (3, &[5, 5, 5][..]));
        assert!(notes[0].starts_with("1 tetrahedron left out"), "{notes:?}");
        let mut out = Vec::new();
        write(&mesh, &mut out).unwrap();
        assert_eq!(read(out.as_slice(), "b.su2").unwrap().mesh, mesh);
    }

    #[test]
    fn other_sections_are_passed_over() {
        let more =
            "FFD_NBOX= 1\nFFD_CORNER_POINTS= 2\n0 0\n1 1\nNPERIODIC= 1\nPERIODIC_INDEX= 0\nPERIODIC_CENTER= 0 0 0\n";
        let mesh = |text: &str| read(text.as_bytes(), "a.su2").unwrap().mesh;
        assert_eq!(mesh(&format!("NZONE= 1\n{SQUARE}{more}")), mesh(SQUARE));
    }

    /// As SU2 partitioned periodic meshes before version 7, and as its own test cases spell a marker.
    #[test]
    fn points_that_are_sent_are_no_boundary() {
        let sent = "MARKER_TAG= SEND_RECEIVE\nMARKER_ELEMS= 2\nSEND_TO= 1\n1 0 1\n1 3 1\n";
        let mesh = |text: &str| read(text.as_bytes(), "a.su2").unwrap();
        let again = mesh(&format!("{SQUARE}{sent}MARKERTAG= 9\nMARKER_ELEMS= 1\n3 0 2\n"));
        let expected = mesh(&format!("{SQUARE}MARKER_TAG= 9\nMARKER_ELEMS= 1\n3 0 2\n"));
        assert_eq!((again.mesh, again.notes), (expected.mesh, expected.notes));
    }

    #[test]
    fn curves_that_correspond_are_an_option_in_a_comment() {
        let mut mesh = read(SQUARE.as_bytes(), "a.su2").unwrap().mesh;
        let turn = Periodic { labels: [1, 7], rotation: [0.0, 1.0], translation: [0.5, 0.0], ..Periodic::default() };
        let shift = Periodic { labels: [-2, 3], rotation: [1.0, 0.0], translation: [0.0, 1e-9], ..turn.clone() };
        mesh.periodic = vec![turn, shift];
        let mut out = Vec::new();
        write(&mesh, &mut out).unwrap();
        let expected =
            "% MARKER_PERIODIC= ( 1, 7, 0.25, 0.25, 0, 0, 0, 90, 0, 0, 0, -2, 3, 0, 0, 0, 0, 0, 0, 0, 1e-9, 0 )\n";
        assert!(String::from_utf8(out.clone()).unwrap().ends_with(expected));
        assert_eq!(read(out.as_slice(), "a.su2").unwrap().mesh.edges, mesh.edges);
    }

    #[test]
    fn errors_say_what_and_where() {
        for (from, to, expected) in [
            ("NDIME= 2", "NDIME= 4", "a.su2:2: NDIME= 4"),
            ("NDIME= 2\n", "", "a.su2:5: NPOIN= before NDIME="),
            ("NELEM=2", "NELEM= two", "a.su2:3: 'two' is not a whole number (the head of NELEM)"),
            ("NELEM=2", "NELEM= 1", "a.su2:5: '5 0 2 3 1' where a section should begin"),
            (
                "NELEM=2",
                "NELEM= 9000000000000000000",
                "a.su2:6: 'NPOIN=' is not a whole number (row 3 of 90000000000000",
            ),
            ("5 0 2 3 1", "5 0 2 4 1", "a.su2:5: point 4 does not exist: the file lists 4, from 0"),
            ("5 0 2 3 1", "6 0 2 4 1", "a.su2:5: an element of kind 6 (row 2 of 2 of the elements)"),
            ("0 1 3\n", "nan 1 3\n", "a.su2:10: 'nan' is not a finite number (row 4 of 4 of the points)"),
            ("MARKER_TAG= lower\n", "", "a.su2:12: MARKER_ELEMS= before any MARKER_TAG="),
            ("3 3 0\n", "", "a.su2:18: the text ends in row 3 of 3 of the marker"),
            ("% a square", "NZONE= 2", "a.su2:1: more than one zone"),
        ] {
            let text = SQUARE.replacen(from, to, 1);
            let error = read(text.as_bytes(), "a.su2").unwrap_err();
            assert!(error.to_string().starts_with(expected) && !error.help().is_empty(), "{from} {to}: {error}");
        }
        assert!(read("hello".as_bytes(), "a.su2").is_err() && read("".as_bytes(), "a.su2").is_err());
    }
}
