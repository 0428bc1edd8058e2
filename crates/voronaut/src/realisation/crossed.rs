//! Ways on a surface that cross: straight in every triangle of a canvas, they do where one parts the ends of the other there.

use crate::canvas::Way;
use crate::lists::distinct;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};

/// A place on an edge: its ends, and the share of the way from the first to the second; a vertex twice for that.
type OnEdge = ([VertexId; 2], f64);

/// Where a way goes through a face: its number, and where around the face it comes in and leaves.
struct Passage {
    face: FaceId,
    way: u32,
    around: [f64; 2],
}

/// Pairs of ways, by number, smaller first, that cross elsewhere than where they end.
pub(super) fn crossed(topology: &Triangulation, ways: &[Option<Way>]) -> Vec<[u32; 2]> {
    let of_way = |(number, way): (u32, &Option<Way>)| {
        let pieces = way.iter().flat_map(|way| way.on.windows(2).map(|ends| [ends[0], ends[1]]));
        pieces.filter_map(|ends| passage(topology, number, ends)).collect::<Vec<_>>()
    };
    let mut passages: Vec<Passage> = (0..).zip(ways).flat_map(of_way).collect();
    passages.sort_by_key(|passage| (passage.face, passage.way));
    let mut pairs = Vec::new();
    for in_face in passages.chunk_by(|a, b| a.face == b.face) {
        for (i, passage) in in_face.iter().enumerate() {
            let others = in_face[i + 1..].iter().filter(|other| other.way != passage.way);
            pairs.extend(
                others.filter(|other| part(passage.around, other.around)).map(|other| [passage.way, other.way]),
            );
        }
    }
    distinct(pairs)
}

/// Of two places the first face that has both.
fn passage(topology: &Triangulation, way: u32, ends: [OnEdge; 2]) -> Option<Passage> {
    let ([a, b], _) = ends[0];
    let faces: Vec<FaceId> = if a == b {
        topology.star(a).map(HalfEdge::face).collect()
    } else {
        topology.sides(topology.edge_between(a, b)?).map(HalfEdge::face).collect()
    };
    faces.into_iter().find_map(|face| {
        let [from, to] = ends.map(|on| around(topology, face, on));
        Some(Passage { face, way, around: [from?, to?] })
    })
}

/// Where around a face a place is: i at corner i, from there towards 3, which is 0.
fn around(topology: &Triangulation, face: FaceId, ([a, b], t): OnEdge) -> Option<f64> {
    let corners = topology.corners(face);
    let number = |v: VertexId| corners.iter().position(|&corner| corner == v);
    let (i, j) = (number(a)?, number(b)?);
    let along = match j {
        _ if i == j => i as f64,
        j if j == (i + 1) % 3 => i as f64 + t,
        j => j as f64 + 1.0 - t,
    };
    Some(along % 3.0)
}

/// Whether of two chords of a convex face one parts the ends of the other; not where they have an end in common.
fn part([a, b]: [f64; 2], other: [f64; 2]) -> bool {
    let is_common = other.iter().any(|x| x.total_cmp(&a).is_eq() || x.total_cmp(&b).is_eq());
    let is_between = |x: f64| a.min(b) < x && x < a.max(b);
    !is_common && is_between(other[0]) != is_between(other[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_cross_where_one_parts_the_ends_of_the_other() {
        assert!(part([0.5, 1.5], [1.2, 2.5]) && part([2.9, 1.0], [0.0, 1.7]));
        assert!(!part([0.5, 1.5], [1.6, 2.5]) && !part([0.5, 1.5], [0.7, 1.2]));
        assert!(!part([0.0, 1.5], [0.0, 1.2]), "from one corner");
    }
}
