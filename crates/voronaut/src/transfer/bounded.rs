//! Values brought back into bounds; what they lose is gained nearby.

use super::mass::MassMatrix;
use crate::sparse::dot;

/// Sweeps that spread what is out of bounds to the neighbours, before the little that is left goes everywhere.
const SWEEPS: usize = 50;
/// The share of all mass that is little.
const LITTLE: f64 = 1e-12;

/// Values within bounds with the same integral: what is beyond goes to the neighbours, as the mass matrix spreads it (Farrell et
/// al. 2009), until there is room; what is left in the end goes where there is room, in proportion to that. Values within their bounds
/// from the start stay as they are.
///
/// There must be values within the bounds with that integral.
pub(super) fn bounded(matrix: &MassMatrix<'_>, mut values: Vec<f64>, bounds: &[(f64, f64)]) -> Vec<f64> {
    let masses = &matrix.lumped;
    let target = dot(&values, masses);
    let little = LITTLE * values.iter().zip(masses).map(|(u, m)| u.abs() * m).sum::<f64>();
    for _ in 0..SWEEPS {
        let excess: Vec<f64> = values.iter().zip(bounds).map(|(&u, &bounds)| u - within(u, bounds)).collect();
        if excess.iter().zip(masses).map(|(e, m)| e.abs() * m).sum::<f64>() <= little {
            break;
        }
        let spread = matrix.times(&excess);
        for (i, value) in values.iter_mut().enumerate().filter(|(i, _)| masses[*i] > 0.0) {
            *value += spread[i] / masses[i] - excess[i];
        }
    }
    values.iter_mut().zip(bounds).for_each(|(u, &bounds)| *u = within(*u, bounds));
    close(&mut values, masses, bounds, target);
    values
}

/// Brings the weighted sum to `target`, every value by the same share of the room it has.
fn close(values: &mut [f64], masses: &[f64], bounds: &[(f64, f64)], target: f64) {
    let missing = target - dot(values, masses);
    let room = |u: f64, (low, high): (f64, f64)| if missing > 0.0 { high - u } else { u - low };
    let total: f64 = values.iter().zip(bounds).zip(masses).map(|((&u, &bounds), m)| room(u, bounds) * m).sum();
    if total > 0.0 {
        let share = (missing / total).clamp(-1.0, 1.0);
        values.iter_mut().zip(bounds).for_each(|(u, &bounds)| *u = within(*u + share * room(*u, bounds), bounds));
    }
}

/// Bounds may be those of no value at all.
fn within(value: f64, (low, high): (f64, f64)) -> f64 {
    value.max(low).min(high)
}
