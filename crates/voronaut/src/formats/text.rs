//! Text files as a whole, with errors that say what is wrong with them.

use crate::error::{Error, Result};
use std::path::Path;

/// Reads a text file.
///
/// # Errors
/// [`Error::Io`] where it cannot be read; [`Error::Parse`] where it is empty, or no text.
pub fn read_text(path: &Path) -> Result<String> {
    let bytes = std::fs::read(path).map_err(|source| Error::Io { path: path.into(), source })?;
    let place = path.display().to_string();
    let text = String::from_utf8(bytes).map_err(|error| {
        let what = format!("not a text in UTF-8 (byte {})", error.utf8_error().valid_up_to() + 1);
        let help = "save the file as UTF-8 text; binary files are not read yet";
        Error::parse(&place, what, help)
    })?;
    if text.trim().is_empty() {
        return Err(Error::parse(place, "the file is empty", "check that the program that wrote it had finished"));
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_text_is_named() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("a.sol");
        for (bytes, expected) in
            [(&b" \n"[..], "a.sol: the file is empty"), (b"ab\xff", "not a text in UTF-8 (byte 3)")]
        {
            std::fs::write(&file, bytes).unwrap();
            let error = read_text(&file).unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
        }
        assert!(matches!(read_text(&directory.path().join("b.sol")), Err(Error::Io { .. })));
    }
}
