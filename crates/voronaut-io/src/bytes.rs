//! Numbers of binary formats, read in turn, with the bytes they stand at.

use super::words::At;
use std::io::{BufRead, ErrorKind, Read};
use voronaut::{Error, Result};

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// The least.
    Little,
    /// The greatest.
    Big,
}

/// A binary file, as far as it is read. Only a buffer of it is in memory.
pub(super) struct Bytes<'a> {
    source: Box<dyn BufRead + 'a>,
    place: &'a str,
    position: u64,
    /// Of all numbers from here on.
    pub(super) order: Order,
}

impl<'a> Bytes<'a> {
    /// What follows the first `position` bytes of a file that messages call `place`.
    pub(super) fn new(source: impl BufRead + 'a, position: u64, order: Order, place: &'a str) -> Self {
        Self { source: Box::new(source), place, position, order }
    }

    /// What messages call the file.
    pub(super) fn place(&self) -> &'a str {
        self.place
    }

    /// How many bytes were read.
    pub(super) fn position(&self) -> u64 {
        self.position
    }

    /// So many bytes.
    ///
    /// # Errors
    /// [`Error::Parse`] with the byte where the file ends; [`Error::Io`] of a file that cannot be read.
    pub(super) fn array<const N: usize>(&mut self, at: At<'_>) -> Result<[u8; N]> {
        let mut found = [0; N];
        match self.source.read_exact(&mut found) {
            Ok(()) => {
                self.position += N as u64;
                Ok(found)
            }
            Err(source) if source.kind() == ErrorKind::UnexpectedEof => Err(self.cut_off(at)),
            Err(source) => Err(self.io(source)),
        }
    }

    /// Passes over so many bytes; errors as of [`Bytes::array`].
    pub(super) fn skip(&mut self, count: u64, at: At<'_>) -> Result<()> {
        let found = std::io::copy(&mut (&mut self.source).take(count), &mut std::io::sink());
        let found = found.map_err(|source| self.io(source))?;
        self.position += found;
        if found < count { Err(self.cut_off(at)) } else { Ok(()) }
    }

    /// Appends what follows to `row`, up to the end of a line or so many bytes; false where nothing follows.
    ///
    /// # Errors
    /// [`Error::Io`] of a file that cannot be read.
    pub(super) fn line(&mut self, most: u64, row: &mut Vec<u8>) -> Result<bool> {
        let found = (&mut self.source).take(most).read_until(b'\n', row);
        let found = found.map_err(|source| self.io(source))?;
        self.position += found as u64;
        Ok(found > 0)
    }

    /// Whether nothing follows.
    ///
    /// # Errors
    /// [`Error::Io`] of a file that cannot be read.
    pub(super) fn is_at_end(&mut self) -> Result<bool> {
        match self.source.fill_buf() {
            Ok(rest) => Ok(rest.is_empty()),
            Err(source) => Err(self.io(source)),
        }
    }

    /// A whole number of 32 bits; errors as of [`Bytes::array`].
    pub(super) fn i32(&mut self, at: At<'_>) -> Result<i32> {
        let found = self.array(at)?;
        Ok(if self.order == Order::Big { i32::from_be_bytes(found) } else { i32::from_le_bytes(found) })
    }

    /// A whole number of 64 bits; errors as of [`Bytes::array`].
    pub(super) fn i64(&mut self, at: At<'_>) -> Result<i64> {
        let found = self.array(at)?;
        Ok(if self.order == Order::Big { i64::from_be_bytes(found) } else { i64::from_le_bytes(found) })
    }

    /// A finite number in single precision; errors as of [`Bytes::array`], and of what is not finite.
    pub(super) fn f32(&mut self, at: At<'_>) -> Result<f64> {
        let found = self.array(at)?;
        let value = if self.order == Order::Big { f32::from_be_bytes(found) } else { f32::from_le_bytes(found) };
        self.finite(value.into(), 4, at)
    }

    /// A finite number in double precision; errors as of [`Bytes::array`], and of what is not finite.
    pub(super) fn f64(&mut self, at: At<'_>) -> Result<f64> {
        let found = self.array(at)?;
        let value = if self.order == Order::Big { f64::from_be_bytes(found) } else { f64::from_le_bytes(found) };
        self.finite(value, 8, at)
    }

    /// A [`Error::Parse`] at a byte, counted from 0.
    pub(super) fn error_at(&self, byte: u64, what: impl Into<String>, help: impl Into<String>) -> Error {
        Error::parse(format!("{}, byte {byte}", self.place), what, help)
    }

    /// A [`Error::Parse`] at the byte that comes next.
    pub(super) fn error(&self, what: impl Into<String>, help: impl Into<String>) -> Error {
        self.error_at(self.position, what, help)
    }

    fn finite(&self, value: f64, size: u64, at: At<'_>) -> Result<f64> {
        if value.is_finite() {
            return Ok(value);
        }
        let what = format!("{value} is not a finite number ({at})");
        Err(self.error_at(self.position - size, what, "correct the number, and check that the file is whole"))
    }

    fn cut_off(&self, at: At<'_>) -> Error {
        let help = format!("the file is cut off, or the count of {} is too large", at.section);
        self.error(format!("the file ends in {at}"), help)
    }

    fn io(&self, source: std::io::Error) -> Error {
        Error::Io { path: self.place.into(), source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_both_orders_and_where_they_end() {
        let at = At { section: "Vertices", row: 2, rows: 3 };
        for (order, file) in [
            (Order::Little, [1_i32.to_le_bytes().as_slice(), &(-2_i64).to_le_bytes(), &0.5_f64.to_le_bytes(), &[0; 2]]),
            (Order::Big, [1_i32.to_be_bytes().as_slice(), &(-2_i64).to_be_bytes(), &0.5_f64.to_be_bytes(), &[0; 2]]),
        ] {
            let file = file.concat();
            let mut bytes = Bytes::new(file.as_slice(), 0, order, "a");
            assert_eq!((bytes.i32(at).unwrap(), bytes.i64(at).unwrap()), (1, -2));
            assert_eq!(bytes.f64(at).unwrap().to_bits(), 0.5_f64.to_bits());
            assert_eq!((bytes.position(), bytes.is_at_end().unwrap()), (20, false));
            let error = bytes.i32(at).unwrap_err();
            assert_eq!(error.to_string(), "a, byte 20: the file ends in row 2 of 3 of Vertices");
            assert!(bytes.skip(u64::MAX, at).is_err());
        }
        let nan = f32::NAN.to_le_bytes();
        let error = Bytes::new(nan.as_slice(), 8, Order::Little, "a").f32(at).unwrap_err();
        assert_eq!(error.to_string(), "a, byte 8: NaN is not a finite number (row 2 of 3 of Vertices)");
    }
}
