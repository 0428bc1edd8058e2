//! Curved triangles moved to where the error of interpolating a function is least.

use super::EXCHANGED_SHARE;
use super::elements::Elements;
use super::exchange::exchange;
use super::flips::flip;
use super::newton::{Aim, minimise_damped};
use super::target::Target;
use crate::error::Result;
use crate::metric::{MetricField, Norm, ScalarField};
use crate::optimise::{Patience, Polished};
use crate::progress::Progress;

/// The least Jacobian that polishing may leave, in units of a triangle's mean: where it nearly vanishes polynomials on the triangle have no bounds on their
/// derivatives.
const LEAST: f64 = 0.05;
/// What going a unit of the metric costs at first, in mean energies of triangles: steps are about that long.
const DAMPING: f64 = 0.1;
/// Steps between rounds of flips.
const STEPS: usize = 4;

/// Moves all points, flips sides and exchanges vertices, in so many rounds at most and as long as a step gains a share of the error. The metric is that whose
/// unit is a length that points may go in a step.
///
/// # Errors
/// The work is to stop.
pub(super) fn polish(
    elements: &mut Elements,
    metric: &dyn MetricField,
    (function, norm): (&dyn ScalarField, Norm),
    patience: Patience,
    progress: &dyn Progress,
) -> Result<Polished> {
    let measured = |elements: &Elements| {
        let all: Vec<_> = (0..elements.triangles.len()).map(|t| elements.of_triangle(&elements.points, t)).collect();
        Target::new(function, norm, elements.order).in_unit_of(&all)
    };
    let (mut target, error) = measured(elements);
    let mut found = Polished { error: vec![error], ..Polished::default() };
    let (mut damping, mut best) = (DAMPING, elements.clone());
    for _ in 0..patience.steps {
        let aim = Aim { metric, lengths: 0.0, least: LEAST, target: Some(&target) };
        let moves = minimise_damped(elements, &aim, STEPS, &mut damping, progress)?;
        let flips = flip(elements, &aim) as u64;
        progress.advance(1)?;
        let (after, error) = measured(elements);
        let before = found.error[found.error.len() - 1];
        if error >= before {
            break;
        }
        (found.moves, found.flips) = (found.moves + moves, found.flips + flips);
        found.error.push(error);
        best.clone_from(elements);
        if before - error < STEPS as f64 * patience.gain * before {
            break;
        }
        let most = (elements.vertices() as f64 * EXCHANGED_SHARE) as usize;
        if let Some(changed) = exchange(elements, &Aim { target: Some(&after), ..aim }, most) {
            *elements = changed;
        }
        target = after;
    }
    *elements = best;
    Ok(found)
}
