//! Medit's formats for values on vertices and triangles, `.sol` as text and `.solb` as binary files: scalars (sizes), vectors and
//! symmetric tensors (metrics).

use super::codec::{At, Form};
use super::medit::{Sections, Writer};
use std::io::{self, BufRead, Write};
use voronaut::mesh::{Solution, SolutionValues, Solutions};
use voronaut::{Error, Result};

/// Reads the section `SolAtVertices` of a file, text or binary, with one value per vertex; other sections are passed over.
///
/// `place` names the file in messages. Memory follows the file, never a count written in it.
///
/// # Errors
///
/// [`Error::Parse`] with the line or the byte of what is not as announced: a file cut off, more or fewer values than
/// announced, something that is no finite number. [`Error::Unsupported`] of several values per vertex. [`Error::Io`] of a file
/// that cannot be read.
pub fn read(source: impl BufRead, place: &str) -> Result<Solution> {
    let help = "save the values on vertices, in a section SolAtVertices";
    let (dimension, [(place, values), _]) = read_sections(source, place, &SECTIONS[..1], help)?;
    let [values] = <[SolutionValues; 1]>::try_from(values).map_err(|values| {
        let what = format!("{} solutions per vertex ({place})", values.len());
        Error::unsupported(what, "save each solution in a .sol file of its own ('1 t')")
    })?;
    Ok(Solution { dimension, values })
}

/// Reads the sections `SolAtVertices` and `SolAtTriangles` of a file, with any number of values per vertex or triangle;
/// other sections are passed over.
///
/// # Errors
///
/// As for [`read`]; neither of the sections is there.
pub fn read_all(source: impl BufRead, place: &str) -> Result<Solutions> {
    let help = "save values in one of these sections";
    let (dimension, [(_, vertices), (_, triangles)]) = read_sections(source, place, &SECTIONS, help)?;
    Ok(Solutions { dimension, vertices, triangles })
}

/// Writes a file of version 2 that [`read`] turns into the same solution, to the last bit.
///
/// # Errors
/// What `out` says; [`io::ErrorKind::InvalidInput`] of vectors and tensors of another dimension.
pub fn write(solution: &Solution, form: Form, out: &mut dyn Write) -> io::Result<()> {
    write_sections(solution.dimension, [std::slice::from_ref(&solution.values), &[]], form, out)
}

/// Writes a file of version 2 that [`read_all`] turns into the same solutions, as many entries each as the first of their
/// section has.
///
/// # Errors
/// As of [`write()`].
///
/// # Panics
/// If a solution has fewer.
pub fn write_all(solutions: &Solutions, form: Form, out: &mut dyn Write) -> io::Result<()> {
    write_sections(solutions.dimension, [&solutions.vertices, &solutions.triangles], form, out)
}

/// Sections that are read; any other is passed over.
const SECTIONS: [&str; 2] = ["SolAtVertices", "SolAtTriangles"];

/// Where the head of a section ends, and its values.
type Section = (String, Vec<SolutionValues>);

/// Reads the dimension and the sections that are wanted, in the order of [`SECTIONS`]; one of them has to be there.
fn read_sections(source: impl BufRead, place: &str, wanted: &[&str], help: &str) -> Result<(u8, [Section; 2])> {
    let (mut from, mut sections) = (Sections::new(source, place)?, [None, None]);
    while let Some(name) = from.next_section()? {
        match wanted.iter().position(|wanted| *wanted == name) {
            _ if name == "Dimension" && from.dimension.is_none() => from.read_dimension()?,
            found if name == "Dimension" || found.is_some_and(|i| sections[i].is_some()) => {
                return Err(from.source.error(format!("a second section {name}"), "keep one of them"));
            }
            Some(i) => sections[i] = Some(read_section(&mut from, &name)?),
            None => from.skip_section()?,
        }
    }
    if sections.iter().all(Option::is_none) {
        return Err(from.source.error(format!("the file has no section {}", wanted.join(", nor ")), help));
    }
    Ok((from.dimension.unwrap_or_default(), sections.map(Option::unwrap_or_default)))
}

