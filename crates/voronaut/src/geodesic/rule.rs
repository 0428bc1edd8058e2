//! Gauss-Legendre quadrature on [0, 1], with the polynomials that paths are made of at its points.

use crate::elementary::Elementary;

/// Quadrature points and weights, and at each point as many functions, the modes, and their slopes: the slope of
/// the k-th is the Legendre polynomial of degree k on [0, 1], normalised, and it vanishes at both ends.
///
/// With one tensor everywhere the energy of a path with these modes is a sum of squares, mode by mode.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    pub(super) points: Vec<f64>,
    pub(super) weights: Vec<f64>,
    pub(super) values: Vec<Vec<f64>>,
    pub(super) slopes: Vec<Vec<f64>>,
}

impl Rule {
    /// A rule of `points` points for paths of `modes` modes.
    pub(super) fn new(points: usize, modes: usize) -> Self {
        let nodes: Vec<(f64, f64)> = (0..points).map(|i| node(points, i)).collect();
        let mut rule = Self { points: Vec::new(), weights: Vec::new(), values: Vec::new(), slopes: Vec::new() };
        for (s, weight) in nodes {
            let p = legendre(modes + 1, s);
            let scale = |k: usize| ((2 * k + 1) as f64).sqrt();
            rule.points.push(0.5 * (1.0 + s));
            rule.weights.push(0.5 * weight);
            rule.slopes.push((1..=modes).map(|k| scale(k) * p[k]).collect());
            rule.values.push(values(modes, &p));
        }
        rule
    }

    pub(super) fn len(&self) -> usize {
        self.points.len()
    }
}

/// The values of so many modes at t in [0, 1].
pub(super) fn modes_at(modes: usize, t: f64) -> Vec<f64> {
    values(modes, &legendre(modes + 1, 2.0 * t - 1.0))
}

/// The values of so many modes where the Legendre polynomials are known.
fn values(modes: usize, p: &[f64]) -> Vec<f64> {
    // The integral of P_k is (P_{k+1} - P_{k-1}) / (2 k + 1), and half of that on [0, 1].
    (1..=modes).map(|k| 0.5 * (p[k + 1] - p[k - 1]) / ((2 * k + 1) as f64).sqrt()).collect()
}

/// Legendre polynomials of degree 0 to n at s in [-1, 1].
fn legendre(n: usize, s: f64) -> Vec<f64> {
    let mut p = vec![1.0, s];
    for k in 1..n {
        let k1 = k as f64;
        p.push(((2.0 * k1 + 1.0) * s * p[k] - k1 * p[k - 1]) / (k1 + 1.0));
    }
    p
}

/// Abscissa and weight i of n on [-1, 1]: a root of the Legendre polynomial of degree n by Newton steps.
fn node(n: usize, i: usize) -> (f64, f64) {
    let degree = n as f64;
    let mut s = -((i as f64 + 0.75) / (degree + 0.5) * std::f64::consts::PI).cosine();
    let mut slope = 1.0;
    for _ in 0..8 {
        let p = legendre(n, s);
        slope = degree * (s * p[n] - p[n - 1]) / (s * s - 1.0);
        s -= p[n] / slope;
    }
    (s, 2.0 / ((1.0 - s * s) * slope * slope))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_for_polynomials_and_modes_are_orthonormal() {
        for (points, modes) in [(5, 2), (8, 4), (14, 8), (28, 16)] {
            let rule = Rule::new(points, modes);
            let sum = |f: &dyn Fn(usize) -> f64| (0..points).map(|i| rule.weights[i] * f(i)).sum::<f64>();
            for degree in 0..2 * points {
                let exact = 1.0 / (degree as f64 + 1.0);
                assert!((sum(&|i| rule.points[i].powf(degree as f64)) - exact).abs() < 1e-13);
            }
            for (k, l) in [(0, 0), (0, 1), (1, 1), (modes - 1, modes - 1), (modes - 2, modes - 1)] {
                let product = sum(&|i| rule.slopes[i][k] * rule.slopes[i][l]);
                assert!((product - f64::from(u8::from(k == l))).abs() < 1e-12);
            }
            // b_1 = sqrt(3) t (t - 1).
            let t = rule.points[1];
            assert!((rule.values[1][0] - 3.0_f64.sqrt() * t * (t - 1.0)).abs() < 1e-14);
        }
    }
}
