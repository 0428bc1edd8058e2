//! Points, vectors and boxes of the plane and of space, in the user's (Euclidean) units.

use super::linear::linear;
use crate::elementary::Elementary;
use std::fmt;
use std::ops::{Add, Sub};

/// A point of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// First coordinate.
    pub x: f64,
    /// Second coordinate.
    pub y: f64,
}

/// A difference of two points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vector {
    /// First component.
    pub x: f64,
    /// Second component.
    pub y: f64,
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: Point,
    /// The corner with the largest coordinates.
    pub max: Point,
}

/// A point of space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point3 {
    /// First coordinate.
    pub x: f64,
    /// Second coordinate.
    pub y: f64,
    /// Third coordinate.
    pub z: f64,
}

/// A difference of two points of space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vector3 {
    /// First component.
    pub x: f64,
    /// Second component.
    pub y: f64,
    /// Third component.
    pub z: f64,
}

/// An axis-aligned box of space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb3 {
    /// The corner with the smallest coordinates.
    pub min: Point3,
    /// The corner with the largest coordinates.
    pub max: Point3,
}

/// What is the same in the plane and in space, coordinate by coordinate.
macro_rules! affine {
    ($point:ident, $vector:ident, $bounds:ident: $($x:ident),+) => {
        linear!($vector: $($x),+);

        impl $point {
            /// The point with these coordinates.
            pub const fn new($($x: f64),+) -> Self {
                Self { $($x),+ }
            }

            /// The point `self + t (other - self)`; a coordinate that both points share is kept to the last bit.
            #[must_use]
            pub fn lerp(self, other: Self, t: f64) -> Self {
                self + (other - self) * t
            }

            /// The point nearest to this one of the segment from a to b, which may be the same.
            pub(crate) fn nearest_between(self, a: Self, b: Self) -> Self {
                let t = self.share_between(a, b);
                a.lerp(b, if t.is_nan() { 0.0 } else { t })
            }

            /// How much of the way from a to b leads to the point of the segment that is nearest to this one; none where they are the same.
            pub(crate) fn share_between(self, a: Self, b: Self) -> f64 {
                let along = b - a;
                let square = along.dot(along);
                if square > 0.0 { ((self - a).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 }
            }

            /// The squared distance to the nearest point of a triangle's sides, and its barycentric coordinates.
            pub(crate) fn nearest_on_sides(self, [a, b, c]: [Self; 3]) -> (f64, [f64; 3]) {
                let on_side = |(i, (start, end)): (usize, (Self, Self))| {
                    let t = self.share_between(start, end);
                    let rest = (self - start) - (end - start) * t;
                    let mut weights = [0.0; 3];
                    (weights[i], weights[(i + 1) % 3]) = (1.0 - t, t);
                    (rest.dot(rest), weights)
                };
                let sides = [(a, b), (b, c), (c, a)].into_iter().enumerate().map(on_side);
                sides.min_by(|a, b| a.0.total_cmp(&b.0)).expect("three sides")
            }

            /// Euclidean distance.
            pub fn distance(self, other: Self) -> f64 {
                (self - other).norm()
            }

            /// The length of the longest side of a triangle.
            pub(crate) fn longest_side([a, b, c]: [Self; 3]) -> f64 {
                a.distance(b).max(b.distance(c)).max(c.distance(a))
            }

            /// Whether all coordinates are finite.
            pub fn is_finite(self) -> bool {
                $(self.$x.is_finite())&&+
            }
        }

        impl $vector {
            /// The vector with these components.
            pub const fn new($($x: f64),+) -> Self {
                Self { $($x),+ }
            }

            /// Euclidean length; components beyond about 1e150 overflow, those below 1e-150 vanish.
            pub fn norm(self) -> f64 {
                // Not `hypot`: its guard against overflow cost a seventh of the relaxation.
                self.dot(self).sqrt()
            }
        }

        impl $bounds {
            /// The smallest box that holds all points; `None` of no point.
            pub fn of(points: impl IntoIterator<Item = $point>) -> Option<Self> {
                points.into_iter().fold(None, |bounds: Option<Self>, p| {
                    let Self { min, max } = bounds.unwrap_or(Self { min: p, max: p });
                    Some(Self { min: $point::new($(min.$x.min(p.$x)),+), max: $point::new($(max.$x.max(p.$x)),+) })
                })
            }

            /// Its extent along each axis.
            pub fn extent(&self) -> $vector {
                self.max - self.min
            }
        }

        impl Sub for $point {
            type Output = $vector;
            fn sub(self, other: Self) -> $vector {
                $vector::new($(self.$x - other.$x),+)
            }
        }

        impl Add<$vector> for $point {
            type Output = Self;
            fn add(self, v: $vector) -> Self {
                Self::new($(self.$x + v.$x),+)
            }
        }

        impl Sub<$vector> for $point {
            type Output = Self;
            fn sub(self, v: $vector) -> Self {
                Self::new($(self.$x - v.$x),+)
            }
        }
    };
}

affine!(Point, Vector, Aabb: x, y);
affine!(Point3, Vector3, Aabb3: x, y, z);

impl Point {
    /// The centroid of a triangle.
    pub(crate) fn centroid([a, b, c]: [Point; 3]) -> Point {
        a + ((b - a) + (c - a)) * (1.0 / 3.0)
    }

    /// The midpoint of two points.
    #[must_use]
    pub(crate) fn midpoint(self, other: Point) -> Point {
        Point::new(0.5 * self.x + 0.5 * other.x, 0.5 * self.y + 0.5 * other.y)
    }
}

impl Vector {
    /// Euclidean dot product.
    pub fn dot(self, other: Vector) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// The z component of the cross product: twice the signed area of the triangle (0, self, other).
    pub fn cross(self, other: Vector) -> f64 {
        self.x * other.y - self.y * other.x
    }

    /// The angle (radians, 0 to pi) between two directions.
    pub(crate) fn turn(self, other: Vector) -> f64 {
        self.cross(other).abs().arctangent_over(self.dot(other))
    }

    /// The vector turned by +90 degrees.
    #[must_use]
    pub fn perpendicular(self) -> Vector {
        Vector::new(-self.y, self.x)
    }
}

impl Aabb {
    /// The middle of the box.
    pub(crate) fn centre(&self) -> Point {
        self.min.midpoint(self.max)
    }
}

impl Point3 {
    /// The coordinates in order.
    pub const fn to_array(self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }

    /// The point of a triangle with these barycentric coordinates, which sum to one.
    pub(crate) fn weighted([a, b, c]: [Point3; 3], [_, s, t]: [f64; 3]) -> Point3 {
        a + (b - a) * s + (c - a) * t
    }
}

impl Vector3 {
    /// Euclidean dot product.
    pub fn dot(self, other: Vector3) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// The cross product: perpendicular to both, as long as the parallelogram is large.
    #[must_use]
    pub fn cross(self, other: Vector3) -> Vector3 {
        Vector3::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// The vector with length one; `None` of the zero vector and of what is not finite.
    pub fn unit(self) -> Option<Vector3> {
        let norm = self.norm();
        (norm > 0.0 && norm.is_finite()).then(|| self * (1.0 / norm))
    }

    /// Some unit vector perpendicular to this one, which has length one (Duff et al. 2017).
    #[must_use]
    pub fn perpendicular(self) -> Vector3 {
        let sign = 1.0_f64.copysign(self.z);
        let a = -1.0 / (sign + self.z);
        Vector3::new(1.0 + sign * self.x * self.x * a, sign * self.x * self.y * a, -sign * self.x)
    }
}

impl Aabb3 {
    /// Whether a point is in the box or on its sides.
    pub(crate) fn contains(&self, p: Point3) -> bool {
        let [x, low, high] = [p, self.min, self.max].map(Point3::to_array);
        (0..3).all(|i| low[i] <= x[i] && x[i] <= high[i])
    }

    /// The length of the diagonal.
    pub(crate) fn diagonal(&self) -> f64 {
        self.extent().norm()
    }
}

impl From<Point> for [f64; 3] {
    fn from(Point { x, y }: Point) -> Self {
        [x, y, 0.0]
    }
}

impl From<Point3> for [f64; 3] {
    fn from(p: Point3) -> Self {
        p.to_array()
    }
}

impl From<[f64; 3]> for Point3 {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self { x, y, z }
    }
}

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}, {})", Readable(self.x), Readable(self.y))
    }
}