fn read_section(from: &mut Sections<'_>, section: &str) -> Result<Section> {
    let (head, dimension) = (At::head(section), from.known_dimension()?);
    let count = from.count()?;
    let solutions: u64 = from.short(head)?;
    if solutions == 0 {
        let help = "write how many solutions there are, then the type of each: '1 1' for a scalar";
        return Err(from.source.error(format!("no solution in {section}"), help));
    }
    let mut values = Vec::new();
    for _ in 0..solutions {
        let kind: i64 = from.short(head)?;
        values.push(match (kind, dimension) {
            (1, _) => SolutionValues::Scalar(Vec::new()),
            (2, _) => SolutionValues::Vector { components: dimension.into(), numbers: Vec::new() },
            (3, 2) => SolutionValues::Tensor(Vec::new()),
            (3, _) => SolutionValues::Tensor3(Vec::new()),
            _ => {
                let help = "write 1 for scalars, 2 for vectors, 3 for symmetric tensors";
                return Err(from.source.error(format!("the type of the values is {kind}"), help));
            }
        });
    }
    let place = from.source.place().to_string();
    for at in At::rows(section, count) {
        values.iter_mut().try_for_each(|values| push(values, from, at))?;
    }
    Ok((place, values))
}

fn push(values: &mut SolutionValues, from: &mut Sections<'_>, at: At<'_>) -> Result<()> {
    match values {
        SolutionValues::Scalar(entries) => entries.extend(from.numbers::<1>(at)?),
        SolutionValues::Vector { components, numbers } => {
            for _ in 0..*components {
                numbers.extend(from.numbers::<1>(at)?);
            }
        }
        SolutionValues::Tensor(entries) => entries.push(from.numbers(at)?),
        SolutionValues::Tensor3(entries) => entries.push(from.numbers(at)?),
    }
    Ok(())
}

fn write_sections(dimension: u8, sections: [&[SolutionValues]; 2], form: Form, out: &mut dyn Write) -> io::Result<()> {
    let size = |values: &SolutionValues| 8 * values.components() as u64 * values.count() as u64;
    let bytes = sections.into_iter().flatten().map(size).sum();
    let mut writer = Writer::new(form, dimension, bytes, out)?;
    for (name, values) in SECTIONS.into_iter().zip(sections) {
        if !values.is_empty() {
            write_section(&mut writer, dimension, name, values)?;
        }
    }
    writer.finish()
}

fn write_section(writer: &mut Writer<'_>, dimension: u8, name: &str, values: &[SolutionValues]) -> io::Result<()> {
    let kinds = values.iter().map(|values| kind(values, dimension)).collect::<io::Result<Vec<i32>>>()?;
    let number = i32::try_from(values.len()).map_err(|_| io::Error::other("more than 2^31 solutions"))?;
    let head: Vec<i32> = std::iter::once(number).chain(kinds).collect();
    let row = 8 * values.iter().map(SolutionValues::components).sum::<usize>();
    let count = values[0].count();
    writer.section(name, count, row, &head)?;
    writer.sink.rows(count, |row, i| row.put_all(values.iter().flat_map(|values| values.row(i)).copied()))
}

