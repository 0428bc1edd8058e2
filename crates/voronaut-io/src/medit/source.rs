//! Medit's files as a sequence of sections, each a keyword and numbers: as text, and in libMeshb's binary form.

use super::keywords::{KEYWORDS, code_of};
use crate::bytes::{Bytes, Order};
use crate::words::{At, Largest, Words, error_at, shortened};
use std::io::BufRead;
use voronaut::{Error, Result};

/// The numbers of a file, one after the other, section by section.
pub(crate) enum Source<'a> {
    Text(Words<'a>),
    Binary(Binary<'a>),
}

/// A binary file: each section begins with its keyword's code and the byte where the next begins.
pub(crate) struct Binary<'a> {
    bytes: Bytes<'a>,
    version: i32,
    /// Where the next section begins; `None` behind the last.
    next: Option<u64>,
}

impl<'a> Source<'a> {
    /// Reads the head of a file, which tells whether it is text or binary, and of which byte order and version.
    ///
    /// # Errors
    /// [`Error::Parse`] of what begins otherwise, and of versions but 1 to 4; [`Error::Io`] of what cannot be read.
    pub(crate) fn new(mut source: impl BufRead + 'a, place: &'a str) -> Result<Self> {
        let start = source.fill_buf().map_err(|source| Error::Io { path: place.into(), source })?;
        // Text begins with a letter or white space, binary files with the number 1 in four bytes.
        let order = match start.first() {
            Some(1) => Order::Little,
            Some(0) => Order::Big,
            _ => {
                let mut words = Words::new(source, place);
                read_head(&mut words)?;
                return Ok(Self::Text(words));
            }
        };
        Ok(Self::Binary(Binary::new(Bytes::new(source, 0, order, place))?))
    }

    /// The keyword of the next section, as the format spells it where it is known; `None` behind the last.
    ///
    /// # Errors
    /// [`Error::Parse`] where the section `before` holds more or fewer numbers than it announced.
    pub(crate) fn next_section(&mut self, before: &str) -> Result<Option<String>> {
        match self {
            Self::Text(words) => next_section(words, before),
            Self::Binary(binary) => binary.next_section(before),
        }
    }

    /// Passes over the rest of a section.
    ///
    /// # Errors
    /// As of [`Source::number`].
    pub(crate) fn skip_section(&mut self, section: &str) -> Result<()> {
        match self {
            Self::Text(words) => {
                while words.peek()?.is_some_and(|word| !is_keyword(word.text)) {
                    words.next()?;
                }
                Ok(())
            }
            Self::Binary(binary) => binary.skip_section(section),
        }
    }

    /// The number of rows of a section.
    ///
    /// # Errors
    /// As of [`Source::whole`]; of numbers below 0.
    pub(crate) fn count(&mut self, section: &str) -> Result<u64> {
        let at = At::head(section);
        match self {
            Self::Text(words) => words.whole(at),
            Self::Binary(binary) => {
                let count = if binary.version == 4 { binary.bytes.i64(at)? } else { binary.bytes.i32(at)?.into() };
                u64::try_from(count)
                    .map_err(|_| self.error(format!("'{count}' is out of range ({at})"), "check the file"))
            }
        }
    }

    /// The next whole number: a vertex, a label, a type.
    ///
    /// # Errors
    /// [`Error::Parse`] with line or byte where the file ends, or holds no such number.
    pub(crate) fn whole<T: TryFrom<i64> + std::str::FromStr>(&mut self, at: At<'_>) -> Result<T> {
        match self {
            Self::Text(words) => words.whole(at),
            Self::Binary(binary) => {
                let found = if binary.version == 4 { binary.bytes.i64(at)? } else { binary.bytes.i32(at)?.into() };
                binary.in_range(found, at)
            }
        }
    }

    /// As [`Source::whole`], of the numbers that have 32 bits in all versions: the dimension, and the types of solutions.
    ///
    /// # Errors
    /// As of [`Source::whole`].
    pub(crate) fn short<T: TryFrom<i64> + std::str::FromStr>(&mut self, at: At<'_>) -> Result<T> {
        match self {
            Self::Text(words) => words.whole(at),
            Self::Binary(binary) => {
                let found = binary.bytes.i32(at)?;
                binary.in_range(found.into(), at)
            }
        }
    }

    /// The next finite number.
    ///
    /// # Errors
    /// As of [`Source::whole`].
    pub(crate) fn number(&mut self, at: At<'_>) -> Result<f64> {
        match self {
            Self::Text(words) => words.number(at),
            Self::Binary(binary) if binary.version == 1 => binary.bytes.f32(at),
            Self::Binary(binary) => binary.bytes.f64(at),
        }
    }

