//! Triangles of order 1 to 3 by their Bezier points, numbered as the nodes of [`Curved`]: corners, then those of the sides in
//! their direction, then the interior one.

use crate::geometry::{Point, Point3, TangentPlane, Vector};
use crate::mesh::Mesh;

/// Bezier points of a triangle, at most.
pub(crate) const MOST: usize = 10;

/// Exponents of the Bernstein polynomials of order 1.
const LINEAR: [[u8; 3]; 3] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
/// Those of order 2.
const QUADRATIC: [[u8; 3]; 6] = [[2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 1, 0], [0, 1, 1], [1, 0, 1]];
/// Those of order 3.
const CUBIC: [[u8; 3]; MOST] =
    [[3, 0, 0], [0, 3, 0], [0, 0, 3], [2, 1, 0], [1, 2, 0], [0, 2, 1], [0, 1, 2], [1, 0, 2], [2, 0, 1], [1, 1, 1]];

/// The exponents of the Bernstein polynomials of a triangle, in the order of its Bezier points.
pub(crate) const fn exponents(order: usize) -> &'static [[u8; 3]] {
    match order {
        1 => &LINEAR,
        2 => &QUADRATIC,
        _ => &CUBIC,
    }
}

const FACTORIALS: [f64; 5] = [1.0, 1.0, 2.0, 6.0, 24.0];

/// n! / (i! j! k!) with n = i + j + k up to 4.
pub(super) const fn multinomial([i, j, k]: [u8; 3]) -> f64 {
    FACTORIALS[(i + j + k) as usize] / (FACTORIALS[i as usize] * FACTORIALS[j as usize] * FACTORIALS[k as usize])
}

/// Powers with small exponents.
fn power(x: f64, exponent: u8) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * x)
}

/// The Bernstein polynomials of an order at a place in barycentric coordinates.
pub(crate) fn bernstein(order: usize, at: [f64; 3]) -> [f64; MOST] {
    let mut values = [0.0; MOST];
    for (value, &e) in values.iter_mut().zip(exponents(order)) {
        *value = multinomial(e) * (0..3).map(|c| power(at[c], e[c])).product::<f64>();
    }
    values
}

/// Their derivatives along the two sides of the reference triangle that leave its corner 0.
pub(super) fn slopes(order: usize, at: [f64; 3]) -> [Vector; MOST] {
    let lower = |e: [u8; 3], c: usize| -> f64 {
        if e[c] == 0 {
            return 0.0;
        }
        let mut less = e;
        less[c] -= 1;
        order as f64 * multinomial(less) * (0..3).map(|d| power(at[d], less[d])).product::<f64>()
    };
    let mut found = [Vector::default(); MOST];
    for (slope, &e) in found.iter_mut().zip(exponents(order)) {
        let [zero, one, two] = [0, 1, 2].map(|c| lower(e, c));
        *slope = Vector::new(one - zero, two - zero);
    }
    found
}

/// The sum of points by weights that sum to one.
pub(crate) fn blend(points: &[Point], weights: &[f64]) -> Point {
    let sum = |of: fn(&Point) -> f64| points.iter().zip(weights).map(|(p, w)| w * of(p)).sum();
    Point::new(sum(|p| p.x), sum(|p| p.y))
}

/// The inner Bezier points of a curve of order 2 or 3 from its nodes, those at equal steps of the parameter, ends included.
pub(super) fn curve_of_nodes(nodes: &[Point]) -> Vec<Point> {
    match nodes.len() {
        3 => vec![blend(nodes, &[-0.5, 2.0, -0.5])],
        4 => {
            let weights = [-5.0 / 6.0, 3.0, -1.5, 1.0 / 3.0];
            vec![blend(nodes, &weights), blend(nodes, &[weights[3], weights[2], weights[1], weights[0]])]
        }
        _ => Vec::new(),
    }
}

/// The inner nodes of a curve from its Bezier points.
pub(super) fn nodes_of_curve(points: &[Point]) -> Vec<Point> {
    match points.len() {
        3 => vec![blend(points, &[0.25, 0.5, 0.25])],
        4 => {
            let weights = [8.0 / 27.0, 12.0 / 27.0, 6.0 / 27.0, 1.0 / 27.0];
            vec![blend(points, &weights), blend(points, &[weights[3], weights[2], weights[1], weights[0]])]
        }
        _ => Vec::new(),
    }
}

/// The numbers, among the Bezier points of a triangle, of those of a side, from corner to corner.
pub(crate) fn side(order: usize, side: usize) -> impl Iterator<Item = usize> + Clone {
    let inner = 3 + side * (order - 1);
    std::iter::once(side).chain(inner..inner + order - 1).chain(std::iter::once((side + 1) % 3))
}

