//! The certificate of a diagram's seeds, and the canvas that it takes.

use super::{SeedDual, dual, net};
use crate::canvas::{BYTES_PER_VERTEX, Canvas, Kind, VERTICES_PER_SEED, size_for};
use crate::certificate::{Area, Certificate, Constants, sized_canvas};
use crate::diagram::Diagram;
use crate::domain::Domain;
use crate::dual::Road;
use crate::error::{Error, Result};
use crate::geometry::Point;
use crate::metric::MetricField;
use crate::progress::Silent;
use crate::sampling::demand_memory;

/// Canvases are made so much finer than what they are asked for, so that errors of distances have room.
const RESERVE: f64 = 0.9;
/// So often at most, with what distances on the canvas before left of the room.
const ROUNDS: usize = 3;

/// The certificate of a diagram whose exact dual is known.
pub(crate) fn certify(
    diagram: &Diagram,
    field: &dyn MetricField,
    exact: &[[u32; 3]],
    constants: Constants,
) -> Certificate {
    Certificate::new(diagram, exact, &net(diagram, field, exact), constants)
}

/// The canvas for which section 9.4's conditions hold, if the seeds allow one: refined to the sizing field s0 that a
/// certificate on an ordinary canvas asks for, with `size_for` the seeds as the least. Its vertices are estimated
/// before it is made.
///
/// # Errors
/// [`Error::Limit`] where no canvas would do, with the factor by which the seeds miss the conditions, and where the one
/// that would is estimated to need more memory than `memory_limit` bytes; as for [`Canvas::new`].
pub fn certified_canvas(
    kind: Kind,
    domain: &Domain,
    field: &dyn MetricField,
    seeds: &[Point],
    constants: Constants,
    memory_limit: u64,
) -> Result<Canvas> {
    let vertices = size_for(seeds.len(), VERTICES_PER_SEED);
    demand_memory(seeds.len() as f64, vertices as f64, memory_limit)?;
    let mut canvas = Canvas::new(kind, domain, field, vertices)?;
    for _ in 0..ROUNDS {
        let certificate = on(&canvas, field, seeds, constants)?;
        if certificate.verdict("9.4").is_some_and(crate::certificate::Verdict::holds) {
            break;
        }
        // A finer canvas has smaller errors: what is asked with none leaves the most room.
        let size = RESERVE
            * certificate.verdict("9.10").and_then(|verdict| verdict.size).ok_or_else(|| hopeless(&certificate))?;
        let size = size.min(RESERVE * certificate.size);
        let cost = Area::of(&canvas, field).cost(size);
        let estimate = if kind == Kind::Isotropic { cost.isotropic } else { cost.intrinsic };
        demand_memory(seeds.len() as f64, estimate, memory_limit)?;
        canvas = if kind == Kind::Isotropic {
            // Its sizes are sixths of the metric's unit.
            Canvas::isotropic_sized(domain, field, 6.0 * size)?
        } else {
            let most = memory_limit as f64 / BYTES_PER_VERTEX;
            sized_canvas(domain, field, size, estimate, most)?.ok_or_else(|| too_fine(size, most))?
        };
    }
    Ok(canvas)
}

fn on(canvas: &Canvas, field: &dyn MetricField, seeds: &[Point], constants: Constants) -> Result<Certificate> {
    let diagram = Diagram::new(canvas, field, seeds)?;
    let SeedDual { exact, .. } = dual(&diagram, field, Road::Both, &Silent);
    Ok(certify(&diagram, field, &exact, constants))
}

fn too_fine(size: f64, most: f64) -> Error {
    let what = format!(
        "a canvas without edges longer than {:.3e} in the metric needs more than {most:.3e} vertices",
        2.0 * size
    );
    Error::limit(what, "raise `memory_limit`, or give `canvas_size` a number")
}

fn hopeless(certificate: &Certificate) -> Error {
    let verdict = certificate.verdict("9.10");
    let doubt = verdict.and_then(|verdict| verdict.not_measured.clone());
    let missed = verdict.into_iter().flat_map(|verdict| &verdict.conditions).find(|condition| !condition.holds);
    let why = missed
        .map(|condition| format!("{}: {:.3e} against {:.3e}", condition.what, condition.measured, condition.limit));
    let what = format!("no canvas is certified for these seeds: {}", doubt.or(why).unwrap_or_default());
    let help = "see `certify` for all figures; take more seeds, better protected (mesh with `seeding=protected`), or give \
                `canvas_size` a number";
    Error::limit(what, help)
}
