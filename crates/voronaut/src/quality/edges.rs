//! The edges of a triangle list, found by sorting: no hashing, the same order on every machine.

use crate::parallel::prelude::*;

/// No half-edge on the other side.
pub(crate) const NONE: u32 = u32::MAX;

/// All edges of a triangle list. Half-edge `3 t + i` runs from corner `i` of triangle `t` to its next corner.
pub struct Edges<'a> {
    triangles: &'a [[u32; 3]],
    /// (smaller vertex, larger vertex) in one number, and the half-edge; sorted.
    sorted: Vec<(u64, u32)>,
}

impl<'a> Edges<'a> {
    /// Finds the edges of the triangles, in O(n log n).
    pub fn of(triangles: &'a [[u32; 3]]) -> Self {
        let mut sorted: Vec<(u64, u32)> = (0..3 * triangles.len() as u32)
            .into_par_iter()
            .map(|half_edge| {
                let [a, b] = ends(triangles, half_edge);
                (key(a, b), half_edge)
            })
            .collect();
        sorted.par_sort_unstable();
        Self { triangles, sorted }
    }

    /// Each edge once, as its two vertices (smaller first) and its half-edges, in increasing order.
    pub fn iter(&self) -> impl Iterator<Item = ([u32; 2], &[(u64, u32)])> {
        self.sorted.chunk_by(|a, b| a.0 == b.0).map(|group| ([(group[0].0 >> 32) as u32, group[0].0 as u32], group))
    }

    /// How many edges there are.
    pub(crate) fn count(&self) -> usize {
        self.iter().count()
    }

    /// The two vertices of a half-edge, in its direction.
    pub fn ends(&self, half_edge: u32) -> [u32; 2] {
        ends(self.triangles, half_edge)
    }

    /// Whether two vertices share an edge.
    pub fn contains(&self, a: u32, b: u32) -> bool {
        self.sorted.binary_search_by_key(&key(a, b), |entry| entry.0).is_ok()
    }

    /// Whether an edge has one or two triangles, and two traverse it in opposite directions.
    pub(crate) fn is_manifold(&self, half_edges: &[(u64, u32)]) -> bool {
        match *half_edges {
            [_] => true,
            [(_, g), (_, h)] => self.ends(g)[0] != self.ends(h)[0],
            _ => false,
        }
    }

    /// For each half-edge the one on the other side; [`NONE`] on the boundary and where the edge is not manifold.
    pub(crate) fn twins(&self) -> Vec<u32> {
        let mut twins = vec![NONE; self.sorted.len()];
        for (_, half_edges) in self.iter() {
            if let [(_, g), (_, h)] = *half_edges
                && self.is_manifold(half_edges)
            {
                twins[g as usize] = h;
                twins[h as usize] = g;
            }
        }
        twins
    }

    /// The half-edges of edges with a single triangle, in the direction of that triangle, in edge order.
    pub fn boundary(&self) -> Vec<u32> {
        self.iter().filter(|(_, half_edges)| half_edges.len() == 1).map(|(_, half_edges)| half_edges[0].1).collect()
    }
}

/// The half-edge after one, around its triangle.
pub(crate) fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

/// The half-edge before one, around its triangle.
pub(crate) fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}

fn ends(triangles: &[[u32; 3]], half_edge: u32) -> [u32; 2] {
    let triangle = triangles[half_edge as usize / 3];
    [triangle[half_edge as usize % 3], triangle[next(half_edge) as usize % 3]]
}

fn key(a: u32, b: u32) -> u64 {
    u64::from(a.min(b)) << 32 | u64::from(a.max(b))
}
