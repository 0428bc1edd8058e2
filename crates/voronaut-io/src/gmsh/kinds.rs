//! Gmsh's types of elements.

/// What is written.
pub(super) const EDGE: i32 = 1;
pub(super) const TRIANGLE: i32 = 2;
pub(super) const POINT: i32 = 15;

/// A type of elements.
#[derive(Clone, Copy)]
pub(super) struct Kind {
    /// What files call it.
    pub(super) code: i32,
    /// How many nodes an element has.
    pub(super) nodes: usize,
    pub(super) shape: Shape,
}

/// What a triangle mesh makes of elements of a type.
#[derive(Clone, Copy)]
pub(super) enum Shape {
    Point,
    Edge,
    /// A triangle, or a quadrangle that is cut in two.
    Face,
    /// A cell with straight edges, of which the outside may be taken.
    Solid,
    /// Nothing: what such elements are called.
    Foreign(&'static str),
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
        let shape = match code {
            POINT => Shape::Point,
            EDGE => Shape::Edge,
            TRIANGLE | 3 => Shape::Face,
            4..=7 => Shape::Solid,
            8 | 26..=28 => Shape::Foreign("curved edges"),
            9 | 20..=25 => Shape::Foreign("curved triangles"),
            10 | 16 | 36 => Shape::Foreign("curved quadrangles"),
            _ => Shape::Foreign("curved volume elements"),
        };
        Some(Self { code, nodes, shape })
    }

    pub(super) fn dimension(self) -> u8 {
        match self.shape {
            Shape::Point => 0,
            Shape::Edge => 1,
            Shape::Face => 2,
            Shape::Solid | Shape::Foreign(_) => 3,
        }
    }
}

/// How many nodes elements of types 1 to 31 have, after "Node ordering" and "MSH file format" of Gmsh's manual.
const NODES: [usize; 31] =
    [2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5, 6, 20, 35, 56];
