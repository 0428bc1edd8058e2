//! Exact predicates (Shewchuk's, by the `robust` crate): the sign is right for every finite input
//! whose products neither over- nor underflow.

use super::{Point, Point3};
use robust::{Coord, Coord3D};

/// On which side of the directed line a-b the point c lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// a, b, c turn left: the triangle has positive area.
    Left,
    /// The three points are exactly collinear.
    Collinear,
    /// a, b, c turn right.
    Right,
}

/// The exact orientation of the triangle a, b, c.
pub fn orientation(a: Point, b: Point, c: Point) -> Orientation {
    let area = signed_area(a, b, c);
    if area > 0.0 {
        Orientation::Left
    } else if area < 0.0 {
        Orientation::Right
    } else {
        Orientation::Collinear
    }
}

/// Twice the signed area of the triangle a, b, c; the sign is exact, the value rounded.
pub fn signed_area(a: Point, b: Point, c: Point) -> f64 {
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// Positive when d lies strictly inside the circle through the counter-clockwise a, b, c; exact sign.
pub(crate) fn in_circle(a: Point, b: Point, c: Point, d: Point) -> f64 {
    robust::incircle(coord(a), coord(b), coord(c), coord(d))
}

/// Six times the signed volume of the tetrahedron a, b, c, d, positive where a, b, c look clockwise from d; the sign is
/// exact, zero for four points of one plane, the value rounded.
pub(crate) fn signed_volume(a: Point3, b: Point3, c: Point3, d: Point3) -> f64 {
    let coord = |p: Point3| Coord3D { x: p.x, y: p.y, z: p.z };
    robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// Where the lines through a-b and c-d meet (rounded).
pub(crate) fn segment_intersection(a: Point, b: Point, c: Point, d: Point) -> Point {
    let (u, v) = (b - a, d - c);
    let denominator = u.cross(v);
    if denominator == 0.0 {
        return a.midpoint(b);
    }
    a + u * ((c - a).cross(v) / denominator)
}

/// The centroid of a triangle.
pub(crate) fn centroid([a, b, c]: [Point; 3]) -> Point {
    Point::new((a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0)
}

/// Whether a counter-clockwise triangle holds a point, inside or on its sides.
pub(crate) fn holds([a, b, c]: [Point; 3], p: Point) -> bool {
    [(a, b), (b, c), (c, a)].iter().all(|&(u, v)| orientation(u, v, p) != Orientation::Right)
}

fn coord(p: Point) -> Coord<f64> {
    Coord { x: p.x, y: p.y }
}
