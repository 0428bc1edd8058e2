//! Gmsh's files as sections of text, with blocks of numbers in them that are text as well, or binary.

use super::tags::Tags;
use crate::codec::{At, Kind, Order, Source, several, shortened};
use voronaut::{Error, Result};

/// Numbers in blocks: types, dimensions, tags in versions 2 and 4.0.
pub(super) const INT: Kind = Kind::Signed(4);
/// Counts, and tags in version 4.1.
pub(super) const SIZE: Kind = Kind::Signed(8);
/// Coordinates and values.
pub(super) const REAL: Kind = Kind::Float(8);

/// How the sections of a file are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    /// Versions 2 to 2.2: elements with their tags.
    Two,
    /// Version 4.0: blocks of entities.
    Four,
    /// Version 4.1: blocks of entities, tags in 64 bits.
    FourOne,
}

/// The sections of a file behind its head.
pub(super) struct Blocks<'a> {
    pub(super) source: Source<'a>,
    pub(super) layout: Layout,
}

impl<'a> Blocks<'a> {
    /// Reads the head of a file.
    ///
    /// # Errors
    /// [`Error::Parse`] of what is none; [`Error::Unsupported`] of versions but 2 to 2.2, 4.0 and 4.1.
    pub(super) fn new(mut source: Source<'a>) -> Result<Self> {
        loop {
            match next_section(&mut source)?.as_deref() {
                Some("MeshFormat") => break,
                Some("NOD") => return Err(unsupported("version 1", &source)),
                Some(other) => skip_section(&mut source, other)?,
                None => return Err(source.error("the file has no section MeshFormat", "give a file that Gmsh wrote")),
            }
        }
        Ok(Self { layout: read_format(&mut source)?, source })
    }

    /// The numbers of blocks and of rows of a section; in version 2 it is one block, and the number of rows is text in all files.
    pub(super) fn read_totals(&mut self, section: &str) -> Result<(u64, u64)> {
        let at = At::head(section);
        if self.layout == Layout::Two {
            return Ok((1, self.source.word(at)?.whole(at)?));
        }
        let totals = (self.source.whole(SIZE, at)?, self.source.whole(SIZE, at)?);
        if self.layout == Layout::FourOne {
            // The least and the greatest tag.
            let _: [u64; 2] = several(|| self.source.whole(SIZE, at))?;
        }
        Ok(totals)
    }

    /// Dimension and tag of the entity of a block.
    pub(super) fn read_entity(&mut self, at: At<'_>) -> Result<(u8, i32)> {
        let (first, second): (i32, i32) = (self.source.whole(INT, at)?, self.source.whole(INT, at)?);
        let (dimension, tag) = if self.layout == Layout::Four { (second, first) } else { (first, second) };
        if (0..=3).contains(&dimension) {
            return Ok((dimension as u8, tag));
        }
        let what = format!("an entity of dimension {dimension} ({at})");
        Err(self.source.error(what, format!("check the counts of {}, and the version", at.section)))
    }

    /// The tag of a node or an element.
    pub(super) fn tag(&mut self, at: At<'_>) -> Result<u64> {
        let is_wide = self.layout == Layout::FourOne;
        if is_wide { self.source.whole(SIZE, at) } else { Ok(self.source.whole::<u32>(INT, at)?.into()) }
    }

    /// The rows of a block of so many behind `done` others; refuses more than `total` in all.
    pub(super) fn block<'s>(
        &self,
        section: &'s str,
        done: usize,
        count: u64,
        total: u64,
    ) -> Result<impl Iterator<Item = At<'s>> + Clone + use<'s>> {
        let done = done as u64;
        if count <= total.saturating_sub(done) {
            return Ok((done + 1..=done + count).map(move |row| At { section, row, rows: total }));
        }
        let what = format!("a block of {count} behind {done} others, where {section} announces {total} in all");
        Err(self.source.error(what, format!("check the counts of {section}")))
    }

    /// Refuses blocks that hold `done` rows where there are `total`.
    pub(super) fn demand_all(&self, section: &str, done: usize, total: u64) -> Result<()> {
        if done as u64 == total {
            return Ok(());
        }
        let what = format!("{section} announces {total}, and its blocks hold {done}");
        Err(self.source.error(what, "check the counts of the blocks, and that the file is whole"))
    }

    /// The entries of all tags; refuses one that is there twice.
    pub(super) fn index(&self, tags: &[u64], of: &str, section: &str) -> Result<Tags> {
        Tags::new(tags).map_err(|(tag, [first, second])| {
            let (first, second) = (u64::from(first) + 1, u64::from(second) + 1);
            let what = format!("{of} {tag} is there twice (rows {first} and {second} of {section})");
            self.source.error(what, format!("give each {of} a tag of its own"))
        })
    }
}

/// Reads the section that opens a file: version, form, and the size of numbers.
fn read_format(source: &mut Source<'_>) -> Result<Layout> {
    let at = At::head("MeshFormat");
    let version = source.word(at)?.text.to_owned();
    let layout = match version.as_str() {
        "2" | "2.0" | "2.1" | "2.2" => Layout::Two,
        "4" | "4.0" => Layout::Four,
        "4.1" => Layout::FourOne,
        _ if version.parse::<f64>().is_ok() => {
            return Err(unsupported(&format!("version {}", shortened(&version)), source));
        }
        _ => {
            let what = format!("'{}' is not a version of the format", shortened(&version));
            return Err(source.error(what, "save the file as version 4.1"));
        }
    };
    let (form, size): (u32, u32) = (source.word(at)?.whole(at)?, source.word(at)?.whole(at)?);
    if form > 1 {
        let what = format!("form {form}, where 0 (text) or 1 (binary) is expected");
        return Err(source.error(what, "save the file again"));
    }
    if size != 8 {
        let what = format!("numbers of {size} bytes, where 8 are expected");
        return Err(source.error(what, "save the file on a machine of 64 bits, or correct the data-size"));
    }
    if form == 1 {
        read_one(source)?;
    }
    end_section(source, "MeshFormat")?;
    Ok(layout)
}

/// Reads the number 1 behind the head of a binary file, which tells the order of bytes of all others.
///
/// # Errors
/// [`Error::Parse`] where it is none in either order, or not there.
fn read_one(source: &mut Source<'_>) -> Result<()> {
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
/// [`Error::Parse`] of anything else that stands between sections.
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
/// [`Error::Parse`] of anything else: the section is longer than announced.
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
/// [`Error::Parse`] where the file ends before the section.
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

/// An error about what the format has and this library does not read.
pub(super) fn unsupported(what: &str, source: &Source<'_>) -> Error {
    let what = format!("{what} of Gmsh's format ({})", source.place());
    Error::unsupported(what, "save the mesh as version 4.1 or 2.2, as a whole and without parameters")
}
