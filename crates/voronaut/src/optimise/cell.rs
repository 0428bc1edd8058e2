//! The Voronoi cell of a seed in the tangent plane at the seed.

use crate::geometry::Vector;

/// A convex polygon around the origin of a tangent plane, in an orthonormal frame (metric units).
#[derive(Clone, Debug, Default)]
pub struct Cell {
    corners: Vec<Vector>,
    scratch: Vec<Vector>,
}

/// Moments of a cell about its seed, in the tangent plane there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moments {
    /// Area.
    pub mass: f64,
    /// The integral of the position vector.
    pub first: Vector,
    /// The integral of its square: the seed's share of the energy of centroidal Voronoi tessellations.
    pub second: f64,
}

impl Cell {
    /// Starts again with a square of this half-width.
    pub(crate) fn reset(&mut self, half_width: f64) {
        let w = half_width;
        self.corners.clear();
        self.corners.extend([(-w, -w), (w, -w), (w, w), (-w, w)].map(|(x, y)| Vector::new(x, y)));
    }

    /// Keeps what lies nearer to the origin than to another seed.
    pub(crate) fn cut_by_bisector(&mut self, seed: Vector) {
        self.cut(seed, 0.5 * seed.dot(seed));
    }

    /// Keeps what lies on the origin's side of the line through two points.
    pub(crate) fn cut_by_line(&mut self, a: Vector, b: Vector) {
        let normal = (a - b).perpendicular();
        let offset = normal.dot(a);
        if offset > 0.0 { self.cut(normal, offset) } else { self.cut(-normal, -offset) }
    }

    /// Keeps what lies to the left of a vector from the origin.
    pub(crate) fn keep_left_of(&mut self, direction: Vector) {
        self.cut(-direction.perpendicular(), 0.0);
    }

    /// Keeps the points x with x . normal <= offset (Sutherland and Hodgman 1974).
    fn cut(&mut self, normal: Vector, offset: f64) {
        self.scratch.clear();
        for (i, &p) in self.corners.iter().enumerate() {
            let q = self.corners[(i + 1) % self.corners.len()];
            let (at_p, at_q) = (p.dot(normal) - offset, q.dot(normal) - offset);
            if at_p <= 0.0 {
                self.scratch.push(p);
            }
            if (at_p < 0.0) != (at_q < 0.0) {
                self.scratch.push(p + (q - p) * (at_p / (at_p - at_q)));
            }
        }
        std::mem::swap(&mut self.corners, &mut self.scratch);
    }

    /// The cell's moments about the origin.
    pub(crate) fn moments(&self) -> Moments {
        let mut moments = Moments::default();
        for (i, &p) in self.corners.iter().enumerate() {
            let q = self.corners[(i + 1) % self.corners.len()];
            let cross = p.cross(q);
            moments.mass += 0.5 * cross;
            moments.first = moments.first + (p + q) * (cross / 6.0);
            moments.second += cross / 12.0 * (p.dot(p) + p.dot(q) + q.dot(q));
        }
        moments
    }
}

impl Moments {
    /// The centroid; the origin where the cell has no area.
    #[cfg(test)]
    fn centroid(&self) -> Vector {
        let mean = self.first * (1.0 / self.mass);
        if self.mass > 0.0 && mean.norm().is_finite() { mean } else { Vector::default() }
    }
}

impl std::ops::Add for Moments {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { mass: self.mass + other.mass, first: self.first + other.first, second: self.second + other.second }
    }
}

/// A tangent vector in the orthonormal frame that a tensor's Cholesky factor makes.
pub(super) fn to_frame([a, b, c]: [f64; 3], v: Vector) -> Vector {
    Vector::new(a * v.x + b * v.y, c * v.y)
}

/// The inverse of [`to_frame`].
pub(super) fn from_frame([a, b, c]: [f64; 3], w: Vector) -> Vector {
    let y = w.y / c;
    Vector::new((w.x - b * y) / a, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cell_of_a_square_lattice_is_a_square() {
        let mut cell = Cell::default();
        cell.reset(10.0);
        for (x, y) in [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -3.0)] {
            cell.cut_by_bisector(Vector::new(x, y));
        }
        let moments = cell.moments();
        let c = moments.centroid();
        assert!(c.x.abs() < 1e-15 && (c.y + 0.5).abs() < 1e-15, "{c:?}");
        // A rectangle of 1 by 2 from y = -1.5 to 0.5.
        assert!((moments.mass - 2.0).abs() < 1e-15 && (moments.second - (1.0 / 6.0 + 3.5 / 3.0)).abs() < 1e-14);
        cell.cut_by_line(Vector::new(-5.0, -0.5), Vector::new(5.0, -0.5));
        assert!(cell.moments().centroid().norm() < 1e-15);
    }

    #[test]
    fn half_planes_keep_what_is_left() {
        let mut cell = Cell::default();
        cell.reset(1.0);
        cell.keep_left_of(Vector::new(1.0, 0.0));
        let moments = cell.moments();
        assert!((moments.mass - 2.0).abs() < 1e-15 && (moments.centroid().y - 0.5).abs() < 1e-15);
        assert_eq!(Cell::default().moments().centroid(), Vector::default());
    }
}
