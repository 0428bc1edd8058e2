//! Physical groups: Gmsh's sets of points, curves, surfaces. A mesh's labels are their tags, and its marks are groups with names.

use std::collections::{BTreeMap, BTreeSet};

/// What a mesh marks, in the order of [`marked`](crate::document::marked): the dimension of what has the mark, and the name of its
/// physical group.
pub(super) const MARKS: [(u8, &str); 5] =
    [(0, "corners"), (0, "required vertices"), (1, "ridges"), (1, "required edges"), (2, "required triangles")];

/// The place of corners in [`MARKS`].
pub(super) const CORNER: usize = 0;

/// A set of marks, by their places in [`MARKS`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Marks(u8);

impl Marks {
    pub(super) fn insert(&mut self, mark: usize) {
        self.0 |= 1 << mark;
    }

    pub(super) fn contains(self, mark: usize) -> bool {
        self.0 & (1 << mark) != 0
    }
}

/// The physical groups whose names mean something.
#[derive(Default)]
pub(super) struct Groups {
    meanings: BTreeMap<(u8, i32), Meaning>,
    /// Those that have a group.
    pub(super) marks: Marks,
}

enum Meaning {
    Label(i32),
    Mark(usize),
}

impl Groups {
    /// Notes a group's name.
    pub(super) fn name(&mut self, dimension: u8, tag: i32, name: &str) {
        let mark = MARKS.iter().position(|known| *known == (dimension, name));
        let meaning = match mark {
            Some(mark) => {
                self.marks.insert(mark);
                Meaning::Mark(mark)
            }
            None => match name.strip_prefix(&label_name(dimension)).and_then(|number| number.parse().ok()) {
                Some(label) if label <= 0 => Meaning::Label(label),
                _ => return,
            },
        };
        self.meanings.insert((dimension, tag), meaning);
    }

    /// The label and the marks of what belongs to some groups: the first that is no mark, or the first, or else `entity`.
    pub(super) fn of(&self, dimension: u8, tags: &[i32], entity: i32) -> (i32, Marks) {
        let (mut label, mut marks) = (None, Marks::default());
        for &tag in tags {
            match self.meanings.get(&(dimension, tag)) {
                Some(Meaning::Mark(mark)) => marks.insert(*mark),
                Some(Meaning::Label(meant)) => label = label.or(Some(*meant)),
                None => label = label.or(Some(tag)),
            }
        }
        (label.unwrap_or_else(|| tags.first().copied().unwrap_or(entity)), marks)
    }
}

/// The tags of the groups of one dimension that is written, with the names of those that need one.
pub(super) struct Numbering {
    pub(super) dimension: u8,
    labels: BTreeMap<i32, i32>,
    /// With their tags.
    marks: Vec<(usize, i32)>,
    /// Tag and name of groups with names.
    pub(super) names: Vec<(i32, String)>,
}

impl Numbering {
    /// Groups for some labels and for all marks of a dimension. Labels above 0 are their own tags. Gmsh knows no tags below 1: other
    /// labels are tags that no label needs, with the label in the group's name.
    pub(super) fn new(dimension: u8, labels: impl Iterator<Item = i32>) -> Self {
        let mut labels: BTreeMap<i32, i32> = labels.map(|label| (label, label)).collect();
        let taken: Vec<i32> = labels.keys().copied().collect();
        let mut free = (1..).filter(|tag| taken.binary_search(tag).is_err());
        let mut names = Vec::new();
        for (label, tag) in labels.range_mut(..=0) {
            *tag = free.next().unwrap_or(i32::MAX);
            names.push((*tag, format!("{}{label}", label_name(dimension))));
        }
        let mut marks = Vec::new();
        for (mark, (_, name)) in MARKS.iter().enumerate().filter(|(_, (of, _))| *of == dimension) {
            let tag = free.next().unwrap_or(i32::MAX);
            marks.push((mark, tag));
            names.push((tag, (*name).to_owned()));
        }
        Self { dimension, labels, marks, names }
    }

    /// The tags of a label and of marks.
    pub(super) fn tags(&self, label: i32, marks: Marks) -> Vec<i32> {
        let label = self.labels.get(&label).copied();
        let marks = self.marks.iter().filter(|(mark, _)| marks.contains(*mark)).map(|&(_, tag)| tag);
        label.into_iter().chain(marks).collect()
    }

    /// Leaves out names of groups that no element uses. Where points are no corners the group of corners is there to say so, even if
    /// it is empty.
    pub(super) fn keep_used(&mut self, used: &BTreeSet<i32>) {
        let corners = self.marks.iter().find(|&&(mark, _)| mark == CORNER && !used.is_empty());
        self.names.retain(|(tag, _)| used.contains(tag) || corners.is_some_and(|(_, of_corners)| of_corners == tag));
    }
}

/// How names of groups begin that mean a label.
fn label_name(dimension: u8) -> String {
    let of = ["vertex", "edge", "triangle"].get(usize::from(dimension)).unwrap_or(&"volume");
    format!("{of} label ")
}
