//! The head of a `.ply` file: which elements follow, of which properties.

use crate::words::{At, Word, error_at, shortened, whole};
use std::io::{BufRead, Read};
use voronaut::{Error, Result};

/// What the head says.
pub(super) struct Header {
    pub(super) format: Format,
    pub(super) elements: Vec<Element>,
    /// Where the body begins, in bytes and in lines.
    pub(super) bytes: u64,
    pub(super) lines: usize,
}

/// How the body is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Text,
    LittleEndian,
    BigEndian,
}

/// So many rows of the same properties.
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

/// A column of an element.
pub(super) struct Property {
    pub(super) name: String,
    pub(super) shape: Shape,
}

/// One value, or a list behind its length.
#[derive(Clone, Copy)]
pub(super) enum Shape {
    Scalar(Kind),
    List(Kind, Kind),
}

/// A number's type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// More columns are refused.
const MOST_PROPERTIES: usize = 1 << 10;

/// More kinds of elements are in no head.
const MOST_ELEMENTS: usize = 256;

/// Longer lines are in no head.
const LONGEST_LINE: u64 = 1 << 16;

/// What programs call the list of a face's vertices.
pub(super) const VERTEX_LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

const KINDS: [(&str, Kind); 18] = [
    ("char", Kind::I8),
    ("int8", Kind::I8),
    ("uchar", Kind::U8),
    ("uint8", Kind::U8),
    ("short", Kind::I16),
    ("int16", Kind::I16),
    ("ushort", Kind::U16),
    ("uint16", Kind::U16),
    ("int", Kind::I32),
    ("int32", Kind::I32),
    ("uint", Kind::U32),
    ("uint32", Kind::U32),
    // No types of the format, but meshio writes them.
    ("int64", Kind::I64),
    ("uint64", Kind::U64),
    ("float", Kind::F32),
    ("float32", Kind::F32),
    ("double", Kind::F64),
    ("float64", Kind::F64),
];

impl Header {
    /// Reads the head, up to the end of the line `end_header`.
    ///
    /// # Errors
    /// [`Error::Parse`] with the line at fault.
    pub(super) fn read(source: &mut dyn BufRead, place: &str) -> Result<Self> {
        let mut header = Self { format: Format::Text, elements: Vec::new(), bytes: 0, lines: 0 };
        let mut format = None;
        let mut line = Vec::new();
        while header.next_line(source, &mut line, place)? {
            let no_text = |_| error_at(place, header.lines, "the head is no text", "give a whole .ply file");
            let line = std::str::from_utf8(&line).map_err(no_text)?;
            let words: Vec<&str> = line.split_whitespace().collect();
            match words[..] {
                ["ply"] if header.lines == 1 => {}
                _ if header.lines == 1 => break,
                ["end_header"] => {
                    let help = "write 'format ascii 1.0' below ply";
                    let missing = || error_at(place, header.lines, "the head has no line format", help);
                    header.format = format.ok_or_else(missing)?;
                    return Ok(header);
                }
                ["format", ..] => format = Some(header.format(&words[1..], place)?),
                ["element", ..] => header.push_element(&words[1..], place)?,
                ["property", ..] => header.push_property(line.trim(), &words[1..], place)?,
                ["comment" | "obj_info", ..] | [] => {}
                _ => {
                    let what = format!("'{}' has no place in the head", shortened(line.trim()));
                    return Err(error_at(place, header.lines, what, "remove the line, or make it a comment"));
                }
            }
        }
        let what = if header.lines <= 1 { "the file does not begin with ply" } else { "the head has no end_header" };
        Err(error_at(place, header.lines.max(1), what, "give a whole .ply file"))
    }

    /// The next line; false where no line ends any more.
    fn next_line(&mut self, source: &mut dyn BufRead, line: &mut Vec<u8>, place: &str) -> Result<bool> {
        line.clear();
        let read = source.take(LONGEST_LINE).read_until(b'\n', line);
        let read = read.map_err(|source| Error::Io { path: place.into(), source })?;
        self.bytes += read as u64;
        let ends = line.ends_with(b"\n");
        self.lines += usize::from(ends);
        Ok(ends)
    }

    fn format(&self, words: &[&str], place: &str) -> Result<Format> {
        match words {
            ["ascii", "1.0"] => Ok(Format::Text),
            ["binary_little_endian", "1.0"] => Ok(Format::LittleEndian),
            ["binary_big_endian", "1.0"] => Ok(Format::BigEndian),
            _ => {
                let what = format!("format '{}' is not known", shortened(&words.join(" ")));
                let help = "write ascii 1.0, binary_little_endian 1.0 or binary_big_endian 1.0";
                Err(error_at(place, self.lines, what, help))
            }
        }
    }

    fn push_element(&mut self, words: &[&str], place: &str) -> Result<()> {
        let [name, count] = words else {
            return Err(error_at(place, self.lines, "an element without name and count", "write 'element vertex 8'"));
        };
        if self.elements.len() >= MOST_ELEMENTS {
            let what = format!("more than {MOST_ELEMENTS} elements");
            return Err(error_at(place, self.lines, what, "check that the file is a .ply: they have two or three"));
        }
        if self.elements.iter().any(|element| element.name == *name) {
            let what = format!("a second element '{}'", shortened(name));
            return Err(error_at(place, self.lines, what, "join both elements into one"));
        }
        let count = whole(place, Word { line: self.lines, text: count }, At::head("the file"))?;
        self.elements.push(Element { name: (*name).into(), count, properties: Vec::new() });
        Ok(())
    }

    fn push_property(&mut self, line: &str, words: &[&str], place: &str) -> Result<()> {
        let kind = |name: &str| KINDS.iter().find(|(known, _)| *known == name).map(|&(_, kind)| kind);
        let property = match words {
            ["list", counts, values, name] => {
                kind(counts).zip(kind(values)).map(|(counts, values)| (name, Shape::List(counts, values)))
            }
            [values, name] => kind(values).map(|values| (name, Shape::Scalar(values))),
            _ => None,
        };
        let Some((name, shape)) = property else {
            let what = format!("'{}' is not a property", shortened(line));
            let help = "write 'property float x' or 'property list uchar int vertex_indices'";
            return Err(error_at(place, self.lines, what, help));
        };
        let Some(element) = self.elements.last_mut() else {
            return Err(error_at(place, self.lines, "a property before any element", "write its element first"));
        };
        if element.properties.len() >= MOST_PROPERTIES {
            let what = format!("more than {MOST_PROPERTIES} properties of the element '{}'", shortened(&element.name));
            return Err(error_at(place, self.lines, what, "save the values in several files"));
        }
        if element.properties.iter().any(|property| property.name == **name) {
            let what = format!("a second property '{}'", shortened(name));
            return Err(error_at(place, self.lines, what, "give each a name of its own"));
        }
        element.properties.push(Property { name: (*name).into(), shape });
        Ok(())
    }
}
