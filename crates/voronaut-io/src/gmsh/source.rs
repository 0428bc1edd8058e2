//! Gmsh's files as lines of text, with blocks of numbers between them that are text as well, or binary.

use crate::bytes::{Bytes, Order};
use crate::words::{self, At, LONGEST_LINE, Word, error_at, is_space, shortened};
use std::io::BufRead;
use std::ops::Range;
use voronaut::{Error, Result};

/// A file, as far as it is read. Only a line and a buffer of it are in memory.
pub(super) struct Source<'a> {
    bytes: Bytes<'a>,
    /// Whether numbers in blocks are binary.
    is_binary: bool,
    /// The line that was read last, counted from 1.
    line: usize,
    row: Vec<u8>,
    /// Where in the row the word is that was read last.
    word: Range<usize>,
}

impl<'a> Source<'a> {
    /// A file that is text until [`Source::read_one`] is called; messages call it `place`.
    pub(super) fn new(source: impl BufRead + 'a, place: &'a str) -> Self {
        let bytes = Bytes::new(source, 0, Order::Little, place);
        Self { bytes, is_binary: false, line: 0, row: Vec::new(), word: 0..0 }
    }

    /// Whether numbers in blocks are binary.
    pub(super) fn is_binary(&self) -> bool {
        self.is_binary
    }

    /// Reads the number 1 behind the head of a binary file, which tells the order of bytes of all others.
    ///
    /// # Errors
    /// [`Error::Parse`] where it is none in either order, or not there.
    pub(super) fn read_one(&mut self) -> Result<()> {
        self.is_binary = true;
        let one: [u8; 4] = self.bytes.array(At::head("MeshFormat"))?;
        self.bytes.order = match one {
            [1, 0, 0, 0] => Order::Little,
            [0, 0, 0, 1] => Order::Big,
            _ => {
                let what = format!("the four bytes {one:?} are not the number 1 in either order");
                return Err(self.bytes.error_at(
                    self.bytes.position() - 4,
                    what,
                    "the file is damaged: write it again",
                ));
            }
        };
        Ok(())
    }

    /// The name of the next section, without its `$`; `None` at the end of the file.
    ///
    /// # Errors
    /// [`Error::Parse`] of anything else that stands between sections.
    pub(super) fn next_section(&mut self) -> Result<Option<String>> {
        if !self.advance()? {
            return Ok(None);
        }
        let word = self.word();
        if let Some(name) = word.text.strip_prefix('$')
            && !name.starts_with("End")
        {
            return Ok(Some(name.to_owned()));
        }
        let what = format!("'{}' where a section such as $Nodes should begin", shortened(word.text));
        Err(self.error(what, "give a file that Gmsh wrote; remove what stands between its sections"))
    }

    /// Reads the line that ends a section.
    ///
    /// # Errors
    /// [`Error::Parse`] of anything else: the section is longer than announced.
    pub(super) fn end_section(&mut self, section: &str) -> Result<()> {
        if !self.advance()? {
            let what = format!("the file ends without $End{section}");
            return Err(self.error(what, "the file is cut off: write it again"));
        }
        let word = self.word();
        if word.text.strip_prefix("$End") == Some(section) {
            return Ok(());
        }
        let what =
            format!("'{}' where $End{section} should be: {section} is longer than announced", shortened(word.text));
        Err(self.error(what, format!("check the counts of {section}, and the version of the file")))
    }

    /// Passes over the rest of a section, whatever it holds.
    ///
    /// # Errors
    /// [`Error::Parse`] where the file ends before the section.
    pub(super) fn skip_section(&mut self, section: &str) -> Result<()> {
        /// Of lines, so that a binary block without ends of lines does not pile up in memory.
        const CHUNK: u64 = 1 << 16;
        let (start, end) = (self.position(), format!("$End{section}"));
        loop {
            self.row.clear();
            self.word = 0..0;
            if !self.bytes.line(CHUNK, &mut self.row)? {
                let what = format!("${section}, which begins here, has no {end}");
                return Err(self.error_at(start, what, "the file is cut off: write it again"));
            }
            self.line += usize::from(self.row.ends_with(b"\n"));
            if self.row.trim_ascii() == end.as_bytes() {
                self.row.clear();
                return Ok(());
            }
        }
    }

    /// What is left of the line, without white space around it, or the next line that is not blank.
    ///
    /// # Errors
    /// [`Error::Parse`] where the file ends.
    pub(super) fn rest_of_line(&mut self, at: At<'_>) -> Result<String> {
        self.expect(at)?;
        let rest = String::from_utf8_lossy(&self.row[self.word.start..]).trim().to_owned();
        self.word.end = self.row.len();
        Ok(rest)
    }

    /// The next word of text as a whole number.
    ///
    /// # Errors
    /// [`Error::Parse`] where the file ends, or the word is no such number.
    pub(super) fn text<T: std::str::FromStr>(&mut self, at: At<'_>) -> Result<T> {
        self.expect(at)?;
        words::whole(self.bytes.place(), self.word(), at).map_err(|error| self.moved(error))
    }

