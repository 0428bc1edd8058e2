//! Gmsh's files as sections of text, with blocks of numbers in them that are text as well, or binary.

use super::Version;
use crate::codec::{At, Form, Kind, Order, Sink, Source};
use std::io::{self, Write};
use voronaut::Result;

/// Numbers in blocks: types, dimensions, tags in versions 2 and 4.0.
pub(super) const INT: Kind = Kind::Signed(4);
/// Counts, and tags in version 4.1.
pub(super) const SIZE: Kind = Kind::Signed(8);
/// Coordinates and values.
pub(super) const REAL: Kind = Kind::Float(8);

/// Reads the number 1 behind the head of a binary file, which tells the order of bytes of all others.
///
/// # Errors
/// [`Error::Parse`](voronaut::Error::Parse) where it is none in either order, or not there.
pub(super) fn read_one(source: &mut Source<'_>) -> Result<()> {
    source.be_binary(Order::Little);
    let place = source.place();
    let one: i32 = source.whole(INT, At::head("MeshFormat"))?;
    match one.to_le_bytes() {
        [1, 0, 0, 0] => {}
        [0, 0, 0, 1] => source.be_binary(Order::Big),
        bytes => {
            let what = format!("the four bytes {bytes:?} are not the number 1 in either order");
            return Err(place.error(what, "the file is damaged: write it again"));
        }
    }
    Ok(())
}

/// The name of the next section, without its `$`; `None` at the end of the file.
///
/// # Errors
/// [`Error::Parse`](voronaut::Error::Parse) of anything else that stands between sections.
pub(super) fn next_section(source: &mut Source<'_>) -> Result<Option<String>> {
    let Some(word) = source.next_word()? else { return Ok(None) };
    if let Some(name) = word.text.strip_prefix('$').filter(|name| !name.starts_with("End")) {
        return Ok(Some(name.to_owned()));
    }
    let what = format!("'{}' where a section such as $Nodes should begin", word.quoted());
    Err(word.place.error(what, "give a file that Gmsh wrote; remove what stands between its sections"))
}

/// Reads the line that ends a section.
///
/// # Errors
/// [`Error::Parse`](voronaut::Error::Parse) of anything else: the section is longer than announced.
pub(super) fn end_section(source: &mut Source<'_>, section: &str) -> Result<()> {
    let Some(word) = source.next_word()? else {
        let what = format!("the file ends without $End{section}");
        return Err(source.error(what, "the file is cut off: write it again"));
    };
    if word.text.strip_prefix("$End") == Some(section) {
        return Ok(());
    }
    let what = format!("'{}' where $End{section} should be: {section} is longer than announced", word.quoted());
    Err(word.place.error(what, format!("check the counts of {section}, and the version of the file")))
}

/// Passes over the rest of a section, whatever it holds.
///
/// # Errors
/// [`Error::Parse`](voronaut::Error::Parse) where the file ends before the section.
pub(super) fn skip_section(source: &mut Source<'_>, section: &str) -> Result<()> {
    /// Of lines, so that a binary block without ends of lines does not pile up in memory.
    const CHUNK: u64 = 1 << 16;
    let (start, end) = (source.place(), format!("$End{section}"));
    while source.read_line(CHUNK)? {
        if source.line().trim_ascii() == end.as_bytes() {
            source.skip_row();
            return Ok(());
        }
    }
    Err(start.error(format!("${section}, which begins here, has no {end}"), "the file is cut off: write it again"))
}

/// Begins to write a file.
pub(super) fn begin(version: Version, form: Form, out: &mut dyn Write) -> io::Result<Sink<'_>> {
    let mut sink = Sink::new(form, out);
    sink.line(format_args!("$MeshFormat\n{version} {} 8", i32::from(sink.is_binary())))?;
    if sink.is_binary() {
        sink.put(1_i32);
    }
    write_end("MeshFormat", &mut sink)?;
    Ok(sink)
}

/// Writes the line that ends a section.
pub(super) fn write_end(section: &str, sink: &mut Sink<'_>) -> io::Result<()> {
    if sink.is_binary() {
        // Behind the bytes of a block a line begins.
        sink.line(format_args!(""))?;
    }
    sink.line(format_args!("$End{section}"))
}
