//! Valid files, with notes on what their parts mean.

use crate::reading::Reader;
use std::ops::Range;

/// A valid file.
pub(crate) struct Sample {
    pub(crate) name: &'static str,
    pub(crate) reader: Reader,
    pub(crate) bytes: Vec<u8>,
    pub(crate) marks: Vec<Mark>,
    /// References from this number on, and below that, have nothing to refer to.
    pub(crate) references: Range<i64>,
    pub(crate) cuts: Cuts,
}

/// A number whose value matters.
pub(crate) struct Mark {
    pub(crate) place: Range<usize>,
    pub(crate) kind: Kind,
    pub(crate) number: Number,
}

/// What a number says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Count,
    Reference,
    Coordinate,
    Dimension,
    /// The byte where the next section begins.
    Position,
}

/// How a number is written.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Number {
    Text,
    U8(u8),
    I32(i32, bool),
    I64(i64, bool),
    F32(bool),
    F64(bool),
}

/// Where a file can be cut off so that this must be seen.
pub(crate) enum Cuts {
    /// Anywhere but where so many bytes are left: there the format lets a file end.
    Bytes(Vec<usize>),
    /// Where neither so many words are left, nor one more.
    Words(Vec<usize>),
}

impl Sample {
    /// A text whose numbers have their kind as a sign in front: `!` counts, `@` references, `~` coordinates, `^` dimensions. Where
    /// a `;` stands the format lets the file end; if there is none, it must be whole.
    pub(crate) fn text(name: &'static str, reader: Reader, references: Range<i64>, annotated: &str) -> Self {
        let (mut bytes, mut marks, mut ends) = (Vec::new(), Vec::new(), Vec::new());
        let mut rest = annotated;
        while let Some(c) = rest.chars().next() {
            rest = &rest[c.len_utf8()..];
            match "!@~^".find(c) {
                Some(i) => {
                    let end = rest.find(|c: char| !c.is_alphanumeric() && !"+-.".contains(c)).unwrap_or(rest.len());
                    let place = bytes.len()..bytes.len() + end;
                    let kind = [Kind::Count, Kind::Reference, Kind::Coordinate, Kind::Dimension][i];
                    marks.push(Mark { place, kind, number: Number::Text });
                }
                None if c == ';' => ends.push(bytes.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty()).count()),
                None => bytes.extend(c.to_string().bytes()),
            }
        }
        let cuts = if ends.is_empty() { Cuts::Bytes(ends) } else { Cuts::Words(ends) };
        Self { name, reader, bytes, marks, references, cuts }
    }

    /// A file of whose parts nothing is known, but that its first bytes must all be there.
    pub(crate) fn opaque(name: &'static str, reader: Reader, bytes: Vec<u8>, needed: usize) -> Self {
        let cuts = Cuts::Bytes((needed..=bytes.len()).collect());
        Self { name, reader, bytes, marks: Vec::new(), references: 0..0, cuts }
    }
}

/// A binary file in the making.
pub(crate) struct Binary {
    pub(crate) bytes: Vec<u8>,
    pub(crate) marks: Vec<Mark>,
    pub(crate) big: bool,
    ends: Vec<usize>,
}

impl Binary {
    pub(crate) fn new(big: bool) -> Self {
        Self { bytes: Vec::new(), marks: Vec::new(), big, ends: Vec::new() }
    }

    pub(crate) fn raw(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
    }

    pub(crate) fn byte(&mut self, value: u8, kind: Option<Kind>) {
        self.push(&[value], kind, Number::U8(value));
    }

    pub(crate) fn i32(&mut self, value: i32, kind: Option<Kind>) {
        self.push(&value.to_le_bytes(), kind, Number::I32(value, self.big));
    }

    pub(crate) fn i32s(&mut self, values: &[i32], kind: Option<Kind>) {
        for &value in values {
            self.i32(value, kind);
        }
    }

    pub(crate) fn i64(&mut self, value: i64, kind: Option<Kind>) {
        self.push(&value.to_le_bytes(), kind, Number::I64(value, self.big));
    }

    pub(crate) fn i64s(&mut self, values: &[i64], kind: Option<Kind>) {
        for &value in values {
            self.i64(value, kind);
        }
    }

    pub(crate) fn f32(&mut self, value: f32) {
        self.push(&value.to_le_bytes(), Some(Kind::Coordinate), Number::F32(self.big));
    }

    pub(crate) fn f32s(&mut self, values: &[f32]) {
        for &value in values {
            self.f32(value);
        }
    }

    pub(crate) fn f64(&mut self, value: f64) {
        self.push(&value.to_le_bytes(), Some(Kind::Coordinate), Number::F64(self.big));
    }

    pub(crate) fn f64s(&mut self, values: &[f64]) {
        for &value in values {
            self.f64(value);
        }
    }

    /// The line that ends a section, behind which the format lets the file end.
    pub(crate) fn end(&mut self, line: &str) {
        self.raw(format!("\n{line}\n").as_bytes());
        self.ends.extend([self.bytes.len() - 1, self.bytes.len()]);
    }

    /// The sample.
    pub(crate) fn finish(self, name: &'static str, reader: Reader, references: Range<i64>) -> Sample {
        Sample { name, reader, bytes: self.bytes, marks: self.marks, references, cuts: Cuts::Bytes(self.ends) }
    }

    fn push(&mut self, little: &[u8], kind: Option<Kind>, number: Number) {
        let start = self.bytes.len();
        self.bytes.extend(in_order(little, self.big));
        let place = start..self.bytes.len();
        self.marks.extend(kind.map(|kind| Mark { place, kind, number }));
    }
}

/// Bytes, the least first, in the order of a file.
pub(crate) fn in_order(little: &[u8], big: bool) -> Vec<u8> {
    let mut bytes = little.to_vec();
    if big {
        bytes.reverse();
    }
    bytes
}
