//! The Voronoi cell of a seed in the tangent plane at the seed.

use crate::geometry::Vector;

/// A convex polygon around the origin of a tangent plane, in an orthonormal frame (metric units).
#[derive(Clone, Debug, Default)]
pub struct Cell {
    corners: Vec<Vector>,
    scratch: Vec<Vector>,
}

impl Cell {
    /// Starts again with a square of this half-width.
    pub fn reset(&mut self, half_width: f64) {
        let w = half_width;
        self.corners.clear();
        self.corners.extend([(-w, -w), (w, -w), (w, w), (-w, w)].map(|(x, y)| Vector::new(x, y)));
    }

    /// Keeps what lies nearer to the origin than to another seed.
    pub fn cut_by_bisector(&mut self, seed: Vector) {
        self.cut(seed, 0.5 * seed.dot(seed));
    }

    /// Keeps what lies on the origin's side of the line through two points.
    pub fn cut_by_line(&mut self, a: Vector, b: Vector) {
        let normal = (a - b).perpendicular();
        let offset = normal.dot(a);
        if offset > 0.0 { self.cut(normal, offset) } else { self.cut(-normal, -offset) }
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

    /// The cell's corners, counter-clockwise.
    pub fn corners(&self) -> &[Vector] {
        &self.corners
    }
}

/// Centroid of a convex polygon that holds the origin; the origin where the polygon has no area.
pub fn centroid(corners: &[Vector]) -> Vector {
    let mut area = 0.0;
    let mut moment = Vector::default();
    for (i, &p) in corners.iter().enumerate() {
        let q = corners[(i + 1) % corners.len()];
        let cross = p.cross(q);
        area += cross;
        moment = moment + (p + q) * (cross / 3.0);
    }
    let mean = moment * (1.0 / area);
    if area > 0.0 && mean.norm().is_finite() { mean } else { Vector::default() }
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
        let c = centroid(cell.corners());
        assert!(c.x.abs() < 1e-15 && (c.y + 0.5).abs() < 1e-15, "{c:?}");
        cell.cut_by_line(Vector::new(-5.0, -0.5), Vector::new(5.0, -0.5));
        assert!(centroid(cell.corners()).norm() < 1e-15);
    }
}
