//! Where energies of curved triangles and sides are taken.

use super::bezier::{MOST, bernstein, blend, slopes};
use super::density::Matrix;
use crate::geometry::{Point, Point3, Vector, radon};
use crate::mesh::Mesh;

/// The area of the equilateral triangle with unit sides.
pub(crate) const AREA: f64 = 0.433_012_701_892_219_3;

/// A place of a triangle: its weight, the polynomials, and their gradients on the equilateral triangle with sides of length one.
pub(crate) struct Place {
    pub(crate) weight: f64,
    pub(super) values: [f64; MOST],
    pub(super) slopes: [Vector; MOST],
}

/// Places of a triangle, with weights that sum to one.
pub(crate) struct Rule {
    pub(crate) places: Vec<Place>,
}

impl Place {
    /// That of the triangles of a mesh, in barycentric coordinates.
    pub(crate) fn of(mesh: &Mesh, at: [f64; 3], weight: f64) -> Self {
        Self::new(mesh.curved.as_ref().map_or(1, |curved| curved.order), at, weight)
    }

    fn new(order: usize, at: [f64; 3], weight: f64) -> Self {
        let root = 3.0_f64.sqrt();
        // The corner opposite is at (1/2, sqrt(3) / 2).
        let even = |s: Vector| Vector::new(s.x, (2.0 * s.y - s.x) / root);
        Self { weight, values: bernstein(order, at), slopes: slopes(order, at).map(even) }
    }

    /// The image of the place.
    pub(crate) fn image(&self, points: &[Point]) -> Point {
        blend(points, &self.values)
    }

    /// The image in space, by [`points_in_space`](super::points_in_space).
    pub(crate) fn image_in_space(&self, points: &[[Point; MOST]; 2]) -> Point3 {
        let [p, z] = points.each_ref().map(|points| self.image(points));
        Point3::new(p.x, p.y, z.x)
    }

    /// The derivative of the map there, from the equilateral triangle.
    pub(crate) fn derivative(&self, points: &[Point]) -> Matrix {
        let mut sides = [Vector::default(); 2];
        for (p, slope) in points.iter().zip(&self.slopes) {
            let p = Vector::new(p.x, p.y);
            sides = [sides[0] + p * slope.x, sides[1] + p * slope.y];
        }
        sides
    }
}

/// A rule of twelve nodes, exact for polynomials of degree 6 (Dunavant 1985): weights, and two barycentric coordinates each; the
/// first of them with two coordinates alike.
const TWELVE: [(f64, [f64; 2]); 3] = [
    (0.116_786_275_726_379, [0.249_286_745_170_910, 0.249_286_745_170_910]),
    (0.050_844_906_370_207, [0.063_089_014_491_502, 0.063_089_014_491_502]),
    (0.082_851_075_618_374, [0.053_145_049_844_817, 0.310_352_451_033_784]),
];

impl Rule {
    /// That by which meshes are judged: Radon's on each of the four quarters of a triangle.
    pub(crate) fn fine(mesh: &Mesh) -> Self {
        Self::fine_of(mesh.curved.as_ref().map_or(1, |curved| curved.order))
    }

    /// The same, for triangles of an order.
    pub(super) fn fine_of(order: usize) -> Self {
        let half = |c: usize| std::array::from_fn(|i| if i == c { 0.0 } else { 0.5 });
        let corner = |c: usize| std::array::from_fn(|i| if i == c { 1.0 } else { 0.0 });
        let [a, b, c]: [[f64; 3]; 3] = [half(0), half(1), half(2)];
        let quarters = [[a, b, c], [corner(0), c, b], [c, corner(1), a], [b, a, corner(2)]];
        let at =
            |quarter: [[f64; 3]; 3], s: [f64; 3]| std::array::from_fn(|i| (0..3).map(|j| s[j] * quarter[j][i]).sum());
        let all = quarters.iter().flat_map(|&q| radon().map(|(s, weight)| Place::new(order, at(q, s), 0.25 * weight)));
        Self { places: all.collect() }
    }

    /// The middle of a triangle.
    pub(super) fn middle(order: usize) -> Place {
        Place::new(order, [1.0 / 3.0; 3], 1.0)
    }

    /// That for triangles of an order: exact to degree 5, of cubic ones to degree 6.
    pub(crate) fn of(order: usize) -> Self {
        if order < 3 {
            return Self { places: radon().into_iter().map(|(at, weight)| Place::new(order, at, weight)).collect() };
        }
        let mut places = Vec::with_capacity(12);
        for (weight, [a, b]) in TWELVE {
            let c = 1.0 - a - b;
            let turns = [[a, b, c], [b, c, a], [c, a, b]];
            let mirrored = [[b, a, c], [a, c, b], [c, b, a]];
            let all = if a.to_bits() == b.to_bits() { &[turns][..] } else { &[turns, mirrored][..] };
            places.extend(all.iter().flatten().map(|&at| Place::new(order, at, weight)));
        }
        Self { places }
    }
}

/// Nodes on [0, 1] and weights of 5-point Gauss-Legendre quadrature.
pub(crate) const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668_004, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// The Bernstein polynomials of a curve, and their derivatives, at a parameter.
pub(super) fn on_curve(order: usize, t: f64) -> [[f64; 2]; 4] {
    let s = 1.0 - t;
    match order {
        1 => [[s, -1.0], [t, 1.0], [0.0; 2], [0.0; 2]],
        2 => [[s * s, -2.0 * s], [2.0 * s * t, 2.0 * (s - t)], [t * t, 2.0 * t], [0.0; 2]],
        _ => [
            [s * s * s, -3.0 * s * s],
            [3.0 * s * s * t, 3.0 * s * (s - 2.0 * t)],
            [3.0 * s * t * t, 3.0 * t * (2.0 * s - t)],
            [t * t * t, 3.0 * t * t],
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::super::bezier::exponents;
    use super::*;

    #[test]
    fn rules_are_exact_to_their_degree() {
        // The mean of x^i y^j over the triangle with corners (0, 0), (1, 0), (0, 1) is 2 i! j! / (i + j + 2)!.
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for (order, degree) in [(2, 5), (3, 6)] {
            let rule = Rule::of(order);
            let share = |e: u8| f64::from(e) / order as f64;
            let points: Vec<Point> = exponents(order).iter().map(|e| Point::new(share(e[1]), share(e[2]))).collect();
            for (i, j) in (0..=degree).flat_map(|i| (0..=degree - i).map(move |j| (i, j))) {
                let term = |p: &Place| p.weight * p.image(&points).x.powi(i) * p.image(&points).y.powi(j);
                let found: f64 = rule.places.iter().map(term).sum();
                let exact = 2.0 * factorial(i) * factorial(j) / factorial(i + j + 2);
                assert!((found - exact).abs() < 1e-13, "{order}: {i} {j}: {found} {exact}");
            }
        }
    }

    #[test]
    fn the_equilateral_triangle_is_mapped_by_the_identity() {
        let corners = [Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(0.5, 0.75_f64.sqrt())];
        let [one, two] = Rule::of(1).places[3].derivative(&corners);
        assert!((one.x - 1.0).abs() + one.y.abs() + two.x.abs() + (two.y - 1.0).abs() < 1e-15);
    }
}
