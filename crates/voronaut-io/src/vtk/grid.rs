//! The pieces of a file, and the arrays of each.

use super::numbers::Array;
use super::stored::Layout;

/// The two types of files that are read.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    /// `.vtu`
    UnstructuredGrid,
    /// `.vtp`
    PolyData,
}

impl Type {
    /// What its tag is called.
    pub(super) fn name(self) -> &'static str {
        if self == Type::PolyData { "PolyData" } else { "UnstructuredGrid" }
    }
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
pub(super) struct Piece<'a> {
    pub(super) points: u64,
    /// As [`CELLS`] has them.
    pub(super) cells: [u64; 5],
    /// In the order of their tags.
    pub(super) arrays: Vec<(Section, Array<'a>)>,
    /// Arrays in the appended section, by where they begin there.
    pub(super) appended: Vec<(u64, Section, Array<'a>)>,
    /// Where its tag is.
    pub(super) byte: u64,
}

impl<'a> Piece<'a> {
    /// How many entries the arrays of a section have; vertices of cells are as many or more.
    pub(super) fn count(&self, section: Section) -> u64 {
        match section {
            Section::PointData | Section::Points => self.points,
            Section::CellData => self.cells.iter().sum(),
            cells => CELLS.iter().zip(self.cells).find(|((_, known), _)| *known == cells).map_or(0, |(_, count)| count),
        }
    }

    /// Takes an array out.
    pub(super) fn take(&mut self, section: Section, name: Option<&str>) -> Option<Array<'a>> {
        let is_it = |(of, array): &(Section, Array<'_>)| *of == section && name.is_none_or(|name| array.name == name);
        self.arrays.iter().position(is_it).map(|i| self.arrays.remove(i).1)
    }
}

/// A file, its arrays not yet looked at.
pub(super) struct Grid<'a> {
    /// What messages call it.
    pub(super) file: &'a str,
    pub(super) layout: Layout,
    pub(super) kind: Type,
    pub(super) pieces: Vec<Piece<'a>>,
}