impl fmt::Display for Point3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}, {}, {})", Readable(self.x), Readable(self.y), Readable(self.z))
    }
}

/// What is kept of a curve between two of its places, the second one included: each chord is cut at the place that `strays` from it
/// too far, until none does (Ramer 1972; Douglas and Peucker 1973).
pub(crate) fn kept_within<P: Copy>(ends: [P; 2], strays: impl Fn([P; 2]) -> Option<P>) -> Vec<P> {
    let (mut pending, mut kept) = (vec![ends], Vec::new());
    while let Some([from, to]) = pending.pop() {
        match strays([from, to]) {
            Some(between) => pending.extend([[between, to], [from, between]]),
            None => kept.push(to),
        }
    }
    kept
}

/// A number as messages show it: all its digits, with an exponent where plain digits would be a row of zeros.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Readable(pub f64);

impl fmt::Display for Readable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || !size.is_finite() || (1e-6..1e21).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_are_readable_at_every_scale() {
        let shown = [0.0, -0.25, 1e300, 3e-75, f64::NAN].map(|x| Readable(x).to_string());
        assert_eq!(shown, ["0", "-0.25", "1e300", "3e-75", "NaN"]);
        assert_eq!(Point::new(1e16, -1e-9).to_string(), "(10000000000000000, -1e-9)");
    }

    proptest! {
        #[test]
        fn perpendiculars_are_perpendicular_units(x in -1.0..1.0, y in -1.0..1.0, z in -1.0..1.0) {
            let Some(n) = Vector3::new(x, y, z).unit() else { return Ok(()) };
            let u = n.perpendicular();
            let v = n.cross(u);
            for value in [u.dot(u) - 1.0, v.dot(v) - 1.0, u.dot(n), v.dot(n), u.dot(v)] {
                prop_assert!(value.abs() < 1e-14, "{value}");
            }
        }
    }

    #[test]
    fn the_axes_have_perpendiculars_too() {
        for n in [Vector3::new(0.0, 0.0, 1.0), Vector3::new(0.0, 0.0, -1.0), Vector3::new(0.0, -1.0, -0.0)] {
            assert!(n.perpendicular().dot(n).abs() < 1e-15 && (n.perpendicular().norm() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn boxes_hold_their_points() {
        let bounds = Aabb3::of([[1.0, 5.0, 0.0], [-1.0, 2.0, 6.0]].map(Point3::from)).unwrap();
        assert_eq!(bounds.extent(), Vector3::new(2.0, 3.0, 6.0));
        assert!((bounds.diagonal() - 7.0).abs() < 1e-15);
        assert_eq!(Aabb3::of([]), None);
    }
}
