//! Text for the parser of XML: UTF-8 as it is, other bytes as characters of Latin-1.

use crate::codec::Counted;
use std::io::{self, BufRead, Read};

/// A file whose bytes that are no UTF-8 are taken for Latin-1: VTK writes the names of arrays as it got them, whatever their
/// encoding. Never reads further than it is asked to, for raw bytes may follow.
pub(super) struct Characters<R> {
    source: Counted<R>,
    /// So many bytes that come next are known to be ASCII: they are looked at once, however few are taken at a time.
    ascii: usize,
    /// The characters that are not ASCII and come next, in UTF-8.
    ahead: Vec<u8>,
    /// How many bytes of `ahead` were taken.
    taken: usize,
}

impl<R: BufRead> Characters<R> {
    pub(super) fn new(source: R) -> Self {
        Self { source: Counted::new(source), ascii: 0, ahead: Vec::new(), taken: 0 }
    }

    /// How many bytes of the file were read.
    pub(super) fn position(&self) -> u64 {
        self.source.position()
    }

    /// The file behind what was read.
    pub(super) fn source(&mut self) -> &mut Counted<R> {
        &mut self.source
    }

    fn next_byte(&mut self) -> io::Result<Option<u8>> {
        Ok(self.source.fill_buf()?.first().copied())
    }

    fn take_byte(&mut self, byte: u8, into: &mut Vec<u8>) {
        self.source.consume(1);
        into.push(byte);
    }

    /// Takes one character of UTF-8, or else what could not become one.
    fn look_ahead(&mut self, lead: u8) -> io::Result<()> {
        const LONGEST: usize = 4;
        let mut found = Vec::with_capacity(LONGEST);
        self.take_byte(lead, &mut found);
        while found.len() < LONGEST && std::str::from_utf8(&found).is_err() {
            match self.next_byte()? {
                Some(byte @ 0x80..0xc0) => self.take_byte(byte, &mut found),
                _ => break,
            }
        }
        if std::str::from_utf8(&found).is_err() {
            found = found.into_iter().map(char::from).collect::<String>().into_bytes();
        }
        (self.ahead, self.taken) = (found, 0);
        Ok(())
    }
}

impl<R: BufRead> BufRead for Characters<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.taken < self.ahead.len() {
            return Ok(&self.ahead[self.taken..]);
        }
        if self.ascii == 0 {
            let found = self.source.fill_buf()?;
            self.ascii = found.iter().position(|byte| !byte.is_ascii()).unwrap_or(found.len());
            if let Some(&lead @ 0x80..) = found.first() {
                self.look_ahead(lead)?;
                return Ok(&self.ahead);
            }
        }
        Ok(&self.source.fill_buf()?[..self.ascii])
    }

    fn consume(&mut self, count: usize) {
        if self.taken < self.ahead.len() {
            self.taken += count;
        } else {
            self.source.consume(count);
            self.ascii -= count;
        }
    }
}

impl<R: BufRead> Read for Characters<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(out)?;
        self.consume(count);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::BufReader;

    #[test]
    fn utf_8_stays_and_latin_1_is_translated_whatever_the_buffer() {
        for (bytes, text) in [
            ("a\u{e9}\u{20ac}\u{1f600}b".as_bytes(), "a\u{e9}\u{20ac}\u{1f600}b"),
            (b"gr\xfc\xdfe \xe9", "gr\u{fc}\u{df}e \u{e9}"),
            (b"\xff\xff\x80x", "\u{ff}\u{ff}\u{80}x"),
            (b"", ""),
        ] {
            for capacity in 1..6 {
                let mut characters = Characters::new(BufReader::with_capacity(capacity, bytes));
                let mut found = String::new();
                characters.read_to_string(&mut found).unwrap();
                assert_eq!((found.as_str(), characters.position()), (text, bytes.len() as u64));
            }
        }
    }
}
