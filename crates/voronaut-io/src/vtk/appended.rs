//! The section of a file where arrays stand one after the other, behind all tags.

use super::base64::Base64;
use super::grid::Grid;
use super::stored::Stored;
use crate::codec::Place;
use std::io::{self, BufRead, ErrorKind, Read};
use voronaut::{Error, Result};

/// Reads the arrays that tags refer to, in one pass. `start`: the byte of the file that comes next.
///
/// # Errors
/// [`Error::Parse`] where an array is not there as a whole, or begins in another; [`Error::Io`] of what cannot be read.
pub(super) fn read(source: &mut dyn BufRead, start: u64, is_raw: bool, grid: &mut Grid<'_>) -> Result<()> {
    let (file, layout) = (grid.file, grid.layout);
    let io = |source| Error::Io { path: file.into(), source };
    let mut section = Counted { source, position: 0 };
    let mark = section.bytes_to_mark().map_err(io)?;
    let Some(before) = mark else {
        let what = "AppendedData without the '_' that its arrays begin with";
        return Err(Place::byte(file, start).error(what, "the file is cut off or damaged"));
    };
    let start = start + before;
    let mut wanted = Vec::new();
    for (i, piece) in grid.pieces.iter_mut().enumerate() {
        wanted.extend(piece.appended.drain(..).map(|(offset, of, array)| (offset, i, of, array)));
    }
    wanted.sort_by_key(|&(offset, ..)| offset);
    section.position = 0;
    for (offset, i, of, mut array) in wanted {
        array.byte = start.saturating_add(offset);
        if offset < section.position {
            return Err(array.error("begins in another array", "check the attribute offset"));
        }
        let missing = offset - section.position;
        if io::copy(&mut (&mut section).take(missing), &mut io::sink()).map_err(io)? < missing {
            return Err(array.error("begins behind the end of the file", "the file is cut off, or offset is wrong"));
        }
        let stored = if is_raw {
            Stored::read(&mut section, layout)
        } else {
            Stored::read(&mut Base64::new(&mut section), layout)
        };
        array.stored = stored.map_err(|error| array.misread(&error))?;
        grid.pieces[i].arrays.push((of, array));
    }
    for piece in &mut grid.pieces {
        piece.arrays.sort_by_key(|(_, array)| array.tag);
    }
    Ok(())
}

/// A source that counts what was read.
struct Counted<'a> {
    source: &'a mut dyn BufRead,
    position: u64,
}

impl Counted<'_> {
    /// Reads on to behind the mark that the arrays begin with: how many bytes; `None` where there is none.
    fn bytes_to_mark(&mut self) -> io::Result<Option<u64>> {
        loop {
            let mut byte = [0];
            match self.read_exact(&mut byte) {
                Ok(()) if byte == *b"_" => return Ok(Some(self.position)),
                Ok(()) if byte[0].is_ascii_whitespace() => {}
                Err(error) if error.kind() != ErrorKind::UnexpectedEof => return Err(error),
                _ => return Ok(None),
            }
        }
    }
}

impl Read for Counted<'_> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let count = self.source.read(out)?;
        self.position += count as u64;
        Ok(count)
    }
}

impl BufRead for Counted<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.source.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.position += count as u64;
        self.source.consume(count);
    }
}
