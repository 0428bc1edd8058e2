//! Rows and words of line-based text formats, with the lines they stand on.

use crate::error::{Error, Result};
use std::fmt;

/// A line that holds something, without its comment.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    /// Counted from 1.
    pub(super) line: usize,
    /// Neither empty nor blank.
    pub(super) text: &'a str,
}

/// The rows of a text: comments (from `#` to the end of the line) and blank lines are left out.
#[derive(Clone)]
pub(super) struct Rows<'a> {
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
}

/// The words of a text, one after the other, whatever the lines they stand on.
#[derive(Clone)]
pub(super) struct Words<'a> {
    place: &'a str,
    rows: Rows<'a>,
    row: std::str::SplitWhitespace<'a>,
    line: usize,
}

/// A word and the line it stands on.
#[derive(Clone, Copy)]
pub(super) struct Word<'a> {
    pub(super) line: usize,
    pub(super) text: &'a str,
}

/// Where a reader is, for messages: row so-and-so of a section.
#[derive(Clone, Copy)]
pub(super) struct At<'a> {
    pub(super) section: &'a str,
    /// Counted from 1.
    pub(super) row: u64,
    /// As many as the file announces, which may be a lie.
    pub(super) rows: u64,
}

/// The largest number that referred to something so far: whether that exists is known once the text is read.
#[derive(Default)]
pub(super) struct Largest {
    number: u32,
    line: usize,
}

/// A number in the shortest form that reads back as itself; huge and tiny ones with an exponent.
pub(super) struct Shortest(pub(super) f64);

/// Reads a finite number, with the exponent letter of C (`e`) or Fortran (`d`).
///
/// # Errors
///
/// [`Error::Parse`] with line and section of a word that is no number, or not finite.
pub(super) fn number(place: &str, word: Word<'_>, at: At<'_>) -> Result<f64> {
    let value = word.text.parse().or_else(|_| word.text.replace(['d', 'D'], "e").parse::<f64>());
    let problem = match value {
        Ok(value) if value.is_finite() => return Ok(value),
        Ok(_) => "is not a finite number",
        Err(_) => "is not a number",
    };
    Err(misread(place, word, at, problem))
}

/// Reads a whole number of type `T`.
///
/// # Errors
///
/// [`Error::Parse`] with line and section of a word that is no whole number, or outside the range of `T`.
pub(super) fn whole<T: std::str::FromStr>(place: &str, word: Word<'_>, at: At<'_>) -> Result<T> {
    let digits = word.text.strip_prefix(['+', '-']).unwrap_or(word.text);
    let is_whole = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
    let problem = if is_whole { "is out of range" } else { "is not a whole number" };
    word.text.parse().map_err(|_| misread(place, word, at, problem))
}

/// A [`Error::Parse`] at a line of a text.
pub(super) fn error_at(place: &str, line: usize, what: impl Into<String>, help: impl Into<String>) -> Error {
    Error::parse(format!("{place}:{line}"), what, help)
}

fn misread(place: &str, word: Word<'_>, at: At<'_>, problem: &str) -> Error {
    let help =
        format!("check this row, the count of {}, and the numbers of columns that the file announces", at.section);
    error_at(place, word.line, format!("'{}' {problem} ({at})", shortened(word.text)), help)
}

/// A word as messages quote it: a binary file may hold one of megabytes.
pub(super) fn shortened(word: &str) -> String {
    const QUOTED: usize = 40;
    match word.char_indices().nth(QUOTED) {
        Some((end, _)) => format!("{}...", &word[..end]),
        None => word.to_owned(),
    }
}

impl<'a> Rows<'a> {
    /// All rows of a text; a byte order mark is no part of it.
    pub(super) fn new(text: &'a str) -> Self {
        Self { lines: text.strip_prefix('\u{feff}').unwrap_or(text).lines().enumerate() }
    }
}

impl<'a> Iterator for Rows<'a> {
    type Item = Row<'a>;

    fn next(&mut self) -> Option<Row<'a>> {
        self.lines.by_ref().find_map(|(index, line)| {
            let text = line.split('#').next().unwrap_or_default();
            (!text.trim().is_empty()).then_some(Row { line: index + 1, text })
        })
    }
}

