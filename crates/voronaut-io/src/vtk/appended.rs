//! The section of a file where arrays stand one after the other, behind all tags.

use super::base64::Base64;
use super::grid::Grid;
use super::stored::Stored;
use crate::codec::{Counted, Place};
use std::io::{self, BufRead, ErrorKind, Read};
use voronaut::{Error, Result};

/// Reads the arrays that tags refer to, in one pass.
///
/// # Errors
/// [`Error::Parse`] where an array is not there as a whole, or begins in another; [`Error::Io`] of what cannot be read.
pub(super) fn read(section: &mut Counted<impl BufRead>, is_raw: bool, grid: &mut Grid<'_>) -> Result<()> {
    let (file, layout, begin) = (grid.file, grid.layout, section.position());
    let io = |source| Error::Io { path: file.into(), source };
    if !passes_mark(section).map_err(io)? {
        let what = "AppendedData without the '_' that its arrays begin with";
        return Err(Place::byte(file, begin).error(what, "the file is cut off or damaged"));
    }
    let start = section.position();
    let arrays = grid.pieces.iter_mut().flat_map(|piece| &mut piece.arrays);
    let mut wanted: Vec<_> = arrays.filter(|array| matches!(array.stored, Stored::Appended(_))).collect();
    for array in &mut wanted {
        if let Stored::Appended(offset) = array.stored {
            array.byte = start.saturating_add(offset);
        }
    }
    wanted.sort_by_key(|array| array.byte);
    for array in wanted {
        let Some(missing) = array.byte.checked_sub(section.position()) else {
            return Err(array.error("begins in another array", "check the attribute offset"));
        };
        if io::copy(&mut section.take(missing), &mut io::sink()).map_err(io)? < missing {
            return Err(array.error("begins behind the end of the file", "the file is cut off, or offset is wrong"));
        }
        let stored =
            if is_raw { Stored::read(section, layout) } else { Stored::read(&mut Base64::new(&mut *section), layout) };
        array.stored = stored.map_err(|error| array.misread(&error))?;
    }
    Ok(())
}

/// Reads on to behind the mark that the arrays begin with, and whether there is one.
fn passes_mark(section: &mut impl Read) -> io::Result<bool> {
    loop {
        let mut byte = [0];
        match section.read_exact(&mut byte) {
            Ok(()) if byte == *b"_" => return Ok(true),
            Ok(()) if byte[0].is_ascii_whitespace() => {}
            Err(error) if error.kind() != ErrorKind::UnexpectedEof => return Err(error),
            _ => return Ok(false),
        }
    }
}
