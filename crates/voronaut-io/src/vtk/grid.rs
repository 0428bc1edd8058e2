//! The pieces of a file, and the arrays of each as numbers.

use super::stored::{Layout, Stored};
use crate::codec::{Kind, Order, Place, shortened};
use std::io::{self, ErrorKind};
use std::str::FromStr;
use voronaut::{Error, Result};

/// What tags are called that hold the arrays of a piece.
pub(super) const SECTIONS: [&str; 8] =
    ["PointData", "CellData", "Points", "Cells", "Verts", "Lines", "Polys", "Strips"];

/// Sections of cells, in the order that their data have. `Cells` are those of an unstructured grid, the others of polygons.
pub(super) const CELLS: [&str; 5] = ["Cells", "Verts", "Lines", "Polys", "Strips"];

/// A file, its arrays not yet looked at.
pub(super) struct Grid<'a> {
    /// What messages call it.
    pub(super) file: &'a str,
    pub(super) layout: Layout,
    pub(super) pieces: Vec<Piece<'a>>,
}

/// A part of the mesh: points, cells, and their arrays.
pub(super) struct Piece<'a> {
    pub(super) points: u64,
    /// As [`CELLS`] has them.
    pub(super) cells: [u64; 5],
    /// In the order of their tags.
    pub(super) arrays: Vec<Array<'a>>,
    /// Where its tag is.
    pub(super) byte: u64,
}

impl<'a> Piece<'a> {
    /// How many entries the arrays of a section have; vertices of cells are as many or more.
    pub(super) fn count(&self, section: &str) -> u64 {
        match section {
            "PointData" | "Points" => self.points,
            "CellData" => self.cells.iter().sum(),
            cells => CELLS.iter().zip(self.cells).find(|(known, _)| **known == cells).map_or(0, |(_, count)| count),
        }
    }

    /// Takes an array out.
    pub(super) fn take(&mut self, section: &str, name: Option<&str>) -> Option<Array<'a>> {
        let is_it = |array: &Array<'_>| array.section == section && name.is_none_or(|name| array.name == name);
        self.arrays.iter().position(is_it).map(|i| self.arrays.remove(i))
    }
}

/// An array of a file, its numbers not yet looked at.
pub(super) struct Array<'a> {
    /// What messages call the file.
    pub(super) file: &'a str,
    /// Of the bytes of a number.
    pub(super) order: Order,
    /// One of [`SECTIONS`].
    pub(super) section: &'static str,
    pub(super) name: String,
    pub(super) kind: Kind,
    /// Numbers per entry; `None` where the file does not say.
    pub(super) components: Option<u64>,
    /// Where its text or its bytes begin, or its tag where they are not known.
    pub(super) byte: u64,
    pub(super) stored: Stored,
}

/// What to do about arrays that are too long or too short.
const HELP: &str = "check the counts of the piece and of the array, and that the file is whole";