    /// The 2 or 3 of `Dimension`.
    ///
    /// # Errors
    /// [`Error::Parse`] of any other number.
    pub(crate) fn dimension(&mut self) -> Result<u8> {
        let dimension: i64 = self.short(At::head("Dimension"))?;
        match dimension {
            2 => Ok(2),
            3 => Ok(3),
            _ => {
                let what = format!("Dimension {dimension}, where 2 or 3 is expected");
                Err(self.error(what, "write Dimension 2 for a planar file"))
            }
        }
    }

    /// The dimension read before a section that needs it.
    ///
    /// # Errors
    /// [`Error::Parse`] if there was none.
    pub(crate) fn known_dimension(&self, dimension: Option<u8>, section: &str) -> Result<u8> {
        dimension.ok_or_else(|| {
            let what = format!("{section} comes before Dimension");
            self.error(what, "write 'Dimension 2' below MeshVersionFormatted")
        })
    }

    /// Whether all that the file refers to exists.
    ///
    /// # Errors
    /// [`Error::Parse`] with line or byte of the largest number.
    pub(crate) fn check(&self, largest: &Largest, of: &str, count: usize) -> Result<()> {
        let Some((number, position)) = largest.beyond(count) else { return Ok(()) };
        let what = format!("{of} {number} does not exist: the file lists {count}");
        Err(self.error_at(position, what, "check the number, and that the file is whole"))
    }

    /// The line of the number read last, or the byte behind it.
    pub(crate) fn position(&self) -> u64 {
        match self {
            Self::Text(words) => words.line() as u64,
            Self::Binary(binary) => binary.bytes.position(),
        }
    }

    /// Where the number read last is, for messages that are no [`Error::Parse`].
    pub(crate) fn here(&self) -> String {
        match self {
            Self::Text(words) => format!("{}:{}", words.place(), words.line()),
            Self::Binary(binary) => format!("{}, byte {}", binary.bytes.place(), binary.bytes.position()),
        }
    }

    /// An [`Error::Parse`] at a position that [`Source::position`] gave.
    pub(crate) fn error_at(&self, at: u64, what: impl Into<String>, help: impl Into<String>) -> Error {
        match self {
            Self::Text(words) => error_at(words.place(), at as usize, what, help),
            Self::Binary(binary) => binary.bytes.error_at(at, what, help),
        }
    }

    /// An [`Error::Parse`] at the number read last.
    pub(crate) fn error(&self, what: impl Into<String>, help: impl Into<String>) -> Error {
        self.error_at(self.position(), what, help)
    }
}

/// Reads `MeshVersionFormatted V`, which opens every text.
fn read_head(words: &mut Words<'_>) -> Result<()> {
    let at = At::head("MeshVersionFormatted");
    let place = words.place();
    let word = words.expect(at)?;
    if !word.text.eq_ignore_ascii_case(at.section) {
        let what = format!("the file begins with '{}', not with MeshVersionFormatted", shortened(word.text));
        return Err(error_at(place, word.line, what, "give a file in one of Medit's formats"));
    }
    let version: i64 = words.whole(at)?;
    // bamg's manual writes 0, and as text all versions read alike.
    if version == 0 || VERSIONS.contains(&version) {
        return Ok(());
    }
    let what = format!("MeshVersionFormatted {version} does not exist");
    Err(error_at(place, words.line(), what, "save the file as version 2"))
}

const VERSIONS: std::ops::RangeInclusive<i64> = 1..=4;

fn next_section(words: &mut Words<'_>, before: &str) -> Result<Option<String>> {
    let place = words.place();
    let Some(word) = words.next()? else { return Ok(None) };
    if word.text.eq_ignore_ascii_case("End") {
        return Ok(None);
    }
    if is_keyword(word.text) {
        let known = KEYWORDS.iter().find(|(_, name)| name.eq_ignore_ascii_case(word.text));
        return Ok(Some(known.map_or(word.text, |(_, name)| name).to_owned()));
    }
    let what =
        format!("'{}' where the next section should begin: {before} is longer than announced", shortened(word.text));
    let help = format!("check the count of {before}, and the Dimension, against the rows below");
    Err(error_at(place, word.line, what, help))
}

fn is_keyword(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_alphabetic())
}

impl<'a> Binary<'a> {
    /// Reads the number 1 that tells the byte order, and the version.
    fn new(mut bytes: Bytes<'a>) -> Result<Self> {
        let at = At::head("the file");
        if bytes.i32(at)? != 1 {
            let what = "the file begins neither with MeshVersionFormatted nor with the number 1 in four bytes";
            return Err(bytes.error_at(0, what, "give a file in one of Medit's formats"));
        }
        let version = bytes.i32(at)?;
        if !VERSIONS.contains(&version.into()) {
            let what = format!("version {version} does not exist");
            return Err(bytes.error_at(4, what, "save the file as version 2"));
        }
        let next = Some(bytes.position());
        Ok(Self { bytes, version, next })
    }

