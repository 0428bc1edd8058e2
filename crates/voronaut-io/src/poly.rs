//! Triangle's `.poly` files (Shewchuk): a planar straight-line graph with holes and regions.

use super::words::{At, Row, Rows, Shortest, Word, error_at, number, whole};
use std::io::{self, BufRead, Write};
use voronaut::domain::{Poly, PolyRegion};
use voronaut::geometry::Point;
use voronaut::{Error, Result};

/// Reads a `.poly` text with its vertices inline, numbered from 0 or 1. Vertex attributes are passed over.
///
/// The lists of holes and regions may be missing. `place` names the text in messages. Memory follows the text, never a
/// count written in it.
///
/// # Errors
///
/// [`Error::Parse`] with the line of what is not as announced: a text cut off, rows with too many or too few columns,
/// numbers out of turn, something that is no finite number, an end that is no vertex, no vertices inline, a dimension
/// other than 2.
pub fn read(source: impl BufRead, place: &str) -> Result<Poly> {
    let mut rows = Rows::new(source, place);
    let mut reader = Reader { place, line: 1, poly: Poly::default() };
    reader.read_vertices(&mut rows)?;
    reader.read_segments(&mut rows)?;
    reader.read_holes(&mut rows)?;
    reader.read_regions(&mut rows)?;
    if let Some(row) = rows.next()? {
        let what = "more rows than the counts in the file announce";
        return Err(error_at(place, row.line, what, "check the counts of holes and regions"));
    }
    Ok(reader.poly)
}

/// Writes a `.poly` text that [`read`] turns into the same.
///
/// # Errors
/// What `out` says.
pub fn write(poly: &Poly, out: &mut dyn Write) -> io::Result<()> {
    let number = |i: usize| i as u64 + u64::from(poly.first);
    writeln!(out, "# vertices\n{} 2 0 1", poly.points.len())?;
    for (i, (p, marker)) in poly.points.iter().zip(&poly.point_markers).enumerate() {
        writeln!(out, "{} {} {} {marker}", number(i), Shortest(p.x), Shortest(p.y))?;
    }
    writeln!(out, "# segments\n{} 1", poly.segments.len())?;
    for (i, (ends, marker)) in poly.segments.iter().zip(&poly.segment_markers).enumerate() {
        let [a, b] = ends.map(|v| number(v as usize));
        writeln!(out, "{} {a} {b} {marker}", number(i))?;
    }
    writeln!(out, "# holes\n{}", poly.holes.len())?;
    for (i, p) in poly.holes.iter().enumerate() {
        writeln!(out, "{} {} {}", number(i), Shortest(p.x), Shortest(p.y))?;
    }
    writeln!(out, "# regions\n{}", poly.regions.len())?;
    for (i, region) in poly.regions.iter().enumerate() {
        let (p, attribute) = (region.point, Shortest(region.attribute));
        write!(out, "{} {} {} {attribute}", number(i), Shortest(p.x), Shortest(p.y))?;
        region.max_area.map_or(Ok(()), |area| write!(out, " {}", Shortest(area)))?;
        out.write_all(b"\n")?;
    }
    Ok(())
}

struct Reader<'a> {
    place: &'a str,
    line: usize,
    poly: Poly,
}

