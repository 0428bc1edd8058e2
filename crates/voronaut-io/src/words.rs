//! Rows and words of line-based text formats, read line by line, with the lines they stand on.

use std::fmt;
use std::io::{BufRead, Read};
use std::ops::Range;
use voronaut::{Error, Result};

/// A line that holds something, without its comment.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    /// Counted from 1.
    pub(super) line: usize,
    /// Neither empty nor blank.
    pub(super) text: &'a str,
}

/// The rows of a text: comments (from `#` to the end of the line) and blank lines are left out. Only one line at a time is in
/// memory.
pub(super) struct Rows<'a> {
    source: Box<dyn BufRead + 'a>,
    place: &'a str,
    line: usize,
    buffer: Vec<u8>,
    /// Whether the row in the buffer was looked at but not taken.
    is_ahead: bool,
    /// First words of rows that may be in any encoding.
    naming: &'static [&'static str],
}

/// The words of a text, one after the other, whatever the lines they stand on.
pub(super) struct Words<'a> {
    rows: Rows<'a>,
    /// Where in the row the word is that was read last.
    word: Range<usize>,
    is_ahead: bool,
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

/// The largest number that referred to something so far: whether that exists is known once the file is read.
#[derive(Default)]
pub(super) struct Largest {
    number: u64,
    /// The line, or the byte, where it stands.
    position: u64,
}

/// A number in the shortest form that reads back as itself; huge and tiny ones with an exponent.
pub(super) struct Shortest(pub(super) f64);

/// Longer lines are refused: a binary file may have no line at all.
pub(super) const LONGEST_LINE: u64 = 1 << 24;

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
    /// All rows of a text that messages call `place`; a byte order mark is no part of it.
    pub(super) fn new(source: impl BufRead + 'a, place: &'a str) -> Self {
        Self { source: Box::new(source), place, line: 0, buffer: Vec::new(), is_ahead: false, naming: &[] }
    }

    /// As [`Rows::new`]; rows that begin with one of these words may be in any encoding, and characters that are not UTF-8 are
    /// replaced there.
    pub(super) fn with_names(source: impl BufRead + 'a, place: &'a str, naming: &'static [&'static str]) -> Self {
        Self { naming, ..Self::new(source, place) }
    }

    /// What messages call the text.
    pub(super) fn place(&self) -> &'a str {
        self.place
    }

    /// The line of the row read last; 1 before the first.
    pub(super) fn line(&self) -> usize {
        self.line.max(1)
    }

    /// The next row; `None` at the end of the text.
    ///
    /// # Errors
    /// [`Error::Io`] of a text that cannot be read; [`Error::Parse`] of a line that is too long, or not UTF-8.
    pub(super) fn next(&mut self) -> Result<Option<Row<'_>>> {
        let there = self.advance()?;
        Ok(there.then(|| self.row()))
    }

    /// Whether there is another row, which is left to be read.
    ///
    /// # Errors
    /// As of [`Rows::next`].
    pub(super) fn has_next(&mut self) -> Result<bool> {
        let line = self.line;
        self.is_ahead = self.is_ahead || self.advance()?;
        if !self.is_ahead {
            self.line = line;
        }
        Ok(self.is_ahead)
    }

    /// Reads on to the next row, and whether there is one.
    fn advance(&mut self) -> Result<bool> {
        if std::mem::take(&mut self.is_ahead) {
            return Ok(true);
        }
        let last = self.line;
        while self.read_line()? {
            if !self.buffer.trim_ascii().is_empty() {
                return Ok(true);
            }
        }
        // Messages name the last line that said something.
        self.line = last;
        Ok(false)
    }

    /// The row in the buffer.
    fn row(&self) -> Row<'_> {
        let text = std::str::from_utf8(&self.buffer).unwrap_or_default();
        Row { line: self.line, text }
    }

    /// Fills the buffer with the next line, without its comment; false at the end of the text.
    fn read_line(&mut self) -> Result<bool> {
        self.buffer.clear();
        let io = |source| Error::Io { path: self.place.into(), source };
        let read = (&mut self.source).take(LONGEST_LINE).read_until(b'\n', &mut self.buffer).map_err(io)?;
        self.line += usize::from(read > 0);
        if self.line == 1 && self.buffer.starts_with(b"\xef\xbb\xbf") {
            self.buffer.drain(..3);
        }
        if read as u64 == LONGEST_LINE {
            let what = format!("a line of more than {LONGEST_LINE} bytes");
            return Err(error_at(self.place, self.line, what, "check that the file is text, and break its lines"));
        }
        // Comments may be in any encoding.
        if let Some(end) = self.buffer.iter().position(|&byte| byte == b'#') {
            self.buffer.truncate(end);
        }
        let Err(error) = std::str::from_utf8(&self.buffer) else { return Ok(read > 0) };
        let first = self.buffer.split(|&byte| is_space(byte)).find(|word| !word.is_empty());
        if !self.naming.iter().any(|name| first == Some(name.as_bytes())) {
            let what = format!("not a text in UTF-8 (byte {} of the line)", error.valid_up_to() + 1);
            return Err(error_at(self.place, self.line, what, "save the file as UTF-8 text; it seems to be binary"));
        }
        self.buffer = String::from_utf8_lossy(&self.buffer).into_owned().into_bytes();
        Ok(read > 0)
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
    pub(super) fn new(source: impl BufRead + 'a, place: &'a str) -> Self {
        Self::after(0, source, place)
    }

    /// The words of what follows so many lines of a text.
    pub(super) fn after(lines: usize, source: impl BufRead + 'a, place: &'a str) -> Self {
        Self { rows: Rows { line: lines, ..Rows::new(source, place) }, word: 0..0, is_ahead: false }
    }

    /// What messages call the text.
    pub(super) fn place(&self) -> &'a str {
        self.rows.place
    }

    /// The line of the word read last.
    pub(super) fn line(&self) -> usize {
        self.rows.line()
    }

    /// The next word; `None` at the end of the text.
    ///
    /// # Errors
    /// As of [`Rows::next`].
    pub(super) fn next(&mut self) -> Result<Option<Word<'_>>> {
        let there = self.advance()?;
        Ok(there.then(|| self.word()))
    }

    /// The word after the one read last, left to be read.
    ///
    /// # Errors
    /// As of [`Rows::next`].
    pub(super) fn peek(&mut self) -> Result<Option<Word<'_>>> {
        self.is_ahead = self.advance()?;
        Ok(self.is_ahead.then(|| self.word()))
    }

    /// The next word, which has to be there.
    ///
    /// # Errors
    ///
    /// [`Error::Parse`] with section and row where the text ends; as of [`Rows::next`].
    pub(super) fn expect(&mut self, at: At<'_>) -> Result<Word<'_>> {
        if self.advance()? {
            return Ok(self.word());
        }
        let help = format!("the file is cut off, or the count of {} is too large", at.section);
        Err(error_at(self.place(), self.line(), format!("the text ends in {at}"), help))
    }

    /// The next word as a finite number; errors as of [`Words::expect`] and [`number`].
    pub(super) fn number(&mut self, at: At<'_>) -> Result<f64> {
        let place = self.place();
        number(place, self.expect(at)?, at)
    }

    /// The next word as a whole number; errors as of [`Words::expect`] and [`whole`].
    pub(super) fn whole<T: std::str::FromStr>(&mut self, at: At<'_>) -> Result<T> {
        let place = self.place();
        whole(place, self.expect(at)?, at)
    }

    /// Reads on to the next word, and whether there is one.
    fn advance(&mut self) -> Result<bool> {
        if std::mem::take(&mut self.is_ahead) {
            return Ok(true);
        }
        loop {
            let rest = self.rows.buffer.get(self.word.end..).unwrap_or_default();
            if let Some(start) = rest.iter().position(|byte| !is_space(*byte)) {
                let length = rest[start..].iter().position(|&byte| is_space(byte)).unwrap_or(rest.len() - start);
                let start = self.word.end + start;
                self.word = start..start + length;
                return Ok(true);
            }
            self.word = 0..0;
            if !self.rows.advance()? {
                self.rows.buffer.clear();
                return Ok(false);
            }
        }
    }

    fn word(&self) -> Word<'_> {
        let text = std::str::from_utf8(&self.rows.buffer[self.word.clone()]).unwrap_or_default();
        Word { line: self.rows.line, text }
    }
}