/// The interior Bezier point of a cubic triangle that has second derivatives as even as those of its sides allow (Farin).
pub(super) fn interior_of_sides(points: &[Point]) -> Point {
    let weights: [f64; 9] = std::array::from_fn(|i| if i < 3 { -1.0 / 6.0 } else { 0.25 });
    blend(&points[..9], &weights)
}

/// The Bezier points of a triangle of a curved mesh in the plane; of a straight one with its corners alone.
pub(crate) fn bezier_points(mesh: &Mesh, triangle: usize) -> ([Point; MOST], usize) {
    seen(mesh, triangle, |p| Point::new(p.x, p.y))
}

/// Those of a triangle on a surface, as they are seen along the normal of the straight triangle between its corners.
pub(crate) fn seen_from_above(mesh: &Mesh, triangle: usize) -> ([Point; MOST], usize) {
    let [a, b, c] = mesh.positions_of(mesh.triangles[triangle]);
    let plane = TangentPlane::new((b - a).cross(c - a).unit().unwrap_or_default());
    seen(mesh, triangle, |p| {
        let at = plane.flatten(p - a);
        Point::new(at.x, at.y)
    })
}

/// The Bezier points of a triangle in space: their x and y, and their z in place of x.
pub(crate) fn points_in_space(mesh: &Mesh, triangle: usize) -> [[Point; MOST]; 2] {
    let of_z = seen(mesh, triangle, |p| Point::new(p.z, 0.0));
    [bezier_points(mesh, triangle).0, of_z.0]
}

/// The Bezier points of what is seen of a triangle.
fn seen(mesh: &Mesh, triangle: usize, of: impl Fn(Point3) -> Point) -> ([Point; MOST], usize) {
    let mut points = [Point::default(); MOST];
    points[..3].copy_from_slice(&mesh.positions_of(mesh.triangles[triangle]).map(&of));
    let Some(curved) = &mesh.curved else { return (points, 1) };
    let order = curved.order;
    for (p, &n) in points[3..].iter_mut().zip(curved.triangle(triangle)) {
        *p = of(curved.nodes[n as usize].into());
    }
    (points_of_nodes(&points, order), order)
}

/// The Bezier points of a triangle from its nodes, in the same order.
pub(crate) fn points_of_nodes(nodes: &[Point; MOST], order: usize) -> [Point; MOST] {
    let mut points = *nodes;
    for s in 0..3 {
        let on_side: Vec<Point> = side(order, s).map(|i| nodes[i]).collect();
        let start = 3 + s * (order - 1);
        points[start..start + order - 1].copy_from_slice(&curve_of_nodes(&on_side));
    }
    if order == 3 {
        let weights: [f64; 10] =
            std::array::from_fn(|i| [-1.0 / 6.0, -0.5, 4.5][usize::from(i > 2) + usize::from(i > 8)]);
        points[9] = nodes[9];
        points[9] = blend(&points, &weights);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_sum_to_one_and_slopes_are_their_differences() {
        let at = [0.2, 0.5, 0.3];
        for order in 1..=3 {
            let count = exponents(order).len();
            assert!((bernstein(order, at)[..count].iter().sum::<f64>() - 1.0).abs() < 1e-15);
            let h = 1e-6;
            let along = |d: [f64; 3]| {
                let step = |s: f64| bernstein(order, [0, 1, 2].map(|c| at[c] + s * h * d[c]));
                let (after, before) = (step(0.5), step(-0.5));
                (0..count).map(|i| (after[i] - before[i]) / h).collect::<Vec<f64>>()
            };
            let (one, two) = (along([-1.0, 1.0, 0.0]), along([-1.0, 0.0, 1.0]));
            for (i, slope) in slopes(order, at)[..count].iter().enumerate() {
                assert!((slope.x - one[i]).abs() < 1e-8 && (slope.y - two[i]).abs() < 1e-8, "{order} {i}");
            }
        }
    }

    #[test]
    fn nodes_and_bezier_points_are_of_the_same_curve() {
        let p = |x: f64, y: f64| Point::new(x, y);
        for nodes in
            [vec![p(0.0, 0.0), p(1.0, 2.0), p(3.0, 1.0)], vec![p(0.0, 1.0), p(1.0, 2.0), p(3.0, 1.0), p(4.0, 5.0)]]
        {
            let inner = curve_of_nodes(&nodes);
            let mut points = nodes.clone();
            let last = points.len() - 1;
            points[1..last].copy_from_slice(&inner);
            for (a, b) in nodes_of_curve(&points).iter().zip(&nodes[1..last]) {
                assert!(a.distance(*b) < 1e-14);
            }
        }
    }
}