impl Reader<'_> {
    fn read_vertices(&mut self, rows: &mut Rows<'_>) -> Result<()> {
        let head = self.head(rows, "vertices", 4)?;
        let [count, dimension, attributes, markers] = head;
        if dimension.unwrap_or(2) != 2 {
            let what = format!("the vertices have dimension {}, not 2", dimension.unwrap_or(2));
            return Err(
                self.error(what, "give a planar .poly file; TetGen's three-dimensional ones are another format")
            );
        }
        if count == Some(0) {
            let help = "inline the vertices: put the content of the .node file here, in place of this row";
            return Err(self.error("the file holds no vertices: they are in a .node file", help));
        }
        // A row of a text holds fewer columns than this; the sum below must not overflow.
        let attributes = attributes.unwrap_or(0).min(1 << 40) as usize;
        let columns = 3 + attributes + self.marker_columns(markers)?;
        for at in At::rows("vertices", count.unwrap_or(0)) {
            let row = self.row(rows, at, columns, columns)?;
            self.check_vertex_number(row[0], at)?;
            self.poly.points.push(self.point(&row[1..3], at)?);
            self.poly.point_markers.push(self.marker(row.get(3 + attributes), at)?);
        }
        Ok(())
    }

    fn read_segments(&mut self, rows: &mut Rows<'_>) -> Result<()> {
        let [count, markers] = self.head(rows, "segments", 2)?;
        let columns = 3 + self.marker_columns(markers)?;
        for at in At::rows("segments", count.unwrap_or(0)) {
            let row = self.row(rows, at, columns, columns)?;
            let ends = [self.vertex(row[1], at)?, self.vertex(row[2], at)?];
            self.poly.segments.push(ends);
            self.poly.segment_markers.push(self.marker(row.get(3), at)?);
        }
        Ok(())
    }

    fn read_holes(&mut self, rows: &mut Rows<'_>) -> Result<()> {
        let [count] = self.optional_head(rows, "holes")?;
        for at in At::rows("holes", count) {
            let row = self.row(rows, at, 3, 3)?;
            self.poly.holes.push(self.point(&row[1..3], at)?);
        }
        Ok(())
    }

    fn read_regions(&mut self, rows: &mut Rows<'_>) -> Result<()> {
        let [count] = self.optional_head(rows, "regions")?;
        for at in At::rows("regions", count) {
            let row = self.row(rows, at, 4, 5)?;
            let point = self.point(&row[1..3], at)?;
            let attribute = number(self.place, row[3], at)?;
            let max_area = row.get(4).map(|&word| number(self.place, word, at)).transpose()?;
            self.poly.regions.push(PolyRegion { point, attribute, max_area });
        }
        Ok(())
    }

    /// The counts that open a list; those at the end of the row may be missing.
    fn head<const N: usize>(&mut self, rows: &mut Rows<'_>, section: &str, columns: usize) -> Result<[Option<u64>; N]> {
        let at = At::head(section);
        let row = self.row(rows, at, 1, columns)?;
        let mut counts = [None; N];
        for (count, &word) in counts.iter_mut().zip(&row) {
            *count = Some(whole(self.place, word, at)?);
        }
        Ok(counts)
    }

    /// The count that opens a list which may be missing altogether.
    fn optional_head(&mut self, rows: &mut Rows<'_>, section: &str) -> Result<[u64; 1]> {
        if !rows.has_next()? {
            return Ok([0]);
        }
        Ok(self.head::<1>(rows, section, 1)?.map(Option::unwrap_or_default))
    }

    /// The words of the next row, which has to have between `least` and `most` columns.
    fn row<'r>(&mut self, rows: &'r mut Rows<'_>, at: At<'_>, least: usize, most: usize) -> Result<Vec<Word<'r>>> {
        let Some(row) = rows.next()? else {
            let help = format!("the file is cut off, or the count of {} is too large", at.section);
            return Err(self.error(format!("the text ends in {at}"), help));
        };
        self.line = row.line;
        let words: Vec<_> = Row::words(row).collect();
        if (least..=most).contains(&words.len()) {
            return Ok(words);
        }
        let expected = if least == most { least.to_string() } else { format!("{least} to {most}") };
        let what = format!("{} columns where {expected} are expected ({at})", words.len());
        let help = format!("check the counts (of rows, attributes, markers) in the row that opens the {}", at.section);
        Err(self.error(what, help))
    }

    fn check_vertex_number(&mut self, word: Word<'_>, at: At<'_>) -> Result<()> {
        let number: u64 = whole(self.place, word, at)?;
        if at.row == 1 && number <= 1 {
            self.poly.first = number as u32;
        }
        let expected = at.row - 1 + u64::from(self.poly.first);
        if number == expected {
            return Ok(());
        }
        let what = format!("vertex {number} where vertex {expected} is expected ({at})");
        Err(self.error(what, "number the vertices in turn, from 0 or from 1"))
    }

    fn vertex(&self, word: Word<'_>, at: At<'_>) -> Result<u32> {
        let number: u32 = whole(self.place, word, at)?;
        let count = self.poly.points.len();
        match number.checked_sub(self.poly.first) {
            Some(vertex) if (vertex as usize) < count => Ok(vertex),
            _ => {
                let help = format!("this file has {count} vertices, numbered from {}", self.poly.first);
                Err(self.error(format!("vertex {number} does not exist ({at})"), help))
            }
        }
    }

    fn point(&self, words: &[Word<'_>], at: At<'_>) -> Result<Point> {
        Ok(Point::new(number(self.place, words[0], at)?, number(self.place, words[1], at)?))
    }

    fn marker(&self, word: Option<&Word<'_>>, at: At<'_>) -> Result<i32> {
        word.map_or(Ok(0), |&word| whole(self.place, word, at))
    }

    fn marker_columns(&self, markers: Option<u64>) -> Result<usize> {
        match markers.unwrap_or(0) {
            0 => Ok(0),
            1 => Ok(1),
            more => Err(self.error(format!("{more} boundary markers per row"), "give 0 or 1")),
        }
    }

    fn error(&self, what: impl Into<String>, help: impl Into<String>) -> Error {
        error_at(self.place, self.line, what, help)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "# a square\n4 2 1 1\n1 0 0 0.5 7\n2 1 0 0.5 7\n3 1 1 0.5 7 # top\n4 0 1. 0.5 8\n";

    #[test]
    fn numbered_from_one_with_everything() {
        let text =
            format!("{SQUARE}\n4 1\n1 1 2 5\n2 2 3 5\n3 3 4 5\n4 4 1 -6\n1\n1 .5 .5\n2\n1 .1 .1 3\n2 .2 .1 4 0.01\n");
        let poly = read(text.as_bytes(), "a.poly").unwrap();
        assert_eq!((poly.points[2], poly.first), (Point::new(1.0, 1.0), 1));
        assert_eq!(poly.point_markers, [7, 7, 7, 8]);
        assert_eq!(poly.segments, [[0, 1], [1, 2], [2, 3], [3, 0]]);
        assert_eq!(poly.segment_markers, [5, 5, 5, -6]);
        assert_eq!(poly.holes, [Point::new(0.5, 0.5)]);
        assert_eq!(poly.regions[0], PolyRegion { point: Point::new(0.1, 0.1), attribute: 3.0, max_area: None });
        assert_eq!(poly.regions[1].max_area, Some(0.01));
    }

    #[test]
    fn numbered_from_zero_without_markers() {
        let poly = read("3\n0 0 0\n1 1 0\n2 0 1d0\n3\n1 0 1\n2 1 2\n3 2 0\n".as_bytes(), "a.poly").unwrap();
        assert_eq!((poly.segments, poly.first), (vec![[0, 1], [1, 2], [2, 0]], 0));
        assert_eq!((poly.point_markers, poly.segment_markers), (vec![0; 3], vec![0; 3]));
        assert!(poly.holes.is_empty() && poly.regions.is_empty());
    }

    #[test]
    fn errors_say_what_and_where() {
        for (text, expected) in [
            ("", "a.poly:1: the text ends in the head of vertices"),
            ("0 2 0 0\n3 0\n", "a.poly:1: the file holds no vertices: they are in a .node file"),
            ("3 3 0 0\n", "a.poly:1: the vertices have dimension 3, not 2"),
            ("3 2 0 2\n", "a.poly:1: 2 boundary markers per row"),
            ("999999999999999999 2 0 0\n1 0 0\n", "a.poly:2: the text ends in row 2 of 999999999999999999 of vertices"),
            ("1 2 18446744073709551615 0\n1 0 0\n", "a.poly:2: 3 columns where"),
            ("2 2\n1 0 0\n3 1 0\n", "a.poly:3: vertex 3 where vertex 2 is expected (row 2 of 2 of vertices)"),
            ("2 2\n5 0 0\n6 1 0\n", "a.poly:2: vertex 5 where vertex 0 is expected"),
            ("1 2\n1 0 inf\n", "a.poly:2: 'inf' is not a finite number (row 1 of 1 of vertices)"),
            ("1 2\n1 0 0 0\n", "a.poly:2: 4 columns where 3 are expected (row 1 of 1 of vertices)"),
            ("1 2\n1 0 0\n", "a.poly:2: the text ends in the head of segments"),
            ("2 2\n1 0 0\n2 1 1\n1\n1 1 3\n", "a.poly:5: vertex 3 does not exist (row 1 of 1 of segments)"),
            ("2 2\n1 0 0\n2 1 1\n1\n1 0 1\n", "a.poly:5: vertex 0 does not exist"),
            ("2 2\n1 0 0\n2 1 1\n1\n1 1 2\n0\n1\n1 0 0\n", "a.poly:8: 3 columns where 4 to 5 are expected"),
            (
                "2 2\n1 0 0\n2 1 1\n1\n1 1 2\n1\n1 0 0\n2 1 1\n",
                "a.poly:8: 3 columns where 1 are expected (the head of regions)",
            ),
            ("2 2\n1 0 0\n2 1 1\n1\n1 1 2\n0\n0\n9\n", "a.poly:8: more rows than the counts"),
        ] {
            let error = read(text.as_bytes(), "a.poly").unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }

    #[test]
    fn the_help_says_to_inline_vertices() {
        assert!(read("0 2 0 0\n".as_bytes(), "a.poly").unwrap_err().help().contains("inline the vertices"));
    }
}
