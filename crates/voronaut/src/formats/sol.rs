//! Medit's text format for values on vertices and triangles, `.sol`: scalars (sizes), vectors and symmetric tensors (metrics).

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
        self.values.count()
    }
}

/// Everything that a `.sol` file holds: any number of solutions on vertices and on triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solutions {
    /// 2 or 3: the coordinates of the mesh's vertices.
    pub dimension: u8,
    /// One entry per vertex each.
    pub vertices: Vec<SolutionValues>,
    /// One entry per triangle each.
    pub triangles: Vec<SolutionValues>,
}

/// The entries of a solution, in the order of the vertices or triangles.
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

impl SolutionValues {
    /// How many entries there are.
    pub fn count(&self) -> usize {
        match self {
            SolutionValues::Scalar(entries) => entries.len(),
            SolutionValues::Vector(entries) => entries.len(),
            SolutionValues::Tensor(entries) => entries.len(),
            SolutionValues::Tensor3(entries) => entries.len(),
        }
    }

    /// The numbers of entry `i`.
    ///
    /// # Panics
    /// If there is no such entry.
    pub fn row(&self, i: usize) -> &[f64] {
        match self {
            SolutionValues::Scalar(entries) => std::slice::from_ref(&entries[i]),
            SolutionValues::Vector(entries) => &entries[i],
            SolutionValues::Tensor(entries) => &entries[i],
            SolutionValues::Tensor3(entries) => &entries[i],
        }
    }

    /// Entries of the same type from their numbers, one after the other; vectors have so many as the dimension says.
    #[must_use]
    pub fn with_numbers(&self, dimension: u8, numbers: &[f64]) -> Self {
        match self {
            SolutionValues::Scalar(_) => SolutionValues::Scalar(numbers.to_vec()),
            SolutionValues::Vector(_) => {
                SolutionValues::Vector(numbers.chunks_exact(usize::from(dimension)).map(<[f64]>::to_vec).collect())
            }
            SolutionValues::Tensor(_) => SolutionValues::Tensor(numbers.as_chunks().0.to_vec()),
            SolutionValues::Tensor3(_) => SolutionValues::Tensor3(numbers.as_chunks().0.to_vec()),
        }
    }

    /// The number by which the format calls the type.
    fn kind(&self) -> u8 {
        match self {
            SolutionValues::Scalar(_) => 1,
            SolutionValues::Vector(_) => 2,
            SolutionValues::Tensor(_) | SolutionValues::Tensor3(_) => 3,
        }
    }

    fn push(&mut self, words: &mut Words<'_>, dimension: u8, at: At<'_>) -> Result<()> {
        match self {
            SolutionValues::Scalar(entries) => entries.push(words.number(at)?),
            SolutionValues::Vector(entries) => {
                entries.push((0..dimension).map(|_| words.number(at)).collect::<Result<_>>()?);
            }
            SolutionValues::Tensor(entries) => entries.push(row(words, at)?),
            SolutionValues::Tensor3(entries) => entries.push(row(words, at)?),
        }
        Ok(())
    }
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
    let mut file = Parsed::read(text, place, &SECTIONS[..1])?;
    let Some(mut found) = file.sections[0].take() else {
        return Err(file.missing("", "save the values on vertices, in a section SolAtVertices"));
    };
    match found.values.pop() {
        Some(values) if found.values.is_empty() => Ok(Solution { dimension: file.dimension, values }),
        _ => {
            let what = format!("{} solutions per vertex ({place}:{})", found.values.len() + 1, found.line);
            Err(Error::Unsupported { what, help: "save each solution in a .sol file of its own ('1 t')".into() })
        }
    }
}

/// Reads the sections `SolAtVertices` and `SolAtTriangles` of a `.sol` text, with any number of values per vertex or triangle;
/// other sections are passed over.
///
/// # Errors
///
/// As for [`read`]; neither of the sections is there.
pub fn read_all(text: &str, place: &str) -> Result<Solutions> {
    let mut file = Parsed::read(text, place, &SECTIONS)?;
    let [vertices, triangles] = [0, 1].map(|i| file.sections[i].take());
    if vertices.is_none() && triangles.is_none() {
        return Err(file.missing(", nor SolAtTriangles", "save values in one of these sections"));
    }
    let values = |found: Option<Section>| found.map_or_else(Vec::new, |found| found.values);
    Ok(Solutions { dimension: file.dimension, vertices: values(vertices), triangles: values(triangles) })
}

