//! A quadrature rule for triangles.

use super::Point;

/// Barycentric coordinates and a weight; weights sum to one.
pub(crate) type Node = ([f64; 3], f64);

/// Radon's rule of seven nodes: exact for polynomials of degree 5.
pub(crate) fn radon() -> [Node; 7] {
    let root = 15f64.sqrt();
    let third = 1.0 / 3.0;
    let mut nodes = [([third; 3], 9.0 / 40.0); 7];
    for (i, sign) in [-1.0, 1.0].into_iter().enumerate() {
        let near = (6.0 + sign * root) / 21.0;
        let far = 1.0 - 2.0 * near;
        let weight = (155.0 + sign * root) / 1200.0;
        for corner in 0..3 {
            let mut at = [near; 3];
            at[corner] = far;
            nodes[1 + 3 * i + corner] = (at, weight);
        }
    }
    nodes
}

/// The point with these barycentric coordinates.
pub(crate) fn combine([u, v, w]: [f64; 3], [a, b, c]: [Point; 3]) -> Point {
    Point::new(u * a.x + v * b.x + w * c.x, u * a.y + v * b.y + w * c.y)
}
