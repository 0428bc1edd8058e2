//! Whether a curved triangle is valid: a lower bound of its Jacobian, by the Bezier coefficients of that polynomial.
//!
//! A polynomial is nowhere less than the least of its coefficients, and at the corners equal to them. Halving the triangle brings the
//! coefficients closer to the polynomial, quadratically (Johnen, Remacle and Geuzaine 2013).

use super::bezier::{exponents, multinomial};
use crate::geometry::{Point, Vector};

/// Coefficients of the Jacobian of a cubic triangle, a polynomial of degree 4.
const MOST: usize = 15;
/// Relative rounding of a coefficient, a sum of up to 36 products of differences, and of these themselves in units of positions: nodes are rounded, and so is
/// what readers make of them.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What is known of the least Jacobian of a triangle, in units of its mean: 1 everywhere for a straight triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bound {
    /// It is nowhere less.
    pub(crate) least: f64,
    /// Whether it is known to be positive everywhere, or not to be somewhere.
    pub(crate) is_decided: bool,
    /// The area of the triangle.
    pub(crate) area: f64,
}

impl Bound {
    /// Whether the triangle is valid: what is not decided is not.
    pub(crate) fn is_valid(&self) -> bool {
        self.least > 0.0
    }
}

/// Where the coefficient (i, j, k) of a polynomial is in the list: rows of equal k, the least first, in each with growing j.
const fn place(degree: usize, j: usize, k: usize) -> usize {
    k * (degree + 1) - k * k.saturating_sub(1) / 2 + j
}

/// Bounds the Jacobian of a triangle from below; halves are halved again until it is decided, at most so many times.
pub(crate) fn bound(points: &[Point], order: usize, halvings: u32) -> Bound {
    let (coefficients, rounding) = coefficients(points, order);
    let degree = 2 * (order - 1);
    let count = (degree + 1) * (degree + 2) / 2;
    let mean = coefficients[..count].iter().sum::<f64>() / count as f64;
    // A number that is none decides, too.
    if mean.is_nan() || mean <= rounding {
        return Bound { least: -1.0, is_decided: true, area: 0.5 * mean };
    }
    let (least, is_decided) = least(&coefficients, degree, rounding, halvings);
    Bound { least: least / mean, is_decided, area: 0.5 * mean }
}

/// The coefficients of the Jacobian, and how far rounding may have moved them.
pub(super) fn coefficients(points: &[Point], order: usize) -> ([f64; MOST], f64) {
    let lower = exponents(order - 1);
    let mut slopes = [[Vector::default(); 2]; 6];
    let count = if order == 1 { 1 } else { lower.len() };
    for (slope, at) in slopes.iter_mut().zip(0..count) {
        let e = if order == 1 { [0; 3] } else { lower[at] };
        let [zero, one, two] = [0, 1, 2].map(|c| points[raised(order, e, c)]);
        *slope = [one - zero, two - zero].map(|v| v * order as f64);
    }
    let exponent = |at: usize| if order == 1 { [0; 3] } else { lower[at] };
    let mut found = [0.0; MOST];
    for a in 0..count {
        for b in 0..count {
            let (e, f) = (exponent(a), exponent(b));
            let sum = [e[0] + f[0], e[1] + f[1], e[2] + f[2]];
            let share = multinomial(e) * multinomial(f) / multinomial(sum);
            found[place(2 * (order - 1), sum[1] as usize, sum[2] as usize)] += share * slopes[a][0].cross(slopes[b][1]);
        }
    }
    let greatest = |i: usize| slopes[..count].iter().map(|s| s[i].norm()).fold(0.0, f64::max);
    let position = points.iter().map(|p| p.x.abs().max(p.y.abs())).fold(0.0, f64::max);
    let (u, v) = (greatest(0), greatest(1));
    (found, ROUNDING * (u * v + position * (u + v)))
}

/// The number of the Bezier point whose exponents are these with one more at a corner.
fn raised(order: usize, mut e: [u8; 3], corner: usize) -> usize {
    e[corner] += 1;
    exponents(order).iter().position(|f| *f == e).expect("exponents of this order")
}

/// A bound from below, and whether it tells the sign.
fn least(coefficients: &[f64; MOST], degree: usize, rounding: f64, halvings: u32) -> (f64, bool) {
    let count = (degree + 1) * (degree + 2) / 2;
    let least = coefficients[..count].iter().copied().fold(f64::INFINITY, f64::min) - rounding;
    let corners = [0, degree, count - 1].map(|at| coefficients[at]);
    if least > 0.0 || corners.iter().any(|&c| c <= rounding) {
        return (least, true);
    }
    if halvings == 0 {
        return (least, false);
    }
    let [one, other] = halves(coefficients, degree);
    let first = self::least(&one, degree, rounding, halvings - 1);
    if first.0 <= 0.0 && first.1 {
        return first;
    }
    let second = self::least(&other, degree, rounding, halvings - 1);
    let is_decided = if second.0 <= 0.0 && second.1 { true } else { first.1 && second.1 };
    (first.0.min(second.0), is_decided)
}

