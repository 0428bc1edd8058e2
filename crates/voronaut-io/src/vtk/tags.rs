//! What the tags of a file say: its pieces, and the arrays of each.

use super::base64::Base64;
use super::characters::Characters;
use super::grid::{Array, CELLS, Grid, Piece, SECTIONS};
use super::stored::{Layout, Stored};
use crate::codec::{Counted, Kind, Order, Place, shortened};
use quick_xml::events::{BytesStart, Event};
use std::io::{self, BufRead, ErrorKind, Read};
use voronaut::{Error, Result};

/// Reads the tags of a file and the arrays that are between or behind them. Memory follows the file.
///
/// # Errors
/// [`Error::Parse`] with the byte of what is no XML, or not as VTK has it; [`Error::Unsupported`] of other types of files and
/// compressors; [`Error::Io`] of what cannot be read.
pub(super) fn read(source: impl BufRead, place: &str) -> Result<Grid<'_>> {
    let layout = Layout { order: Order::Little, is_wide: false, is_compressed: false };
    let grid = Grid { file: place, layout, pieces: Vec::new() };
    let xml = quick_xml::Reader::from_reader(Characters::new(source));
    let (open, text, mut buffer) = (Vec::new(), String::new(), Vec::new());
    let mut tags = Tags { xml, grid, kind: UNSTRUCTURED, open, array: None, compressor: None, text, byte: 0 };
    while tags.read_event(&mut buffer)? {
        buffer.clear();
    }
    tags.finish()
}

/// The types of files that are read, each with an element of that name: `.vtu` and `.vtp`.
const KINDS: [&str; 2] = [UNSTRUCTURED, "PolyData"];
const UNSTRUCTURED: &str = "UnstructuredGrid";
const FILE: &str = "VTKFile";
const PIECE: &str = "Piece";
const ARRAY: &str = "DataArray";

struct Tags<'a, R> {
    xml: quick_xml::Reader<Characters<R>>,
    grid: Grid<'a>,
    /// The type of the file, one of [`KINDS`].
    kind: &'static str,
    /// The elements that are open; of those that are passed over the name is empty.
    open: Vec<&'static str>,
    /// That whose element is open.
    array: Option<Array<'a>>,
    /// By which binary arrays are compressed.
    compressor: Option<String>,
    text: String,
    /// Where the event that is looked at begins.
    byte: u64,
}

impl<'a, R: BufRead> Tags<'a, R> {
    /// Reads a tag or a text; false at the end of what matters.
    fn read_event(&mut self, buffer: &mut Vec<u8>) -> Result<bool> {
        self.byte = self.xml.get_ref().position();
        let event = self.xml.read_event_into(buffer).map_err(|error| self.misread(&error))?;
        match event {
            Event::Start(tag) if self.open == [FILE] && tag.name().0 == "AppendedData" => {
                let is_raw = self.choice(&tag, "encoding", [("base64", false), ("raw", true)])?;
                read_appended(self.xml.get_mut().source(), is_raw, &mut self.grid)?;
                return Ok(false);
            }
            Event::Start(tag) => self.open(&tag)?,
            Event::Empty(tag) => {
                self.open(&tag)?;
                self.close()?;
            }
            Event::End(_) => self.close()?,
            Event::Text(text) => self.add(&text.into_inner())?,
            Event::CData(text) => self.add(&text.into_inner())?,
            Event::GeneralRef(_) if self.open.last() == Some(&ARRAY) => {
                return Err(self.error("an '&' among the numbers of an array", "write numbers only"));
            }
            Event::Eof if self.open.is_empty() => return Ok(false),
            Event::Eof => return Err(self.error("the file ends in the midst of its tags", "the file is cut off")),
            _ => {}
        }
        Ok(true)
    }

    fn add(&mut self, text: &str) -> Result<()> {
        if self.open.is_empty() && !text.trim().is_empty() {
            return Err(self.no_vtk());
        }
        if self.open.last() == Some(&ARRAY) {
            if let Some(array) = self.array.as_mut().filter(|_| self.text.is_empty()) {
                array.byte = self.byte;
            }
            self.text.push_str(text);
        }
        Ok(())
    }

    fn open(&mut self, tag: &BytesStart<'_>) -> Result<()> {
        let name = tag.name().0;
        let element = match self.open.last().copied() {
            None if name == FILE && self.grid.pieces.is_empty() => {
                self.read_head(tag)?;
                FILE
            }
            None => return Err(self.no_vtk()),
            Some(FILE) if name == self.kind => self.kind,
            Some(grid) if name == PIECE && grid == self.kind => {
                let piece = self.piece(tag)?;
                self.grid.pieces.push(piece);
                PIECE
            }
            Some(PIECE) => SECTIONS.into_iter().find(|section| *section == name).unwrap_or_default(),
            Some(section) if name == ARRAY && SECTIONS.contains(&section) => {
                self.array = self.array(section, tag)?;
                self.text.clear();
                if self.array.is_some() { ARRAY } else { "" }
            }
            _ => "",
        };
        self.open.push(element);
        Ok(())
    }

