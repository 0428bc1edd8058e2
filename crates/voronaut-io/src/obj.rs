//! Wavefront `.obj`, as far as surfaces go: vertices, polygons, lines.

use super::Document;
use super::codec::{At, Largest, Place, Shortest, Source, Text, several};
use super::cutting::Polygons;
use super::document::{labelled, labels};
use std::collections::BTreeMap;
use std::io::{self, BufRead, Write};
use voronaut::Result;
use voronaut::mesh::Mesh;

/// Reads `v`, `f` and `l` of an `.obj` text.
///
/// Polygons are cut along diagonals that suit them, quadrilaterals along the better one. Faces in a group `region_LABEL` have that
/// label, as our own writer has it; all others 0. Of `i/j/k` only the vertex i counts; numbers below zero count back from the last
/// vertex read. Lines become edges with label 0. A row that ends in `\\` goes on in the next one. Points, texture coordinates,
/// normals, colours, materials and all else are passed over; of free-form curves and surfaces a note says so.
///
/// # Errors
///
/// [`voronaut::Error::Parse`] with the line of what is no finite number, of a face of fewer than three vertices, and of a vertex
/// that does not exist.
pub fn read(source: impl BufRead, file: &str) -> Result<Document> {
    let mut source = Source::with_names(source, file, &NAMING);
    let (mut reader, mut joined, mut begin) = (Reader::default(), String::new(), None);
    while let Some(row) = source.next_row()? {
        let text = row.text.trim_end();
        let goes_on = text.ends_with('\\');
        joined.push_str(text.strip_suffix('\\').unwrap_or(text));
        joined.push(' ');
        let place = *begin.get_or_insert(source.place());
        if !goes_on {
            reader.read_row(Text { place, text: &joined })?;
            begin = None;
            joined.clear();
        }
    }
    if let Some(place) = begin {
        reader.read_row(Text { place, text: &joined })?;
    }
    reader.finish(file)
}

/// Rows that name things, in whatever encoding.
const NAMING: [&str; 5] = ["g", "o", "usemtl", "mtllib", "usemap"];

/// Rows that are a surface or a curve of their own, and what these are called.
const FREE_FORM: [(&str, &str); 5] = [
    ("surf", "free-form surfaces"),
    ("curv", "free-form curves"),
    ("curv2", "free-form curves"),
    ("bzp", "Bezier patches"),
    ("bsp", "B-spline patches"),
];

/// Writes a mesh as an `.obj` text: vertices in order, then the triangles of each region label in a group `region_LABEL`, then the
/// labelled edges as lines. Coordinates read back as the same bits; labels of vertices and edges have no place there.
///
/// # Errors
/// What `out` says.
pub(crate) fn write(mesh: &Mesh, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(b"# voronaut\n")?;
    for [x, y, z] in &mesh.points {
        writeln!(out, "v {} {} {}", Shortest(*x), Shortest(*y), Shortest(*z))?;
    }
    // One group for each label: many programs make a part of each group they read.
    let mut sorted: Vec<(i32, [u32; 3])> = labels(&mesh.triangle_labels).zip(mesh.triangles.iter().copied()).collect();
    sorted.sort_by_key(|&(label, _)| label);
    for group in sorted.chunk_by(|(one, _), (other, _)| one == other) {
        writeln!(out, "g region_{}", group[0].0)?;
        for [a, b, c] in group.iter().map(|(_, triangle)| triangle.map(|v| u64::from(v) + 1)) {
            writeln!(out, "f {a} {b} {c}")?;
        }
    }
    if !mesh.edges.is_empty() {
        out.write_all(b"g edges\n")?;
    }
    mesh.edges.iter().try_for_each(|&[a, b]| writeln!(out, "l {} {}", u64::from(a) + 1, u64::from(b) + 1))
}

#[derive(Default)]
struct Reader {
    mesh: Mesh,
    polygons: Polygons,
    /// That of the group.
    label: i32,
    largest: Largest,
    free_form: BTreeMap<&'static str, u64>,
}

impl Reader {
    fn read_row(&mut self, row: Text<'_>) -> Result<()> {
        let mut words = row.words();
        match words.next().map(|word| word.text) {
            Some("v") => {
                let missing = || row.place.error("a vertex with fewer than three coordinates", "write v x y z");
                self.mesh.points.push(several(|| words.next().ok_or_else(missing)?.number(At::head("v")))?);
            }
            // Wavefront's programs once wrote fo.
            Some("f" | "fo") => {
                let polygon = self.references(row.place, words, At::head("f"), ("face", 3))?;
                self.polygons.push(&polygon);
                self.polygons.label(self.label);
            }
            Some("l") => {
                let line = self.references(row.place, words, At::head("l"), ("line", 2))?;
                self.mesh.edges.extend(line.windows(2).map(|pair| [pair[0], pair[1]]));
            }
            Some("g") => {
                let region = words.next().and_then(|word| word.text.strip_prefix("region_")?.parse().ok());
                self.label = region.unwrap_or(0);
            }
            other => {
                if let Some((_, name)) = FREE_FORM.iter().find(|(keyword, _)| other == Some(keyword)) {
                    *self.free_form.entry(name).or_default() += 1;
                }
            }
        }
        Ok(())
    }

    /// Faces may refer to vertices below them: whether these exist is known at the end.
    fn finish(self, file: &str) -> Result<Document> {
        let Self { mut mesh, polygons, largest, free_form, .. } = self;
        largest.check("vertex", 1, mesh.points.len(), file)?;
        (mesh.triangles, mesh.triangle_labels) = polygons.cut(&mesh.points);
        let notes = free_form.into_iter().map(|(name, count)| format!("{count} {name} left out: only faces are read"));
        Ok(Document { notes: notes.collect(), ..labelled(mesh).into() })
    }