impl Array<'_> {
    /// So many numbers of any type. The array is empty then.
    ///
    /// # Errors
    /// [`Error::Parse`] where there are more or fewer, and of what is no number.
    pub(super) fn take_reals(&mut self, count: u64) -> Result<Vec<f64>> {
        self.take_numbers(count, "a number", Kind::real)
    }

    /// So many whole numbers; those beyond the range of i64 come out as its largest.
    ///
    /// # Errors
    /// As of [`Array::take_reals`]; [`Error::Parse`] of an array of another type.
    pub(super) fn take_wholes(&mut self, count: u64) -> Result<Vec<i64>> {
        if !self.kind.is_whole() {
            return Err(self.error("holds floating point numbers", "write whole numbers, such as Int64"));
        }
        self.take_numbers(count, "a whole number", Kind::whole)
    }

    /// An [`Error::Parse`] at the beginning of the array: `what` follows its name.
    pub(super) fn error(&self, what: &str, help: &str) -> Error {
        self.error_at(self.byte, what, help)
    }

    /// Why the bytes of the array could not be read.
    pub(super) fn misread(&self, error: &io::Error) -> Error {
        match error.kind() {
            ErrorKind::UnexpectedEof => {
                self.error("ends before all is there that its sizes announce", "the file is cut off or damaged")
            }
            ErrorKind::InvalidData => self.error(&format!("holds {error}"), "the file is damaged"),
            kind => Error::io(self.file, io::Error::new(kind, error.to_string())),
        }
    }

    fn error_at(&self, byte: u64, what: &str, help: &str) -> Error {
        Place::byte(self.file, byte).error(format!("array '{}' {what}", shortened(&self.name)), help)
    }

    fn take_numbers<T: FromStr>(&mut self, count: u64, what: &str, of: impl Fn(Kind, u64) -> T) -> Result<Vec<T>> {
        let (kind, order) = (self.kind, self.order);
        let stored = std::mem::replace(&mut self.stored, Stored::Plain(Vec::new()));
        if let Stored::Text(text) = &stored {
            return self.parse(text, count, what);
        }
        let bytes = stored.bytes(count.saturating_mul(kind.size() as u64)).map_err(|what| self.error(&what, HELP))?;
        Ok(bytes.chunks_exact(kind.size()).map(|number| of(kind, order.bits(number))).collect())
    }

    fn parse<T: FromStr>(&self, text: &str, count: u64, what: &str) -> Result<Vec<T>> {
        let mut numbers = Vec::new();
        for word in text.split_ascii_whitespace() {
            if numbers.len() as u64 == count {
                return Err(self.error(&format!("holds more than {count} numbers"), HELP));
            }
            let entry = numbers.len() + 1;
            numbers.push(word.parse().map_err(|_| {
                let byte = self.byte + (word.as_ptr().addr() - text.as_ptr().addr()) as u64;
                let what = format!("holds '{}', which is not {what} (number {entry} of {count})", shortened(word));
                self.error_at(byte, &what, "correct it, or check the type of the array")
            })?);
        }
        if (numbers.len() as u64) < count {
            let what = format!("holds {} numbers, where {count} are needed", numbers.len());
            return Err(self.error(&what, HELP));
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(kind: Kind, order: Order, stored: Stored) -> Array<'static> {
        Array { file: "f", order, section: "Points", name: "a".into(), kind, components: None, byte: 5, stored }
    }

    #[test]
    fn all_types_in_both_orders() {
        for (kind, little, value) in [
            (Kind::Signed(1), (-2_i8).to_le_bytes().to_vec(), -2),
            (Kind::Unsigned(1), vec![200], 200),
            (Kind::Signed(2), (-300_i16).to_le_bytes().to_vec(), -300),
            (Kind::Unsigned(2), 60_000_u16.to_le_bytes().to_vec(), 60_000),
            (Kind::Signed(4), (-70_000_i32).to_le_bytes().to_vec(), -70_000),
            (Kind::Unsigned(4), u32::MAX.to_le_bytes().to_vec(), u32::MAX.into()),
            (Kind::Signed(8), (-(1_i64 << 40)).to_le_bytes().to_vec(), -(1 << 40)),
            (Kind::Unsigned(8), (1_u64 << 40).to_le_bytes().to_vec(), 1 << 40),
            (Kind::Float(4), 3_f32.to_le_bytes().to_vec(), 3),
            (Kind::Float(8), 3_f64.to_le_bytes().to_vec(), 3),
        ] {
            let big = little.iter().rev().copied().collect();
            for (order, bytes) in [(Order::Little, little), (Order::Big, big)] {
                let reals = array(kind, order, Stored::Plain(bytes.clone())).take_reals(1).unwrap();
                assert_eq!(reals[0].to_bits(), (value as f64).to_bits());
                let wholes = array(kind, order, Stored::Plain(bytes)).take_wholes(1);
                assert_eq!(wholes.ok(), kind.is_whole().then(|| vec![value]));
            }
        }
    }

    #[test]
    fn too_many_too_few_and_what_is_no_number() {
        let text = |text: &str| array(Kind::Signed(4), Order::Big, Stored::Text(text.into()));
        assert_eq!(text(" 1\n-2 ").take_wholes(2).unwrap(), [1, -2]);
        for (found, expected) in [
            (text("1 2 3").take_wholes(2), "f, byte 5: array 'a' holds more than 2 numbers"),
            (
                text("1").take_wholes(1 << 60),
                "f, byte 5: array 'a' holds 1 numbers, where 1152921504606846976 are needed",
            ),
            (
                text("1 2.5").take_wholes(2),
                "f, byte 7: array 'a' holds '2.5', which is not a whole number (number 2 of 2)",
            ),
            (
                array(Kind::Unsigned(2), Order::Big, Stored::Plain(vec![0; 3])).take_wholes(2),
                "f, byte 5: array 'a' holds 3 bytes, where 4 are needed",
            ),
            (
                array(Kind::Float(4), Order::Big, Stored::Plain(vec![])).take_wholes(0),
                "f, byte 5: array 'a' holds floating point numbers",
            ),
        ] {
            let error = found.unwrap_err();
            assert_eq!(error.to_string(), expected);
            assert!(!error.help().is_empty());
        }
    }
}
