//! The complexity of a metric at vertices, in closed form, and metrics of a given complexity.

use super::Vertices;
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::Tensor;

/// The integral of sqrt(det M) over a mesh, of the metric that is log-Euclidean between the vertices: exact but for
/// rounding, for there log sqrt(det M) is linear on every triangle. Triangles of either orientation count.
pub(crate) fn complexity(mesh: &impl Vertices, tensors: &[Tensor]) -> f64 {
    let logs: Vec<f64> = tensors.iter().map(|tensor| 0.5 * tensor.determinant().logarithm()).collect();
    mesh.triangles().map(|(t, double_area)| of_triangle(double_area, t.map(|v| logs[v as usize]))).sum()
}

/// The same on one triangle, by twice its area and log sqrt(det M) at its corners.
pub(in crate::metric) fn of_triangle(double_area: f64, logs: [f64; 3]) -> f64 {
    double_area * divided_difference(logs)
}

/// A metric times the factor that gives it a complexity.
pub(super) fn scaled_to(mesh: &impl Vertices, tensors: &[Tensor], target_complexity: f64) -> Result<Vec<Tensor>> {
    demand_target(target_complexity)?;
    let factor = target_complexity / complexity(mesh, tensors);
    if !(factor > 0.0 && factor.is_finite()) {
        let what = format!("no factor gives the metric the complexity {target_complexity}");
        return Err(Error::metric(
            what,
            "the mesh as a whole",
            "check its triangles for areas of zero, its metric for overflow",
        ));
    }
    Ok(tensors.iter().map(|&tensor| tensor * factor).collect())
}

/// Refuses what is no complexity.
pub(super) fn demand_target(target_complexity: f64) -> Result<()> {
    if target_complexity > 0.0 && target_complexity.is_finite() {
        return Ok(());
    }
    let help = "a complexity is positive and finite: about 0.87 times the number of vertices";
    Err(Error::parse("complexity", format!("{target_complexity} is no complexity"), help))
}

/// The second divided difference of exp, by whose integral representation (Hermite and Genocchi) the integral of exp of a
/// linear function over a triangle is twice its area times this, at its values at the corners.
fn divided_difference(values: [f64; 3]) -> f64 {
    let mut sorted = values;
    sorted.sort_unstable_by(f64::total_cmp);
    let [a, b, c] = sorted;
    if c - a < CLOSE {
        return close_difference(sorted);
    }
    // Not cancelled where a and c are apart: the two differ by more than a third.
    (first_difference(b, c) - first_difference(a, b)) / (c - a)
}

/// Values nearer to each other are expanded about their mean.
const CLOSE: f64 = 1.0;

/// (exp b - exp a) / (b - a), for a <= b.
fn first_difference(a: f64, b: f64) -> f64 {
    let d = b - a;
    b.exponential() * if d > 0.0 { -(-d).exponential_less_one() / d } else { 1.0 }
}

/// The sum of `h_k / (k + 2)!`, with `h_k` the complete homogeneous symmetric polynomials, about the mean: its terms fall like 1 / k!.
fn close_difference(values: [f64; 3]) -> f64 {
    const TERMS: u32 = 20;
    let mean = values.iter().sum::<f64>() / 3.0;
    let [a, b, c] = values.map(|value| value - mean);
    // Of one variable, of two, of three: h_k(x, y) = h_k(x) + y h_(k-1)(x, y).
    let (mut one, mut two, mut three, mut factorial, mut sum) = (1.0, 1.0, 1.0, 2.0, 0.5);
    for k in 1..TERMS {
        one *= a;
        two = one + b * two;
        three = two + c * three;
        factorial *= f64::from(k + 2);
        sum += three / factorial;
    }
    mean.exponential() * sum
}

#[cfg(test)]
mod tests {
    use super::super::test_meshes::{grid, tensors_at};
    use super::super::weighted::weighted;
    use super::*;
    use crate::geometry::{Point, Vector};
    use crate::mesh::Mesh;
    use crate::metric::Norm;
    use crate::metric::{MetricField, Sampled};
    use proptest::prelude::*;

