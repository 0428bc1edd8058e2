//! The edges of a list of triangles, and which triangles have them: found by sorting, so in the same order on every machine.

use crate::lists::{Classes, distinct, in_order};
use crate::parallel::prelude::*;

/// No half-edge on the other side.
pub(crate) const NONE: u32 = u32::MAX;

/// One side of an edge: a triangle that has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeSide {
    /// The edge's vertices, the smaller first.
    pub ends: [u32; 2],
    /// The half-edge: `3 t + i` runs from corner `i` of triangle `t` to its next corner.
    pub half_edge: u32,
    /// Whether the triangle passes from the smaller to the larger.
    pub forward: bool,
}

impl EdgeSide {
    /// The number of the triangle.
    pub fn triangle(&self) -> usize {
        self.half_edge as usize / 3
    }

    /// The edge's vertices, in the direction of the triangle.
    pub(crate) fn directed(&self) -> [u32; 2] {
        let [a, b] = self.ends;
        if self.forward { [a, b] } else { [b, a] }
    }
}

/// All edges of a triangle list.
pub struct Edges {
    /// Those of one edge together, in the order of their half-edges; edges in the order of their ends.
    sides: Vec<EdgeSide>,
}

impl Edges {
    /// Finds the edges of the triangles, in O(n log n).
    pub fn of(triangles: &[[u32; 3]]) -> Self {
        let side = |half_edge: u32| {
            let ends = edges_of(triangles[half_edge as usize / 3])[half_edge as usize % 3];
            EdgeSide { ends: in_order(ends), half_edge, forward: ends[0] < ends[1] }
        };
        let mut sides: Vec<EdgeSide> = (0..3 * triangles.len() as u32).into_par_iter().map(side).collect();
        sides.par_sort_unstable();
        Self { sides }
    }

    /// The sides of each edge, in increasing order.
    pub fn iter(&self) -> impl Iterator<Item = &[EdgeSide]> {
        self.sides.chunk_by(|s, t| s.ends == t.ends)
    }

    /// The ends of each edge, the smaller first, in increasing order.
    pub fn ends(&self) -> impl Iterator<Item = [u32; 2]> {
        self.iter().map(|sides| sides[0].ends)
    }

    /// The sides of the edge between two vertices; none where there is no edge.
    pub fn at(&self, ends: [u32; 2]) -> &[EdgeSide] {
        let ends = in_order(ends);
        let start = self.sides.partition_point(|side| side.ends < ends);
        let count = self.sides[start..].iter().take_while(|side| side.ends == ends).count();
        &self.sides[start..start + count]
    }

    /// The sides of edges of one triangle only, in the order of the edges.
    pub fn boundary(&self) -> impl Iterator<Item = EdgeSide> {
        self.iter().filter_map(|sides| if let [alone] = sides { Some(*alone) } else { None })
    }

    /// For each half-edge the one on the other side; [`NONE`] on the boundary and where the edge is not manifold.
    pub(crate) fn twins(&self) -> Vec<u32> {
        let mut twins = vec![NONE; self.sides.len()];
        for sides in self.iter() {
            if let [s, t] = sides
                && is_manifold(sides)
            {
                twins[s.half_edge as usize] = t.half_edge;
                twins[t.half_edge as usize] = s.half_edge;
            }
        }
        twins
    }
}

/// Whether an edge has one or two triangles, and two traverse it in opposite directions.
pub(crate) fn is_manifold(sides: &[EdgeSide]) -> bool {
    match sides {
        [_] => true,
        [s, t] => s.forward != t.forward,
        _ => false,
    }
}

/// The edges of a triangle, in its direction.
pub(crate) fn edges_of([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// The half-edge after one, around its triangle.
pub(crate) fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

/// The half-edge before one, around its triangle.
pub(crate) fn previous(half_edge: u32) -> u32 {
    next(next(half_edge))
}

/// The corners of triangles, each with the number of the half-edge that leaves it, in classes: those of a vertex that can be reached
/// from each other across edges with a twin. `are_alike` says of half-edges that are twins whether they run in one direction.
pub(crate) fn fans(twins: &[u32], are_alike: impl Fn(u32, u32) -> bool) -> Classes {
    let mut fans = Classes::new(twins.len());
    for (h, &twin) in (0..).zip(twins).filter(|(h, twin)| **twin != NONE && h < *twin) {
        let [start, end] = if are_alike(h, twin) { [twin, next(twin)] } else { [next(twin), twin] };
        fans.join(h, start);
        fans.join(next(h), end);
    }
    fans.flatten();
    fans
}

/// The vertices whose corners are in several of these classes, in order.
pub(crate) fn vertices_of_several(fans: &Classes, corners: &[u32]) -> Vec<u32> {
    let mut first = vec![NONE; corners.iter().max().map_or(0, |&v| v as usize + 1)];
    let has_another = |&(h, &v): &(u32, &u32)| {
        let (fan, known) = (fans.of(h), &mut first[v as usize]);
        *known = if *known == NONE { fan } else { *known };
        *known != fan
    };
    distinct((0..).zip(corners).filter(has_another).map(|(_, &v)| v))
}