/// White space of ASCII, with the vertical tab that C counts among it.
pub(super) fn is_space(byte: u8) -> bool {
    byte.is_ascii_whitespace() || byte == 0x0b
}

impl Largest {
    /// A reference, counted from 1, at a line or a byte.
    pub(super) fn note(&mut self, number: u64, position: u64) {
        if number > self.number {
            *self = Self { number, position };
        }
    }

    /// Whether all that was referred to exists; else the number, and where it stands.
    pub(super) fn beyond(&self, count: usize) -> Option<(u64, u64)> {
        (self.number > count as u64).then_some((self.number, self.position))
    }

    /// Whether all that a text refers to exists.
    ///
    /// # Errors
    ///
    /// [`Error::Parse`] at the line of the largest number.
    pub(super) fn check(&self, of: &str, count: usize, place: &str) -> Result<()> {
        let Some((number, line)) = self.beyond(count) else { return Ok(()) };
        let what = format!("{of} {number} does not exist: the file lists {count}");
        Err(error_at(place, line as usize, what, "check the number, and that the file is whole"))
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
        let mut words = Words::new("\u{feff}a b # c\n\n#\r\n  d\n\n#".as_bytes(), "f");
        for expected in [Some((1, "a")), Some((1, "b")), Some((4, "d")), None, None] {
            assert_eq!(words.peek().unwrap().map(|w| (w.line, w.text)), expected);
            assert_eq!(words.next().unwrap().map(|w| (w.line, w.text)), expected);
        }
        assert_eq!(words.line(), 4);
    }

    #[test]
    fn what_is_no_text_is_refused() {
        let message = |bytes: &[u8]| Rows::new(bytes, "f").has_next().unwrap_err().to_string();
        assert!(!Rows::new(b"# caf\xe9\n".as_slice(), "f").has_next().unwrap());
        assert_eq!(message(b"\n1 2\xff"), "f:2: not a text in UTF-8 (byte 4 of the line)");
        assert_eq!(message(&vec![b'1'; 1 << 25]), "f:1: a line of more than 16777216 bytes");
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
