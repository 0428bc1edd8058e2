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
        let &(code, nodes, name) = KINDS.iter().find(|(known, ..)| *known == code)?;
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

const CURVED_EDGES: &str = "curved edges";
const CURVED_TRIANGLES: &str = "curved triangles";
const CURVED_QUADRANGLES: &str = "curved quadrangles";
const VOLUMES: &str = "curved volume elements";

/// Code, nodes and name, after "Node ordering" and "MSH file format" of Gmsh's manual.
const KINDS: [(i32, usize, &str); 34] = [
    (EDGE, 2, "edges"),
    (TRIANGLE, 3, "triangles"),
    (QUADRANGLE, 4, "quadrangles"),
    (4, 4, "tetrahedra"),
    (5, 8, "hexahedra"),
    (6, 6, "prisms"),
    (7, 5, "pyramids"),
    (8, 3, CURVED_EDGES),
    (9, 6, CURVED_TRIANGLES),
    (10, 9, CURVED_QUADRANGLES),
    (11, 10, VOLUMES),
    (12, 27, VOLUMES),
    (13, 18, VOLUMES),
    (14, 14, VOLUMES),
    (POINT, 1, "points"),
    (16, 8, CURVED_QUADRANGLES),
    (17, 20, VOLUMES),
    (18, 15, VOLUMES),
    (19, 13, VOLUMES),
    (20, 9, CURVED_TRIANGLES),
    (21, 10, CURVED_TRIANGLES),
    (22, 12, CURVED_TRIANGLES),
    (23, 15, CURVED_TRIANGLES),
    (24, 15, CURVED_TRIANGLES),
    (25, 21, CURVED_TRIANGLES),
    (26, 4, CURVED_EDGES),
    (27, 5, CURVED_EDGES),
    (28, 6, CURVED_EDGES),
    (29, 20, VOLUMES),
    (30, 35, VOLUMES),
    (31, 56, VOLUMES),
    (36, 16, CURVED_QUADRANGLES),
    (92, 64, VOLUMES),
    (93, 125, VOLUMES),
];
