//! Triangles in space that cross each other.

use super::closest::Sheet;
use crate::geometry::{Aabb3, Bounds, BoxTree, Point3};
use crate::parallel::prelude::*;
use crate::triangulation::FaceId;
use robust::{Coord3D, orient3d};

/// All pairs of triangles of which an edge of one passes through the inside of the other, by exact predicates, in order, the
/// smaller number first; only pairs of which one at least is `asked` for. What lies in one plane, or only touches, does not
/// cross.
pub(super) fn crossings(sheet: &Sheet, asked: impl Fn(FaceId) -> bool + Sync) -> Vec<[FaceId; 2]> {
    let bounds = |f: FaceId| -> Bounds<3> { Aabb3::of(sheet.triangle(f)).expect("three corners").into() };
    let faces: Vec<FaceId> = sheet.topology.faces().collect();
    let tree = BoxTree::new(faces.iter().map(|&f| (bounds(f), f)));
    let of_one = |&f: &FaceId| {
        let near = tree.meeting(bounds(f)).copied();
        // Of two that are asked for, the smaller one looks.
        let others = near.filter(|&g| if asked(g) { f < g } else { f != g });
        others.filter(|&g| cross(sheet, f, g)).map(|g| [f.min(g), f.max(g)]).collect::<Vec<_>>()
    };
    let mut all: Vec<_> = faces.par_iter().filter(|&&f| asked(f)).flat_map_iter(of_one).collect();
    all.sort_unstable();
    all
}

fn cross(sheet: &Sheet, f: FaceId, g: FaceId) -> bool {
    pierces(sheet, f, g) || pierces(sheet, g, f)
}

/// Whether an edge of f passes through the inside of g; edges with an end in common with g do not.
fn pierces(sheet: &Sheet, f: FaceId, g: FaceId) -> bool {
    let taken = sheet.topology.corners(g);
    let through = sheet.triangle(g);
    f.half_edges().into_iter().any(|h| {
        let ends = [sheet.topology.origin(h), sheet.topology.target(h)];
        !ends.iter().any(|v| taken.contains(v)) && passes(ends.map(|v| sheet.positions[v.index()]), through)
    })
}

fn passes([p, q]: [Point3; 2], [a, b, c]: [Point3; 3]) -> bool {
    if side(a, b, c, p) * side(a, b, c, q) >= 0.0 {
        return false;
    }
    let turns = [[a, b], [b, c], [c, a]].map(|[u, v]| side(p, q, u, v));
    turns.iter().all(|&t| t > 0.0) || turns.iter().all(|&t| t < 0.0)
}

/// 1 or -1 by the side of the plane of a, b and c on which d is, 0 if on it: exact.
fn side(a: Point3, b: Point3, c: Point3, d: Point3) -> f64 {
    let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    let value = orient3d(a, b, c, d);
    if value == 0.0 { 0.0 } else { value.signum() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::triangulation::Triangulation;

    fn count(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> usize {
        let topology = Triangulation::from_triangles(points.len(), triangles, &vec![0; triangles.len()]);
        let sheet = Sheet { topology: &topology, positions: points.iter().map(|&p| p.into()).collect() };
        let all = crossings(&sheet, |_| true);
        assert_eq!(all, crossings(&sheet, |f| f == FaceId(1)), "one asks for both");
        all.len()
    }

    #[test]
    fn triangles_pierce_touch_and_share_corners() {
        let ground = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        let with = |other: [[f64; 3]; 3]| count(&[ground, other].concat(), &[[0, 1, 2], [3, 4, 5]]);
        assert_eq!(with([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]]), 1, "an edge through it");
        assert_eq!(with([[1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 0.5]]), 1, "and its edge through the other");
        assert_eq!(with([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]]), 0, "touches it");
        assert_eq!(with([[1.0, 1.0, 1e-300], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]]), 0, "is above it");
        assert_eq!(with([[1.0, 1.0, 0.0], [5.0, 1.0, 0.0], [5.0, 5.0, 0.0]]), 0, "lies in its plane");
        let fan = |other: [f64; 3], another: [f64; 3]| {
            count(&[&ground[..], &[other, another]].concat(), &[[0, 1, 2], [0, 3, 4]])
        };
        assert_eq!(fan([1.0, 1.0, 1.0], [1.0, 1.0, -1.0]), 1, "a corner in common, through it");
        assert_eq!(fan([1.0, 1.0, 1.0], [-1.0, -1.0, 1.0]), 0, "a corner in common");
    }
}
