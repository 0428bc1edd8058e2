//! Medit's text format for values on vertices, `.sol`: scalars (sizes), vectors and symmetric tensors (metrics).

use super::sections::{known_dimension, next_section, read_dimension, read_head, skip_section};
use super::words::{At, Shortest, Words, error_at};
use crate::error::{Error, Result};
use std::fmt::Write;

/// Values on the vertices of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// 2 or 3: the coordinates of the mesh's vertices.
    pub dimension: u8,
    /// One entry per vertex.
    pub values: SolutionValues,
}

impl Solution {
    /// The entries of some vertices, in their order.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    pub fn of_vertices(&self, vertices: &[u32]) -> Self {
        fn taken<T: Clone>(entries: &[T], vertices: &[u32]) -> Vec<T> {
            vertices.iter().map(|&v| entries[v as usize].clone()).collect()
        }
        let values = match &self.values {
            SolutionValues::Scalar(entries) => SolutionValues::Scalar(taken(entries, vertices)),
            SolutionValues::Vector(entries) => SolutionValues::Vector(taken(entries, vertices)),
            SolutionValues::Tensor(entries) => SolutionValues::Tensor(taken(entries, vertices)),
            SolutionValues::Tensor3(entries) => SolutionValues::Tensor3(taken(entries, vertices)),
        };
        Self { dimension: self.dimension, values }
    }

    /// How many vertices it has entries of.
    pub fn count(&self) -> usize {
        match &self.values {
            SolutionValues::Scalar(entries) => entries.len(),
            SolutionValues::Vector(entries) => entries.len(),
            SolutionValues::Tensor(entries) => entries.len(),
            SolutionValues::Tensor3(entries) => entries.len(),
        }
    }
}

/// The entries of a [`Solution`], in the order of the vertices.
#[derive(Clone, Debug, PartialEq)]
pub enum SolutionValues {
    /// One number each; as a metric: a size h, not 1/h^2.
    Scalar(Vec<f64>),
    /// As many numbers each as the dimension says.
    Vector(Vec<Vec<f64>>),
    /// Dimension 2: m11 m12 m22.
    Tensor(Vec<[f64; 3]>),
    /// Dimension 3, in the order on disk (the lower triangle): m11 m12 m22 m13 m23 m33.
    Tensor3(Vec<[f64; 6]>),
}

/// Reads the section `SolAtVertices` of a `.sol` text with one value per vertex; other sections are passed over.
///
/// `place` names the text in messages. Memory follows the text, never a count written in it.
///
/// # Errors
///
/// [`Error::Parse`] with the line of what is not as announced: a text cut off, more or fewer values than
/// announced, something that is no finite number. [`Error::Unsupported`] of several values per vertex.
pub fn read(text: &str, place: &str) -> Result<Solution> {
    let mut words = Words::new(text, place);
    read_head(&mut words)?;
    let (mut dimension, mut solution, mut before) = (None, None, "MeshVersionFormatted");
    while let Some(keyword) = next_section(&mut words, before)? {
        before = keyword.text;
        if before.eq_ignore_ascii_case("Dimension") {
            dimension = Some(read_dimension(&mut words)?);
        } else if before.eq_ignore_ascii_case("SolAtVertices") && solution.is_none() {
            let dimension = known_dimension(dimension, &words, SECTION)?;
            solution = Some(Solution { dimension, values: read_values(&mut words, dimension)? });
        } else if before.eq_ignore_ascii_case("SolAtVertices") {
            return Err(error_at(place, keyword.line, "a second section SolAtVertices", "keep one of them"));
        } else {
            skip_section(&mut words);
        }
    }
    solution.ok_or_else(|| {
        let help = "save the values on vertices, in a section SolAtVertices";
        error_at(place, words.line(), "the file has no section SolAtVertices", help)
    })
}

/// Writes a `.sol` text of version 2 that [`read`] turns into the same solution.
pub fn write(solution: &Solution) -> String {
    match &solution.values {
        SolutionValues::Scalar(values) => write_rows(solution, 1, values.iter().map(std::slice::from_ref)),
        SolutionValues::Vector(values) => write_rows(solution, 2, values.iter().map(Vec::as_slice)),
        SolutionValues::Tensor(values) => write_rows(solution, 3, values.iter().map(<[f64; 3]>::as_slice)),
        SolutionValues::Tensor3(values) => write_rows(solution, 3, values.iter().map(<[f64; 6]>::as_slice)),
    }
}

const SECTION: &str = "SolAtVertices";

