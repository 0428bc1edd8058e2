//! What files are read by: rows, words or bytes, one after the other.

use super::kinds::{Kind, Order};
use super::places::{At, Place, Text};
use super::several;
use std::io::{self, BufRead, ErrorKind, Read};
use std::ops::Range;
use std::str::FromStr;
use voronaut::{Error, Result};

/// A file, as far as it is read. It is text until [`Source::be_binary`] is called, and lines can be read of it after that, too: some
/// formats have both. Only a line and a buffer of it are in memory.
pub(crate) struct Source<'a> {
    from: Counted<Box<dyn BufRead + 'a>>,
    file: &'a str,
    /// Which byte of a number comes first, if numbers are binary.
    order: Option<Order>,
    /// Whether lines are taken as they are: without comments, and in any encoding.
    is_verbatim: bool,
    /// What begins a comment.
    comment: u8,
    /// First words of rows that may be in any encoding.
    naming: &'static [&'static str],
    /// The line that was read last, counted from 1.
    line: usize,
    /// That line, without its comment.
    row: Vec<u8>,
    /// Where in the row the word is that was read last.
    word: Range<usize>,
}

/// Longer lines are refused: a binary file may have no line at all.
const LONGEST_LINE: u64 = 1 << 24;

impl<'a> Source<'a> {
    /// A text that messages call `file`. Comments (from `#` to the end of the line), blank lines and a byte order mark are no part of it.
    pub(crate) fn new(from: impl BufRead + 'a, file: &'a str) -> Self {
        let (from, row) = (Counted::new(Box::new(from) as Box<dyn BufRead>), Vec::new());
        Self { from, file, order: None, is_verbatim: false, comment: b'#', naming: &[], line: 0, row, word: 0..0 }
    }