    /// The next word of text.
    ///
    /// # Errors
    /// [`Error::Parse`] where the file ends.
    pub(super) fn text_word(&mut self, at: At<'_>) -> Result<&str> {
        self.expect(at)?;
        Ok(self.word().text)
    }

    /// A whole number of a block, of 32 bits if it is binary.
    ///
    /// # Errors
    /// [`Error::Parse`] where the file ends, or of what is no number of type `T`.
    pub(super) fn int<T: TryFrom<i64> + std::str::FromStr>(&mut self, at: At<'_>) -> Result<T> {
        if !self.is_binary {
            return self.text(at);
        }
        let found = i64::from(self.bytes.i32(at)?);
        T::try_from(found).map_err(|_| self.out_of_range(found, at))
    }

    /// A count or a tag of version 4 in a block, of 64 bits if it is binary.
    ///
    /// # Errors
    /// As of [`Source::int`].
    pub(super) fn size(&mut self, at: At<'_>) -> Result<u64> {
        if !self.is_binary {
            return self.text(at);
        }
        let found = self.bytes.i64(at)?;
        u64::try_from(found).map_err(|_| self.out_of_range(found, at))
    }

    /// A finite number of a block.
    ///
    /// # Errors
    /// As of [`Source::int`]; of what is not finite.
    pub(super) fn number(&mut self, at: At<'_>) -> Result<f64> {
        if self.is_binary {
            return self.bytes.f64(at);
        }
        self.expect(at)?;
        words::number(self.bytes.place(), self.word(), at)
    }

    /// Passes over so many numbers of a block, finite or not.
    ///
    /// # Errors
    /// [`Error::Parse`] where the file ends.
    pub(super) fn skip_numbers(&mut self, count: u64, at: At<'_>) -> Result<()> {
        if self.is_binary {
            return self.bytes.skip(8 * count, at);
        }
        (0..count).try_for_each(|_| self.expect(at))
    }

    /// The line, or of a binary file the byte, that was reached.
    pub(super) fn position(&self) -> u64 {
        if self.is_binary { self.bytes.position() } else { self.line.max(1) as u64 }
    }

    /// An [`Error::Parse`] at a position that [`Source::position`] gave.
    pub(super) fn error_at(&self, at: u64, what: impl Into<String>, help: impl Into<String>) -> Error {
        if self.is_binary {
            return self.bytes.error_at(at, what, help);
        }
        error_at(self.bytes.place(), at as usize, what, help)
    }

    /// An [`Error::Parse`] at what was read last.
    pub(super) fn error(&self, what: impl Into<String>, help: impl Into<String>) -> Error {
        self.error_at(self.position(), what, help)
    }

    /// Where the reader is, for messages that are no [`Error::Parse`].
    pub(super) fn place(&self) -> String {
        let (place, at) = (self.bytes.place(), self.position());
        if self.is_binary { format!("{place}, byte {at}") } else { format!("{place}:{at}") }
    }

    fn out_of_range(&self, found: i64, at: At<'_>) -> Error {
        let what = format!("'{found}' is out of range ({at})");
        self.error(what, format!("check this row, and the counts of {}", at.section))
    }

    /// An error about a word of a binary file's text names the byte.
    fn moved(&self, error: Error) -> Error {
        match error {
            Error::Parse { what, help, .. } if self.is_binary => self.error(what, help),
            _ => error,
        }
    }

    fn expect(&mut self, at: At<'_>) -> Result<()> {
        if self.advance()? {
            return Ok(());
        }
        let help = format!("the file is cut off, or a count of {} is too large", at.section);
        Err(self.error(format!("the file ends in {at}"), help))
    }

    /// Reads on to the next word, and whether there is one.
    fn advance(&mut self) -> Result<bool> {
        loop {
            let rest = &self.row[self.word.end.min(self.row.len())..];
            if let Some(start) = rest.iter().position(|&byte| !is_space(byte)) {
                let length = rest[start..].iter().position(|&byte| is_space(byte)).unwrap_or(rest.len() - start);
                let start = self.word.end + start;
                self.word = start..start + length;
                return Ok(true);
            }
            self.row.clear();
            self.word = 0..0;
            if !self.bytes.line(LONGEST_LINE, &mut self.row)? {
                return Ok(false);
            }
            self.line += 1;
            if self.row.len() as u64 == LONGEST_LINE {
                let what = format!("a line of more than {LONGEST_LINE} bytes");
                return Err(self.error(what, "check that the file is one of Gmsh's"));
            }
            if self.line == 1 && self.row.starts_with(b"\xef\xbb\xbf") {
                self.row.drain(..3);
            }
        }
    }

    fn word(&self) -> Word<'_> {
        let text = std::str::from_utf8(&self.row[self.word.clone()]).unwrap_or("\u{fffd}");
        Word { line: self.line, text }
    }
}
