//! From what the user says of a metric to the field itself, with its files read.

use super::Aim;
use super::background::smooth_metric;
use super::graded::{GradedAt, grade_metric};
use crate::domain::Domain;
use crate::error::{Error, Result};
use crate::geometry::Tensor;
use crate::mesh::{Mesh, SolutionValues};
use crate::metric::{
    Boundary, Bounded, Bounds, Hessian, MetricField, MetricSpec, Norm, Recovered, Recovery, Sampled, ScalarField,
    Snapshot, rough_complexity,
};
use crate::optimise::polishing_norm;
use crate::quality::interpolation_error;

/// Sweeps of smoothing (`--smooth-metric`, TOML key and Python keyword `smooth_metric`) unless told otherwise.
pub const SMOOTH_METRIC: u32 = 0;

/// What is done to a metric in the plane, in this order: recovery of second derivatives and the norm they are weighted for, limits,
/// smoothing, gradation. Every parameter has one name (flag, TOML key, Python keyword).
#[derive(Clone, Debug, PartialEq)]
pub struct MetricOptions {
    /// Least and greatest sizes, greatest anisotropy.
    pub bounds: Bounds,
    /// The norm in which the error of interpolation is to be least.
    pub norm: Norm,
    /// How second derivatives are recovered from a solution.
    pub recovery: Recovery,
    /// Sweeps of smoothing.
    pub smooth_metric: u32,
    /// How fast sizes may grow; `None` for no gradation.
    pub gradation: Option<f64>,
}

impl Default for MetricOptions {
    fn default() -> Self {
        Self {
            bounds: Bounds::default(),
            norm: Norm::default(),
            recovery: Recovery::default(),
            smooth_metric: SMOOTH_METRIC,
            gradation: None,
        }
    }
}

/// A metric in the plane.
pub struct PlanarMetric {
    /// The field.
    pub field: Box<dyn MetricField>,
    /// The function whose interpolation it is for, if it is for one and nothing else was asked of it.
    pub function: Option<Box<dyn ScalarField>>,
    /// The error to which that function is known: zero of a formula; of a solution that of its interpolation on its own mesh.
    pub known_to: f64,
    /// The multiple of the field in which limits on sizes are meant: one, but for Hessians, whose units are those of the function.
    scale: f64,
}

impl PlanarMetric {
    /// A metric that is for no function.
    pub fn plain(field: impl MetricField + 'static) -> Self {
        Self { field: Box::new(field), function: None, known_to: 0.0, scale: 1.0 }
    }

    /// What a mesh by it is for.
    pub fn aim(&self, norm: Norm) -> Option<Aim<'_>> {
        let known_to = self.known_to;
        self.function.as_deref().map(|function| Aim { function, norm, known_to })
    }
}

/// In the metric of second derivatives no size is greater than this share of the domain's extent: where a function is linear in some
/// direction, longer edges would gain nothing, and make a metric that no straight edges can honour.
const LONGEST: f64 = 1.0 / 3.0;

/// The field that a specification names on a domain; `at` is the multiple of the metric in which edges are to have length one, for
/// gradation.
///
/// # Errors
/// The limits contradict each other; smoothing asks for too many sweeps; as of [`crate::metric::nodal::Pipeline::run`].
pub fn metric(spec: &MetricSpec, domain: &Domain, options: &MetricOptions, at: GradedAt) -> Result<PlanarMetric> {
    finished(named(spec, domain, options, at)?, domain, None, options, at)
}

/// The field of sizes or tensors at the vertices of a mesh; `place` names the values in messages.
///
/// # Errors
/// As of [`metric()`]; there is not one value per vertex; the values are no metric in the plane.
pub fn metric_of_values(
    mesh: &Mesh,
    values: &SolutionValues,
    place: &str,
    domain: &Domain,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    let field = match values {
        SolutionValues::Scalar(sizes) => Sampled::sizes(mesh, sizes)?,
        _ => sampled(mesh, values, place)?,
    };
    finished(PlanarMetric::plain(field), domain, Some(mesh), options, at)
}

/// The metric that a solver's solution on a mesh of the domain asks for: that of its recovered second derivatives, if it is a
/// scalar; itself, if it is a tensor.
///
/// # Errors
/// As of [`metric`].
pub fn metric_of_solution(
    mesh: &Mesh,
    values: &SolutionValues,
    domain: &Domain,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    let named = match values {
        SolutionValues::Scalar(values) => recovered(mesh, values, domain, options, at)?,
        _ => PlanarMetric::plain(sampled(mesh, values, "the solution")?),
    };
    finished(named, domain, Some(mesh), options, at)
}

