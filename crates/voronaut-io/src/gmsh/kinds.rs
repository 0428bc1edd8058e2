//! Gmsh's types of elements.

use crate::volumes::Solid;

/// What is read, and written.
pub(super) const EDGE: i32 = 1;
pub(super) const TRIANGLE: i32 = 2;
pub(super) const QUADRANGLE: i32 = 3;
pub(super) const POINT: i32 = 15;

/// A type of elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Kind {
    /// What files call it.
    pub(super) code: i32,
    /// How many nodes an element has.
    pub(super) nodes: usize,
    /// For messages.
    pub(super) name: &'static str,
}

impl Kind {
    /// The type that files call `code`; `None` of others.
    pub(super) fn of(code: i32) -> Option<Self> {
        let nodes = match code {
            36 => 16,
            92 => 64,
            93 => 125,
            _ => *NODES.get(usize::try_from(code).ok()?.checked_sub(1)?)?,
        };
        let name = match code {
            EDGE => "edges",
            TRIANGLE => "triangles",
            QUADRANGLE => "quadrangles",
            POINT => "points",
            4 => "tetrahedra",
            5 => "hexahedra",
            6 => "prisms",
            7 => "pyramids",
            8 | 26..=28 => "curved edges",
            9 | 20..=25 => "curved triangles",
            10 | 16 | 36 => "curved quadrangles",
            _ => "curved volume elements",
        };
        Some(Self { code, nodes, name })
    }

    /// Whether a triangle mesh can hold such elements, cut in two or not.
    pub(super) fn is_flat(self) -> bool {
        matches!(self.code, EDGE | TRIANGLE | QUADRANGLE | POINT)
    }

    /// What kind of cell such elements are, if they are cells with straight edges.
    pub(super) fn solid(self) -> Option<Solid> {
        SOLIDS.iter().find(|(code, _)| *code == self.code).map(|&(_, solid)| solid)
    }
}

/// Cells of volumes, of which the outside may be taken.
const SOLIDS: [(i32, Solid); 4] =
    [(4, Solid::Tetrahedron), (5, Solid::Hexahedron), (6, Solid::Prism), (7, Solid::Pyramid)];

/// How many nodes elements of types 1 to 31 have, after "Node ordering" and "MSH file format" of Gmsh's manual.
const NODES: [usize; 31] =
    [2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5, 6, 20, 35, 56];
