//! Physical groups: Gmsh's sets of points, curves, surfaces. A mesh's labels are their tags, and its marks are groups with names.

use std::collections::BTreeMap;

/// What a mesh says about some vertices, edges or triangles beside their labels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mark {
    Corner,
    RequiredVertex,
    Ridge,
    RequiredEdge,
    RequiredTriangle,
}

/// A set of marks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Marks(u8);

/// Each mark, the dimension of what has it, and the name of its physical group.
pub(super) const MARKS: [(Mark, u8, &str); 5] = [
    (Mark::Corner, 0, "corners"),
    (Mark::RequiredVertex, 0, "required vertices"),
    (Mark::Ridge, 1, "ridges"),
    (Mark::RequiredEdge, 1, "required edges"),
    (Mark::RequiredTriangle, 2, "required triangles"),
];

impl Marks {
    pub(super) fn insert(&mut self, mark: Mark) {
        self.0 |= 1 << mark as u8;
    }

    pub(super) fn contains(self, mark: Mark) -> bool {
        self.0 & (1 << mark as u8) != 0
    }
}

/// The physical groups whose names mean something.
#[derive(Default)]
pub(super) struct Groups {
    meanings: BTreeMap<(u8, i32), Meaning>,
    marks: Marks,
}

enum Meaning {
    Label(i32),
    Mark(Mark),
}

impl Groups {
    /// Notes a group's name.
    pub(super) fn name(&mut self, dimension: u8, tag: i32, name: &str) {
        let mark = MARKS.iter().find(|&&(_, of, known)| of == dimension && known == name);
        let meaning = match mark {
            Some(&(mark, ..)) => {
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

    /// Whether a group is called as a mark.
    pub(super) fn have(&self, mark: Mark) -> bool {
        self.marks.contains(mark)
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
    dimension: u8,
    labels: BTreeMap<i32, i32>,
    marks: Vec<(Mark, i32)>,
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
        for &(mark, _, name) in MARKS.iter().filter(|(_, of, _)| *of == dimension) {
            let tag = free.next().unwrap_or(i32::MAX);
            marks.push((mark, tag));
            names.push((tag, name.to_owned()));
        }
        Self { dimension, labels, marks, names }
    }

    /// The dimension of the groups.
    pub(super) fn dimension(&self) -> u8 {
        self.dimension
    }

    /// The tags of a label and of marks.
    pub(super) fn tags(&self, label: i32, marks: Marks) -> Vec<i32> {
        let label = self.labels.get(&label).copied();
        let marks = self.marks.iter().filter(|(mark, _)| marks.contains(*mark)).map(|&(_, tag)| tag);
        label.into_iter().chain(marks).collect()
    }

    /// The tag of a mark.
    pub(super) fn mark(&self, mark: Mark) -> Option<i32> {
        self.marks.iter().find(|(known, _)| *known == mark).map(|&(_, tag)| tag)
    }

    /// Leaves out names of groups that are not used.
    pub(super) fn keep(&mut self, used: impl Fn(i32) -> bool) {
        self.names.retain(|(tag, _)| used(*tag));
    }
}

/// How names of groups begin that mean a label.
fn label_name(dimension: u8) -> String {
    let of = ["vertex", "edge", "triangle"].get(usize::from(dimension)).unwrap_or(&"volume");
    format!("{of} label ")
}
