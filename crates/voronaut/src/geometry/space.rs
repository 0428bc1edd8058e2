//! Points and vectors of space, in the user's (Euclidean) units.

use super::Readable;
use std::fmt;
use std::ops::{Add, Mul, Neg, Sub};

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

impl Point3 {
    /// The point (x, y, z).
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self { x, y, z }
    }

    /// The coordinates in order.
    pub const fn to_array(self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }

    /// Euclidean distance.
    pub fn distance(self, other: Point3) -> f64 {
        (self - other).norm()
    }

    /// The point `self + t (other - self)`; a coordinate that both points share is kept to the last bit.
    #[must_use]
    pub fn lerp(self, other: Point3, t: f64) -> Point3 {
        self + (other - self) * t
    }

    /// The point of a triangle with these barycentric coordinates, which sum to one.
    pub(crate) fn weighted([a, b, c]: [Point3; 3], [_, s, t]: [f64; 3]) -> Point3 {
        a + (b - a) * s + (c - a) * t
    }

    /// Whether all coordinates are finite.
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }
}

impl Vector3 {
    /// The vector (x, y, z).
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self { x, y, z }
    }

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

    /// Euclidean length; components beyond about 1e150 overflow, those below 1e-150 vanish.
    pub fn norm(self) -> f64 {
        self.dot(self).sqrt()
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
    /// The smallest box that holds all points; `None` of no point.
    pub fn of(points: impl IntoIterator<Item = Point3>) -> Option<Self> {
        points.into_iter().fold(None, |bounds: Option<Self>, p| {
            let Self { min, max } = bounds.unwrap_or(Self { min: p, max: p });
            Some(Self {
                min: Point3::new(min.x.min(p.x), min.y.min(p.y), min.z.min(p.z)),
                max: Point3::new(max.x.max(p.x), max.y.max(p.y), max.z.max(p.z)),
            })
        })
    }

    /// Width, depth and height.
    pub fn extent(&self) -> Vector3 {
        self.max - self.min
    }

    /// The length of the diagonal.
    pub(crate) fn diagonal(&self) -> f64 {
        self.extent().norm()
    }
}

impl From<[f64; 3]> for Point3 {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self { x, y, z }
    }
}

impl fmt::Display for Point3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}, {}, {})", Readable(self.x), Readable(self.y), Readable(self.z))
    }
}

impl Sub for Point3 {
    type Output = Vector3;
    fn sub(self, other: Point3) -> Vector3 {
        Vector3::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl Add<Vector3> for Point3 {
    type Output = Point3;
    fn add(self, v: Vector3) -> Point3 {
        Point3::new(self.x + v.x, self.y + v.y, self.z + v.z)
    }
}

impl Add for Vector3 {
    type Output = Vector3;
    fn add(self, v: Vector3) -> Vector3 {
        Vector3::new(self.x + v.x, self.y + v.y, self.z + v.z)
    }
}

impl Sub for Vector3 {
    type Output = Vector3;
    fn sub(self, v: Vector3) -> Vector3 {
        Vector3::new(self.x - v.x, self.y - v.y, self.z - v.z)
    }
}

impl Neg for Vector3 {
    type Output = Vector3;
    fn neg(self) -> Vector3 {
        Vector3::new(-self.x, -self.y, -self.z)
    }
}

impl Mul<f64> for Vector3 {
    type Output = Vector3;
    fn mul(self, s: f64) -> Vector3 {
        Vector3::new(self.x * s, self.y * s, self.z * s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

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