    /// By Gauss's rule of two points along each of two axes, on 4^12 triangles.
    fn by_halving(values: [f64; 3], depth: u32) -> f64 {
        let [a, b, c] = values;
        if depth == 0 {
            // Twice the area is one; the rule of the middles of the edges is exact for quadratics.
            return ((0.5 * (a + b)).exp() + (0.5 * (b + c)).exp() + (0.5 * (c + a)).exp()) / 6.0;
        }
        let (d, e, f) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a));
        let parts = [[a, d, f], [d, b, e], [f, e, c], [d, e, f]];
        parts.iter().map(|&part| by_halving(part, depth - 1)).sum::<f64>() / 4.0
    }

    #[test]
    fn integrals_of_exponentials() {
        for values in
            [[0.0; 3], [0.3, 0.1, -0.2], [0.0, 0.999, 0.0], [1.001, 0.0, 0.0], [3.0, -2.0, 0.5], [-2.0, 3.0, 3.0]]
        {
            let (found, truth) = (divided_difference(values), by_halving(values, 8));
            assert!((found / truth - 1.0).abs() < 1e-9, "{values:?}: {found} {truth}");
        }
        assert!((divided_difference([2.0; 3]) / (0.5 * 2f64.exp()) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn both_formulas_agree_where_they_meet() {
        for middle in [0.0, 1e-12, 0.3, 0.5, 0.97, 1.0] {
            let values = [0.0, middle, 1.0];
            let apart = (first_difference(middle, 1.0) - first_difference(0.0, middle)) / 1.0;
            assert!((close_difference(values) / apart - 1.0).abs() < 1e-14, "{middle}");
        }
    }

    #[test]
    fn the_closed_form_is_the_integral_of_the_field() {
        let mesh = grid(4, 0.3);
        let tensors = tensors_at(&mesh, |p| {
            let angle = 3.0 * p.x + p.y;
            Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), (6.0 * p.x).exp(), 1.0 + p.y)
        });
        let field = Sampled::new(&mesh, &tensors).unwrap();
        let by_points = |t: [u32; 3]| {
            let [a, b, c] = mesh.corners_of(t);
            let n = 60;
            let (mut sum, mut count) = (0.0, 0.0);
            for i in 0..n {
                for j in 0..n - i {
                    let (u, v) = ((f64::from(i) + 1.0 / 3.0) / f64::from(n), (f64::from(j) + 1.0 / 3.0) / f64::from(n));
                    sum += field.at(a + (b - a) * u + (c - a) * v).determinant().sqrt();
                    count += 1.0;
                }
            }
            0.5 * (b - a).cross(c - a) * sum / count
        };
        let truth: f64 = mesh.triangles.iter().map(|&t| by_points(t)).sum();
        // The sum over points is of first order.
        assert!((complexity(&mesh, &tensors) / truth - 1.0).abs() < 0.01);
    }

    fn normalise(mesh: &Mesh, hessians: &[Tensor], norm: Norm, target: f64) -> Result<Vec<Tensor>> {
        scaled_to(mesh, &weighted(hessians, norm)?, target)
    }

    fn hessians() -> impl Strategy<Value = Vec<Tensor>> {
        proptest::collection::vec(
            (-50.0..50.0, -50.0..50.0, -50.0..50.0).prop_map(|(a, b, c)| Tensor::new(a, b, c)),
            25,
        )
    }

    proptest! {
        #[test]
        fn the_target_is_met(hessians in hessians(), target in 1e-3..1e9_f64, scale in -9.0..9.0_f64) {
            let mesh = grid(4, 0.2);
            let scaled: Vec<Tensor> = hessians.iter().map(|&h| h * 10_f64.powf(scale)).collect();
            for norm in [1.0, 2.0, 4.0, f64::INFINITY].map(|p| Norm::new(p).unwrap()) {
                let found = normalise(&mesh, &scaled, norm, target).unwrap();
                prop_assert!((complexity(&mesh, &found) / target - 1.0).abs() < 1e-12);
                // The function's units do not matter.
                let plain = normalise(&mesh, &hessians, norm, target).unwrap();
                prop_assert!(found.iter().zip(&plain).all(|(f, p)| (f.xx / p.xx - 1.0).abs() < 1e-6), "{norm}");
            }
        }
    }

    #[test]
    fn the_norm_decides_between_strong_and_weak_places() {
        // Where the Hessian is 16 times as large the density is 16^(p / (p + 1)) times as large.
        let mesh = grid(4, 0.0);
        let hessians = tensors_at(&mesh, |p| Tensor::IDENTITY * if p.x > 0.5 { 16.0 } else { 1.0 });
        for (p, ratio) in [(1.0, 4.0), (2.0, 16_f64.powf(2.0 / 3.0)), (4.0, 16_f64.powf(0.8)), (f64::INFINITY, 16.0)] {
            let found = normalise(&mesh, &hessians, Norm::new(p).unwrap(), 7.0).unwrap();
            let density = |at: Point| {
                let v = (0..25).find(|&v| mesh.point(v) == at).unwrap();
                found[v as usize].determinant().sqrt()
            };
            let found = density(Point::new(1.0, 0.5)) / density(Point::new(0.0, 0.5));
            assert!((found / ratio - 1.0).abs() < 1e-12, "{p}: {found}");
        }
    }

    #[test]
    fn senseless_targets_are_named() {
        let mesh = grid(1, 0.0);
        for target in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = normalise(&mesh, &[Tensor::IDENTITY; 4], Norm::default(), target).unwrap_err();
            assert!(error.to_string().contains("is no complexity"), "{error}");
        }
    }
}
