//! The numbers of a `.ply` file's body, whichever way they are written.

use super::header::{Format, Header, Kind};
use crate::error::{Error, Result};
use crate::formats::words::{At, Words, error_at};

/// Numbers one after the other, and where they stand.
pub(super) struct Source<'a> {
    body: Body<'a>,
    place: &'a str,
    element: String,
    row: u64,
    rows: u64,
}

enum Body<'a> {
    Text(Words<'a>),
    Binary { bytes: &'a [u8], at: usize, big_endian: bool },
}

impl<'a> Source<'a> {
    /// The numbers behind the head.
    ///
    /// # Errors
    /// [`Error::Parse`] of a text that is none.
    pub(super) fn new(header: &Header, bytes: &'a [u8], place: &'a str) -> Result<Self> {
        let body = match header.format {
            Format::Text => {
                let text = std::str::from_utf8(bytes).map_err(|error| {
                    let what = format!("not a text in UTF-8 (byte {})", error.valid_up_to() + 1);
                    Error::parse(place, what, "check the line format: the file seems binary")
                })?;
                let mut words = Words::new(text, place);
                while words.peek().is_some_and(|word| word.line <= header.lines) {
                    words.next();
                }
                Body::Text(words)
            }
            format => Body::Binary { bytes, at: header.bytes, big_endian: format == Format::BigEndian },
        };
        Ok(Self { body, place, element: String::new(), row: 0, rows: 0 })
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
            Body::Binary { bytes, at, big_endian } => {
                let Some(found) = bytes.get(*at..*at + size(kind)) else {
                    let what = format!("the file ends in {here}");
                    let help = "the file is cut off, or its counts are too large";
                    return Err(Error::parse(format!("{}, byte {at}", self.place), what, help));
                };
                *at += found.len();
                Ok(decode(kind, found, *big_endian))
            }
        }
    }

    /// An error at the number read last.
    pub(super) fn error(&self, what: &str, help: &str) -> Error {
        let what = format!("{what} ({})", At { section: &self.element, row: self.row, rows: self.rows });
        match &self.body {
            Body::Text(words) => error_at(self.place, words.line(), what, help),
            Body::Binary { at, .. } => Error::parse(format!("{}, byte {at}", self.place), what, help),
        }
    }
}

fn size(kind: Kind) -> usize {
    match kind {
        Kind::I8 | Kind::U8 => 1,
        Kind::I16 | Kind::U16 => 2,
        Kind::I32 | Kind::U32 | Kind::F32 => 4,
        Kind::F64 => 8,
    }
}

/// A number from as many bytes as its kind has.
fn decode(kind: Kind, found: &[u8], big_endian: bool) -> f64 {
    let mut bits = 0_u64;
    for (i, &byte) in found.iter().enumerate() {
        let place = if big_endian { found.len() - 1 - i } else { i };
        bits |= u64::from(byte) << (8 * place);
    }
    match kind {
        Kind::I8 => f64::from((bits as u8).cast_signed()),
        Kind::U8 => f64::from(bits as u8),
        Kind::I16 => f64::from((bits as u16).cast_signed()),
        Kind::U16 => f64::from(bits as u16),
        Kind::I32 => f64::from((bits as u32).cast_signed()),
        Kind::U32 => f64::from(bits as u32),
        Kind::F32 => f64::from(f32::from_bits(bits as u32)),
        Kind::F64 => f64::from_bits(bits),
    }
}