    /// As [`Source::new`]; rows that begin with one of these words may be in any encoding, and characters that are not UTF-8 are
    /// replaced there.
    pub(crate) fn with_names(from: impl BufRead + 'a, file: &'a str, naming: &'static [&'static str]) -> Self {
        Self { naming, ..Self::new(from, file) }
    }

    /// As [`Source::new`], but that comments begin with another character.
    pub(crate) fn with_comments(from: impl BufRead + 'a, file: &'a str, comment: u8) -> Self {
        Self { comment, ..Self::new(from, file) }
    }

    /// As [`Source::new`]; lines are taken as they are, in any encoding, and `#` begins no comment.
    pub(crate) fn verbatim(from: impl BufRead + 'a, file: &'a str) -> Self {
        Self { is_verbatim: true, ..Self::new(from, file) }
    }

    /// From here on lines have comments.
    pub(crate) fn skip_comments(&mut self) {
        self.is_verbatim = false;
    }

    /// From here on numbers are binary, and messages name bytes.
    pub(crate) fn be_binary(&mut self, order: Order) {
        self.order = Some(order);
    }

    pub(crate) fn is_binary(&self) -> bool {
        self.order.is_some()
    }

    /// What messages call the file.
    pub(crate) fn file(&self) -> &'a str {
        self.file
    }

    /// How many bytes were read.
    pub(crate) fn position(&self) -> u64 {
        self.from.position
    }

    /// What was read last: its line, or of a binary file the byte behind it.
    pub(crate) fn place(&self) -> Place<'a> {
        if self.is_binary() { self.place_of(self.position()) } else { Place::line(self.file, self.line.max(1)) }
    }

    /// A byte of the file.
    pub(crate) fn place_of(&self, byte: u64) -> Place<'a> {
        Place::byte(self.file, byte)
    }

    /// An [`Error::Parse`] at what was read last.
    pub(crate) fn error(&self, what: impl Into<String>, help: impl Into<String>) -> Error {
        self.place().error(what, help)
    }

    /// The bytes that come next, as many as are in the buffer, left to be read; empty at the end of the file.
    ///
    /// # Errors
    /// [`Error::Io`] of a file that cannot be read.
    pub(crate) fn ahead(&mut self) -> Result<&[u8]> {
        self.from.fill_buf().map_err(|source| Error::io(self.file, source))
    }

    /// Whether nothing follows but blanks and comments, or in a binary file nothing at all. What follows in a text is read.
    ///
    /// # Errors
    /// As of [`Source::next_row`].
    pub(crate) fn is_at_end(&mut self) -> Result<bool> {
        if self.is_binary() { Ok(self.ahead()?.is_empty()) } else { Ok(!self.advance()?) }
    }

    /// Refuses what stands behind all that the file announces.
    ///
    /// # Errors
    /// [`Error::Parse`] where anything does; as of [`Source::is_at_end`].
    pub(crate) fn demand_end(&mut self, what: &str, help: &str) -> Result<()> {
        if self.is_at_end()? { Ok(()) } else { Err(self.error(what, help)) }
    }

    /// Reads on to the end of a line, or so many bytes, whatever they are; false where nothing follows.
    ///
    /// # Errors
    /// [`Error::Io`] of a file that cannot be read.
    pub(crate) fn read_line(&mut self, most: u64) -> Result<bool> {
        self.row.clear();
        self.word = 0..0;
        let found = (&mut self.from).take(most).read_until(b'\n', &mut self.row);
        let found = found.map_err(|source| Error::io(self.file, source))?;
        self.line += usize::from(self.row.ends_with(b"\n"));
        Ok(found > 0)
    }

    /// The bytes of the line that was read last.
    pub(crate) fn line(&self) -> &[u8] {
        &self.row
    }

    /// The next row; `None` at the end of the text.
    ///
    /// # Errors
    /// [`Error::Io`] of a text that cannot be read; [`Error::Parse`] of a line that is too long, or not UTF-8.
    pub(crate) fn next_row(&mut self) -> Result<Option<Text<'_>>> {
        Ok(if self.next_line()? { Some(self.whole_row()) } else { None })
    }

    /// The next row, which has to be there.
    ///
    /// # Errors
    /// [`Error::Parse`] with section and row where the text ends; as of [`Source::next_row`].
    pub(crate) fn row(&mut self, at: At<'_>) -> Result<Text<'_>> {
        if self.next_line()? { Ok(self.whole_row()) } else { Err(self.cut_off(at)) }
    }

    /// The next word, whatever the line it stands on; `None` at the end of the text.
    ///
    /// # Errors
    /// As of [`Source::next_row`].
    pub(crate) fn next_word(&mut self) -> Result<Option<Text<'_>>> {
        Ok(if self.advance()? { Some(self.text(self.word.clone())) } else { None })
    }

    /// The next word, which has to be there.
    ///
    /// # Errors
    /// As of [`Source::row`].
    pub(crate) fn word(&mut self, at: At<'_>) -> Result<Text<'_>> {
        if self.advance()? { Ok(self.text(self.word.clone())) } else { Err(self.cut_off(at)) }
    }

    /// Leaves the word that was read last to be read again.
    pub(crate) fn unread(&mut self) {
        self.word.end = self.word.start;
    }

    /// What is left of the line, without white space around it, or the next line that is not blank.
    ///
    /// # Errors
    /// As of [`Source::row`].
    pub(crate) fn rest_of_row(&mut self, at: At<'_>) -> Result<String> {
        self.word(at)?;
        let rest = String::from_utf8_lossy(&self.row[self.word.start..]).trim().to_owned();
        self.skip_row();
        Ok(rest)
    }

    /// Passes over what is left of the line.
    pub(crate) fn skip_row(&mut self) {
        self.word = self.row.len()..self.row.len();
    }

    /// A whole number of type `T`, in binary files of some kind.
    ///
    /// # Errors
    /// [`Error::Parse`] with its place where the file ends, or of what is no such number.
    pub(crate) fn whole<T: TryFrom<i64> + FromStr>(&mut self, kind: Kind, at: At<'_>) -> Result<T> {
        let Some(order) = self.order else { return self.word(at)?.whole(at) };
        let found = kind.whole(self.bits(order, kind, at)?);
        T::try_from(found).map_err(|_| {
            let help = format!("check this row, and the count of {}", at.section);
            self.error(format!("'{found}' is out of range ({at})"), help)
        })
    }

    /// A finite number, in binary files of some kind.
    ///
    /// # Errors
    /// As of [`Source::whole`]; of what is not finite.
    pub(crate) fn number(&mut self, kind: Kind, at: At<'_>) -> Result<f64> {
        let value = self.any_number(kind, at)?;
        if value.is_finite() {
            return Ok(value);
        }
        let place = self.place_of(self.position() - kind.size() as u64);
        let what = format!("{value} is not a finite number ({at})");
        Err(place.error(what, "correct the number, and check that the file is whole"))
    }

    /// As [`Source::number`], but in binary files it may be not finite.
    ///
    /// # Errors
    /// As of [`Source::whole`].
    pub(crate) fn any_number(&mut self, kind: Kind, at: At<'_>) -> Result<f64> {
        let Some(order) = self.order else { return self.word(at)?.number(at) };
        Ok(kind.real(self.bits(order, kind, at)?))
    }

    /// So many finite numbers of a kind.
    ///
    /// # Errors
    /// As of [`Source::number`].
    pub(crate) fn numbers<const N: usize>(&mut self, kind: Kind, at: At<'_>) -> Result<[f64; N]> {
        several(|| self.number(kind, at))
    }

    /// Passes over so many numbers of a kind, whatever they are.
    ///
    /// # Errors
    /// [`Error::Parse`] where the file ends.
    pub(crate) fn skip(&mut self, count: u64, kind: Kind, at: At<'_>) -> Result<()> {
        (0..count).try_for_each(|_| match self.order {
            Some(order) => self.bits(order, kind, at).map(drop),
            None => self.word(at).map(drop),
        })
    }

    /// Passes over so many bytes.
    ///
    /// # Errors
    /// As of [`Source::skip`].
    pub(crate) fn skip_bytes(&mut self, count: u64, at: At<'_>) -> Result<()> {
        let found = io::copy(&mut (&mut self.from).take(count), &mut io::sink());
        let found = found.map_err(|source| Error::io(self.file, source))?;
        if found < count { Err(self.cut_off(at)) } else { Ok(()) }
    }

    fn bits(&mut self, order: Order, kind: Kind, at: At<'_>) -> Result<u64> {
        let mut found = [0; 8];
        let bytes = &mut found[..kind.size()];
        match self.from.read_exact(bytes) {
            Ok(()) => Ok(order.bits(bytes)),
            Err(source) if source.kind() == ErrorKind::UnexpectedEof => Err(self.cut_off(at)),
            Err(source) => Err(Error::io(self.file, source)),
        }
    }

    /// Reads on to the next word, and whether there is one.
    fn advance(&mut self) -> Result<bool> {
        loop {
            let rest = &self.row[self.word.end..];
            if let Some(start) = rest.iter().position(|&byte| !is_space(byte)) {
                let length = rest[start..].iter().position(|&byte| is_space(byte)).unwrap_or(rest.len() - start);
                let start = self.word.end + start;
                self.word = start..start + length;
                return Ok(true);
            }
            if !self.next_line()? {
                return Ok(false);
            }
        }
    }

    /// Reads on to the next line that says something, and whether there is one.
    fn next_line(&mut self) -> Result<bool> {
        let last = self.line;
        while self.read_line(LONGEST_LINE)? {
            // The last line may lack its end.
            self.line += usize::from(!self.row.ends_with(b"\n"));
            if self.row.len() as u64 == LONGEST_LINE {
                let what = format!("a line of more than {LONGEST_LINE} bytes");
                return Err(self.error(what, "check that the file is text, and break its lines"));
            }
            if self.line == 1 && self.row.starts_with(b"\xef\xbb\xbf") {
                self.row.drain(..3);
            }
            if !self.is_verbatim {
                self.drop_comment()?;
            }
            if !self.row.trim_ascii().is_empty() {
                return Ok(true);
            }
        }
        // Messages name the last line that said something.
        self.line = last;
        Ok(false)
    }

    /// Comments may be in any encoding, what is left of the line only if it begins with one of some words.
    fn drop_comment(&mut self) -> Result<()> {
        let end = self.row.iter().position(|&byte| byte == self.comment);
        self.row.truncate(end.unwrap_or(self.row.len()));
        let Err(error) = std::str::from_utf8(&self.row) else { return Ok(()) };
        let first = self.row.split(|&byte| is_space(byte)).find(|word| !word.is_empty());
        if self.naming.iter().any(|name| first == Some(name.as_bytes())) {
            self.row = String::from_utf8_lossy(&self.row).into_owned().into_bytes();
            return Ok(());
        }
        let what = format!("not a text in UTF-8 (byte {} of the line)", error.valid_up_to() + 1);
        Err(self.error(what, "save the file as UTF-8 text; it seems to be binary"))
    }

    /// The line that was read last, of which nothing is left then.
    fn whole_row(&mut self) -> Text<'_> {
        self.skip_row();
        self.text(0..self.row.len())
    }

    fn text(&self, part: Range<usize>) -> Text<'_> {
        Text { place: self.place(), text: std::str::from_utf8(&self.row[part]).unwrap_or("\u{fffd}") }
    }

    fn cut_off(&self, at: At<'_>) -> Error {
        let what = if self.is_binary() || self.is_verbatim { "file" } else { "text" };
        let help = format!("the file is cut off, or the count of {} is too large", at.section);
        self.error(format!("the {what} ends in {at}"), help)
    }
}

