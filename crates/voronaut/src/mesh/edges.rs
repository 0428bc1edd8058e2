//! The edges of a list of triangles, and which triangles have them: found by sorting, so in the same order on every machine.

use crate::lists::{Classes, Rows, distinct, in_order};
use crate::parallel::prelude::*;
use smallvec::SmallVec;
use std::borrow::Cow;

/// Tables by vertices may have so many rows for each triangle; meshes have half a vertex for each.
const SPREAD: usize = 4;

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

/// The sides of one edge, in the order of their half-edges.
pub(crate) type Sides = SmallVec<[EdgeSide; 2]>;

/// All edges of a triangle list. Takes 4 bytes for each half-edge beside the triangles.
pub struct Edges<'a> {
    triangles: Cow<'a, [[u32; 3]]>,
    /// Those of one edge together, in order; edges in the order of their ends.
    half_edges: Vec<u32>,
}

impl<'a> Edges<'a> {
    /// Finds the edges of the triangles, in O(n log n); where numbers of vertices are not much greater than how many there are, in O(n).
    pub fn of(triangles: impl Into<Cow<'a, [[u32; 3]]>>) -> Self {
        let triangles = triangles.into();
        let by_ends = |&h: &u32| (ends_of(&triangles, h), h);
        let all = 0..3 * triangles.len() as u32;
        let vertices = triangles.as_flattened().iter().max().map_or(0, |&v| (v as usize).saturating_add(1));
        let half_edges = if vertices <= SPREAD * triangles.len() {
            let rows = Rows::new(vertices, all.map(|h| (ends_of(&triangles, h)[0], h)));
            rows.into_sorted_by_key(by_ends)
        } else {
            let mut list: Vec<u32> = all.collect();
            list.sort_unstable_by_key(by_ends);
            list
        };
        Self { triangles, half_edges }
    }

    /// The sides of each edge, in increasing order of its ends.
    pub fn iter(&self) -> impl Iterator<Item = Sides> {
        self.groups().map(|same| self.sides(same))
    }

    /// The ends of each edge, the smaller first, in increasing order.
    pub fn ends(&self) -> impl Iterator<Item = [u32; 2]> {
        self.groups().map(|same| ends_of(&self.triangles, same[0]))
    }

    /// The first half-edge of each edge, in the order of the edges.
    pub(crate) fn firsts(&self) -> Vec<u32> {
        let ends = |i: usize| ends_of(&self.triangles, self.half_edges[i]);
        let all = (0..self.half_edges.len()).into_par_iter().with_min_len(4096);
        all.filter(|&i| i == 0 || ends(i) != ends(i - 1)).map(|i| self.half_edges[i]).collect()
    }

    /// The sides of the edge between two vertices; none where there is no edge.
    pub fn at(&self, ends: [u32; 2]) -> Sides {
        let ends = in_order(ends);
        let start = self.half_edges.partition_point(|&h| ends_of(&self.triangles, h) < ends);
        let from_there = &self.half_edges[start..];
        let count = from_there.iter().take_while(|&&h| ends_of(&self.triangles, h) == ends).count();
        self.sides(&from_there[..count])
    }

    /// The sides of edges of one triangle only, in the order of the edges.
    pub fn boundary(&self) -> impl Iterator<Item = EdgeSide> {
        self.groups().filter_map(|same| if let [alone] = *same { Some(self.side(alone)) } else { None })
    }

    /// For each half-edge the one on the other side; [`NONE`] on the boundary and where the edge is not manifold.
    pub(crate) fn twins(&self) -> Vec<u32> {
        let mut twins = vec![NONE; self.half_edges.len()];
        for same in self.groups() {
            if let [s, t] = *same
                && self.are_opposite(s, t)
            {
                twins[s as usize] = t;
                twins[t as usize] = s;
            }
        }
        twins
    }

    /// The sides of each edge that has not one triangle, or two that traverse it in opposite directions; in order.
    pub(crate) fn not_manifold(&self) -> impl Iterator<Item = Sides> {
        let is_wrong = |same: &&[u32]| match **same {
            [_] => false,
            [s, t] => !self.are_opposite(s, t),
            _ => true,
        };
        self.groups().filter(is_wrong).map(|same| self.sides(same))
    }

    fn are_opposite(&self, s: u32, t: u32) -> bool {
        directed(&self.triangles, s)[0] != directed(&self.triangles, t)[0]
    }

    /// The half-edges of each edge.
    fn groups(&self) -> impl Iterator<Item = &[u32]> {
        self.half_edges.chunk_by(|&g, &h| ends_of(&self.triangles, g) == ends_of(&self.triangles, h))
    }

    fn sides(&self, half_edges: &[u32]) -> Sides {
        half_edges.iter().map(|&h| self.side(h)).collect()
    }

    /// The side that a half-edge is.
    pub(crate) fn side(&self, half_edge: u32) -> EdgeSide {
        let [a, b] = directed(&self.triangles, half_edge);
        EdgeSide { ends: in_order([a, b]), half_edge, forward: a < b }
    }
}

/// The vertices of a half-edge, in the direction of its triangle.
fn directed(triangles: &[[u32; 3]], half_edge: u32) -> [u32; 2] {
    let (corners, i) = (triangles[half_edge as usize / 3], half_edge as usize % 3);
    [corners[i], corners[(i + 1) % 3]]
}

/// The same, the smaller first.
fn ends_of(triangles: &[[u32; 3]], half_edge: u32) -> [u32; 2] {
    in_order(directed(triangles, half_edge))
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
