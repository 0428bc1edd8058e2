//! Conjugate gradients.

/// The share of the right-hand side that a residual is rounding of.
const ROUNDING: f64 = 1e-16;

/// Solves A x = b by conjugate gradients with Jacobi's preconditioner, from a guess: `times` is what A makes of a vector, b is
/// `right`. It ends when the residual is rounding, or after so many steps.
///
/// A is symmetric and positive definite. Where its diagonal is zero the unknown takes no part and stays as guessed.
pub(crate) fn conjugate_gradients(
    times: impl Fn(&[f64]) -> Vec<f64>,
    diagonal: &[f64],
    right: &[f64],
    guess: Vec<f64>,
    steps: usize,
) -> Vec<f64> {
    let scaled =
        |r: &[f64]| -> Vec<f64> { r.iter().zip(diagonal).map(|(r, d)| if *d > 0.0 { r / d } else { 0.0 }).collect() };
    let mut values = guess;
    let mut residual: Vec<f64> = right.iter().zip(times(&values)).map(|(b, a)| b - a).collect();
    let mut direction = scaled(&residual);
    let mut square = dot(&residual, &direction);
    let enough = dot(right, &scaled(right)) * ROUNDING * ROUNDING;
    for _ in 0..steps {
        if square <= enough {
            break;
        }
        let image = times(&direction);
        let step = square / dot(&direction, &image);
        values.iter_mut().zip(&direction).for_each(|(x, d)| *x += step * d);
        residual.iter_mut().zip(&image).for_each(|(r, a)| *r -= step * a);
        let better = scaled(&residual);
        let next = dot(&residual, &better);
        let share = next / square;
        direction.iter_mut().zip(&better).for_each(|(d, z)| *d = z + share * *d);
        square = next;
    }
    values
}

/// The sum of products, in order: it does not depend on threads.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
