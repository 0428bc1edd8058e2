//! What Medit's `.mesh` and `.sol` files have in common: a head, then sections of numbers, each after a keyword.

use super::words::{At, Word, Words, error_at, shortened};
use crate::error::Result;

/// Reads `MeshVersionFormatted V`, which opens every file.
///
/// # Errors
///
/// [`crate::Error::Parse`] of any other beginning and of versions but 1 to 4 (as text all read alike).
pub(super) fn read_head(words: &mut Words<'_>) -> Result<()> {
    let at = At::head("MeshVersionFormatted");
    let word = words.expect(at)?;
    if !word.text.eq_ignore_ascii_case(at.section) {
        let what = format!("the file begins with '{}', not with MeshVersionFormatted", shortened(word.text));
        return Err(error_at(words.place(), word.line, what, "give a file in Medit's text format"));
    }
    let version: i64 = words.whole(at)?;
    if (1..=4).contains(&version) {
        return Ok(());
    }
    let what = format!("MeshVersionFormatted {version} does not exist");
    Err(error_at(words.place(), words.line(), what, "save the file as version 2"))
}

/// The keyword of the next section; `None` at `End` and at the end of the text.
///
/// # Errors
///
/// [`crate::Error::Parse`] where the section `before` holds more numbers than it announced.
pub(super) fn next_section<'a>(words: &mut Words<'a>, before: &str) -> Result<Option<Word<'a>>> {
    let Some(word) = words.next() else { return Ok(None) };
    if word.text.eq_ignore_ascii_case("End") {
        return Ok(None);
    }
    if is_keyword(word) {
        return Ok(Some(word));
    }
    let what =
        format!("'{}' where the next section should begin: {before} is longer than announced", shortened(word.text));
    let help = format!("check the count of {before}, and the Dimension, against the rows below");
    Err(error_at(words.place(), word.line, what, help))
}

/// Passes over the numbers of a section that nobody needs.
pub(super) fn skip_section(words: &mut Words<'_>) {
    while words.peek().is_some_and(|word| !is_keyword(word)) {
        words.next();
    }
}

/// The 2 or 3 of `Dimension`.
///
/// # Errors
///
/// [`crate::Error::Parse`] of any other number.
pub(super) fn read_dimension(words: &mut Words<'_>) -> Result<u8> {
    let dimension: i64 = words.whole(At::head("Dimension"))?;
    match dimension {
        2 => Ok(2),
        3 => Ok(3),
        _ => {
            let what = format!("Dimension {dimension}, where 2 or 3 is expected");
            Err(error_at(words.place(), words.line(), what, "write Dimension 2 for a planar file"))
        }
    }
}

/// The dimension read before a section that needs it.
///
/// # Errors
///
/// [`crate::Error::Parse`] if there was none.
pub(super) fn known_dimension(dimension: Option<u8>, words: &Words<'_>, section: &str) -> Result<u8> {
    dimension.ok_or_else(|| {
        let what = format!("{section} comes before Dimension");
        error_at(words.place(), words.line(), what, "write 'Dimension 2' below MeshVersionFormatted")
    })
}

fn is_keyword(word: Word<'_>) -> bool {
    word.text.starts_with(|c: char| c.is_ascii_alphabetic())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_are_told_apart_by_their_keywords() {
        let mut words =
            Words::new("meshversionformatted 2\nDimension\n3 Normals 1\n0 -1.e0 .5\nEdges 0 END 7", "a.mesh");
        read_head(&mut words).unwrap();
        let next =
            |words: &mut Words<'_>| next_section(words, "Normals").map(|word| word.map(|w| (w.line, w.text.len())));
        assert_eq!(next(&mut words).unwrap(), Some((2, 9)));
        assert_eq!(read_dimension(&mut words).unwrap(), 3);
        assert_eq!(next(&mut words).unwrap(), Some((3, 7)));
        assert!(next(&mut words.clone()).unwrap_err().to_string().starts_with("a.mesh:3: '1' where the next section"));
        skip_section(&mut words);
        assert_eq!(next(&mut words).unwrap(), Some((5, 5)));
        skip_section(&mut words);
        assert_eq!(next(&mut words).unwrap(), None);
    }
}
