//! Triangle's `.poly` files (Shewchuk): a planar straight-line graph with holes and regions.

use super::codec::{At, Form, Sink, Source, Text};
use std::io::{self, BufRead, Write};
use std::ops::RangeInclusive;
use voronaut::Result;
use voronaut::geometry::Point;
use voronaut::manifold::domain::{Poly, PolyRegion};

/// Reads a `.poly` text with its vertices inline, numbered from 0 or 1. Vertex attributes are passed over. ([`read_pslg`](super::read_pslg)
/// finds vertices in the `.node` file beside it, too.)
///
/// The lists of holes and regions may be missing. `place` names the text in messages. Memory follows the text, never a
/// count written in it.
///
/// # Errors
///
/// [`Error::Parse`](voronaut::Error::Parse) with the line of what is not as announced: a text cut off, rows with too many or too few columns,
/// numbers out of turn, something that is no finite number, an end that is no vertex, no vertices inline, a dimension
/// other than 2.
pub fn read(source: impl BufRead, place: &str) -> Result<Poly> {
    read_with(source, place, || None::<Result<(io::Empty, String)>>)
}

/// The same of a text whose vertices may be in a `.node` text, which is asked for then, with its name.
///
/// # Errors
/// As of [`read`], and of asking.
pub(crate) fn read_with<N: BufRead>(
    source: impl BufRead,
    place: &str,
    nodes: impl FnOnce() -> Option<Result<(N, String)>>,
) -> Result<Poly> {
    let (mut source, mut poly) = (Source::new(source, place), Poly::default());
    if read_vertices(&mut source, &mut poly)? == 0 {
        let (nodes, name) = nodes().transpose()?.ok_or_else(|| {
            let help = "inline the vertices: put the content of the .node file here, in place of this row";
            source.error("the file holds no vertices: they are in a .node file", help)
        })?;
        let mut nodes = Source::new(nodes, &name);
        if read_vertices(&mut nodes, &mut poly)? == 0 {
            return Err(nodes.error("the file holds no vertices", "give the file that Triangle wrote beside the .poly"));
        }
    }
    read_segments(&mut source, &mut poly)?;
    for at in At::rows("holes", read_count(&mut source, "holes")?) {
        let row = columns(source.row(at)?, at, 3..=3)?;
        poly.holes.push(point(&row, at)?);
    }
    for at in At::rows("regions", read_count(&mut source, "regions")?) {
        let row = columns(source.row(at)?, at, 4..=5)?;
        let (point, attribute) = (point(&row, at)?, row[3].number(at)?);
        let max_area = row.get(4).map(|word| word.number(at)).transpose()?;
        poly.regions.push(PolyRegion { point, attribute, max_area });
    }
    source.demand_end("more rows than the counts in the file announce", "check the counts of holes and regions")?;
    Ok(poly)
}

/// Writes a `.poly` text that [`read`] turns into the same.
///
/// # Errors
/// What `out` says.
pub fn write(poly: &Poly, out: &mut dyn Write) -> io::Result<()> {
    let mut sink = Sink::new(Form::Text, out);
    let number = |i: usize| i as u64 + u64::from(poly.first);
    sink.line(format_args!("# vertices\n{} 2 0 1", poly.points.len()))?;
    for (i, (p, marker)) in poly.points.iter().zip(&poly.point_markers).enumerate() {
        sink.put(number(i));
        sink.put_all([p.x, p.y]);
        sink.row([*marker])?;
    }
    sink.line(format_args!("# segments\n{} 1", poly.segments.len()))?;
    for (i, (ends, marker)) in poly.segments.iter().zip(&poly.segment_markers).enumerate() {
        sink.put_all([number(i), number(ends[0] as usize), number(ends[1] as usize)]);
        sink.row([*marker])?;
    }
    sink.line(format_args!("# holes\n{}", poly.holes.len()))?;
    for (i, p) in poly.holes.iter().enumerate() {
        sink.put(number(i));
        sink.row([p.x, p.y])?;
    }
    sink.line(format_args!("# regions\n{}", poly.regions.len()))?;
    for (i, region) in poly.regions.iter().enumerate() {
        sink.put(number(i));
        sink.put_all([region.point.x, region.point.y, region.attribute]);
        sink.row(region.max_area)?;
    }
    Ok(())
}