impl<'a> Row<'a> {
    /// The words of the row.
    pub(super) fn words(self) -> impl Iterator<Item = Word<'a>> {
        self.text.split_whitespace().map(move |text| Word { line: self.line, text })
    }
}

impl<'a> Words<'a> {
    /// The words of a text that messages call `place`.
    pub(super) fn new(text: &'a str, place: &'a str) -> Self {
        Self { place, rows: Rows::new(text), row: "".split_whitespace(), line: 1 }
    }

    /// What messages call the text.
    pub(super) fn place(&self) -> &'a str {
        self.place
    }

    /// The line of the word read last.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// The word after the one read last, left to be read.
    pub(super) fn peek(&self) -> Option<Word<'a>> {
        self.clone().next()
    }

    /// The next word, which has to be there.
    ///
    /// # Errors
    ///
    /// [`Error::Parse`] with section and row where the text ends.
    pub(super) fn expect(&mut self, at: At<'_>) -> Result<Word<'a>> {
        let (place, line) = (self.place, self.line);
        self.next().ok_or_else(|| {
            let help = format!("the file is cut off, or the count of {} is too large", at.section);
            error_at(place, line, format!("the text ends in {at}"), help)
        })
    }

    /// The next word as a finite number; errors as of [`Words::expect`] and [`number`].
    pub(super) fn number(&mut self, at: At<'_>) -> Result<f64> {
        let word = self.expect(at)?;
        number(self.place, word, at)
    }

    /// The next word as a whole number; errors as of [`Words::expect`] and [`whole`].
    pub(super) fn whole<T: std::str::FromStr>(&mut self, at: At<'_>) -> Result<T> {
        let word = self.expect(at)?;
        whole(self.place, word, at)
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = Word<'a>;

    fn next(&mut self) -> Option<Word<'a>> {
        loop {
            if let Some(text) = self.row.next() {
                return Some(Word { line: self.line, text });
            }
            let row = self.rows.next()?;
            self.line = row.line;
            self.row = row.text.split_whitespace();
        }
    }
}

impl Largest {
    /// A reference, counted from 1, on a line.
    pub(super) fn note(&mut self, number: u32, line: usize) {
        if number > self.number {
            *self = Self { number, line };
        }
    }

    /// Whether all that was referred to exists.
    ///
    /// # Errors
    ///
    /// [`Error::Parse`] at the line of the largest number.
    pub(super) fn check(&self, of: &str, count: usize, place: &str) -> Result<()> {
        if self.number as usize <= count {
            return Ok(());
        }
        let what = format!("{of} {} does not exist: the file lists {count}", self.number);
        Err(error_at(place, self.line, what, "check the number, and that the file is whole"))
    }
}

impl<'a> At<'a> {
    /// The line that opens a section.
    pub(super) fn head(section: &'a str) -> Self {
        Self { section, row: 0, rows: 0 }
    }

    /// All rows of a section in turn.
    pub(super) fn rows(section: &'a str, rows: u64) -> impl Iterator<Item = At<'a>> {
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

impl fmt::Display for Shortest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-5..1e16).contains(&size) { write!(f, "{}", self.0) } else { write!(f, "{:e}", self.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_know_their_lines() {
        let words: Vec<_> =
            Words::new("\u{feff}a b # c\n\n#\r\n  d\n", "f").map(|w| (w.line, w.text.to_owned())).collect();
        assert_eq!(words, [(1, "a".into()), (1, "b".into()), (4, "d".into())]);
    }

    #[test]
    fn numbers_of_all_dialects() {
        let read = |text| number("f", Word { line: 3, text }, At::head("Vertices"));
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

    #[test]
    fn shortest_form_reads_back() {
        for value in [0.0, -0.0, 1.0, 0.1, 1e300, 5e-324, -1.0 / 3.0, 123_456_789.123_456_79] {
            let text = Shortest(value).to_string();
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits(), "{text}");
            assert!(text.len() < 26, "{text}");
        }
    }
}
