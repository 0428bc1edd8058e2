//! Whether two triangles in space meet where they should not, by exact predicates.

use super::tree::boxes_meet;
use super::{
    Aabb3, Bounds, Orientation, Point, Point3, around, meeting_pairs, orientation, signed_area, signed_volume,
};
use crate::parallel::prelude::*;

/// A triangle that is not flat, by the numbers and the positions of its corners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners {
    pub(crate) vertices: [u32; 3],
    pub(crate) points: [Point3; 3],
}

/// A point (rounded) that two triangles, as closed sets, have in common beyond the vertex or the edge that they share by
/// its numbers; `None` where there is none. Whether there is one is exact. Triangles with the same three vertices meet.
fn contact(t: &Corners, u: &Corners) -> Option<Point3> {
    let shared = |a: &Corners, b: &Corners| a.vertices.map(|v| b.vertices.contains(&v));
    let (of_t, of_u) = (shared(t, u), shared(u, t));
    match of_t.iter().filter(|&&is_shared| is_shared).count() {
        0 => apart(t.points, u.points),
        1 => beyond_vertex(t, of_t, u).or_else(|| beyond_vertex(u, of_u, t)),
        2 => folded(t, of_t, u, of_u),
        _ => Some(Point3::weighted(t.points, [1.0 / 3.0; 3])),
    }
}

/// All pairs of triangles that meet ([`contact`]), in order, the smaller number first, each with a point that both have, rounded; only
/// pairs of which one at least is `asked` for. Positions are finite. Fast where triangles are not much longer than their distance from
/// those that are no neighbours ([`meeting_pairs`]).
pub(crate) fn contacts(triangles: &[Corners], asked: impl Fn(usize) -> bool + Sync) -> Vec<([usize; 2], Point3)> {
    let bounds = |t: &Corners| Aabb3::of(t.points).expect("three corners").into();
    let boxes: Vec<Bounds<3>> = triangles.par_iter().with_min_len(1024).map(bounds).collect();
    meeting_pairs(&boxes, asked, |[i, j]| contact(&triangles[i], &triangles[j]))
}

/// Whether three points lie on one line, exactly: their shadows on all three coordinate planes do.
pub(crate) fn is_flat(triangle: [Point3; 3]) -> bool {
    shadow(triangle).is_none()
}

/// Triangles without a common vertex: an edge of one meets the other, or neither does.
fn apart(t: [Point3; 3], u: [Point3; 3]) -> Option<Point3> {
    if one_side(t, u) || one_side(u, t) {
        return None;
    }
    sides(t).into_iter().find_map(|side| meet(side, u)).or_else(|| sides(u).into_iter().find_map(|side| meet(side, t)))
}

/// Whether all of `points` lie strictly on one side of a triangle's plane.
fn one_side([a, b, c]: [Point3; 3], points: [Point3; 3]) -> bool {
    let sides = points.map(|p| signed_volume(a, b, c, p));
    sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)
}

