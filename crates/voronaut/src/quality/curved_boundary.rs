//! Whether the sides of curved triangles that are on the boundary meet elsewhere than in their ends.
//!
//! Where no triangle folds, and the boundary of a mesh in one piece meets itself nowhere, the triangles cover each point once: so many as the boundary winds
//! around it, which is so often at each side of the boundary that it cannot be more than once anywhere.

use crate::curved::{bezier_points, side};
use crate::geometry::{Aabb, Bounds, Point, Vector, meeting_pairs};
use crate::mesh::{EdgeSide, Edges, Mesh};

/// Halvings after which two pieces that are not known to be apart count as meeting: they are as close as a billionth of a side then.
const HALVINGS: u32 = 30;

/// The Bezier points of a side.
type Curve = Vec<Point>;

/// Pairs of sides on the boundary that are not known to meet in common ends only: the vertices of both.
pub(super) fn meetings(mesh: &Mesh, edges: &Edges) -> Vec<[[u32; 2]; 2]> {
    let sides: Vec<EdgeSide> = edges.boundary().collect();
    let curve = |edge: &EdgeSide| -> Curve {
        let (points, order) = bezier_points(mesh, edge.triangle());
        side(order, edge.half_edge as usize % 3).map(|i| points[i]).collect()
    };
    let curves: Vec<Curve> = sides.iter().map(curve).collect();
    let hull = |curve: &Curve| Aabb::of(curve.iter().copied()).expect("a curve has points").into();
    let boxes: Vec<Bounds<2>> = curves.iter().map(hull).collect();
    let meet = |[i, j]: [usize; 2]| meet(&curves[i], &curves[j], HALVINGS).then_some(());
    meeting_pairs(&boxes, |_| true, meet).into_iter().map(|(pair, ())| pair.map(|i| sides[i].ends)).collect()
}

fn meet(one: &Curve, other: &Curve, halvings: u32) -> bool {
    if are_apart(one, other) || have_ends_only(one, other) {
        return false;
    }
    halvings == 0
        || halves(one).iter().any(|part| halves(other).iter().any(|of_other| meet(part, of_other, halvings - 1)))
}

/// Whether a line has the points of the one on its one side and those of the other on its other side, along a chord or an axis.
fn are_apart(one: &Curve, other: &Curve) -> bool {
    let normal = |curve: &Curve| (curve[curve.len() - 1] - curve[0]).perpendicular();
    let directions = [normal(one), normal(other), Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)];
    directions.into_iter().any(|direction| {
        let size = one.iter().chain(other).map(|p| p.x.abs().max(p.y.abs())).fold(0.0, f64::max);
        let rounding = 8.0 * f64::EPSILON * size * direction.norm();
        let span = |curve: &Curve| {
            let all = curve.iter().map(|&p| (p - one[0]).dot(direction));
            all.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| [least.min(x), most.max(x)])
        };
        let ([least, most], [other_least, other_most]) = (span(one), span(other));
        most + rounding < other_least || other_most + rounding < least
    })
}

/// Whether curves with a common end leave it between directions that the other has none of: all turns from the ones to the others go one way, or all go to
/// the opposite half of the plane.
fn have_ends_only(one: &Curve, other: &Curve) -> bool {
    let leaving = |curve: &Curve, from_start: bool| -> Vec<Vector> {
        let mut points = curve.clone();
        if !from_start {
            points.reverse();
        }
        points[1..].iter().map(|&p| p - points[0]).collect()
    };
    let end = |curve: &Curve, is_start: bool| if is_start { curve[0] } else { curve[curve.len() - 1] };
    let ways = [(true, true), (true, false), (false, true), (false, false)];
    ways.into_iter().filter(|&(a, b)| end(one, a) == end(other, b)).any(|(a, b)| {
        let (ones, others) = (leaving(one, a), leaving(other, b));
        let all = |holds: fn(Vector, Vector) -> f64| {
            let is_clear = |u: Vector, v: Vector| holds(u, v) > 16.0 * f64::EPSILON * u.norm() * v.norm();
            ones.iter().all(|&u| others.iter().all(|&v| is_clear(u, v)))
        };
        all(Vector::cross) || all(|u, v| v.cross(u)) || all(|u, v| -u.dot(v))
    })
}

/// Both halves of a curve (de Casteljau).
fn halves(curve: &Curve) -> [Curve; 2] {
    let (mut first, mut second, mut row) = (Vec::new(), Vec::new(), curve.clone());
    while !row.is_empty() {
        first.push(row[0]);
        second.push(row[row.len() - 1]);
        row = row.windows(2).map(|pair| pair[0].midpoint(pair[1])).collect();
    }
    second.reverse();
    [first, second]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[[f64; 2]]) -> Curve {
        points.iter().map(|&[x, y]| Point::new(x, y)).collect()
    }

    fn are_met(one: &[[f64; 2]], other: &[[f64; 2]]) -> bool {
        let (one, other) = (curve(one), curve(other));
        let mirrored = |c: &Curve| c.iter().rev().copied().collect::<Curve>();
        let all = [(one.clone(), other.clone()), (mirrored(&one), other.clone()), (other.clone(), one.clone())];
        let found = all.map(|(a, b)| meet(&a, &b, HALVINGS));
        assert!(found.iter().all(|&met| met == found[0]));
        found[0]
    }

    #[test]
    fn curves_that_bow_through_each_other_meet() {
        let bowed = [[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]];
        assert!(are_met(&bowed, &[[0.0, 0.4], [0.5, 0.4], [1.0, 0.4]]));
        assert!(!are_met(&bowed, &[[0.0, 0.6], [0.5, 0.6], [1.0, 0.6]]));
        assert!(!are_met(&bowed, &[[0.0, 1e-9], [0.5, 1.0 + 1e-9], [1.0, 1e-9]]), "a billionth apart");
        assert!(are_met(&bowed, &bowed));
    }

    #[test]
    fn curves_may_have_ends_in_common() {
        let one = [[0.0, 0.0], [0.5, 0.1], [1.0, 0.0]];
        assert!(!are_met(&one, &[[1.0, 0.0], [1.5, -0.1], [2.0, 0.0]]), "on a smooth boundary");
        assert!(!are_met(&one, &[[1.0, 0.0], [0.5, 0.11], [0.0, 0.1]]), "in a narrow corner");
        assert!(!are_met(&one, &[[0.0, 0.0], [0.5, -0.1], [1.0, 0.0]]), "in both");
        assert!(are_met(&one, &[[1.0, 0.0], [0.5, 0.09], [0.0, 0.1]]), "crossing behind the corner");
    }

    #[test]
    fn a_side_that_comes_back_over_the_next_one_is_found() {
        let cubic = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 0.0]];
        assert!(are_met(&cubic, &[[1.0, 0.0], [1.5, 0.5], [2.0, 1.0], [3.0, 1.0]]));
    }
}
