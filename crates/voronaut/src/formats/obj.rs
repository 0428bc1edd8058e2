//! Wavefront `.obj`, as far as surfaces go: vertices, polygons, lines.

use super::words::{At, Largest, Row, Rows, Shortest, Word, error_at, number, whole};
use crate::error::Result;
use crate::mesh::Mesh;
use std::io::{self, BufRead, Write};

/// Reads `v`, `f` and `l` of an `.obj` text.
///
/// Polygons are cut into fans around their first vertex. Faces in a group `region_LABEL` have that label, as our own
/// writer has it; all others 0. Of `i/j/k` only the vertex i counts; numbers below zero count back from the last vertex
/// read. Lines become edges with label 0. Texture coordinates, normals, materials and all else are passed over.
///
/// # Errors
///
/// [`crate::Error::Parse`] with the line of what is no finite number, of a face of fewer than three vertices, and of a vertex
/// that does not exist.
pub fn read(source: impl BufRead, place: &str) -> Result<Mesh> {
    let mut rows = Rows::new(source, place);
    let mut reader = Reader { place, mesh: Mesh::default(), label: 0, largest: Largest::default() };
    while let Some(row) = rows.next()? {
        reader.read_row(row)?;
    }
    let Reader { mut mesh, largest, .. } = reader;
    largest.check("vertex", mesh.points.len(), place)?;
    mesh.point_labels = vec![0; mesh.points.len()];
    mesh.edge_labels = vec![0; mesh.edges.len()];
    Ok(mesh)
}

/// Writes a mesh as an `.obj` text: vertices in order, then the triangles of each region label in a group `region_LABEL`, then the
/// labelled edges as lines. Coordinates read back as the same bits; labels of vertices and edges have no place there.
///
/// # Errors
/// What `out` says.
pub fn write(mesh: &Mesh, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(b"# voronaut\n")?;
    for [x, y, z] in &mesh.points {
        writeln!(out, "v {} {} {}", Shortest(*x), Shortest(*y), Shortest(*z))?;
    }
    // One group for each label: many programs make a part of each group they read.
    let label = |&i: &usize| mesh.triangle_labels.get(i).copied().unwrap_or(0);
    let mut order: Vec<usize> = (0..mesh.triangles.len()).collect();
    order.sort_by_key(label);
    let mut group = None;
    for i in order {
        if group.replace(label(&i)) != Some(label(&i)) {
            writeln!(out, "g region_{}", label(&i))?;
        }
        let [a, b, c] = mesh.triangles[i].map(|v| u64::from(v) + 1);
        writeln!(out, "f {a} {b} {c}")?;
    }
    if !mesh.edges.is_empty() {
        out.write_all(b"g edges\n")?;
    }
    mesh.edges.iter().try_for_each(|&[a, b]| writeln!(out, "l {} {}", u64::from(a) + 1, u64::from(b) + 1))
}

struct Reader<'a> {
    place: &'a str,
    mesh: Mesh,
    label: i32,
    largest: Largest,
}

impl Reader<'_> {
    fn read_row(&mut self, row: Row<'_>) -> Result<()> {
        let mut words = row.words();
        match words.next().map(|word| word.text) {
            Some("v") => self.read_vertex(row.line, words),
            Some("f") => {
                let polygon = self.references(words, At::head("f"))?;
                let [first, rest @ ..] = polygon.as_slice() else { return Err(self.too_short(row.line, 0, "face", 3)) };
                if rest.len() < 2 {
                    return Err(self.too_short(row.line, polygon.len(), "face", 3));
                }
                let fan = rest.windows(2).map(|pair| [*first, pair[0], pair[1]]);
                self.mesh.triangles.extend(fan);
                self.mesh.triangle_labels.resize(self.mesh.triangles.len(), self.label);
                Ok(())
            }
            Some("l") => {
                let line = self.references(words, At::head("l"))?;
                if line.len() < 2 {
                    return Err(self.too_short(row.line, line.len(), "line", 2));
                }
                self.mesh.edges.extend(line.windows(2).map(|pair| [pair[0], pair[1]]));
                Ok(())
            }
            Some("g") => {
                let region = words.next().and_then(|word| word.text.strip_prefix("region_")?.parse().ok());
                self.label = region.unwrap_or(0);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn read_vertex<'w>(&mut self, line: usize, mut words: impl Iterator<Item = Word<'w>>) -> Result<()> {
        let mut point = [0.0; 3];
        for coordinate in &mut point {
            let word = words.next().ok_or_else(|| {
                error_at(self.place, line, "a vertex with fewer than three coordinates", "write v x y z")
            })?;
            *coordinate = number(self.place, word, At::head("v"))?;
        }
        self.mesh.points.push(point);
        Ok(())
    }

    fn references<'w>(&mut self, words: impl Iterator<Item = Word<'w>>, at: At<'_>) -> Result<Vec<u32>> {
        words.map(|word| self.reference(word, at)).collect()
    }

    /// A vertex, numbered from 0.
    fn reference(&mut self, word: Word<'_>, at: At<'_>) -> Result<u32> {
        let text = word.text.split('/').next().unwrap_or_default();
        let number: i64 = whole(self.place, Word { text, ..word }, at)?;
        let known = i64::try_from(self.mesh.points.len()).unwrap_or(i64::MAX);
        let absolute = if number < 0 { known + 1 + number } else { number };
        match u32::try_from(absolute) {
            Ok(absolute) if absolute > 0 => {
                self.largest.note(absolute.into(), word.line as u64);
                Ok(absolute - 1)
            }
            _ => {
                let what = format!("vertex {number} does not exist: {known} are listed above");
                let help = "number from 1, or from -1 back from the last vertex above";
                Err(error_at(self.place, word.line, what, help))
            }
        }
    }

    fn too_short(&self, line: usize, found: usize, of: &str, needed: usize) -> crate::Error {
        let what = format!("a {of} of {found} vertices");
        error_at(self.place, line, what, format!("a {of} needs {needed} vertices or more"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_in_all_their_spellings() {
        let text = "mtllib a.mtl\nv 0 0 0 1.0\nv 1 0 0 # corner\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n\
                    g region_-7\nf 1/1/1 2//1 3/4 4\ng other\nf -1 -2 -3\nl 1 2 3\ns off\n";
        let mesh = read(text.as_bytes(), "a.obj").unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [3, 2, 1]]);
        assert_eq!(mesh.triangle_labels, [-7, -7, 0]);
        assert_eq!(mesh.edges, [[0, 1], [1, 2]]);
        assert_eq!((mesh.points.len(), mesh.point_labels.len(), mesh.edge_labels.len()), (4, 4, 2));
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
