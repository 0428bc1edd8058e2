//! Files that a page holds: read from bytes as the program reads them from disk.

use std::path::Path;
use voronaut::manifold::domain::{from_poly, from_polygons};
use voronaut::{Error, Result};
use voronaut_cli::Held;
use voronaut_io::{Format, ending, geojson, in_file, poly};

/// Adds what a file is to what is held.
///
/// # Errors
/// Those of the program.
pub(crate) fn hold(held: &mut Held, name: &str, bytes: &[u8]) -> Result<()> {
    if bytes.is_empty() {
        return Err(Error::parse(name, "the file is empty", "check that the program that wrote it had finished"));
    }
    match ending(Path::new(name)).as_deref() {
        Some("geojson" | "json") => {
            let outline = from_polygons(&geojson::read(text(name, bytes)?, name)?);
            held.outlines.insert(name.into(), outline.map_err(|error| in_file(name, error))?);
        }
        Some("poly") => {
            let outline = from_poly(&poly::read(bytes, name)?);
            held.outlines.insert(name.into(), outline.map_err(|error| in_file(name, error))?);
        }
        _ => {
            let document = Format::from_path(Path::new(name))?.read(bytes, name)?;
            held.documents.insert(name.into(), document);
        }
    }
    Ok(())
}

fn text<'a>(name: &str, bytes: &'a [u8]) -> Result<&'a str> {
    std::str::from_utf8(bytes).map_err(|error| {
        let what = format!("not a text in UTF-8 (byte {})", error.valid_up_to() + 1);
        Error::parse(name, what, "save the file as UTF-8 text; this format has no binary form that is read")
    })
}
