//! Medit's files from a sequence of sections: as text, and in libMeshb's binary form.

use super::keywords::code_of;
use crate::words::Shortest;
use std::io::{self, Write};
use std::path::Path;

/// How a file is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// `.mesh`, `.sol`.
    Text,
    /// `.meshb`, `.solb`: libMeshb's, version 2 (3 where a file may have more than 1 GB), little endian, doubles.
    Binary,
}

impl Form {
    /// That of a solution's file: binary if its name ends in `.solb`.
    pub(crate) fn of_solution(path: &Path) -> Self {
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("solb")) {
            Form::Binary
        } else {
            Form::Text
        }
    }

    /// How the name of a solution's file ends.
    pub fn solution_ending(self) -> &'static str {
        if self == Form::Binary { "solb" } else { "sol" }
    }
}

/// A file that is being written.
pub(crate) struct Sink<'a> {
    out: &'a mut dyn Write,
    form: Form,
    /// Bytes so far, and those of the version's positions.
    written: u64,
    wide: bool,
    is_first_in_row: bool,
}

/// Binary files that may have more bytes get positions of 64 bits; half of what 32 bits could say.
const NARROW: u64 = 1 << 30;

impl<'a> Sink<'a> {
    /// Writes the head of a file, which will have `bytes` bytes if it is binary, at most.
    pub(crate) fn new(form: Form, dimension: u8, bytes: u64, out: &'a mut dyn Write) -> io::Result<Self> {
        let wide = bytes > NARROW;
        let mut sink = Self { out, form, written: 0, wide, is_first_in_row: true };
        match form {
            Form::Text => write!(sink.out, "MeshVersionFormatted 2\n\nDimension {dimension}\n")?,
            Form::Binary => {
                sink.bytes(1_i32.to_le_bytes())?;
                sink.bytes(if wide { 3_i32 } else { 2 }.to_le_bytes())?;
                sink.keyword("Dimension", 4)?;
                sink.bytes(i32::from(dimension).to_le_bytes())?;
            }
        }
        Ok(sink)
    }

    /// Begins a section of so many rows, of so many bytes each if it is binary, behind `head` numbers of 32 bits.
    pub(crate) fn section(&mut self, name: &str, rows: usize, bytes: usize, head: &[i32]) -> io::Result<()> {
        match self.form {
            Form::Text => {
                write!(self.out, "\n{name}\n{rows}\n")?;
                for (i, number) in head.iter().enumerate() {
                    write!(self.out, "{}{number}", if i == 0 { "" } else { " " })?;
                }
                if head.is_empty() { Ok(()) } else { self.out.write_all(b"\n") }
            }
            Form::Binary => {
                self.keyword(name, 4 + 4 * head.len() as u64 + rows as u64 * bytes as u64)?;
                let rows =
                    i32::try_from(rows).map_err(|_| io::Error::other("more than 2^31 rows in a binary section"))?;
                self.bytes(rows.to_le_bytes())?;
                head.iter().try_for_each(|number| self.bytes(number.to_le_bytes()))
            }
        }
    }

    /// A coordinate or a value.
    pub(crate) fn number(&mut self, value: f64) -> io::Result<()> {
        match self.form {
            Form::Text => self.word(format_args!("{}", Shortest(value))),
            Form::Binary => self.bytes(value.to_le_bytes()),
        }
    }

    /// A vertex, an edge or a triangle, from 0.
    pub(crate) fn reference(&mut self, number: u32) -> io::Result<()> {
        match self.form {
            Form::Text => self.word(format_args!("{}", u64::from(number) + 1)),
            Form::Binary => self.bytes((number + 1).to_le_bytes()),
        }
    }

    /// A label.
    pub(crate) fn label(&mut self, label: i32) -> io::Result<()> {
        match self.form {
            Form::Text => self.word(format_args!("{label}")),
            Form::Binary => self.bytes(label.to_le_bytes()),
        }
    }

    /// Ends a row.
    pub(crate) fn end_row(&mut self) -> io::Result<()> {
        self.is_first_in_row = true;
        if self.form == Form::Text { self.out.write_all(b"\n") } else { Ok(()) }
    }

    /// Ends the file.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        match self.form {
            Form::Text => self.out.write_all(b"\nEnd\n"),
            Form::Binary => {
                self.bytes(code_of("End").to_le_bytes())?;
                if self.wide { self.bytes([0; 8]) } else { self.bytes([0; 4]) }
            }
        }
    }

    fn word(&mut self, word: std::fmt::Arguments<'_>) -> io::Result<()> {
        if !std::mem::take(&mut self.is_first_in_row) {
            self.out.write_all(b" ")?;
        }
        self.out.write_fmt(word)
    }

    /// Begins a binary section with so many bytes behind its keyword and the position of the next.
    fn keyword(&mut self, name: &str, bytes: u64) -> io::Result<()> {
        self.bytes(code_of(name).to_le_bytes())?;
        let next = self.written + bytes;
        if self.wide { self.bytes((next + 8).to_le_bytes()) } else { self.bytes(((next + 4) as u32).to_le_bytes()) }
    }

    fn bytes<const N: usize>(&mut self, bytes: [u8; N]) -> io::Result<()> {
        self.written += N as u64;
        self.out.write_all(&bytes)
    }
}
