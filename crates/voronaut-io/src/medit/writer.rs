//! Medit's files from a sequence of sections: as text, and in libMeshb's binary form.

use super::sections::code_of;
use crate::codec::{Form, Sink};
use std::io::{self, Write};

/// A file that is being written.
pub(crate) struct Writer<'a> {
    /// Where the numbers of a section go.
    pub(crate) sink: Sink<'a>,
    /// Whether positions have 64 bits.
    is_wide: bool,
}

/// Binary files that may have more bytes get positions of 64 bits; half of what 32 bits could say.
const NARROW: u64 = 1 << 30;

impl<'a> Writer<'a> {
    /// Writes the head of a file, which will have `bytes` bytes if it is binary, at most.
    pub(crate) fn new(form: Form, dimension: u8, bytes: u64, out: &'a mut dyn Write) -> io::Result<Self> {
        let mut writer = Self { sink: Sink::new(form, out), is_wide: bytes > NARROW };
        if writer.sink.is_binary() {
            writer.sink.put_all([1, if writer.is_wide { 3 } else { 2 }]);
            writer.keyword("Dimension", 4);
            writer.sink.put(i32::from(dimension));
        } else {
            writer.sink.line(format_args!("MeshVersionFormatted 2\n\nDimension {dimension}"))?;
        }
        Ok(writer)
    }

    /// Begins a section of so many rows, of so many bytes each if it is binary, behind `head` numbers of 32 bits.
    pub(crate) fn section(&mut self, name: &str, rows: usize, bytes: usize, head: &[i32]) -> io::Result<()> {
        if self.sink.is_binary() {
            self.keyword(name, 4 + 4 * head.len() as u64 + rows as u64 * bytes as u64);
            let rows = i32::try_from(rows).map_err(|_| io::Error::other("more than 2^31 rows in a binary section"))?;
            self.sink.put(rows);
        } else {
            self.sink.line(format_args!("\n{name}\n{rows}"))?;
        }
        self.sink.row(head.iter().copied())
    }

    /// Ends the file.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        if !self.sink.is_binary() {
            return self.sink.line(format_args!("\nEnd"));
        }
        self.sink.put(code_of("End"));
        self.position(0);
        self.sink.end_row()
    }

    /// Begins a binary section with so many bytes behind its keyword and the position of the next.
    fn keyword(&mut self, name: &str, bytes: u64) {
        self.sink.put(code_of(name));
        self.position(self.sink.written() + if self.is_wide { 8 } else { 4 } + bytes);
    }

    fn position(&mut self, byte: u64) {
        if self.is_wide { self.sink.put(byte) } else { self.sink.put(byte as u32) }
    }
}
