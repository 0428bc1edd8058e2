//! Metrics from what is typed, in the plane and on surfaces.

use crate::options::{MetricChoices, refuse};
use crate::world::World;
use voronaut::Result;
use voronaut::geometry::Point;
use voronaut::manifold::Manifold;
use voronaut::manifold::domain::Domain;
use voronaut::manifold::surface::metric::SurfaceMetric;
use voronaut::metric::MetricField;
use voronaut::recipe::{GradedAt, Idle, PlanarMetric, Task};
use voronaut_io::metric_origin;

/// What a metric is for.
pub(crate) fn task(world: &World, text: &str, choices: &MetricChoices, on_surface: bool) -> Task {
    let origin = world.metric_origin(text).unwrap_or_else(|| metric_origin(text));
    Task { origin, is_limited: choices.options().is_limiting(), on_surface, ..Task::default() }
}

/// The metric in the plane that a text names. `own` is what the domain was read from; `at` the multiple in which edges have length one.
pub(crate) fn in_plane(
    world: &World,
    text: &str,
    domain: &Domain,
    own: &str,
    choices: &MetricChoices,
    at: GradedAt,
) -> Result<PlanarMetric> {
    choices.options().idle(task(world, text, choices, false)).iter().try_for_each(Idle::demand_unset)?;
    world.planar_metric(text, domain, own, choices, at)
}

/// The metric in the plane that a mesh is measured in, times a factor.
pub(crate) fn measuring(
    world: &World,
    text: &str,
    domain: &Domain,
    own: &str,
    choices: &MetricChoices,
    scale: f64,
) -> Result<Box<dyn MetricField>> {
    let metric = in_plane(world, text, domain, own, choices, GradedAt::Scale(scale))?.field;
    Ok(Box::new(move |p: Point| metric.at(p) * scale))
}

/// The metric on a surface that a text names; `at` as of [`in_plane`].
pub(crate) fn on_surface(
    world: &World,
    text: &str,
    input: &Manifold,
    choices: &MetricChoices,
    at: GradedAt,
) -> Result<Box<dyn SurfaceMetric>> {
    demand_for_surfaces(world, text, choices)?;
    world.surface_metric(text, input, choices, at)
}

/// Refuses what is not there for a metric on surfaces.
pub(crate) fn demand_for_surfaces(world: &World, text: &str, choices: &MetricChoices) -> Result<()> {
    choices.options().idle(task(world, text, choices, true)).iter().try_for_each(Idle::demand_unset)?;
    let help = "give the file that the values belong to as the domain";
    refuse([(choices.background.is_some(), "--background on a surface", help)])
}