/// What is read of, and how many bytes were.
pub(crate) struct Counted<R> {
    from: R,
    position: u64,
}

impl<R> Counted<R> {
    pub(crate) fn new(from: R) -> Self {
        Self { from, position: 0 }
    }

    pub(crate) fn position(&self) -> u64 {
        self.position
    }
}

impl<R: Read> Read for Counted<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let count = self.from.read(out)?;
        self.position += count as u64;
        Ok(count)
    }

    /// Where not all is there, nothing counts as read.
    fn read_exact(&mut self, out: &mut [u8]) -> io::Result<()> {
        self.from.read_exact(out)?;
        self.position += out.len() as u64;
        Ok(())
    }
}

impl<R: BufRead> BufRead for Counted<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.from.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.position += count as u64;
        self.from.consume(count);
    }
}

/// White space of ASCII, with the vertical tab that C counts among it.
fn is_space(byte: u8) -> bool {
    byte.is_ascii_whitespace() || byte == 0x0b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_know_their_lines() {
        let mut words = Source::new("\u{feff}a b # c\n\n#\r\n  d\n\n#".as_bytes(), "f");
        let told = |word: Option<Text<'_>>| word.map(|word| format!("{} {}", word.place, word.text));
        for expected in [Some("f:1 a"), Some("f:1 b"), Some("f:4 d"), None, None] {
            assert_eq!(told(words.next_word().unwrap()).as_deref(), expected);
            words.unread();
            assert_eq!(told(words.next_word().unwrap()).as_deref(), expected);
        }
        assert_eq!(words.place().to_string(), "f:4");
    }

    #[test]
    fn what_is_no_text_is_refused() {
        let message = |bytes: &[u8]| Source::new(bytes, "f").next_row().map(|_| ()).unwrap_err().to_string();
        assert!(Source::new(b"# caf\xe9\n".as_slice(), "f").next_row().unwrap().is_none());
        assert_eq!(message(b"\n1 2\xff"), "f:2: not a text in UTF-8 (byte 4 of the line)");
        assert_eq!(message(&vec![b'1'; 1 << 25]), "f:1: a line of more than 16777216 bytes");
    }

    #[test]
    fn lines_as_they_are() {
        let mut source = Source::verbatim(b"a #b\n\xff\n\n \n12".as_slice(), "f");
        let at = At::head("a");
        assert_eq!(source.word(at).unwrap().text, "a");
        assert_eq!(source.rest_of_row(at).unwrap(), "#b");
        assert_eq!(source.word(at).unwrap().text, "\u{fffd}");
        assert_eq!(source.whole::<u8>(Kind::Signed(4), at).unwrap(), 12);
        assert_eq!(source.word(at).map(|_| ()).unwrap_err().to_string(), "f:5: the file ends in the head of a");
    }

    fn binary(file: &[u8], order: Order) -> Source<'_> {
        let mut source = Source::new(file, "a");
        source.be_binary(order);
        source
    }

    #[test]
    fn numbers_in_both_orders_and_where_they_end() {
        let at = At { section: "Vertices", row: 2, rows: 3 };
        for (order, file) in [
            (Order::Little, [1_i32.to_le_bytes().as_slice(), &(-2_i64).to_le_bytes(), &0.5_f64.to_le_bytes(), &[0; 2]]),
            (Order::Big, [1_i32.to_be_bytes().as_slice(), &(-2_i64).to_be_bytes(), &0.5_f64.to_be_bytes(), &[0; 2]]),
        ] {
            let file = file.concat();
            let mut bytes = binary(file.as_slice(), order);
            assert_eq!(bytes.whole::<i32>(Kind::Signed(4), at).unwrap(), 1);
            assert_eq!(bytes.whole::<i64>(Kind::Signed(8), at).unwrap(), -2);
            assert_eq!(bytes.number(Kind::Float(8), at).unwrap().to_bits(), 0.5_f64.to_bits());
            assert_eq!((bytes.position(), bytes.is_at_end().unwrap()), (20, false));
            let error = bytes.whole::<i32>(Kind::Signed(4), at).unwrap_err();
            assert_eq!(error.to_string(), "a, byte 20: the file ends in row 2 of 3 of Vertices");
            assert!(bytes.skip_bytes(u64::MAX, at).is_err());
        }
        let nan = f32::NAN.to_le_bytes();
        let mut bytes = binary(nan.as_slice(), Order::Little);
        let error = bytes.number(Kind::Float(4), at).unwrap_err();
        assert_eq!(error.to_string(), "a, byte 0: NaN is not a finite number (row 2 of 3 of Vertices)");
    }
}
