//! Points and vectors of the plane, in the user's (Euclidean) units.

use std::fmt;
use std::ops::{Add, Mul, Neg, Sub};

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

impl Point {
    /// The point (x, y).
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// The point `self + t (other - self)`; a coordinate that both points share is kept to the last bit.
    #[must_use]
    pub fn lerp(self, other: Point, t: f64) -> Point {
        self + (other - self) * t
    }

    /// The point nearest to this one of the segment from a to b.
    pub(crate) fn nearest_between(self, a: Point, b: Point) -> Point {
        let along = b - a;
        a.lerp(b, ((self - a).dot(along) / along.dot(along)).clamp(0.0, 1.0))
    }

    /// The centroid of a triangle.
    pub(crate) fn centroid([a, b, c]: [Point; 3]) -> Point {
        a + ((b - a) + (c - a)) * (1.0 / 3.0)
    }

    /// The midpoint of two points.
    #[must_use]
    pub(crate) fn midpoint(self, other: Point) -> Point {
        Point::new(0.5 * self.x + 0.5 * other.x, 0.5 * self.y + 0.5 * other.y)
    }

    /// Euclidean distance.
    pub fn distance(self, other: Point) -> f64 {
        (self - other).norm()
    }

    /// Whether both coordinates are finite.
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

impl Vector {
    /// The vector (x, y).
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// Euclidean dot product.
    pub fn dot(self, other: Vector) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// The z component of the cross product: twice the signed area of the triangle (0, self, other).
    pub fn cross(self, other: Vector) -> f64 {
        self.x * other.y - self.y * other.x
    }

    /// Euclidean length; components beyond about 1e150 overflow, those below 1e-150 vanish.
    pub fn norm(self) -> f64 {
        // Not `hypot`: its guard against overflow cost a seventh of the relaxation.
        self.dot(self).sqrt()
    }

    /// The angle (radians, 0 to pi) between two directions.
    pub(crate) fn turn(self, other: Vector) -> f64 {
        self.cross(other).abs().atan2(self.dot(other))
    }

    /// The vector turned by +90 degrees.
    #[must_use]
    pub fn perpendicular(self) -> Vector {
        Vector::new(-self.y, self.x)
    }
}

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}, {})", Readable(self.x), Readable(self.y))
    }
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

impl Sub for Point {
    type Output = Vector;
    fn sub(self, other: Point) -> Vector {
        Vector::new(self.x - other.x, self.y - other.y)
    }
}

impl Add<Vector> for Point {
    type Output = Point;
    fn add(self, v: Vector) -> Point {
        Point::new(self.x + v.x, self.y + v.y)
    }
}

impl Sub<Vector> for Point {
    type Output = Point;
    fn sub(self, v: Vector) -> Point {
        Point::new(self.x - v.x, self.y - v.y)
    }
}

impl Add for Vector {
    type Output = Vector;
    fn add(self, v: Vector) -> Vector {
        Vector::new(self.x + v.x, self.y + v.y)
    }
}

impl Sub for Vector {
    type Output = Vector;
    fn sub(self, v: Vector) -> Vector {
        Vector::new(self.x - v.x, self.y - v.y)
    }
}

impl Neg for Vector {
    type Output = Vector;
    fn neg(self) -> Vector {
        Vector::new(-self.x, -self.y)
    }
}

impl Mul<f64> for Vector {
    type Output = Vector;
    fn mul(self, s: f64) -> Vector {
        Vector::new(self.x * s, self.y * s)
    }
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: Point,
    /// The corner with the largest coordinates.
    pub max: Point,
}

impl Aabb {
    /// The smallest box that holds all points; `None` of no point.
    pub fn of(points: impl IntoIterator<Item = Point>) -> Option<Self> {
        points.into_iter().fold(None, |bounds: Option<Self>, p| {
            Some(bounds.map_or(Self { min: p, max: p }, |b| Self {
                min: Point::new(b.min.x.min(p.x), b.min.y.min(p.y)),
                max: Point::new(b.max.x.max(p.x), b.max.y.max(p.y)),
            }))
        })
    }

    /// Width along x and height along y.
    pub fn extent(&self) -> Vector {
        self.max - self.min
    }

    /// The middle of the box.
    pub(crate) fn centre(&self) -> Point {
        self.min.midpoint(self.max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_readable_at_every_scale() {
        let shown = [0.0, -0.25, 1e300, 3e-75, f64::NAN].map(|x| Readable(x).to_string());
        assert_eq!(shown, ["0", "-0.25", "1e300", "3e-75", "NaN"]);
        assert_eq!(Point::new(1e16, -1e-9).to_string(), "(10000000000000000, -1e-9)");
    }
}
