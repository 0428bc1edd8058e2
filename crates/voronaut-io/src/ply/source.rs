//! The numbers of a `.ply` file's body, whichever way they are written.

use super::header::{Format, Header, Kind};
use crate::bytes::{Bytes, Order};
use crate::words::{At, Words, error_at};
use std::io::BufRead;
use voronaut::{Error, Result};

/// Numbers one after the other, and where they stand.
pub(super) struct Source<'a> {
    body: Body<'a>,
    /// In text, the lines of the head.
    lines_before: usize,
    element: String,
    row: u64,
    rows: u64,
}

enum Body<'a> {
    Text(Words<'a>),
    Binary(Bytes<'a>),
}

impl<'a> Source<'a> {
    /// The numbers behind the head.
    pub(super) fn new(header: &Header, source: impl BufRead + 'a, place: &'a str) -> Self {
        let body = match header.format {
            Format::Text => Body::Text(Words::after(header.lines, source, place)),
            Format::LittleEndian => Body::Binary(Bytes::new(source, header.bytes, Order::Little, place)),
            Format::BigEndian => Body::Binary(Bytes::new(source, header.bytes, Order::Big, place)),
        };
        Self { body, lines_before: header.lines, element: String::new(), row: 0, rows: 0 }
    }

    /// Says which row of which element comes next.
    pub(super) fn begin(&mut self, element: &str, row: u64, rows: u64) {
        if self.element != element {
            self.element = element.into();
        }
        (self.row, self.rows) = (row, rows);
    }

    /// The next number.
    ///
    /// # Errors
    /// [`Error::Parse`] where the file ends, or a text holds something else.
    pub(super) fn number(&mut self, kind: Kind) -> Result<f64> {
        let here = At { section: &self.element, row: self.row, rows: self.rows };
        match &mut self.body {
            Body::Text(words) => words.number(here),
            Body::Binary(bytes) => decode(bytes, kind, here),
        }
    }

    /// Passes over a number, whatever it is.
    ///
    /// # Errors
    /// [`Error::Parse`] where the file ends.
    pub(super) fn pass(&mut self, kind: Kind) -> Result<()> {
        let here = At { section: &self.element, row: self.row, rows: self.rows };
        match &mut self.body {
            Body::Text(words) => words.expect(here).map(drop),
            Body::Binary(bytes) => decode(bytes, kind, here).map(drop),
        }
    }

    /// Whether all was read.
    ///
    /// # Errors
    /// [`Error::Parse`] of what is left over.
    pub(super) fn finish(&mut self) -> Result<()> {
        let is_at_end = match &mut self.body {
            Body::Text(words) => words.next()?.is_none(),
            Body::Binary(bytes) => bytes.is_at_end()?,
        };
        if is_at_end {
            return Ok(());
        }
        let what = "the file goes on behind the elements it announces";
        Err(self.error_at(self.position(), what, "check the counts in its head"))
    }

    /// The line of the number read last, or the byte behind it.
    pub(super) fn position(&self) -> u64 {
        match &self.body {
            Body::Text(words) => words.line().max(self.lines_before) as u64,
            Body::Binary(bytes) => bytes.position(),
        }
    }

    /// An error at the number read last, with its element and row.
    pub(super) fn error(&self, what: &str, help: &str) -> Error {
        let what = format!("{what} ({})", At { section: &self.element, row: self.row, rows: self.rows });
        self.error_at(self.position(), what, help)
    }

    /// An error at a position that [`Source::position`] gave.
    pub(super) fn error_at(&self, position: u64, what: impl Into<String>, help: &str) -> Error {
        match &self.body {
            Body::Text(words) => error_at(words.place(), position as usize, what, help),
            Body::Binary(bytes) => bytes.error_at(position, what, help),
        }
    }
}

/// A number of as many bytes as its kind has.
fn decode(bytes: &mut Bytes<'_>, kind: Kind, at: At<'_>) -> Result<f64> {
    let big = bytes.order == Order::Big;
    let short = |found: [u8; 2]| if big { u16::from_be_bytes(found) } else { u16::from_le_bytes(found) };
    Ok(match kind {
        Kind::I8 => bytes.array::<1>(at)?[0].cast_signed().into(),
        Kind::U8 => bytes.array::<1>(at)?[0].into(),
        Kind::I16 => short(bytes.array(at)?).cast_signed().into(),
        Kind::U16 => short(bytes.array(at)?).into(),
        Kind::I32 => bytes.i32(at)?.into(),
        Kind::U32 => bytes.i32(at)?.cast_unsigned().into(),
        Kind::I64 => bytes.i64(at)? as f64,
        Kind::U64 => bytes.i64(at)?.cast_unsigned() as f64,
        // Whether what nobody needs is finite does not matter.
        Kind::F32 => f32::from_bits(bytes.i32(at)?.cast_unsigned()).into(),
        Kind::F64 => f64::from_bits(bytes.i64(at)?.cast_unsigned()),
    })
}