fn sides([a, b, c]: [Point3; 3]) -> [[Point3; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Where the edge opposite of the one common vertex meets the other triangle. What two triangles have in common is convex:
/// if it is more than the vertex, it leaves one of them through that edge.
fn beyond_vertex(t: &Corners, shared: [bool; 3], u: &Corners) -> Option<Point3> {
    let i = shared.iter().position(|&is_shared| is_shared)?;
    meet([t.points[(i + 1) % 3], t.points[(i + 2) % 3]], u.points)
}

/// The middle of the common edge of two triangles that lie in one plane, on the same side of it.
fn folded(t: &Corners, of_t: [bool; 3], u: &Corners, of_u: [bool; 3]) -> Option<Point3> {
    let i = of_t.iter().position(|&is_shared| !is_shared)?;
    let j = of_u.iter().position(|&is_shared| !is_shared)?;
    let (tip, a, b, other) = (t.points[i], t.points[(i + 1) % 3], t.points[(i + 2) % 3], u.points[j]);
    if signed_volume(a, b, tip, other) != 0.0 {
        return None;
    }
    let axis = shadow(t.points)?;
    let [tip, other, p, q] = [tip, other, a, b].map(|p| cast(axis, p));
    (orientation(p, q, tip) == orientation(p, q, other)).then(|| a.lerp(b, 0.5))
}

/// A point of a segment in a triangle, both closed.
fn meet([p, q]: [Point3; 2], [a, b, c]: [Point3; 3]) -> Option<Point3> {
    let (from, to) = (signed_volume(a, b, c, p), signed_volume(a, b, c, q));
    if from > 0.0 && to > 0.0 || from < 0.0 && to < 0.0 {
        return None;
    }
    if from == 0.0 && to == 0.0 {
        return meet_in_plane([p, q], [a, b, c]);
    }
    // The line meets the plane in one point: inside if it turns around all three sides the same way.
    let turns = [[a, b], [b, c], [c, a]].map(|[a, b]| signed_volume(p, q, a, b));
    let inside = turns.iter().all(|&turn| turn >= 0.0) || turns.iter().all(|&turn| turn <= 0.0);
    inside.then(|| p.lerp(q, from / (from - to)))
}

/// The same where the segment lies in the triangle's plane.
fn meet_in_plane([p, q]: [Point3; 2], triangle: [Point3; 3]) -> Option<Point3> {
    let axis = shadow(triangle)?;
    let [a, b, c] = triangle.map(|p| cast(axis, p));
    let (start, end) = (cast(axis, p), cast(axis, q));
    let holds = |p: Point| {
        let turns = [orientation(a, b, p), orientation(b, c, p), orientation(c, a, p)];
        !(turns.contains(&Orientation::Left) && turns.contains(&Orientation::Right))
    };
    if holds(start) {
        return Some(p);
    }
    if holds(end) {
        return Some(q);
    }
    // Both ends are outside: if the segment meets the triangle, it crosses one of its sides, or a corner.
    let crossed = [[a, b], [b, c], [c, a]].into_iter().find(|&[a, b]| {
        let across = |a, b, p, q| {
            let (left, right) = (orientation(a, b, p), orientation(a, b, q));
            left != right || left == Orientation::Collinear
        };
        across(a, b, start, end) && across(start, end, a, b)
            // Segments of one line meet where their boxes do.
            && boxes_meet(&around([a, b]), &around([start, end]))
    });
    crossed.map(|[a, b]| {
        let (from, to) = (signed_area(a, b, start), signed_area(a, b, end));
        let share = from / (from - to);
        p.lerp(q, if share.is_finite() { share } else { 0.5 })
    })
}

/// The coordinate that can be left out of a triangle's plane without losing the triangle.
fn shadow(triangle: [Point3; 3]) -> Option<usize> {
    (0..3).find(|&axis| {
        let [a, b, c] = triangle.map(|p| cast(axis, p));
        orientation(a, b, c) != Orientation::Collinear
    })
}

/// A point without one of its coordinates.
fn cast(axis: usize, p: Point3) -> Point {
    match axis {
        0 => Point::new(p.y, p.z),
        1 => Point::new(p.z, p.x),
        _ => Point::new(p.x, p.y),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_cases::cases;
    use proptest::prelude::*;

    fn corners(vertices: [u32; 3], points: [[i64; 3]; 3], scale: f64) -> Corners {
        Corners { vertices, points: points.map(|p| p.map(|x| x as f64 * scale).into()) }
    }

    /// Whether triangles 0 1 2 and 3 4 5 meet, the latter with other numbers where they are given.
    fn meets(t: [[i64; 3]; 3], u: [[i64; 3]; 3], numbers: [u32; 3]) -> bool {
        let all = [1e-9, 1.0, 1e9].map(|scale| {
            let (t, u) = (corners([0, 1, 2], t, scale), corners(numbers, u, scale));
            let found = contact(&t, &u);
            assert_eq!(found.is_some(), contact(&u, &t).is_some());
            found.is_some()
        });
        assert!(all.iter().all(|&one| one == all[0]), "{all:?}");
        all[0]
    }

    const FLOOR: [[i64; 3]; 3] = [[0, 0, 0], [8, 0, 0], [0, 8, 0]];

    #[test]
    fn triangles_without_a_common_vertex() {
        let with = |u| meets(FLOOR, u, [3, 4, 5]);
        assert!(with([[1, 1, -1], [1, 1, 1], [9, 9, 1]]), "an edge through the face");
        assert!(with([[1, -4, -1], [1, 4, 1], [5, -9, 0]]), "edges that cross");
        assert!(with([[1, 1, 0], [1, 1, 5], [2, 1, 5]]), "a vertex on the face");
        assert!(with([[4, 4, 0], [4, 4, 5], [9, 9, 5]]), "a vertex on an edge");
        assert!(with([[8, 0, 0], [9, 0, 5], [9, 1, 5]]), "a vertex on a vertex");
        assert!(with([[0, 0, 0], [8, 0, 0], [0, 0, 8]]), "an edge on an edge");
        assert!(with([[1, 1, 0], [2, 1, 0], [1, 2, 0]]), "coplanar, inside");
        assert!(with([[-9, -9, 0], [50, -9, 0], [-9, 50, 0]]), "coplanar, around");
        assert!(with([[-1, 2, 0], [9, 2, 0], [4, 3, 0]]), "coplanar, across");
        assert!(with([[8, 0, 0], [9, 0, 0], [9, 1, 0]]), "coplanar, touching");
        assert!(!with([[5, 4, 0], [9, 4, 0], [5, 9, 0]]), "coplanar, beside");
        assert!(!with([[0, 0, 1], [8, 0, 1], [0, 8, 1]]), "above");
        assert!(!with([[5, 4, -1], [5, 4, 1], [9, 9, 0]]), "through the plane, outside the triangle");
    }

    #[test]
    fn neighbours() {
        let at_vertex = |p, q| meets(FLOOR, [[0, 0, 0], p, q], [0, 4, 5]);
        assert!(!at_vertex([-4, 0, 0], [0, -4, 0]), "coplanar, opposite");
        assert!(!at_vertex([-1, 9, 0], [-2, 9, 0]), "coplanar, beside");
        assert!(at_vertex([2, 1, 0], [1, 2, 0]), "coplanar, inside");
        assert!(at_vertex([9, 0, 0], [9, -9, 0]), "coplanar, along an edge");
        assert!(at_vertex([2, 2, 0], [0, 0, 9]), "an edge on the face");
        assert!(at_vertex([9, 9, 0], [0, 0, 9]), "an edge along the face and beyond it");
        assert!(at_vertex([3, 1, 1], [1, 3, -1]), "through the face");
        assert!(!at_vertex([3, 1, 1], [1, 3, 1]), "above the face");
        assert!(!at_vertex([3, -1, 1], [1, -3, -1]), "through the plane, behind the vertex");
        let at_edge = |tip| meets(FLOOR, [[8, 0, 0], [0, 0, 0], tip], [1, 0, 5]);
        assert!(at_edge([1, 1, 0]) && at_edge([100, 3, 0]), "folded flat");
        assert!(!at_edge([1, -1, 0]), "unfolded flat");
        assert!(!at_edge([1, 1, 1]) && !at_edge([1, 3, -1]), "at an angle");
        assert!(meets(FLOOR, [FLOOR[1], FLOOR[0], FLOOR[2]], [1, 0, 2]), "back to back");
    }

    #[test]
    fn nearly_is_not_quite() {
        let tip = |z: f64| Corners {
            vertices: [3, 4, 5],
            points: [[0.1, 0.2, z], [0.1, 0.2, 1.0], [0.3, 0.2, 1.0]].map(Point3::from),
        };
        let floor =
            Corners { vertices: [0, 1, 2], points: [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from) };
        assert!(contact(&floor, &tip(0.0)).is_some() && contact(&floor, &tip(1e-300)).is_none());
        // One unit in the last place off a slanting plane through 0.1, 0.2, 0.3, which binary numbers do not hold.
        let slant = |x: f64| {
            let [a, b, c] = [[0.1, 0.2, 0.3], [0.7, 0.1, 0.9], [0.3, 0.8, 0.2]].map(Point3::from);
            let d = a + (b - a) * x + (c - a) * x;
            let side = signed_volume(a, b, c, d);
            let away = Point3::new(d.x, d.y, d.z + if side > 0.0 { -1e-3 } else { 1e-3 });
            let t = Corners { vertices: [0, 1, 2], points: [a, b, c] };
            let u = Corners { vertices: [3, 4, 5], points: [d, away, away + (c - a)] };
            (side == 0.0 || signed_volume(a, b, c, away).signum() != side.signum()) == contact(&t, &u).is_some()
        };
        assert!((1..50).all(|i| slant(f64::from(i) * 0.01)));
    }

    type Integer = [i64; 3];

    fn minus(a: Integer, b: Integer) -> Integer {
        [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
    }

    fn cross(a: Integer, b: Integer) -> Integer {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    }

    fn dot(a: Integer, b: Integer) -> i64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    /// Whether a triangle and a triangle or segment meet: no axis separates them, in integers. The axes are the normals, the
    /// products of edges, and in the plane the normals of edges.
    fn not_separated(t: [Integer; 3], u: &[Integer]) -> bool {
        let edges = |p: &[Integer]| (0..p.len()).map(|i| minus(p[(i + 1) % p.len()], p[i])).collect::<Vec<_>>();
        let (of_t, of_u) = (edges(&t), edges(u));
        let normal = cross(of_t[0], of_t[1]);
        let mut axes = vec![normal, cross(of_u[0], of_u[1])];
        axes.extend(of_t.iter().flat_map(|&e| of_u.iter().map(move |&f| cross(e, f))));
        axes.extend(of_t.iter().chain(&of_u).map(|&e| cross(normal, e)));
        let range = |axis: Integer, points: &[Integer]| {
            let values = points.iter().map(|&p| dot(axis, p));
            (values.clone().min(), values.max())
        };
        axes.iter().all(|&axis| {
            let ((low, high), (least, most)) = (range(axis, &t), range(axis, u));
            low <= most && least <= high
        })
    }

    proptest! {
        #![proptest_config(cases(4000))]
        #[test]
        fn random_triangles_on_a_small_grid(
            p in prop::collection::vec(prop::array::uniform3(0_i64..4), 6), exponent in -60..60,
        ) {
            let (t, u) = ([p[0], p[1], p[2]], [p[3], p[4], p[5]]);
            let is_flat = |t: [Integer; 3]| cross(minus(t[1], t[0]), minus(t[2], t[0])) == [0; 3];
            let scale = f64::from(exponent).exp2();
            prop_assert_eq!(super::is_flat(corners([0, 1, 2], t, scale).points), is_flat(t));
            prop_assume!(!is_flat(t) && !is_flat(u));
            let found = |u, numbers| contact(&corners([0, 1, 2], t, scale), &corners(numbers, u, scale)).is_some();
            prop_assert_eq!(found(u, [3, 4, 5]), not_separated(t, &u));
            // With a common vertex: the cone of the one against the far edge of the other.
            let fan = [t[0], p[3], p[4]];
            if !is_flat(fan) {
                let far = |q: Integer| [0, 1, 2].map(|i| t[0][i] + 1000 * (q[i] - t[0][i]));
                prop_assert_eq!(found(fan, [0, 4, 5]), not_separated([t[0], far(t[1]), far(t[2])], &fan[1..]));
            }
            // With a common edge.
            let leaf = [t[1], t[0], p[3]];
            if !is_flat(leaf) {
                let along = minus(t[1], t[0]);
                let sides = [t[2], p[3]].map(|tip| cross(along, minus(tip, t[0])));
                let is_folded = cross(sides[0], sides[1]) == [0; 3] && dot(sides[0], sides[1]) > 0;
                prop_assert_eq!(found(leaf, [1, 0, 5]), is_folded);
            }
        }
    }
}
