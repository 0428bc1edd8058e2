//! Quadrature rules for triangles.

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

/// The same on each of so many times so many parts of a triangle.
pub(crate) fn radon_on_parts(parts: u32) -> Vec<Node> {
    let mut nodes = Vec::new();
    let side = f64::from(parts);
    let corner = |i: u32, j: u32| [f64::from(parts - i - j) / side, f64::from(i) / side, f64::from(j) / side];
    let mut add = |part: [[f64; 3]; 3]| {
        for ([u, v, w], weight) in radon() {
            let at = std::array::from_fn(|k| u * part[0][k] + v * part[1][k] + w * part[2][k]);
            nodes.push((at, weight / (side * side)));
        }
    };
    for i in 0..parts {
        for j in 0..parts - i {
            add([corner(i, j), corner(i + 1, j), corner(i, j + 1)]);
            if i + j + 2 <= parts {
                add([corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]);
            }
        }
    }
    nodes
}

/// The point with these barycentric coordinates.
pub(crate) fn combine([u, v, w]: [f64; 3], [a, b, c]: [Point; 3]) -> Point {
    Point::new(u * a.x + v * b.x + w * c.x, u * a.y + v * b.y + w * c.y)
}