/// The number by which the format calls the type.
fn kind(values: &SolutionValues, dimension: u8) -> io::Result<i32> {
    let what = match values {
        SolutionValues::Scalar(_) => return Ok(1),
        SolutionValues::Vector { components, .. } if *components == usize::from(dimension) => return Ok(2),
        SolutionValues::Tensor(_) if dimension == 2 => return Ok(3),
        SolutionValues::Tensor3(_) if dimension == 3 => return Ok(3),
        SolutionValues::Vector { components, .. } => format!("vectors of {components} components"),
        SolutionValues::Tensor(_) | SolutionValues::Tensor3(_) => "tensors of another dimension".to_owned(),
    };
    let what = format!("{what} in a .sol file of dimension {dimension}");
    Err(io::Error::new(io::ErrorKind::InvalidInput, what))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back() {
        for (dimension, values) in [
            (2, SolutionValues::Scalar(vec![0.1, 1e-20, 3.0])),
            (3, SolutionValues::Vector { components: 3, numbers: vec![1.0, -2.0, 1.0 / 3.0] }),
            (2, SolutionValues::Tensor(vec![[1.0, 0.5, 1e40], [2.0, 0.0, 2.0]])),
            (3, SolutionValues::Tensor3(vec![[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]])),
            (2, SolutionValues::Tensor(vec![])),
        ] {
            let solution = Solution { dimension, values };
            for form in [Form::Text, Form::Binary] {
                let mut out = Vec::new();
                write(&solution, form, &mut out).unwrap();
                assert_eq!(read(out.as_slice(), "a.sol").unwrap(), solution);
            }
        }
    }

    fn written(all: &Solutions, form: Form) -> Vec<u8> {
        let mut out = Vec::new();
        write_all(all, form, &mut out).unwrap();
        out
    }

    #[test]
    fn vectors_have_as_many_components_as_the_dimension() {
        let values = SolutionValues::Vector { components: 3, numbers: vec![1.0; 3] };
        let error = write(&Solution { dimension: 2, values }, Form::Text, &mut Vec::new()).unwrap_err();
        assert_eq!(error.to_string(), "vectors of 3 components in a .sol file of dimension 2");
    }

    #[test]
    fn several_solutions_read_back() {
        let scalars = || SolutionValues::Scalar(vec![0.5, -1e-9]);
        let vectors = SolutionValues::Vector { components: 2, numbers: vec![1.0, 2.0, 0.1, 1.0 / 3.0] };
        let tensors = SolutionValues::Tensor(vec![[1.0, 0.5, 2.0], [3.0, -0.5, 2.0]]);
        let triangles = vec![SolutionValues::Scalar(vec![7.0])];
        let all = Solutions { dimension: 2, vertices: vec![scalars(), vectors, tensors, scalars()], triangles };
        let text = String::from_utf8(written(&all, Form::Text)).unwrap();
        assert!(text.contains("SolAtVertices\n2\n4 1 2 3 1\n0.5 1 2 1 0.5 2 0.5\n"), "{text}");
        for form in [Form::Text, Form::Binary] {
            assert_eq!(read_all(written(&all, form).as_slice(), "a.sol").unwrap(), all);
        }
        let cells = Solutions { vertices: vec![], ..all };
        assert_eq!(read_all(written(&cells, Form::Text).as_slice(), "a.sol").unwrap(), cells);
    }

    #[test]
    fn files_of_other_programs() {
        let text = "MeshVersionFormatted 2\n\nDimension\n2\nSolAtTriangles 1\n1 1\n7\n\nSolAtVertices\n2\n1 3 \n1.D0 0 1\n2 0 2\n";
        let solution = read(text.as_bytes(), "a.sol").unwrap();
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
            ("SolAtVertices 0\n1 2\nDimension 3", "a.sol:5: a second section Dimension"),
        ] {
            let error = read(format!("MeshVersionFormatted 2\nDimension 2\n{body}").as_bytes(), "a.sol").unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
        for (body, expected) in [
            ("End", "a.sol:3: the file has no section SolAtVertices, nor SolAtTriangles"),
            ("SolAtTriangles 2\n2 1 2\n1 2 3\n4 5", "a.sol:6: the text ends in row 2 of 2 of SolAtTriangles"),
            ("SolAtTriangles 0\n1 1\nSolAtTriangles 0\n1 1", "a.sol:5: a second section SolAtTriangles"),
        ] {
            let error =
                read_all(format!("MeshVersionFormatted 2\nDimension 2\n{body}").as_bytes(), "a.sol").unwrap_err();
            assert!(error.to_string().contains(expected) && !error.help().is_empty(), "{error}");
        }
    }
}
