//! Lines in the plane that cross, decided exactly.

use super::edges::Edges;
use super::segments::{Piece, Segments};
use crate::geometry::{Aabb, Orientation, Point, orientation};
use crate::mesh::Mesh;
use rayon::prelude::*;

/// Two polylines that meet elsewhere than at a common point of both.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Crossing {
    /// The two polylines, the smaller number first.
    pub paths: [u32; 2],
    /// The number of the segment of each that meets the other one.
    pub segments: [u32; 2],
}

/// All places where two of these polylines meet, in order: pairs of segments that have a point in common that is not an end
/// of both, by exact predicates. Polylines that share a seed, or bend around the same corner, do not cross there; those
/// that run along each other do. A polyline is not held against itself. Points that are not finite meet nothing.
pub(crate) fn crossings<P: AsRef<[Point]> + Sync>(paths: &[P]) -> Vec<Crossing> {
    let mut origins = Vec::new();
    let mut pieces = Vec::new();
    for (path, points) in (0..).zip(paths) {
        for (segment, w) in (0..).zip(points.as_ref().windows(2)) {
            if w[0].is_finite() && w[1].is_finite() {
                pieces.push(Piece { a: w[0], b: w[1], id: origins.len() as u32 });
                origins.push(([path, segment], [w[0], w[1]]));
            }
        }
    }
    let segments = Segments::new(pieces);
    let of_one = |(i, &([path, segment], ends)): (usize, &([u32; 2], [Point; 2]))| {
        let near = Aabb::of(ends).into_iter().flat_map(|bounds| segments.meeting(bounds));
        let others = near.map(|piece| piece.id as usize).filter(|&j| j > i);
        let others = others.map(|j| origins[j]).filter(|([other, _], them)| *other != path && meet(ends, *them));
        let found = others.map(|([other, with], _)| Crossing { paths: [path, other], segments: [segment, with] });
        found.collect::<Vec<_>>()
    };
    let mut all: Vec<Crossing> = origins.par_iter().enumerate().flat_map_iter(of_one).collect();
    all.sort_unstable();
    all
}

/// The pairs of straight edges without a common vertex that cross or touch, in order: where a dual does not embed. Edges
/// with a vertex that does not exist are left out.
pub fn crossing_edges(mesh: &Mesh) -> Vec<[[u32; 2]; 2]> {
    let exists = |t: &&[u32; 3]| t.iter().all(|&v| (v as usize) < mesh.points.len());
    let triangles: Vec<[u32; 3]> = mesh.triangles.iter().filter(exists).copied().collect();
    let edges: Vec<[u32; 2]> = Edges::of(&triangles).iter().map(|e| e.0).filter(|[a, b]| a != b).collect();
    let paths: Vec<[Point; 2]> = edges.iter().map(|e| e.map(|v| mesh.point(v))).collect();
    let pairs = crossings(&paths).into_iter().map(|c| c.paths.map(|i| edges[i as usize]));
    pairs.filter(|[e, f]| !e.iter().any(|v| f.contains(v))).collect()
}

/// Whether two segments whose bounding boxes meet have a point in common that is not an end of both.
fn meet([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    let shared = [(a, b, c, d), (a, b, d, c), (b, a, c, d), (b, a, d, c)].into_iter().find(|s| s.0 == s.2);
    if let Some((at, p, _, q)) = shared {
        return orientation(at, p, q) == Orientation::Collinear && (p - at).dot(q - at) > 0.0;
    }
    let apart = |a: Point, b: Point, c: Point, d: Point| {
        let (left, right) = (orientation(a, b, c), orientation(a, b, d));
        left == right && left != Orientation::Collinear
    };
    !apart(a, b, c, d) && !apart(c, d, a, b)
}

#[cfg(test)]
mod tests {
    use super::super::test_meshes::{grid, mesh};
    use super::*;

    fn line(points: &[(f64, f64)]) -> Vec<Point> {
        points.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    #[test]
    fn lines_cross_touch_and_share_ends() {
        let first = line(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]);
        let count = |second: &[(f64, f64)]| crossings(&[first.clone(), line(second)]).len();
        assert_eq!(count(&[(0.5, -1.0), (0.5, 1.0)]), 1);
        assert_eq!(count(&[(0.5, 0.0), (0.5, 1.0)]), 1, "an end on it");
        assert_eq!(count(&[(1.0, 0.0), (1.0, 1.0)]), 0, "an end in common");
        assert_eq!(count(&[(0.0, 0.0), (0.3, 0.5), (0.6, -0.5)]), 1, "a common end, and a crossing");
        assert_eq!(count(&[(0.0, 0.0), (0.5, 0.0)]), 1, "along it");
        assert_eq!(count(&[(0.0, 0.0), (-0.5, 0.0)]), 0, "away from it");
        assert_eq!(count(&[(0.5, 1e-300), (0.5, 1.0)]), 0, "near it");
        assert_eq!(count(&[(f64::NAN, 0.0), (0.5, 1.0)]), 0);
        assert!(crossings::<Vec<Point>>(&[]).is_empty());
        let found = crossings(&[line(&[(1.5, 1.0), (1.5, -1.0)]), line(&[(9.0, 9.0), (8.0, 8.0)]), first]);
        assert_eq!(found, [Crossing { paths: [0, 2], segments: [0, 1] }]);
    }

    #[test]
    fn meshes_do_not_cross_and_folded_ones_do() {
        assert!(crossing_edges(&grid(5, 4)).is_empty());
        // The apex of the second triangle lies beyond the other side of the first.
        let folded = mesh(&[[0.0, 0.0], [1.0, 0.0], [0.5, 1.0], [0.4, -0.5]], &[[0, 1, 2], [1, 2, 3], [9, 1, 2]]);
        assert_eq!(crossing_edges(&folded), [[[0, 1], [2, 3]]]);
    }
}