    /// What the tag `VTKFile` says.
    fn read_head(&mut self, tag: &BytesStart<'_>) -> Result<()> {
        let kind = self.attribute(tag, "type")?.unwrap_or_default();
        self.kind = KINDS.into_iter().find(|known| *known == kind).ok_or_else(|| {
            let what = format!("{} is a VTK file of type '{}'", self.grid.file, shortened(&kind));
            Error::unsupported(what, "save it as one file of type UnstructuredGrid (.vtu) or PolyData (.vtp)")
        })?;
        let order = self.choice(tag, "byte_order", [("LittleEndian", Order::Little), ("BigEndian", Order::Big)])?;
        let is_wide = self.choice(tag, "header_type", [("UInt32", false), ("UInt64", true)])?;
        self.compressor = self.attribute(tag, "compressor")?.filter(|name| !name.is_empty());
        self.grid.layout = Layout { order, is_wide, is_compressed: self.compressor.is_some() };
        Ok(())
    }

    /// What the value of an attribute means: without one the first of those that are known.
    fn choice<T: Copy>(&self, tag: &BytesStart<'_>, name: &str, known: [(&str, T); 2]) -> Result<T> {
        let Some(value) = self.attribute(tag, name)? else { return Ok(known[0].1) };
        known.iter().find(|(known, _)| *known == value).map(|&(_, meaning)| meaning).ok_or_else(|| {
            let what = format!("an unknown {name} '{}'", shortened(&value));
            self.error(&what, &format!("write {} or {} in the tag {}", known[0].0, known[1].0, tag.name().0))
        })
    }

    fn piece(&self, tag: &BytesStart<'_>) -> Result<Piece<'a>> {
        let needed = |name: &str| {
            let help = "check that a VTK program wrote the file";
            self.count(tag, name)?.ok_or_else(|| self.error(&format!("a piece without {name}"), help))
        };
        let points = needed("NumberOfPoints")?;
        let mut cells = [0; 5];
        if self.kind == UNSTRUCTURED {
            cells[0] = needed("NumberOfCells")?;
        } else {
            for (count, section) in cells.iter_mut().zip(CELLS).skip(1) {
                *count = self.count(tag, &format!("NumberOf{section}"))?.unwrap_or(0);
            }
        }
        Ok(Piece { points, cells, arrays: Vec::new(), byte: self.byte })
    }

    /// An attribute that counts something that the mesh numbers with 32 bits.
    fn count(&self, tag: &BytesStart<'_>, name: &str) -> Result<Option<u64>> {
        let Some(value) = self.attribute(tag, name)? else { return Ok(None) };
        let count = value.trim().parse::<u32>().map_err(|_| {
            let what = format!("{name}=\"{}\" is not a whole number from 0 to {}", shortened(&value), u32::MAX);
            self.error(&what, "correct the count")
        })?;
        Ok(Some(count.into()))
    }

    /// The array of a tag; `None` where nobody needs it.
    fn array(&self, section: &'static str, tag: &BytesStart<'_>) -> Result<Option<Array<'a>>> {
        let name = self.attribute(tag, "Name")?.unwrap_or_default();
        let step = self.attribute(tag, "TimeStep")?;
        let kind = Kind::of_name(&self.attribute(tag, "type")?.unwrap_or_default());
        let is_known = !CELLS.contains(&section) || ["connectivity", "offsets", "types"].contains(&&*name);
        let is_first = step.is_none_or(|step| step.trim() == "0");
        let Some(kind) = kind.filter(|_| is_known && is_first) else { return Ok(None) };
        let components = match self.attribute(tag, "NumberOfComponents")?.as_deref().map(str::trim) {
            None | Some("") => None,
            Some(text) => Some(text.parse().map_err(|_| {
                let what = format!("array '{}' has '{}' components", shortened(&name), shortened(text));
                self.error(&what, "correct NumberOfComponents")
            })?),
        };
        let stored = self.format(&name, tag)?;
        let is_empty = self.grid.pieces.last().is_none_or(|piece| piece.count(section) == 0);
        if is_empty && matches!(stored, Stored::Appended(_)) {
            return Ok(None);
        }
        let (file, order, byte) = (self.grid.file, self.grid.layout.order, self.byte);
        Ok(Some(Array { file, order, section, name, kind, components, byte, stored }))
    }