/// The coefficients on both halves, cut across the side from corner 0 to 1, with the sides to be cut next first.
fn halves(coefficients: &[f64; MOST], degree: usize) -> [[f64; MOST]; 2] {
    let mut halves = [[0.0; MOST]; 2];
    for k in 0..=degree {
        let length = degree - k;
        let mut row = [0.0; 5];
        row[..=length].copy_from_slice(&coefficients[place(degree, 0, k)..=place(degree, length, k)]);
        for round in 0..=length {
            // Of corners (0, m, 2), as (2, 0, m): j there is i here. Of (m, 1, 2), as (1, 2, m): i there is j here.
            let (first, last) = (row[0], row[length - round]);
            halves[0][place(degree, length - round, round)] = first;
            halves[1][place(degree, k, round)] = last;
            for j in 0..length - round {
                row[j] = 0.5 * (row[j] + row[j + 1]);
            }
        }
    }
    halves
}

#[cfg(test)]
mod tests {
    use super::super::bezier::{MOST as POINTS, bezier_points, slopes};
    use super::*;
    use crate::mesh::{Curved, Mesh};
    use proptest::prelude::*;

    /// The Jacobian at many places, by itself.
    fn sampled(points: &[Point], order: usize) -> f64 {
        let steps = 60;
        let at = |i: i32, j: i32| {
            let [u, v] = [i, j].map(|i| f64::from(i) / f64::from(steps));
            let mut sides = [Vector::default(); 2];
            for (p, slope) in points.iter().zip(slopes(order, [1.0 - u - v, u, v])) {
                sides[0] = sides[0] + Vector::new(p.x, p.y) * slope.x;
                sides[1] = sides[1] + Vector::new(p.x, p.y) * slope.y;
            }
            sides[0].cross(sides[1])
        };
        (0..=steps)
            .flat_map(|i| (0..=steps - i).map(move |j| (i, j)))
            .map(|(i, j)| at(i, j))
            .fold(f64::INFINITY, f64::min)
    }

    fn straight(order: usize) -> Vec<Point> {
        let share = |e: u8| f64::from(e) / order as f64;
        exponents(order).iter().map(|e| Point::new(3.0 * share(e[1]) + share(e[2]), 2.0 * share(e[2]))).collect()
    }

    #[test]
    fn straight_triangles_have_one_jacobian() {
        for order in 1..=3 {
            let Bound { least, is_decided, .. } = bound(&straight(order), order, 0);
            assert!(is_decided && (least - 1.0).abs() < 1e-12, "{order} {least}");
            let mut turned = straight(order);
            for p in &mut turned {
                p.x = -p.x;
            }
            assert!(!bound(&turned, order, 9).is_valid());
        }
    }

    #[test]
    fn a_side_that_comes_back_is_found() {
        // The side's node passes the corner opposite.
        let mut points = straight(2);
        points[3] = Point::new(1.0, 5.0);
        let found = bound(&points, 2, 9);
        assert!(found.is_decided && !found.is_valid());
    }

    /// Both sides at its second corner are on a spline. Lagrange's polynomials through these nodes have a negative Jacobian there, of -3e-12 of its mean.
    #[test]
    fn a_corner_that_opens_to_a_half_turn_but_for_rounding_is_not_valid() {
        let nodes = [
            [946_129.422_903_700_4, 835_011.598_926_134_5],
            [929_324.627_700_089_8, 859_397.294_841_805_9],
            [928_349.785_785_896_2, 860_756.322_791_990_6],
            [940_625.928_031_463_6, 843_205.214_682_319_6],
            [935_023.970_506_229_7, 851_334.151_696_206_4],
            [928_999.987_090_244_3, 859_850.517_678_966_5],
            [928_675.039_720_894_3, 860_303.527_062_578],
            [933_154.096_080_439_7, 851_249.752_929_439],
            [939_305.088_868_652_7, 842_853.177_355_606_8],
            [933_836.457_633_54, 851_055.133_380_025_2],
        ];
        let nodes = nodes.map(|[x, y]| [x, y, 0.0]);
        let curved = Curved { order: 3, nodes: nodes[3..].to_vec(), triangles: (0..7).collect() };
        let mesh =
            Mesh { points: nodes[..3].to_vec(), triangles: vec![[0, 1, 2]], curved: Some(curved), ..Mesh::default() };
        let found = bound(&bezier_points(&mesh, 0).0, 3, 9);
        assert!(found.is_decided && !found.is_valid(), "{found:?}");
    }

    proptest! {
        #![proptest_config(crate::test_cases::cases(400))]

        /// What is valid is so wherever it is sampled, and what is decided not to be is not.
        #[test]
        fn sampling_agrees(order in 2..=3_usize, away in prop::collection::vec(-0.7..0.7, 2 * POINTS)) {
            let mut points = straight(order);
            for (i, p) in points.iter_mut().enumerate() {
                *p = *p + Vector::new(away[2 * i], away[2 * i + 1]);
            }
            let (found, sampled) = (bound(&points, order, 12), sampled(&points, order));
            prop_assert_eq!(found.is_valid(), sampled > 0.0 && found.is_decided, "{:?} {}", found, sampled);
            if found.is_valid() {
                let (all, _) = coefficients(&points, order);
                let count = (2 * order - 1) * order;
                let mean = all[..count].iter().sum::<f64>() / count as f64;
                prop_assert!(found.least * mean <= sampled * (1.0 + 1e-9), "{:?} {}", found, sampled / mean);
            }
        }
    }
}
