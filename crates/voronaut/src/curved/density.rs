//! The energy of a linear map of the plane, by its singular values; least, and zero, of isometries.

use crate::geometry::Vector;

/// A 2 by 2 matrix by its columns.
pub(super) type Matrix = [Vector; 2];

/// The density at a map: its value, its derivative by the matrix, and its second derivative as curvatures along orthonormal
/// matrices.
pub(super) struct Density {
    pub(super) value: f64,
    pub(super) slope: Matrix,
    pub(super) curvatures: [(f64, Matrix); 4],
}

/// The sum of products of entries.
pub(super) fn inner(a: &Matrix, b: &Matrix) -> f64 {
    a[0].dot(b[0]) + a[1].dot(b[1])
}

pub(super) fn times(a: Matrix, s: f64) -> Matrix {
    a.map(|column| column * s)
}

pub(super) fn plus(a: Matrix, b: Matrix) -> Matrix {
    [a[0] + b[0], a[1] + b[1]]
}

fn turned(a: Matrix) -> Matrix {
    a.map(Vector::perpendicular)
}

/// The symmetric Dirichlet energy, (|A|^2 + |A^-1|^2) / 2 - 2, of a map that keeps orientation; infinite of others (Smith and
/// Schaefer 2015). Its second derivatives in closed form are those of Smith, de Goes and Kim 2019.
pub(super) fn dirichlet(a: Matrix) -> f64 {
    let determinant = a[0].cross(a[1]);
    if determinant <= 0.0 {
        return f64::INFINITY;
    }
    0.5 * inner(&a, &a) * (1.0 + 1.0 / (determinant * determinant)) - 2.0
}

impl Density {
    /// That of [`dirichlet`].
    pub(super) fn dirichlet(a: Matrix) -> Self {
        let (rotation, reflection, s, t) = decomposed(a);
        let inverse_cubes = |p: f64, q: f64| p / (q * q * q);
        let (ds, dt) = (s - inverse_cubes(1.0, s), t - inverse_cubes(1.0, t));
        let (dds, ddt) = (1.0 + 3.0 / (s * s * s * s), 1.0 + 3.0 / (t * t * t * t));
        let product = s * t;
        let twist = 1.0 - inverse_cubes(s * s - product + t * t, product);
        let flip = 1.0 + inverse_cubes(s * s + product + t * t, product);
        let half = std::f64::consts::FRAC_1_SQRT_2;
        // Along diag(1, 0) and diag(0, 1) in the axes of the map.
        let (first, second) =
            (times(plus(rotation, reflection), 0.5), times(plus(rotation, times(reflection, -1.0)), 0.5));
        Self {
            value: dirichlet(a),
            slope: plus(times(first, ds), times(second, dt)),
            curvatures: [
                (dds, first),
                (ddt, second),
                (twist, times(turned(rotation), half)),
                (flip, times(turned(reflection), half)),
            ],
        }
    }
}

/// Of the decomposition U diag(s, t) V' of a map the rotation U V', the reflection U diag(1, -1) V', s and t: the map is (s + t) / 2
/// times the one plus (s - t) / 2 times the other.
fn decomposed([p, q]: Matrix) -> (Matrix, Matrix, f64, f64) {
    let turning = Vector::new(0.5 * (p.x + q.y), 0.5 * (p.y - q.x));
    let mirroring = Vector::new(0.5 * (p.x - q.y), 0.5 * (p.y + q.x));
    let (sum, difference) = (turning.norm(), mirroring.norm());
    let unit = |v: Vector, norm: f64| if norm > 0.0 { v * (1.0 / norm) } else { Vector::new(1.0, 0.0) };
    let (r, m) = (unit(turning, sum), unit(mirroring, difference));
    let determinant = p.cross(q);
    let large = sum + difference;
    // The smaller one without cancellation.
    ([r, r.perpendicular()], [m, Vector::new(m.y, -m.x)], large, determinant / large)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(a: f64, b: f64, tolerance: f64) -> bool {
        (a - b).abs() <= tolerance * (1.0 + a.abs().max(b.abs()))
    }

    #[test]
    fn isometries_have_none() {
        let at = Density::dirichlet([Vector::new(0.6, 0.8), Vector::new(-0.8, 0.6)]);
        assert!(at.value.abs() < 1e-15 && inner(&at.slope, &at.slope) < 1e-30);
        assert!(dirichlet([Vector::new(1.0, 0.0), Vector::new(0.0, -1.0)]).is_infinite());
    }

    proptest! {
        #[test]
        fn derivatives_are_those_of_the_value(a in prop::array::uniform4(-2.0..2.0), d in prop::array::uniform4(-1.0..1.0)) {
            let matrix = |x: [f64; 4]| [Vector::new(x[0], x[1]), Vector::new(x[2], x[3])];
            let (a, d) = (matrix(a), matrix(d));
            prop_assume!(a[0].cross(a[1]) > 0.3);
            let h = 1e-4;
            let moved = |s: f64| dirichlet(plus(a, times(d, s * h)));
            let at = Density::dirichlet(a);
            prop_assert!(close(inner(&at.slope, &d), (moved(1.0) - moved(-1.0)) / (2.0 * h), 1e-4));
            let second = (moved(1.0) - 2.0 * moved(0.0) + moved(-1.0)) / (h * h);
            let found: f64 = at.curvatures.iter().map(|(c, e)| c * inner(e, &d) * inner(e, &d)).sum();
            prop_assert!(close(found, second, 1e-3), "{} {}", found, second);
            for (i, (_, e)) in at.curvatures.iter().enumerate() {
                for (j, (_, f)) in at.curvatures.iter().enumerate() {
                    prop_assert!(close(inner(e, f), f64::from(u8::from(i == j)), 1e-12));
                }
            }
        }
    }
}