    /// How an array is stored, which is not yet read.
    fn format(&self, array: &str, tag: &BytesStart<'_>) -> Result<Stored> {
        let format = self.attribute(tag, "format")?;
        let compressor = self.compressor.as_ref().filter(|name| *name != "vtkZLibDataCompressor");
        match (format.as_deref(), compressor) {
            (None | Some("ascii"), _) => Ok(Stored::Text(String::new())),
            (_, Some(compressor)) => {
                let what = format!("{} is compressed by '{}'", self.grid.file, shortened(compressor));
                let help = "save it uncompressed, or compressed by zlib (ParaView: Compressor Type ZLib or None)";
                Err(Error::unsupported(what, help))
            }
            (Some("binary"), _) => Ok(Stored::Plain(Vec::new())),
            (Some("appended"), _) => {
                let offset = self.attribute(tag, "offset")?.unwrap_or_default();
                let offset = offset.trim().parse().map_err(|_| {
                    let what = format!("array '{}' has the offset '{}'", shortened(array), shortened(&offset));
                    self.error(&what, "arrays in the section AppendedData have the attribute offset, in bytes")
                })?;
                Ok(Stored::Appended(offset))
            }
            (Some(other), _) => {
                let what = format!("array '{}' has the format '{}'", shortened(array), shortened(other));
                Err(self.error(&what, "formats are ascii, binary and appended"))
            }
        }
    }

    fn close(&mut self) -> Result<()> {
        if self.open.pop() != Some(ARRAY) {
            return Ok(());
        }
        let (Some(mut array), Some(piece)) = (self.array.take(), self.grid.pieces.last_mut()) else { return Ok(()) };
        let text = std::mem::take(&mut self.text);
        if text.trim().is_empty() && piece.count(array.section) == 0 {
            return Ok(());
        }
        match array.stored {
            Stored::Text(_) => array.stored = Stored::Text(text),
            Stored::Appended(_) => {}
            _ => {
                let stored = Stored::read(&mut Base64::new(text.as_bytes()), self.grid.layout);
                array.stored = stored.map_err(|error| array.misread(&error))?;
            }
        }
        piece.arrays.push(array);
        Ok(())
    }

    fn finish(self) -> Result<Grid<'a>> {
        if self.grid.pieces.is_empty() {
            let what = format!("no {} with a piece in it", self.kind);
            return Err(self.error(&what, "check that the program that wrote it had finished"));
        }
        let mut arrays = self.grid.pieces.iter().flat_map(|piece| &piece.arrays);
        if let Some(array) = arrays.find(|array| matches!(array.stored, Stored::Appended(_))) {
            return Err(array.error("is in a section AppendedData, which is not there", "the file is cut off"));
        }
        Ok(self.grid)
    }

    /// The value of an attribute.
    fn attribute(&self, tag: &BytesStart<'_>, name: &str) -> Result<Option<String>> {
        // Looking for names given twice takes long where there are many.
        for attribute in tag.attributes().with_checks(false) {
            let attribute = attribute.map_err(|error| self.misread(&error.into()))?;
            if attribute.key.0 == name {
                let value = quick_xml::escape::unescape(&attribute.value);
                return value.map(|value| Some(value.into_owned())).map_err(|error| self.misread(&error.into()));
            }
        }
        Ok(None)
    }

    fn no_vtk(&self) -> Error {
        let help = "give a VTK file in its XML form (.vtu or .vtp), not in its legacy form";
        self.error("the file does not begin with the tag VTKFile", help)
    }

    fn misread(&self, error: &quick_xml::Error) -> Error {
        match error {
            quick_xml::Error::Io(source) => {
                let source = io::Error::new(source.kind(), source.to_string());
                Error::io(self.grid.file, source)
            }
            _ if self.open.is_empty() => self.no_vtk(),
            error => self.error(&error.to_string(), "check that the file is whole, and that a VTK program wrote it"),
        }
    }

    fn error(&self, what: &str, help: &str) -> Error {
        Place::byte(self.grid.file, self.byte).error(what, help)
    }
}

/// Reads the arrays that tags refer to, which stand one after the other behind all tags, in one pass.
///
/// # Errors
/// [`Error::Parse`] where an array is not there as a whole, or begins in another; [`Error::Io`] of what cannot be read.
fn read_appended(section: &mut Counted<impl BufRead>, is_raw: bool, grid: &mut Grid<'_>) -> Result<()> {
    let (file, layout, begin) = (grid.file, grid.layout, section.position());
    let io = |source| Error::io(file, source);
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
