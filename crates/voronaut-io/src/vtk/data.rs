//! Data on points and cells: labels, marks and fields.

use super::grid::Array;
use crate::Field;
use crate::codec::Kind;
use std::collections::{HashMap, HashSet};
use voronaut::Result;
use voronaut::mesh::SolutionValues;

/// Whole numbers that are labels, best first: what this library calls them, then meshio's names of Medit's and Gmsh's, VTK's own
/// readers', and names in use.
const LABELS: [&str; 6] = ["label", "medit:ref", "gmsh:physical", "CellEntityIds", "Material", "ref"];

/// Arrays of type `UInt8` by which what else a mesh holds is marked.
const MARKS: [&str; 3] = ["corner", "required", "ridge"];

/// What the arrays of the points or of the cells of a piece say.
#[derive(Default)]
pub(super) struct Data<'a> {
    labels: Option<Vec<i32>>,
    marks: HashMap<String, Vec<i64>>,
    pub(super) fields: Vec<Unsorted<'a>>,
}

/// A field whose type is not yet known.
pub(super) struct Unsorted<'a> {
    /// Its numbers are taken out.
    array: Array<'a>,
    /// How many numbers the entries have.
    pub(super) components: usize,
    numbers: Vec<f64>,
}

impl<'a> Data<'a> {
    /// Reads arrays that have so many entries each; of those with the same name the first.
    ///
    /// # Errors
    /// [`Error::Parse`](voronaut::Error::Parse) of an array with more or fewer entries, and of labels out of range.
    pub(super) fn read(arrays: Vec<Array<'a>>, count: u64) -> Result<Self> {
        let is_label = |array: &Array<'_>| array.kind.is_whole() && array.components.unwrap_or(1) == 1;
        let rank = |array: &Array<'_>| LABELS.iter().position(|name| *name == array.name).filter(|_| is_label(array));
        let label = arrays.iter().enumerate().filter_map(|(i, array)| Some((rank(array)?, i))).min();
        let (mut data, mut names) = (Self::default(), HashSet::new());
        for (i, mut array) in arrays.into_iter().enumerate() {
            let components = array.components.unwrap_or(1);
            let is_label = label.is_some_and(|(_, label)| label == i);
            if components == 0 || !is_label && !names.insert(array.name.clone()) {
                continue;
            }
            let is_mark = array.kind == Kind::Unsigned(1) && components == 1 && MARKS.contains(&array.name.as_str());
            if is_label {
                data.labels = Some(read_labels(array, count)?);
            } else if is_mark {
                data.marks.insert(array.name.clone(), array.take_wholes(count)?);
            } else {
                let numbers = array.take_reals(count.saturating_mul(components))?;
                data.fields.push(Unsorted { array, components: components as usize, numbers });
            }
        }
        Ok(data)
    }

    /// The label of an entry, 0 where there is none.
    pub(super) fn label(&self, entry: usize) -> i32 {
        self.labels.as_ref().map_or(0, |labels| labels[entry])
    }

    /// Which of some things are marked, counted from `first`; `entries` of them.
    pub(super) fn marked(&self, name: &str, first: usize, entries: impl Iterator<Item = usize>) -> Vec<u32> {
        let Some(marks) = self.marks.get(name) else { return Vec::new() };
        entries.enumerate().filter(|&(_, entry)| marks[entry] != 0).map(|(i, _)| (first + i) as u32).collect()
    }
}

fn read_labels(mut array: Array<'_>, count: u64) -> Result<Vec<i32>> {
    let labels = array.take_wholes(count)?;
    let label = |(i, label): (usize, i64)| {
        label.try_into().map_err(|_| {
            let what = format!("holds the label {label}, which is out of range (entry {} of {count})", i + 1);
            array.error(&what, "give labels of 32 bits")
        })
    };
    labels.into_iter().enumerate().map(label).collect()
}

impl Unsorted<'_> {
    /// Keeps these entries, in this order.
    pub(super) fn select(&mut self, entries: &[u32]) {
        let is_all = entries.iter().enumerate().all(|(i, &entry)| i == entry as usize);
        if is_all {
            self.numbers.truncate(entries.len() * self.components);
        } else {
            let row = |&entry: &u32| &self.numbers[entry as usize * self.components..][..self.components];
            self.numbers = entries.iter().flat_map(row).copied().collect();
        }
    }

    /// Refuses numbers that are not finite.
    ///
    /// # Errors
    /// [`Error::Parse`](voronaut::Error::Parse) with array and entry; `entries` says which of the file they are.
    pub(super) fn check(&self, entries: Option<&[u32]>) -> Result<()> {
        let Some(i) = self.numbers.iter().position(|number| !number.is_finite()) else { return Ok(()) };
        let (row, number) = (i / self.components, self.numbers[i]);
        let entry = entries.map_or(row, |entries| entries[row] as usize) + 1;
        let what = format!("holds {number}, which is not finite, in entry {entry}");
        Err(self.array.error(&what, "correct or remove the array"))
    }
}

/// The fields of all pieces, one behind the other.
#[derive(Default)]
pub(super) struct Joined<'a>(Option<Vec<Unsorted<'a>>>);

impl<'a> Joined<'a> {
    /// Appends those of a piece that is not empty.
    ///
    /// # Errors
    /// [`Error::Parse`](voronaut::Error::Parse) where pieces differ in what they have.
    pub(super) fn append(&mut self, fields: Vec<Unsorted<'a>>) -> Result<()> {
        const HELP: &str = "give all pieces the same arrays";
        let Some(known) = &mut self.0 else {
            self.0 = Some(fields);
            return Ok(());
        };
        let mut found: HashMap<String, Unsorted<'_>> =
            fields.into_iter().map(|field| (field.array.name.clone(), field)).collect();
        for field in known {
            let same = found.remove(&field.array.name).filter(|same| same.components == field.components);
            let Some(same) = same else {
                return Err(field.array.error("is not in all pieces, or not with as many components", HELP));
            };
            field.numbers.extend(same.numbers);
        }
        if let Some(other) = found.into_values().min_by_key(|field| field.array.byte) {
            return Err(other.array.error("is not in all pieces", HELP));
        }
        Ok(())
    }

    /// The fields; in a planar mesh what has no third coordinate is planar.
    pub(super) fn finish(self, is_planar: bool) -> Vec<Field> {
        let values = |field: Unsorted<'_>| SolutionValues::in_space(field.numbers, field.components, is_planar);
        let named =
            |mut field: Unsorted<'_>| Field { name: std::mem::take(&mut field.array.name), values: values(field) };
        self.0.into_iter().flatten().map(named).collect()
    }
}