    fn next_section(&mut self, before: &str) -> Result<Option<String>> {
        let Some(next) = self.next else { return Ok(None) };
        let here = self.bytes.position();
        if here != next {
            let what = format!("{before} ends here, and the file says that the next section begins at byte {next}");
            let help = format!("check the count of {before}, the Dimension and the version");
            return Err(self.bytes.error(what, help));
        }
        let at = At::head("a section");
        if self.bytes.is_at_end()? {
            return Err(self.bytes.error("the file ends without End", "the file is cut off: write it again"));
        }
        let code = self.bytes.i32(at)?;
        let next = if self.version < 3 { i64::from(self.bytes.i32(at)?) } else { self.bytes.i64(at)? };
        if code == code_of("End") {
            return Ok(None);
        }
        let here = self.bytes.position();
        self.next = match u64::try_from(next) {
            Ok(0) => None,
            Ok(next) if next >= here => Some(next),
            _ => {
                let what = format!("the section after this one should begin at byte {next}, which is before its own");
                return Err(self.bytes.error(what, "the file is damaged: write it again"));
            }
        };
        let known = KEYWORDS.iter().find(|(known, _)| *known == code);
        Ok(Some(known.map_or_else(|| format!("section {code}"), |(_, name)| (*name).to_owned())))
    }

    fn skip_section(&mut self, section: &str) -> Result<()> {
        let Some(next) = self.next else { return Ok(()) };
        self.bytes.skip(next.saturating_sub(self.bytes.position()), At::head(section))
    }

    fn in_range<T: TryFrom<i64>>(&self, found: i64, at: At<'_>) -> Result<T> {
        T::try_from(found).map_err(|_| {
            let what = format!("'{found}' is out of range ({at})");
            self.bytes.error(what, format!("check this row, and the count of {}", at.section))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_are_told_apart_by_their_keywords() {
        let text = "meshversionformatted 2\nDimension\n3 Normals 1\n0 -1.e0 .5\nEdges 0 END 7";
        let mut source = Source::new(text.as_bytes(), "a.mesh").unwrap();
        let next = |source: &mut Source<'_>| source.next_section("Normals").map(|name| (name, source.position()));
        assert_eq!(next(&mut source).unwrap(), (Some("Dimension".into()), 2));
        assert_eq!(source.dimension().unwrap(), 3);
        assert_eq!(next(&mut source).unwrap(), (Some("Normals".into()), 3));
        source.skip_section("Normals").unwrap();
        assert_eq!(next(&mut source).unwrap(), (Some("Edges".into()), 5));
        let error = next(&mut source).unwrap_err().to_string();
        assert!(error.starts_with("a.mesh:5: '0' where the next section"), "{error}");
        assert_eq!(next(&mut source).unwrap().0, None);
    }

    #[test]
    fn binary_files_of_either_order() {
        for order in [i32::to_le_bytes, i32::to_be_bytes] {
            let file: Vec<u8> = [1, 2, 3, 20, 2, 900, 28, 54, 0].into_iter().flat_map(order).collect();
            let mut source = Source::new(file.as_slice(), "a.meshb").unwrap();
            assert_eq!(source.next_section("").unwrap(), Some("Dimension".into()));
            let early = source.next_section("Dimension").unwrap_err();
            assert!(early.to_string().starts_with("a.meshb, byte 16: Dimension ends here, and the"), "{early}");
            assert_eq!(source.dimension().unwrap(), 2);
            assert_eq!(source.next_section("").unwrap(), Some("section 900".into()));
            source.skip_section("").unwrap();
            assert_eq!(source.next_section("").unwrap(), None);
        }
        for (numbers, expected) in [
            (vec![1, 9], "a.meshb, byte 4: version 9 does not exist"),
            (vec![1], "a.meshb, byte 4: the file ends in the head of the file"),
            (vec![257, 2], "a.meshb, byte 0: the file begins neither with MeshVersionFormatted nor"),
            (vec![1, 2], "a.meshb, byte 8: the file ends without End"),
            (vec![1, 2, 4, 15, 7], "a.meshb, byte 16: the section after this one should begin at byte 15, which"),
            (vec![1, 2, 4, 60, 7], "a.meshb, byte 20: the file ends in the head of Vertices"),
        ] {
            let file: Vec<u8> = numbers.into_iter().flat_map(i32::to_le_bytes).collect();
            let read = || -> Result<()> {
                let mut source = Source::new(file.as_slice(), "a.meshb")?;
                while let Some(name) = source.next_section("a section")? {
                    source.skip_section(&name)?;
                }
                Ok(())
            };
            let error = read().unwrap_err();
            assert!(error.to_string().starts_with(expected) && !error.help().is_empty(), "{error}");
        }
    }
}
