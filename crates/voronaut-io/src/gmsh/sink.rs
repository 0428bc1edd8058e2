//! Gmsh's files from lines of text and blocks of numbers, which are text or binary.

use crate::medit::Form;
use crate::words::Shortest;
use std::fmt::Arguments;
use std::io::{self, Write};

/// A file that is being written.
pub(super) struct Sink<'a> {
    out: &'a mut dyn Write,
    form: Form,
    is_first_in_row: bool,
}

impl<'a> Sink<'a> {
    /// Writes the head of a file.
    pub(super) fn new(version: &str, form: Form, out: &'a mut dyn Write) -> io::Result<Self> {
        let mut sink = Self { out, form, is_first_in_row: true };
        let is_binary = form == Form::Binary;
        sink.line(format_args!("$MeshFormat\n{version} {} 8", i32::from(is_binary)))?;
        if is_binary {
            sink.int(1)?;
        }
        sink.end_section("MeshFormat")?;
        Ok(sink)
    }

    /// A line of text.
    pub(super) fn line(&mut self, line: Arguments<'_>) -> io::Result<()> {
        writeln!(self.out, "{line}")
    }

    /// Ends a section, in a new line.
    pub(super) fn end_section(&mut self, name: &str) -> io::Result<()> {
        if self.form == Form::Binary {
            self.out.write_all(b"\n")?;
        }
        self.end_row()?;
        writeln!(self.out, "$End{name}")
    }

    /// A number of 32 bits.
    pub(super) fn int(&mut self, number: i32) -> io::Result<()> {
        match self.form {
            Form::Text => self.word(format_args!("{number}")),
            Form::Binary => self.out.write_all(&number.to_le_bytes()),
        }
    }

    /// A tag or a count as a number of 32 bits.
    ///
    /// # Errors
    /// Of numbers beyond that; of what `out` says.
    pub(super) fn narrow(&mut self, number: usize) -> io::Result<()> {
        let number = i32::try_from(number);
        self.int(number.map_err(|_| io::Error::other("more than 2^31 nodes or elements, for which Gmsh has no tags"))?)
    }

    /// A tag or a count, of 64 bits if it is binary.
    pub(super) fn size(&mut self, number: usize) -> io::Result<()> {
        match self.form {
            Form::Text => self.word(format_args!("{number}")),
            Form::Binary => self.out.write_all(&(number as u64).to_le_bytes()),
        }
    }

    /// A coordinate or a value.
    pub(super) fn number(&mut self, value: f64) -> io::Result<()> {
        match self.form {
            Form::Text => self.word(format_args!("{}", Shortest(value))),
            Form::Binary => self.out.write_all(&value.to_le_bytes()),
        }
    }

    /// Ends a row of a block, if something is in it.
    pub(super) fn end_row(&mut self) -> io::Result<()> {
        if std::mem::replace(&mut self.is_first_in_row, true) { Ok(()) } else { self.out.write_all(b"\n") }
    }

    fn word(&mut self, word: Arguments<'_>) -> io::Result<()> {
        if !std::mem::take(&mut self.is_first_in_row) {
            self.out.write_all(b" ")?;
        }
        self.out.write_fmt(word)
    }
}
