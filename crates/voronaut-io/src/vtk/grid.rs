//! The pieces of a file, and the arrays of each.

use super::numbers::{Array, Head};
use std::io::ErrorKind;
use voronaut::Error;

/// The two types of files that are read.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    /// `.vtu`
    UnstructuredGrid,
    /// `.vtp`
    PolyData,
}

/// Where in a piece an array is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Section {
    PointData,
    CellData,
    Points,
    /// Of an unstructured grid.
    Cells,
    Verts,
    Lines,
    Polys,
    Strips,
}

/// Where arrays are, by the names of tags.
pub(super) const SECTIONS: [(&str, Section); 8] = [
    ("PointData", Section::PointData),
    ("CellData", Section::CellData),
    ("Points", Section::Points),
    ("Cells", Section::Cells),
    ("Verts", Section::Verts),
    ("Lines", Section::Lines),
    ("Polys", Section::Polys),
    ("Strips", Section::Strips),
];

/// Cells, in the order that their data have.
pub(super) const CELLS: [(&str, Section); 5] = [
    ("NumberOfCells", Section::Cells),
    ("NumberOfVerts", Section::Verts),
    ("NumberOfLines", Section::Lines),
    ("NumberOfPolys", Section::Polys),
    ("NumberOfStrips", Section::Strips),
];

/// A part of the mesh: points, cells, and their arrays.
pub(super) struct Piece {
    pub(super) points: u64,
    /// As [`CELLS`] has them.
    pub(super) cells: [u64; 5],
    /// In the order of their tags.
    pub(super) arrays: Vec<(Section, Array)>,
    /// Arrays in the appended section, by where they begin there.
    pub(super) appended: Vec<(u64, Section, Array)>,
    /// Where its tag is.
    pub(super) byte: u64,
}

impl Piece {
    /// How many entries the arrays of a section have; vertices of cells are as many or more.
    pub(super) fn count(&self, section: Section) -> u64 {
        match section {
            Section::PointData | Section::Points => self.points,
            Section::CellData => self.cells.iter().sum(),
            cells => CELLS.iter().zip(self.cells).find(|((_, known), _)| *known == cells).map_or(0, |(_, count)| count),
        }
    }

    /// Takes an array out.
    pub(super) fn take(&mut self, section: Section, name: Option<&str>) -> Option<Array> {
        let is_it = |(of, array): &(Section, Array)| *of == section && name.is_none_or(|name| array.name == name);
        self.arrays.iter().position(is_it).map(|i| self.arrays.remove(i).1)
    }
}

/// A file, its arrays not yet looked at.
pub(super) struct Grid<'a> {
    pub(super) head: Head<'a>,
    pub(super) kind: Type,
    pub(super) pieces: Vec<Piece>,
}

/// Why the bytes of an array could not be read.
pub(super) fn misread(error: &std::io::Error, array: &Array, head: Head<'_>) -> Error {
    match error.kind() {
        ErrorKind::UnexpectedEof => {
            array.error(head, "ends before all is there that its sizes announce", "the file is cut off or damaged")
        }
        ErrorKind::InvalidData => array.error(head, &format!("holds {error}"), "the file is damaged"),
        kind => Error::Io { path: head.place.into(), source: std::io::Error::new(kind, error.to_string()) },
    }
}
