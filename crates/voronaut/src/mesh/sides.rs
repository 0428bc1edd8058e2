//! The edges of a list of triangles, and which triangles have them.

use crate::lists::in_order;

/// One side of an edge: a triangle that has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Side {
    /// The edge's vertices, the smaller first.
    pub ends: [u32; 2],
    /// The number of the triangle.
    pub triangle: u32,
    /// Whether the triangle passes from the smaller to the larger.
    pub forward: bool,
}

/// The edges of a triangle, in its direction.
pub(crate) fn edges_of([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// All sides, sorted by their edges.
pub(crate) fn sides(triangles: impl IntoIterator<Item = [u32; 3]>) -> Vec<Side> {
    let of_triangle = |(triangle, corners)| {
        edges_of(corners).map(|ends| Side { ends: in_order(ends), triangle, forward: ends[0] < ends[1] })
    };
    let mut sides: Vec<Side> = (0..).zip(triangles).flat_map(of_triangle).collect();
    sides.sort_unstable();
    sides
}

/// All sides of each edge, of sorted ones.
pub(crate) fn by_edge(sides: &[Side]) -> impl Iterator<Item = &[Side]> {
    sides.chunk_by(|s, t| s.ends == t.ends)
}

/// The sides of edges of one triangle only, of sorted ones.
pub(crate) fn borders(sides: &[Side]) -> impl Iterator<Item = Side> {
    by_edge(sides).filter_map(|same| if let [alone] = same { Some(*alone) } else { None })
}

/// The sides of one edge, of sorted ones.
pub(crate) fn sides_at(sides: &[Side], ends: [u32; 2]) -> &[Side] {
    let start = sides.partition_point(|side| side.ends < ends);
    let count = sides[start..].iter().take_while(|side| side.ends == ends).count();
    &sides[start..start + count]
}