/// The metric that a function at one time asks for.
///
/// # Errors
/// As of [`metric`].
pub fn metric_of_function(
    function: &Snapshot,
    domain: &Domain,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    finished(optimal(function, domain, options, at)?, domain, None, options, at)
}

/// The field that a text names on a domain, when nothing else is asked of it and there is no file.
///
/// # Errors
/// As of [`MetricSpec::parse`] and [`metric`].
pub fn metric_named(text: &str, domain: &Domain) -> Result<Box<dyn MetricField>> {
    let made = metric(&MetricSpec::parse(text)?, domain, &MetricOptions::default(), GradedAt::Scale(1.0))?;
    Ok(made.field)
}

fn named(spec: &MetricSpec, domain: &Domain, options: &MetricOptions, at: GradedAt) -> Result<PlanarMetric> {
    Ok(match spec {
        MetricSpec::Uniform(field) => PlanarMetric::plain(*field),
        MetricSpec::Swirl(field) => PlanarMetric::plain(*field),
        MetricSpec::Shock(field) => PlanarMetric::plain(*field),
        MetricSpec::Formula(field) => PlanarMetric::plain(field.clone()),
        MetricSpec::Boundary(sizes) => PlanarMetric::plain(Boundary::new(&domain.boundary(), *sizes)?),
        MetricSpec::Hessian(function) => return optimal(&function.clone().into(), domain, options, at),
    })
}

fn optimal(function: &Snapshot, domain: &Domain, options: &MetricOptions, at: GradedAt) -> Result<PlanarMetric> {
    let field = Hessian::new(function.clone(), options.norm, &domain.triangles())?;
    let (field, scale) = within_domain(field, domain, at)?;
    Ok(PlanarMetric { field: Box::new(field), function: Some(Box::new(function.clone())), known_to: 0.0, scale })
}

fn recovered(
    mesh: &Mesh,
    values: &[f64],
    domain: &Domain,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    let function = Recovered::new(mesh, values, options.recovery)?;
    let (field, scale) = within_domain(function.metric(options.norm)?, domain, at)?;
    // In the norm that polishing goes by.
    let known_to = interpolation_error(mesh, &function, polishing_norm(options.norm))?.norm;
    Ok(PlanarMetric { field: Box::new(field), function: Some(Box::new(function)), known_to, scale })
}

/// The field with sizes of at most [`LONGEST`] of the domain's extent, in the multiple in which edges have length one; and that
/// multiple.
fn within_domain<F: MetricField + 'static>(field: F, domain: &Domain, at: GradedAt) -> Result<(Bounded<F>, f64)> {
    let scale = match at {
        GradedAt::Scale(scale) => scale,
        GradedAt::Complexity(target) => target / rough_complexity(&field, &domain.triangles())?,
    };
    let extent = domain.bounds().extent();
    let h_max = Some(LONGEST * extent.x.max(extent.y) * scale.sqrt());
    Ok((Bounded::new(field, Bounds { h_max, ..Bounds::default() })?, scale))
}

fn sampled(mesh: &Mesh, values: &SolutionValues, place: &str) -> Result<Sampled> {
    let SolutionValues::Tensor(entries) = values else {
        let help = "give one size (type 1) or one tensor m11 m12 m22 (type 3) per vertex, in dimension 2";
        return Err(Error::parse(place, "the values are no planar metric", help));
    };
    let tensors: Vec<Tensor> = entries.iter().map(|&[xx, xy, yy]| Tensor::new(xx, xy, yy)).collect();
    Sampled::new(mesh, &tensors)
}

/// Limits, then smoothing, then gradation. A function counts only where none of them was asked for.
fn finished(
    named: PlanarMetric,
    domain: &Domain,
    own: Option<&Mesh>,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    options.bounds.check()?;
    let PlanarMetric { field, function, known_to, scale } = named;
    let unit = scale.sqrt();
    let bounds = Bounds {
        h_min: options.bounds.h_min.map(|h| h * unit),
        h_max: options.bounds.h_max.map(|h| h * unit),
        a_max: options.bounds.a_max,
    };
    let field: Box<dyn MetricField> =
        if bounds == Bounds::default() { field } else { Box::new(Bounded::new(field, bounds)?) };
    let field = smooth_metric(field, domain, own, options.smooth_metric)?;
    let field = grade_metric(field, domain, own, options.gradation, at)?;
    let is_free = options.bounds == Bounds::default() && options.smooth_metric == 0 && options.gradation.is_none();
    Ok(PlanarMetric { field, function: function.filter(|_| is_free), known_to, scale })
}