/// Writes a `.sol` text of version 2 that [`read`] turns into the same solution.
pub fn write(solution: &Solution) -> String {
    let mut out = head(solution.dimension);
    write_section(&mut out, SECTIONS[0], std::slice::from_ref(&solution.values));
    out + "\nEnd\n"
}

/// Writes a `.sol` text of version 2 that [`read_all`] turns into the same solutions, as many entries each as the first of their
/// section has.
///
/// # Panics
/// If a solution has fewer.
pub fn write_all(solutions: &Solutions) -> String {
    let mut out = head(solutions.dimension);
    for (name, values) in SECTIONS.into_iter().zip([&solutions.vertices, &solutions.triangles]) {
        if !values.is_empty() {
            write_section(&mut out, name, values);
        }
    }
    out + "\nEnd\n"
}

/// Sections that are read; any other is passed over.
const SECTIONS: [&str; 2] = ["SolAtVertices", "SolAtTriangles"];

/// What is read of a file.
struct Parsed<'a> {
    words: Words<'a>,
    dimension: u8,
    /// In the order of [`SECTIONS`].
    sections: [Option<Section>; 2],
}

struct Section {
    /// Where its head ends.
    line: usize,
    values: Vec<SolutionValues>,
}

impl<'a> Parsed<'a> {
    /// Reads the sections that are wanted.
    fn read(text: &'a str, place: &'a str, wanted: &[&str]) -> Result<Self> {
        let mut words = Words::new(text, place);
        read_head(&mut words)?;
        let (mut dimension, mut sections, mut before) = (None, [None, None], "MeshVersionFormatted");
        while let Some(keyword) = next_section(&mut words, before)? {
            before = keyword.text;
            let section = wanted.iter().position(|name| name.eq_ignore_ascii_case(before));
            match section {
                _ if before.eq_ignore_ascii_case("Dimension") => dimension = Some(read_dimension(&mut words)?),
                Some(i) if sections[i].is_some() => {
                    let what = format!("a second section {}", wanted[i]);
                    return Err(error_at(place, keyword.line, what, "keep one of them"));
                }
                Some(i) => {
                    let dimension = known_dimension(dimension, &words, wanted[i])?;
                    sections[i] = Some(read_section(&mut words, dimension, wanted[i])?);
                }
                None => skip_section(&mut words),
            }
        }
        Ok(Self { words, dimension: dimension.unwrap_or_default(), sections })
    }

    fn missing(&self, more: &str, help: &str) -> Error {
        let what = format!("the file has no section SolAtVertices{more}");
        error_at(self.words.place(), self.words.line(), what, help)
    }
}

fn read_section(words: &mut Words<'_>, dimension: u8, section: &str) -> Result<Section> {
    let head = At::head(section);
    let count: u64 = words.whole(head)?;
    let solutions: u64 = words.whole(head)?;
    if solutions == 0 {
        let help = "write how many solutions there are, then the type of each: '1 1' for a scalar";
        return Err(error_at(words.place(), words.line(), format!("no solution in {section}"), help));
    }
    let mut values = Vec::new();
    for _ in 0..solutions {
        let kind: i64 = words.whole(head)?;
        values.push(match (kind, dimension) {
            (1, _) => SolutionValues::Scalar(Vec::new()),
            (2, _) => SolutionValues::Vector(Vec::new()),
            (3, 2) => SolutionValues::Tensor(Vec::new()),
            (3, _) => SolutionValues::Tensor3(Vec::new()),
            _ => {
                let what = format!("the type of the values is {kind}");
                let help = "write 1 for scalars, 2 for vectors, 3 for symmetric tensors";
                return Err(error_at(words.place(), words.line(), what, help));
            }
        });
    }
    let line = words.line();
    for at in At::rows(section, count) {
        values.iter_mut().try_for_each(|values| values.push(words, dimension, at))?;
    }
    Ok(Section { line, values })
}

