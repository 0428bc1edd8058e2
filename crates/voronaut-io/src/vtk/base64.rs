//! Base64 (RFC 4648, section 4) as VTK writes it: padding may be followed by more.

use std::io::{self, BufRead, ErrorKind, Read};

/// The bytes that a text in base64 stands for, to its end or to the next tag. White space is passed over. VTK encodes the sizes
/// of an array apart from its data, each with its own padding.
pub(super) struct Base64<R> {
    source: R,
    /// The bytes of the last four letters, and how many of them are left.
    ahead: [u8; 3],
    left: usize,
}

impl<R: BufRead> Base64<R> {
    pub(super) fn new(source: R) -> Self {
        Self { source, ahead: [0; 3], left: 0 }
    }

    /// The next letter or padding; `None` at the end.
    fn letter(&mut self) -> io::Result<Option<u8>> {
        loop {
            let Some(&byte) = self.source.fill_buf()?.first() else { return Ok(None) };
            if byte == b'<' {
                return Ok(None);
            }
            self.source.consume(1);
            if !byte.is_ascii_whitespace() {
                return Ok(Some(byte));
            }
        }
    }

    /// Decodes the next four letters; false at the end.
    fn decode(&mut self) -> io::Result<bool> {
        let (mut bits, mut padding) = (0_u32, 0);
        for i in 0..4 {
            let letter = match self.letter()? {
                Some(letter) => letter,
                None if i == 0 => return Ok(false),
                None => return Err(ErrorKind::UnexpectedEof.into()),
            };
            let value = value(letter).filter(|_| padding == 0);
            padding += usize::from(letter == b'=' && i > 1);
            if value.is_none() && padding == 0 || value.is_none() && letter != b'=' {
                let what =
                    format!("'{}' at a place where base64 does not have it", char::from(letter).escape_default());
                return Err(io::Error::new(ErrorKind::InvalidData, what));
            }
            bits = bits << 6 | value.unwrap_or(0);
        }
        let [_, bytes @ ..] = bits.to_be_bytes();
        self.left = 3 - padding;
        // The bytes that are left stand at the end.
        self.ahead = bytes;
        self.ahead.rotate_right(padding);
        Ok(true)
    }
}

impl<R: BufRead> Read for Base64<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let mut count = 0;
        while count < out.len() && (self.left > 0 || self.decode()?) {
            out[count] = self.ahead[3 - self.left];
            self.left -= 1;
            count += 1;
        }
        Ok(count)
    }
}

fn value(letter: u8) -> Option<u32> {
    let value = match letter {
        b'A'..=b'Z' => letter - b'A',
        b'a'..=b'z' => letter - b'a' + 26,
        b'0'..=b'9' => letter - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => return None,
    };
    Some(value.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(text: &str) -> io::Result<Vec<u8>> {
        let mut out = Vec::new();
        Base64::new(text.as_bytes()).read_to_end(&mut out).map(|_| out)
    }

    #[test]
    fn the_examples_of_the_standard_alone_and_joined() {
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            (" Zm9v\nYg = = ", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9vYmFy<", "foobar"),
            ("Zg==Zm8=Zm9v</DataArray>", "ffofoo"),
        ] {
            assert_eq!(decoded(text).unwrap(), bytes.as_bytes(), "{text}");
        }
        assert_eq!(decoded("+/+/").unwrap(), [0xfb, 0xff, 0xbf]);
    }

    #[test]
    fn what_is_no_base64_is_refused() {
        for (text, message) in [
            ("Zm9", "unexpected end of file"),
            ("Zg=", "unexpected end of file"),
            ("Z*==", "'*' at a place where base64 does not have it"),
            ("Z===", "'=' at a place where base64 does not have it"),
            ("Zg=v", "'v' at a place where base64 does not have it"),
            ("\u{e9}g==", "'\\u{c3}' at a place where base64 does not have it"),
        ] {
            assert_eq!(decoded(text).unwrap_err().to_string(), message, "{text}");
        }
    }
}
