//! Metrics from what is typed, in the plane and on surfaces.

use crate::options::{MetricChoices, refuse};
use std::path::Path;
use voronaut::Result;
use voronaut::domain::Domain;
use voronaut::geometry::Tensor3;
use voronaut::metric::MetricSpec;
use voronaut::recipe::{GradedAt, Idle, Origin, PlanarMetric, Task};
use voronaut::surface::metric::SurfaceMetric;
use voronaut::surface::{Input, Place};
use voronaut_io::{MetricFiles, MetricSource, surface_metric};

/// What a metric in the plane is for.
pub(crate) fn task(source: &MetricSource, choices: &MetricChoices) -> Task {
    let origin = match source {
        MetricSource::Hessian(_) => Origin::Values,
        MetricSource::Named(MetricSpec::Hessian(_)) => Origin::Function,
        MetricSource::Named(_) | MetricSource::File(_) => Origin::Sizes,
    };
    Task { origin, is_limited: choices.options().is_limiting(), ..Task::default() }
}

/// The metric in the plane that a text names. `own` is what the domain was read from; `at` the multiple in which edges have length one.
pub(crate) fn in_plane(
    text: &str,
    domain: &Domain,
    own: &str,
    choices: &MetricChoices,
    at: GradedAt,
) -> Result<PlanarMetric> {
    let source = MetricSource::parse(text)?;
    choices.options().idle(task(&source, choices)).iter().try_for_each(Idle::demand_unset)?;
    let (own, background) = (Some(Path::new(own)), choices.background.as_deref());
    let files = MetricFiles { own, background, order: choices.tensor_order };
    files.metric(&source, domain, &choices.options(), at)
}

/// The metric on a surface that a text names, within limits.
pub(crate) fn on_surface(text: &str, input: &Input, choices: &MetricChoices) -> Result<Box<dyn SurfaceMetric>> {
    demand_for_surfaces(choices)?;
    surface_metric(text, input, choices.bounds(), choices.tensor_order)
}

/// Refuses what is not there for metrics on surfaces.
pub(crate) fn demand_for_surfaces(choices: &MetricChoices) -> Result<()> {
    let task = Task { on_surface: true, ..Task::default() };
    choices.options().idle(task).iter().try_for_each(Idle::demand_unset)?;
    let help = "give the file that the values belong to as the domain";
    refuse([(choices.background.is_some(), "--background on a surface", help)])
}

/// A metric on a surface times a factor.
pub(crate) struct Scaled<'a> {
    pub(crate) field: &'a dyn SurfaceMetric,
    pub(crate) factor: f64,
}

impl SurfaceMetric for Scaled<'_> {
    fn at(&self, place: &Place) -> Tensor3 {
        self.field.at(place) * self.factor
    }
}
