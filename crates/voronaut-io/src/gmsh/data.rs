//! Values on nodes and elements: the sections `$NodeData` and `$ElementData`.

use super::blocks::{Blocks, INT, REAL};
use super::reader::Reader;
use crate::Field;
use crate::codec::At;
use voronaut::mesh::SolutionValues;
use voronaut::{Error, Result};

impl Reader {
    /// Reads a section as a field; values on elements that are no triangles are passed over.
    ///
    /// # Errors
    /// [`Error::Parse`] of what is not as announced, of a node or an element that does not exist or has two values, and of a triangle
    /// or one of its vertices without value. [`Error::Unsupported`] of more than 9 numbers per value.
    pub(super) fn read_data(&mut self, section: &str, from: &mut Blocks<'_>) -> Result<()> {
        let start = from.source.place();
        let head = read_head(from, section)?;
        if head.rows == 0 {
            return Ok(());
        }
        let (numbers, mut rows) = read_rows(self, section, &head, from)?;
        let on_nodes = section == "NodeData";
        if !on_nodes {
            rows = self.triangle_elements.iter().map(|&element| rows[element as usize]).collect();
        }
        if rows.iter().all(Option::is_none) {
            return Ok(());
        }
        let missing = missing(self, &rows, on_nodes);
        if missing > 0 {
            let of = if on_nodes { "vertices of triangles" } else { "triangles" };
            let what = format!("{section} '{}' has no values on {missing} {of}", head.name);
            return Err(start.error(what, "save values everywhere, or remove the section"));
        }
        // Memory follows the file: values that are not there may be a few.
        if rows.len() > FEW.max(MOST_FILLED * head.rows as usize) {
            let what = format!("{section} '{}' has values on {} of {} vertices", head.name, head.rows, rows.len());
            return Err(start.error(what, "save values everywhere, or remove vertices that no element uses"));
        }
        let zeros = vec![0.0; head.components];
        let values = |row: Option<u32>| {
            row.map_or(zeros.as_slice(), |row| &numbers[row as usize * zeros.len()..][..zeros.len()])
        };
        let numbers = rows.into_iter().flat_map(values).copied().collect();
        let values = SolutionValues::in_space(numbers, head.components, self.mesh.is_planar());
        let fields = if on_nodes { &mut self.fields.vertices } else { &mut self.fields.triangles };
        let numbered = |n| format!("{}_{n}", head.name);
        let mut names = [head.name.clone(), numbered(head.step)].into_iter().chain((2..).map(numbered));
        let name = names.find(|name| fields.iter().all(|field| field.name != *name)).unwrap_or_default();
        fields.push(Field { name, values });
        Ok(())
    }
}

/// Vertices for each one with a value, beyond [`FEW`].
const MOST_FILLED: usize = 16;
const FEW: usize = 1 << 12;

/// What a section says of itself.
struct Head {
    name: String,
    step: i64,
    components: usize,
    rows: u64,
}

/// The numbers of all rows of a section, and the row of each node or element, where there is one.
type Rows = (Vec<f64>, Vec<Option<u32>>);

fn read_head(from: &mut Blocks<'_>, section: &str) -> Result<Head> {
    /// Gmsh's own are 1, 3 and 9.
    const MOST: u64 = 9;
    let (source, at) = (&mut from.source, At::head(section));
    let mut name = None;
    for _ in 0..source.word(at)?.whole::<u64>(at)? {
        let text = source.rest_of_row(at)?;
        name.get_or_insert_with(|| text.trim_matches('"').to_owned());
    }
    for _ in 0..source.word(at)?.whole::<u64>(at)? {
        source.word(at)?;
    }
    let mut integers = [None; 3];
    for i in 0..source.word(at)?.whole::<u64>(at)? {
        let integer: i64 = source.word(at)?.whole(at)?;
        if let Some(place) = integers.get_mut(i as usize) {
            *place = Some(integer);
        }
    }
    let name = name.unwrap_or_default();
    let [Some(step), Some(components), Some(rows)] = integers else {
        let what = format!("{section} '{name}' has fewer than three integer tags");
        return Err(source.error(what, "give step, number of components and number of values"));
    };
    let (components, rows) = (u64::try_from(components).unwrap_or(0), u64::try_from(rows));
    let (1.., Ok(rows)) = (components, rows) else {
        let what = format!("{section} '{name}' has values of {components} numbers, or a negative number of them");
        return Err(source.error(what, "check the second and third integer tag"));
    };
    if components > MOST {
        let what = format!("{section} '{name}' of {components} numbers per value ({})", source.place());
        return Err(Error::unsupported(what, format!("save values of at most {MOST} numbers")));
    }
    Ok(Head { name, step, components: components as usize, rows })
}

fn read_rows(reader: &Reader, section: &str, head: &Head, from: &mut Blocks<'_>) -> Result<Rows> {
    let of = if section == "NodeData" { "node" } else { "element" };
    let tags = if section == "NodeData" { &reader.nodes } else { &reader.elements };
    let (mut numbers, mut rows) = (Vec::new(), vec![None; tags.len()]);
    for at in At::rows(section, head.rows) {
        let source = &mut from.source;
        // Of 32 bits in all versions.
        let tag: u32 = source.whole(INT, at)?;
        let Some(entry) = tags.find(tag.into()) else {
            let what = format!("{of} {tag} does not exist ({at})");
            return Err(source.error(what, format!("check the tag, and that the {of}s are all there")));
        };
        if rows[entry as usize].replace((at.row - 1) as u32).is_some() {
            return Err(source.error(format!("{of} {tag} has two values ({at})"), "remove one of them"));
        }
        for _ in 0..head.components {
            numbers.push(source.number(REAL, at)?);
        }
    }
    Ok((numbers, rows))
}

/// On how many triangles, or vertices of triangles, there is no value.
fn missing(reader: &Reader, rows: &[Option<u32>], on_nodes: bool) -> usize {
    if !on_nodes {
        return rows.iter().filter(|row| row.is_none()).count();
    }
    let mut lacks: Vec<bool> = rows.iter().map(Option::is_none).collect();
    let vertices = reader.mesh.triangles.as_flattened().iter();
    vertices.filter(|&&v| std::mem::take(&mut lacks[v as usize])).count()
}

/// A field, or a part of one, as Gmsh has them: with 1, 3 or 9 numbers per value.
pub(super) struct Column<'a> {
    pub(super) name: String,
    /// How many numbers a value has.
    pub(super) components: usize,
    field: &'a Field,
    /// Which of the field's numbers is the first.
    first: usize,
}

impl<'a> Column<'a> {
    /// A field as columns: one, or one per component where Gmsh knows no values of so many numbers.
    pub(super) fn of(field: &'a Field) -> Vec<Self> {
        let (components, name) = (field.width(true), field.name.replace(['"', '\n', '\r'], "'"));
        if matches!(components, 1 | 3 | 9) {
            return vec![Self { name, components, field, first: 0 }];
        }
        let part = |first| Self { name: format!("{name}_{first}"), components: 1, field, first };
        (0..components).map(part).collect()
    }

    /// The numbers of an entry, zeros where there is none.
    pub(super) fn row(&self, entry: Option<usize>) -> impl Iterator<Item = f64> {
        (self.first..self.first + self.components).map(move |k| entry.map_or(0.0, |i| self.field.number(i, k)))
    }
}