fn row<const N: usize>(words: &mut Words<'_>, at: At<'_>) -> Result<[f64; N]> {
    let mut row = [0.0; N];
    for value in &mut row {
        *value = words.number(at)?;
    }
    Ok(row)
}

fn head(dimension: u8) -> String {
    format!("MeshVersionFormatted 2\n\nDimension {dimension}\n")
}

fn write_section(out: &mut String, name: &str, values: &[SolutionValues]) {
    let count = values[0].count();
    // Writing to a string cannot fail.
    let _ = write!(out, "\n{name}\n{count}\n{}", values.len());
    for values in values {
        let _ = write!(out, " {}", values.kind());
    }
    out.push('\n');
    for i in 0..count {
        for (column, &value) in values.iter().flat_map(|values| values.row(i)).enumerate() {
            let space = if column == 0 { "" } else { " " };
            let _ = write!(out, "{space}{}", Shortest(value));
        }
        out.push('\n');
    }
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
    fn several_solutions_read_back() {
        let scalars = || SolutionValues::Scalar(vec![0.5, -1e-9]);
        let vectors = SolutionValues::Vector(vec![vec![1.0, 2.0], vec![0.1, 1.0 / 3.0]]);
        let tensors = SolutionValues::Tensor(vec![[1.0, 0.5, 2.0], [3.0, -0.5, 2.0]]);
        let triangles = vec![SolutionValues::Scalar(vec![7.0])];
        let all = Solutions { dimension: 2, vertices: vec![scalars(), vectors, tensors, scalars()], triangles };
        let text = write_all(&all);
        assert!(text.contains("SolAtVertices\n2\n4 1 2 3 1\n0.5 1 2 1 0.5 2 0.5\n"), "{text}");
        assert_eq!(read_all(&text, "a.sol").unwrap(), all);
        let cells = Solutions { vertices: vec![], ..all };
        assert_eq!(read_all(&write_all(&cells), "a.sol").unwrap(), cells);
    }

    #[test]
    fn numbers_make_entries_of_the_same_type() {
        for (values, numbers) in [
            (SolutionValues::Scalar(vec![1.0, 2.0]), [1.0, 2.0].as_slice()),
            (SolutionValues::Vector(vec![vec![1.0, 2.0, 3.0]]), &[1.0, 2.0, 3.0]),
            (SolutionValues::Tensor(vec![[1.0, 2.0, 3.0]]), &[1.0, 2.0, 3.0]),
            (SolutionValues::Tensor3(vec![[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]]), &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
        ] {
            let rows: Vec<f64> = (0..values.count()).flat_map(|i| values.row(i)).copied().collect();
            assert_eq!(rows, numbers);
            assert_eq!(values.with_numbers(3, numbers), values);
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
            ("SolAtVertices 900000000000000000\n0", "a.sol:4: no solution in SolAtVertices"),
            ("SolAtVertices 1\n3 1 2 4\n1", "a.sol:4: the type of the values is 4"),
            ("SolAtVertices 1\n1 4\n1", "a.sol:4: the type of the values is 4"),
            ("SolAtVertices 0\n1 1\nSolAtVertices 0\n1 1", "a.sol:5: a second section SolAtVertices"),
            ("SolAtVertices -1\n1 1", "a.sol:3: '-1' is out of range (the head of SolAtVertices)"),
            ("End", "a.sol:3: the file has no section SolAtVertices"),
        ] {
            let error = read(&format!("MeshVersionFormatted 2\nDimension 2\n{body}"), "a.sol").unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
        for (body, expected) in [
            ("End", "a.sol:3: the file has no section SolAtVertices, nor SolAtTriangles"),
            ("SolAtTriangles 2\n2 1 2\n1 2 3\n4 5", "a.sol:6: the text ends in row 2 of 2 of SolAtTriangles"),
            ("SolAtTriangles 0\n1 1\nSolAtTriangles 0\n1 1", "a.sol:5: a second section SolAtTriangles"),
        ] {
            let error = read_all(&format!("MeshVersionFormatted 2\nDimension 2\n{body}"), "a.sol").unwrap_err();
            assert!(error.to_string().contains(expected) && !error.help().is_empty(), "{error}");
        }
    }
}
