//! Where in a file something is, and what words say there.

use std::fmt;
use std::str::FromStr;
use voronaut::{Error, Result};

/// A place in a file, as messages name it.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    pub(crate) file: &'a str,
    spot: Spot,
}

#[derive(Clone, Copy)]
enum Spot {
    /// Counted from 1.
    Line(usize),
    /// Counted from 0.
    Byte(u64),
}

/// A word, or a line that holds something, without its comment; and where it stands.
#[derive(Clone, Copy)]
pub(crate) struct Text<'a> {
    pub(crate) place: Place<'a>,
    /// Neither empty nor blank.
    pub(crate) text: &'a str,
}

/// Where a reader is, for messages: row so-and-so of a section.
#[derive(Clone, Copy)]
pub(crate) struct At<'a> {
    pub(crate) section: &'a str,
    /// Counted from 1.
    pub(crate) row: u64,
    /// As many as the file announces, which may be a lie.
    pub(crate) rows: u64,
}

/// The last entry, from 0, that something referred to so far: whether it exists is known once the file is read.
#[derive(Default)]
pub(crate) struct Largest(Option<(u32, Spot)>);

impl<'a> Place<'a> {
    /// A line, counted from 1.
    pub(crate) fn line(file: &'a str, line: usize) -> Self {
        Self { file, spot: Spot::Line(line) }
    }

    /// A byte, counted from 0.
    pub(crate) fn byte(file: &'a str, byte: u64) -> Self {
        Self { file, spot: Spot::Byte(byte) }
    }

    /// An [`Error::Parse`] here.
    pub(crate) fn error(self, what: impl Into<String>, help: impl Into<String>) -> Error {
        Error::parse(self.to_string(), what, help)
    }
}

impl fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.spot {
            Spot::Line(line) => write!(f, "{}:{line}", self.file),
            Spot::Byte(byte) => write!(f, "{}, byte {byte}", self.file),
        }
    }
}

impl<'a> Text<'a> {
    /// The words of a row.
    pub(crate) fn words(self) -> impl Iterator<Item = Text<'a>> {
        self.text.split_whitespace().map(move |text| Text { place: self.place, text })
    }

    /// A finite number, with the exponent letter of C (`e`) or Fortran (`d`).
    ///
    /// # Errors
    /// [`Error::Parse`] of a word that is no number, or not finite.
    pub(crate) fn number(self, at: At<'_>) -> Result<f64> {
        match self.text.parse().or_else(|_| self.text.replace(['d', 'D'], "e").parse::<f64>()) {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => Err(self.misread("is not a finite number", at)),
            Err(_) => Err(self.misread("is not a number", at)),
        }
    }

    /// A whole number of type `T`.
    ///
    /// # Errors
    /// [`Error::Parse`] of a word that is no whole number, or outside the range of `T`.
    pub(crate) fn whole<T: FromStr>(self, at: At<'_>) -> Result<T> {
        self.text.parse().map_err(|_| {
            let digits = self.text.strip_prefix(['+', '-']).unwrap_or(self.text);
            let is_whole = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
            self.misread(if is_whole { "is out of range" } else { "is not a whole number" }, at)
        })
    }

    /// A vertex, from 0, of a file that has so many, numbered from `first`.
    ///
    /// # Errors
    /// As of [`Text::whole`]; [`Error::Parse`] of a vertex that does not exist.
    pub(crate) fn vertex(self, first: u32, count: u64, at: At<'_>) -> Result<u32> {
        let number: u32 = self.whole(at)?;
        number.checked_sub(first).filter(|&vertex| u64::from(vertex) < count).ok_or_else(|| {
            let help = format!("this file has {count} vertices, numbered from {first}");
            self.place.error(format!("vertex {number} does not exist ({at})"), help)
        })
    }

    /// The word as messages quote it.
    pub(crate) fn quoted(self) -> String {
        shortened(self.text)
    }

    fn misread(self, problem: &str, at: At<'_>) -> Error {
        let of = at.section;
        let help = format!("check this row, the count of {of}, and the numbers of columns that the file announces");
        self.place.error(format!("'{}' {problem} ({at})", self.quoted()), help)
    }
}

/// A text as messages quote it: a binary file may hold a word of megabytes.
pub(crate) fn shortened(text: &str) -> String {
    const QUOTED: usize = 40;
    match text.char_indices().nth(QUOTED) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

impl<'a> At<'a> {
    /// The line that opens a section.
    pub(crate) fn head(section: &'a str) -> Self {
        Self { section, row: 0, rows: 0 }
    }

    /// All rows of a section in turn.
    pub(crate) fn rows(section: &'a str, rows: u64) -> impl Iterator<Item = At<'a>> {
        (1..=rows).map(move |row| Self { section, row, rows })
    }
}

impl fmt::Display for At<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.row {
            0 => write!(f, "the head of {}", self.section),
            row => write!(f, "row {row} of {} of {}", self.rows, self.section),
        }
    }
}

impl Largest {
    /// A reference to an entry, from 0.
    pub(crate) fn note(&mut self, entry: u32, place: Place<'_>) {
        if self.0.is_none_or(|(largest, _)| entry > largest) {
            self.0 = Some((entry, place.spot));
        }
    }

    /// Whether all that was referred to exists; the file counts from `first`.
    ///
    /// # Errors
    /// [`Error::Parse`] where the last entry is referred to.
    pub(crate) fn check(&self, of: &str, first: u64, count: usize, file: &str) -> Result<()> {
        let Some((entry, spot)) = self.0.filter(|&(entry, _)| entry as usize >= count) else { return Ok(()) };
        let what = format!("{of} {} does not exist: the file lists {count}, from {first}", u64::from(entry) + first);
        Err(Place { file, spot }.error(what, "check the number, and that the file is whole"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_all_dialects() {
        let read = |text| Text { place: Place::line("f", 3), text }.number(At::head("Vertices"));
        for (text, value) in [("1.D0", 1.0), ("-2.5d-3", -2.5e-3), ("1e-3", 1e-3), (".5", 0.5), ("+7", 7.0)] {
            assert_eq!(read(text).unwrap().to_bits(), f64::to_bits(value), "{text}");
        }
        for (text, problem) in [("nan", "finite"), ("-inf", "finite"), ("1e999", "finite"), ("x", "a number")] {
            let error = read(text).unwrap_err();
            let expected = format!("f:3: '{text}' is not a");
            assert!(error.to_string().starts_with(&expected) && error.to_string().contains(problem), "{error}");
            assert!(!error.help().is_empty());
        }
    }
}