fn read_values(words: &mut Words<'_>, dimension: u8) -> Result<SolutionValues> {
    let head = At::head(SECTION);
    let count: u64 = words.whole(head)?;
    let per_vertex: u64 = words.whole(head)?;
    if per_vertex != 1 {
        let what = format!("{per_vertex} solutions per vertex ({}:{})", words.place(), words.line());
        return Err(Error::Unsupported { what, help: "save each solution in a .sol file of its own ('1 t')".into() });
    }
    let kind: i64 = words.whole(head)?;
    match (kind, dimension) {
        (1, _) => Ok(SolutionValues::Scalar(read_rows(words, count)?.into_iter().map(|[value]| value).collect())),
        (2, _) => Ok(SolutionValues::Vector(read_vectors(words, count, dimension)?)),
        (3, 2) => Ok(SolutionValues::Tensor(read_rows(words, count)?)),
        (3, _) => Ok(SolutionValues::Tensor3(read_rows(words, count)?)),
        _ => {
            let what = format!("the type of the values is {kind}");
            let help = "write 1 for scalars, 2 for vectors, 3 for symmetric tensors";
            Err(error_at(words.place(), words.line(), what, help))
        }
    }
}

fn read_rows<const N: usize>(words: &mut Words<'_>, count: u64) -> Result<Vec<[f64; N]>> {
    let mut rows = Vec::new();
    for at in At::rows(SECTION, count) {
        let mut row = [0.0; N];
        for value in &mut row {
            *value = words.number(at)?;
        }
        rows.push(row);
    }
    Ok(rows)
}

fn read_vectors(words: &mut Words<'_>, count: u64, dimension: u8) -> Result<Vec<Vec<f64>>> {
    At::rows(SECTION, count).map(|at| (0..dimension).map(|_| words.number(at)).collect()).collect()
}

fn write_rows<'a>(solution: &Solution, kind: u8, rows: impl ExactSizeIterator<Item = &'a [f64]>) -> String {
    let (dimension, count) = (solution.dimension, rows.len());
    let mut out = format!("MeshVersionFormatted 2\n\nDimension {dimension}\n\n{SECTION}\n{count}\n1 {kind}\n");
    for row in rows {
        for (column, &value) in row.iter().enumerate() {
            let space = if column == 0 { "" } else { " " };
            // Writing to a string cannot fail.
            let _ = write!(out, "{space}{}", Shortest(value));
        }
        out.push('\n');
    }
    out.push_str("\nEnd\n");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back() {
        for (dimension, values) in [
            (2, SolutionValues::Scalar(vec![0.1, 1e-20, 3.0])),
            (3, SolutionValues::Vector(vec![vec![1.0, -2.0, 1.0 / 3.0]])),
            (2, SolutionValues::Tensor(vec![[1.0, 0.5, 1e40], [2.0, 0.0, 2.0]])),
            (3, SolutionValues::Tensor3(vec![[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]])),
            (2, SolutionValues::Tensor(vec![])),
        ] {
            let solution = Solution { dimension, values };
            assert_eq!(read(&write(&solution), "a.sol").unwrap(), solution);
        }
    }

    #[test]
    fn files_of_other_programs() {
        let text = "MeshVersionFormatted 2\n\nDimension\n2\nSolAtTriangles 1\n1 1\n7\n\nSolAtVertices\n2\n1 3 \n1.D0 0 1\n2 0 2\n";
        let solution = read(text, "a.sol").unwrap();
        assert_eq!(solution.values, SolutionValues::Tensor(vec![[1.0, 0.0, 1.0], [2.0, 0.0, 2.0]]));
    }

    #[test]
    fn errors_say_what_and_where() {
        for (body, expected) in [
            ("SolAtVertices 2\n1 1\n0.5", "a.sol:5: the text ends in row 2 of 2 of SolAtVertices"),
            ("SolAtVertices 900000000000000000\n1 3\n1 0 1", "a.sol:5: the text ends in row 2 of 900000000000000000"),
            (
                "SolAtVertices 1\n1 1\n0.5\n0.7\nEnd",
                "a.sol:6: '0.7' where the next section should begin: SolAtVertices is longer",
            ),
            ("SolAtVertices 2\n1 1\n0.5\nEnd", "a.sol:6: 'End' is not a number (row 2 of 2 of SolAtVertices)"),
            ("SolAtVertices 1\n1 3\n1 NaN 1", "a.sol:5: 'NaN' is not a finite number (row 1 of 1 of SolAtVertices)"),
            ("SolAtVertices 1\n2 1 3\n1 1 0 1", "not supported: 2 solutions per vertex (a.sol:4)"),
            ("SolAtVertices 1\n1 4\n1", "a.sol:4: the type of the values is 4"),
            ("SolAtVertices 0\n1 1\nSolAtVertices 0\n1 1", "a.sol:5: a second section SolAtVertices"),
            ("SolAtVertices -1\n1 1", "a.sol:3: '-1' is out of range (the head of SolAtVertices)"),
            ("End", "a.sol:3: the file has no section SolAtVertices"),
        ] {
            let error = read(&format!("MeshVersionFormatted 2\nDimension 2\n{body}"), "a.sol").unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }
}