/// How many there are.
fn read_vertices(source: &mut Source<'_>, poly: &mut Poly) -> Result<u64> {
    let [count, dimension, attributes, markers] = read_head(source, "vertices", 4)?;
    if let Some(dimension) = dimension.filter(|&dimension| dimension != 2) {
        let help = "give a planar .poly file; TetGen's three-dimensional ones are another format";
        return Err(source.error(format!("the vertices have dimension {dimension}, not 2"), help));
    }
    // A row of a text holds fewer columns than this; the sum below must not overflow.
    let attributes = attributes.unwrap_or(0).min(1 << 40) as usize;
    let width = 3 + attributes + marker_columns(source, markers)?;
    for at in At::rows("vertices", count.unwrap_or(0)) {
        let row = columns(source.row(at)?, at, width..=width)?;
        check_vertex_number(row[0], poly, at)?;
        poly.points.push(point(&row, at)?);
        poly.point_markers.push(marker(row.get(3 + attributes), at)?);
    }
    Ok(count.unwrap_or(0))
}

fn read_segments(source: &mut Source<'_>, poly: &mut Poly) -> Result<()> {
    let [count, markers] = read_head(source, "segments", 2)?;
    let width = 3 + marker_columns(source, markers)?;
    for at in At::rows("segments", count.unwrap_or(0)) {
        let row = columns(source.row(at)?, at, width..=width)?;
        let end = |word: Text<'_>| word.vertex(poly.first, poly.points.len() as u64, at);
        poly.segments.push([end(row[1])?, end(row[2])?]);
        poly.segment_markers.push(marker(row.get(3), at)?);
    }
    Ok(())
}

/// The counts that open a list; those at the end of the row may be missing.
fn read_head<const N: usize>(source: &mut Source<'_>, section: &str, most: usize) -> Result<[Option<u64>; N]> {
    let at = At::head(section);
    let mut counts = [None; N];
    for (count, word) in counts.iter_mut().zip(columns(source.row(at)?, at, 1..=most)?) {
        *count = Some(word.whole(at)?);
    }
    Ok(counts)
}

/// The count that opens a list which may be missing altogether.
fn read_count(source: &mut Source<'_>, section: &str) -> Result<u64> {
    let at = At::head(section);
    source.next_row()?.map_or(Ok(0), |row| columns(row, at, 1..=1)?[0].whole(at))
}

/// The words of a row, which has to have so many.
fn columns<'r>(row: Text<'r>, at: At<'_>, expected: RangeInclusive<usize>) -> Result<Vec<Text<'r>>> {
    let words: Vec<_> = row.words().collect();
    if expected.contains(&words.len()) {
        return Ok(words);
    }
    let (least, most) = expected.into_inner();
    let expected = if least == most { least.to_string() } else { format!("{least} to {most}") };
    let what = format!("{} columns where {expected} are expected ({at})", words.len());
    let help = format!("check the counts (of rows, attributes, markers) in the row that opens the {}", at.section);
    Err(row.place.error(what, help))
}

fn check_vertex_number(word: Text<'_>, poly: &mut Poly, at: At<'_>) -> Result<()> {
    let number: u64 = word.whole(at)?;
    if at.row == 1 && number <= 1 {
        poly.first = number as u32;
    }
    let expected = at.row - 1 + u64::from(poly.first);
    if number == expected {
        return Ok(());
    }
    let what = format!("vertex {number} where vertex {expected} is expected ({at})");
    Err(word.place.error(what, "number the vertices in turn, from 0 or from 1"))
}

/// The point of a row, behind its number.
fn point(row: &[Text<'_>], at: At<'_>) -> Result<Point> {
    Ok(Point::new(row[1].number(at)?, row[2].number(at)?))
}

fn marker(word: Option<&Text<'_>>, at: At<'_>) -> Result<i32> {
    word.map_or(Ok(0), |word| word.whole(at))
}

fn marker_columns(source: &Source<'_>, markers: Option<u64>) -> Result<usize> {
    match markers.unwrap_or(0) {
        more @ 0..=1 => Ok(more as usize),
        more => Err(source.error(format!("{more} boundary markers per row"), "give 0 or 1")),
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