    /// The vertices of a face or a line, which has to have so many.
    fn references<'w>(
        &mut self,
        place: Place<'_>,
        words: impl Iterator<Item = Text<'w>>,
        at: At<'_>,
        (of, needed): (&str, usize),
    ) -> Result<Vec<u32>> {
        let found: Vec<u32> = words.map(|word| self.reference(word, at)).collect::<Result<_>>()?;
        if found.len() >= needed {
            return Ok(found);
        }
        let what = format!("a {of} of {} vertices", found.len());
        Err(place.error(what, format!("a {of} needs {needed} vertices or more")))
    }

    /// A vertex, numbered from 0.
    fn reference(&mut self, word: Text<'_>, at: At<'_>) -> Result<u32> {
        let text = word.text.split('/').next().unwrap_or_default();
        let number: i64 = Text { text, ..word }.whole(at)?;
        let known = i64::try_from(self.mesh.points.len()).unwrap_or(i64::MAX);
        let absolute = if number < 0 { known + 1 + number } else { number };
        match u32::try_from(absolute) {
            Ok(absolute) if absolute > 0 => {
                self.largest.note(absolute - 1, word.place);
                Ok(absolute - 1)
            }
            _ => {
                let what = format!("vertex {number} does not exist: {known} are listed above");
                let help = "number from 1, or from -1 back from the last vertex above";
                Err(word.place.error(what, help))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_in_all_their_spellings() {
        let text = "mtllib a.mtl\nv 0 0 0 1.0\nv 1 0 0 # corner\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n\
                    g region_-7\nf 1/1/1 2//1 3/4 4\ng other\nf -1 -2 -3\nl 1 2 3\ns off\n";
        let mesh = read(text.as_bytes(), "a.obj").unwrap().mesh;
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [3, 2, 1]]);
        assert_eq!(mesh.triangle_labels, [-7, -7, 0]);
        assert_eq!(mesh.edges, [[0, 1], [1, 2]]);
        assert_eq!((mesh.points.len(), mesh.point_labels.len(), mesh.edge_labels.len()), (4, 4, 2));
    }

    #[test]
    fn what_other_programs_write() {
        let text = b"o cube\r\nv 0 0 0 0.5 0.5 1\r\nv 1 0 0 \\\r\n 1 1 1\nv 1 1 0\nv 0 1 0\np 1\ng caf\xe9 lid\nusemtl bl\xe4u\n\
                     f -4/-4 \\\n-3/-3 \\\n -2/1 # the corner\nfo 1 3 4\nsurf 0 1 0 1 1\nsurf 0 1 0 1 2\ncurv 0 1 1 2\nf 5 6 7\n\
                     v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3 \\";
        let found = read(text.as_slice(), "a.obj").unwrap();
        assert_eq!(found.mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [0, 1, 2]]);
        assert_eq!(found.mesh.points[1].map(f64::to_bits), [1.0_f64, 0.0, 0.0].map(f64::to_bits));
        let free_form =
            ["1 free-form curves left out: only faces are read", "2 free-form surfaces left out: only faces are read"];
        assert_eq!(found.notes, free_form);
        let error = read(b"v 0 0 0\nf \xe9 1 1".as_slice(), "a.obj").unwrap_err();
        assert!(error.to_string().contains("not a text in UTF-8"), "{error}");
    }

    #[test]
    fn errors_say_what_and_where() {
        for (text, expected) in [
            ("v 0 0", "a.obj:1: a vertex with fewer than three coordinates"),
            ("v 0 0 nan", "a.obj:1: 'nan' is not a finite number (the head of v)"),
            ("v 0 0 0\nf 1 1", "a.obj:2: a face of 2 vertices"),
            ("f", "a.obj:1: a face of 0 vertices"),
            ("v 0 0 0\nl 1", "a.obj:2: a line of 1 vertices"),
            ("v 0 0 0\nf 1 2 3\nf 1 1 1", "a.obj:2: vertex 3 does not exist: the file lists 1"),
            ("v 0 0 0\nf 0 1 1", "a.obj:2: vertex 0 does not exist: 1 are listed above"),
            ("v 0 0 0\nf -2 1 1", "a.obj:2: vertex -2 does not exist: 1 are listed above"),
            ("v 0 0 0\nf 1 1 99999999999", "a.obj:2: vertex 99999999999 does not exist"),
            ("v 0 0 0\nf 1 1 /2", "a.obj:2: '' is not a whole number"),
            ("f 1.5 1 1", "a.obj:1: '1.5' is not a whole number"),
            ("v 0 0 0\nf 1 \\\n\n\\\n1", "a.obj:2: a face of 2 vertices"),
        ] {
            let error = read(text.as_bytes(), "a.obj").unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }

    #[test]
    fn regions_are_written_as_groups() {
        let mesh = Mesh {
            points: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.0, 1.0, 0.0]],
            point_labels: vec![0; 4],
            triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 1]],
            triangle_labels: vec![1, -2, 1],
            edges: vec![[0, 2]],
            edge_labels: vec![7],
            ..Mesh::default()
        };
        let expected = "# voronaut\nv 0 0 0\nv 1 0 0\nv 1 0.1 0\nv 0 1 0\n\
                        g region_-2\nf 1 3 4\ng region_1\nf 1 2 3\nf 1 4 2\ng edges\nl 1 3\n";
        let mut out = Vec::new();
        write(&mesh, &mut out).unwrap();
        assert_eq!(String::from_utf8(out).unwrap(), expected);
    }
}
