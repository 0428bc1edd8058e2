//! The head of a `.ply` file: which elements follow, of which properties.

use crate::codec::{At, Kind, Order, Place, Source, Text, shortened};
use voronaut::Result;

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

/// What programs call the list of a face's vertices.
pub(super) const VERTEX_LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Reads the head, up to the end of the line `end_header`; the source gives the numbers behind it as the head says.
///
/// # Errors
/// [`Error::Parse`](voronaut::Error::Parse) with the line at fault.
pub(super) fn read(source: &mut Source<'_>) -> Result<Vec<Element>> {
    let (mut elements, mut format, mut lines) = (Vec::new(), None, 0);
    while source.read_line(LONGEST_LINE)? && source.line().ends_with(b"\n") {
        lines += 1;
        let place = source.place();
        let no_text = |_| place.error("the head is no text", "give a whole .ply file");
        let line = std::str::from_utf8(source.line()).map_err(no_text)?.trim();
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["ply"] if lines == 1 => {}
            _ if lines == 1 => break,
            ["end_header"] => {
                let missing = || place.error("the head has no line format", "write 'format ascii 1.0' below ply");
                match format.ok_or_else(missing)? {
                    Some(order) => source.be_binary(order),
                    None => source.skip_comments(),
                }
                source.skip_row();
                return Ok(elements);
            }
            ["format", ..] => format = Some(read_format(&words[1..], place)?),
            ["element", ..] => push_element(&mut elements, &words[1..], place)?,
            ["property", ..] => push_property(&mut elements, &words, place)?,
            ["comment" | "obj_info", ..] | [] => {}
            _ => {
                let what = format!("'{}' has no place in the head", shortened(line));
                return Err(place.error(what, "remove the line, or make it a comment"));
            }
        }
    }
    let what = if lines <= 1 { "the file does not begin with ply" } else { "the head has no end_header" };
    Err(source.error(what, "give a whole .ply file"))
}

/// More columns are refused.
const MOST_PROPERTIES: usize = 1 << 10;

/// More kinds of elements are in no head.
const MOST_ELEMENTS: usize = 256;

/// Longer lines are in no head.
const LONGEST_LINE: u64 = 1 << 16;

/// What bodies are called, and the order of their bytes if they are no text.
const FORMATS: [(&str, Option<Order>); 3] =
    [("ascii", None), ("binary_little_endian", Some(Order::Little)), ("binary_big_endian", Some(Order::Big))];

/// The first names that types had, in the order of [`Kind::all`]: whole numbers of 64 bits had none. Later names say the number of
/// bits.
const KINDS: [&str; 10] = ["char", "uchar", "short", "ushort", "int", "uint", "", "", "float", "double"];

fn read_format(words: &[&str], place: Place<'_>) -> Result<Option<Order>> {
    let found = FORMATS.iter().find(|(name, _)| words == [name, "1.0"]);
    found.map(|&(_, order)| order).ok_or_else(|| {
        let what = format!("format '{}' is not known", shortened(&words.join(" ")));
        place.error(what, "write ascii 1.0, binary_little_endian 1.0 or binary_big_endian 1.0")
    })
}

fn push_element(elements: &mut Vec<Element>, words: &[&str], place: Place<'_>) -> Result<()> {
    let &[name, count] = words else {
        return Err(place.error("an element without name and count", "write 'element vertex 8'"));
    };
    if elements.len() >= MOST_ELEMENTS {
        let what = format!("more than {MOST_ELEMENTS} elements");
        return Err(place.error(what, "check that the file is a .ply: they have two or three"));
    }
    if elements.iter().any(|element| element.name == name) {
        return Err(place.error(format!("a second element '{}'", shortened(name)), "join both elements into one"));
    }
    let count = Text { place, text: count }.whole(At::head("the file"))?;
    elements.push(Element { name: name.into(), count, properties: Vec::new() });
    Ok(())
}

fn push_property(elements: &mut [Element], words: &[&str], place: Place<'_>) -> Result<()> {
    let property = match *words {
        [_, "list", counts, values, name] => {
            kind(counts).zip(kind(values)).map(|(counts, values)| (name, Shape::List(counts, values)))
        }
        [_, values, name] => kind(values).map(|values| (name, Shape::Scalar(values))),
        _ => None,
    };
    let Some((name, shape)) = property else {
        let what = format!("'{}' is not a property", shortened(&words.join(" ")));
        return Err(place.error(what, "write 'property float x' or 'property list uchar int vertex_indices'"));
    };
    let Some(Element { name: of, properties, .. }) = elements.last_mut() else {
        return Err(place.error("a property before any element", "write its element first"));
    };
    if properties.len() >= MOST_PROPERTIES {
        let what = format!("more than {MOST_PROPERTIES} properties of the element '{}'", shortened(of));
        return Err(place.error(what, "save the values in several files"));
    }
    if properties.iter().any(|property| property.name == name) {
        return Err(place.error(format!("a second property '{}'", shortened(name)), "give each a name of its own"));
    }
    properties.push(Property { name: name.into(), shape });
    Ok(())
}

/// The type of a name. Of those with bits, 64 are none of the format, but meshio writes them.
fn kind(name: &str) -> Option<Kind> {
    let mut named = Kind::all().zip(KINDS);
    named.find(|(kind, first)| name == *first || name == kind.to_string().to_lowercase()).map(|(kind, _)| kind)
}
