//! The certificate of a diagram's seeds, and the canvas that it takes.

use super::{Measured, SeedDual, dual, net};
use crate::canvas::{BYTES_PER_VERTEX, Canvas, Draped, Kind, VERTICES_PER_SEED, size_for};
use crate::certificate::{Area, Certificate, Constants, longest_edge, sized_canvas};
use crate::diagram::{Diagram, SurfaceDiagram};
use crate::dual::Road;
use crate::error::{Error, Result};
use crate::geodesic::Method;
use crate::geometry::Point;
use crate::manifold::surface::metric::SurfaceMetric;
use crate::manifold::{Manifold, Place};
use crate::metric::MetricField;
use crate::planar::Planar;
use crate::progress::Silent;
use crate::sampling::demand_memory;
use crate::triangulation::VertexId;

/// Canvases are made so much finer than what they are asked for, so that errors of distances have room.
const RESERVE: f64 = 0.9;
/// So often at most, with what distances on the canvas before left of the room.
const ROUNDS: usize = 3;

/// The canvas for which section 9.4's conditions hold, if the seeds allow one: refined to the sizing field s0 that a
/// certificate on an ordinary canvas asks for, with `size_for` the seeds as the least. Its vertices are estimated
/// before it is made.
///
/// # Errors
/// [`Error::Limit`] where no canvas would do, with the factor by which the seeds miss the conditions, and where the one
/// that would is estimated to need more memory than `memory_limit` bytes; as for [`Canvas::new`].
pub fn certified_canvas(
    kind: Kind,
    domain: &Planar,
    field: &dyn MetricField,
    seeds: &[Point],
    constants: Constants,
    memory_limit: u64,
) -> Result<Canvas> {
    let make = |vertices: usize| Canvas::new(kind, domain, field, vertices);
    let sized = |size: f64, bounds: [f64; 2]| {
        if kind == Kind::Isotropic {
            // Its sizes are sixths of the metric's unit.
            return Canvas::isotropic_sized(domain, field, 6.0 * size).map(Some);
        }
        // What a certificate speaks of is no star set.
        let make = |vertices: usize| Canvas::intrinsic(domain, field, vertices);
        sized_canvas(size, bounds, make, |canvas| (longest_edge(canvas.topology()), canvas.vertex_count()))
    };
    let examine = |canvas: &Canvas| {
        let diagram = Diagram::new(canvas, field, seeds)?;
        Ok(examined(&diagram, constants))
    };
    Request { kind, seeds: seeds.len(), memory_limit }.met(make, sized, examine)
}

/// The same of seeds on a surface, which are vertices of the canvas, and are returned with it.
///
/// # Errors
/// As for [`certified_canvas`] and [`Canvas::on_surface`].
pub fn certified_canvas_on<'s>(
    kind: Kind,
    manifold: &'s Manifold,
    metric: &'s dyn SurfaceMetric,
    seeds: &[Place],
    constants: Constants,
    memory_limit: u64,
) -> Result<(Canvas<Draped<'s>>, Vec<VertexId>)> {
    let make = |vertices: usize| Canvas::on_surface(kind, manifold, metric, vertices, seeds);
    let sized = |size: f64, bounds: [f64; 2]| {
        sized_canvas(size, bounds, make, |(canvas, _)| (longest_edge(canvas.topology()), canvas.vertex_count()))
    };
    let examine = |(canvas, at): &(Canvas<Draped<'s>>, Vec<VertexId>)| {
        let diagram = SurfaceDiagram::on_surface(canvas, at, Method::March)?;
        Ok(examined(&diagram, constants))
    };
    Request { kind, seeds: seeds.len(), memory_limit }.met(make, sized, examine)
}

/// What a diagram is certified for, and what canvases there take.
fn examined<'a, G: Measured<'a>>(diagram: &Diagram<'a, G>, constants: Constants) -> (Certificate, Area) {
    let SeedDual { exact, .. } = dual(diagram, Road::Both, &Silent);
    (G::certificate(diagram, &exact, &net(diagram, &exact), constants), Area::of(diagram.ground()))
}

/// What canvas is asked for.
struct Request {
    kind: Kind,
    seeds: usize,
    memory_limit: u64,
}

impl Request {
    /// The canvas: made with so many vertices first, then of a size, from an estimate of its vertices to the most that are allowed.
    fn met<C>(
        &self,
        make: impl Fn(usize) -> Result<C>,
        sized: impl Fn(f64, [f64; 2]) -> Result<Option<C>>,
        examine: impl Fn(&C) -> Result<(Certificate, Area)>,
    ) -> Result<C> {
        let vertices = size_for(self.seeds, VERTICES_PER_SEED);
        demand_memory(self.seeds as f64, vertices as f64, self.memory_limit)?;
        let mut canvas = make(vertices)?;
        for _ in 0..ROUNDS {
            let (certificate, area) = examine(&canvas)?;
            if certificate.verdict("9.4").is_some_and(crate::certificate::Verdict::holds) {
                break;
            }
            // A finer canvas has smaller errors: what is asked with none leaves the most room.
            let size = RESERVE
                * certificate.verdict("9.10").and_then(|verdict| verdict.size).ok_or_else(|| hopeless(&certificate))?;
            let size = size.min(RESERVE * certificate.size);
            let cost = area.cost(size);
            let estimate = if self.kind == Kind::Isotropic { cost.isotropic } else { cost.intrinsic };
            demand_memory(self.seeds as f64, estimate, self.memory_limit)?;
            let most = self.memory_limit as f64 / BYTES_PER_VERTEX;
            canvas = sized(size, [estimate, most])?.ok_or_else(|| too_fine(size, most))?;
        }
        Ok(canvas)
    }
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
