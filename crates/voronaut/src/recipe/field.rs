//! From what the user says of a metric to the field itself, with its files read.

use super::background::{read, smooth_metric};
use super::graded::{GradedAt, grade_metric};
use crate::domain::{Domain, read_text};
use crate::error::{Error, Result};
use crate::formats::sol::{self, SolutionValues};
use crate::geometry::Tensor;
use crate::mesh::Mesh;
use crate::metric::{
    Boundary, Bounded, Bounds, Hessian, MetricField, MetricSpec, Norm, Recovered, Recovery, Sampled, ScalarField,
    Snapshot,
};
use std::path::{Path, PathBuf};

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
    /// The mesh that values in a file belong to; `None` for the domain's own.
    pub background: Option<PathBuf>,
}

impl Default for MetricOptions {
    fn default() -> Self {
        Self {
            bounds: Bounds::default(),
            norm: Norm::default(),
            recovery: Recovery::default(),
            smooth_metric: SMOOTH_METRIC,
            gradation: None,
            background: None,
        }
    }
}

/// A metric in the plane.
pub struct PlanarMetric {
    /// The field.
    pub field: Box<dyn MetricField>,
    /// The function whose interpolation it is for, if it is for one and nothing else was asked of it.
    pub function: Option<Box<dyn ScalarField>>,
}

/// The field that a specification names on a domain. `own` is the file that the domain comes from; `at` the multiple of the metric
/// in which edges are to have length one, for gradation.
///
/// # Errors
/// A file is missing or not what it should be; the values are no metric; the limits contradict each other; as of
/// [`crate::metric::smoothed`] and [`crate::metric::nodal::Pipeline::run`].
pub fn metric(
    spec: &MetricSpec,
    domain: &Domain,
    own: Option<&Path>,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    let background = options.background.as_deref();
    let (MetricSpec::File(path) | MetricSpec::RecoveredHessian(path)) = spec else {
        if let Some(mesh) = background {
            let what = "only a .sol metric is given on a background mesh";
            return Err(Error::parse(format!("background {}", mesh.display()), what, "leave the background out"));
        }
        return finished(named(spec, domain, options.norm)?, domain, None, options, at);
    };
    let values = sol::read(&read_text(path)?, &path.display().to_string())?.values;
    let mesh = read(background.or(own), path, domain)?;
    let named = match (spec, &values) {
        (MetricSpec::RecoveredHessian(_), SolutionValues::Scalar(values)) => recovered(&mesh, values, options)?,
        (MetricSpec::RecoveredHessian(_), _) => {
            let help = "give one number (type 1) per vertex";
            return Err(Error::parse(path.display().to_string(), "the values are no scalars", help));
        }
        (_, SolutionValues::Scalar(sizes)) => (Box::new(Sampled::sizes(&mesh, sizes)?) as Box<dyn MetricField>, None),
        _ => (Box::new(sampled(&mesh, &values, &path.display().to_string())?) as Box<dyn MetricField>, None),
    };
    finished(named, domain, Some(&mesh), options, at)
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
        SolutionValues::Scalar(values) => recovered(mesh, values, options)?,
        _ => (Box::new(sampled(mesh, values, "the solution")?) as Box<dyn MetricField>, None),
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
    finished(optimal(function, domain, options.norm)?, domain, None, options, at)
}

/// The field that a text names on a domain, when nothing else is asked of it and there is no file.
///
/// # Errors
/// As of [`MetricSpec::parse`] and [`metric`].
pub fn metric_named(text: &str, domain: &Domain) -> Result<Box<dyn MetricField>> {
    let made = metric(&MetricSpec::parse(text)?, domain, None, &MetricOptions::default(), GradedAt::Scale(1.0))?;
    Ok(made.field)
}

/// A field, and the function that it is for.
type Named = (Box<dyn MetricField>, Option<Box<dyn ScalarField>>);

fn named(spec: &MetricSpec, domain: &Domain, norm: Norm) -> Result<Named> {
    let field: Box<dyn MetricField> = match spec {
        MetricSpec::Uniform(field) => Box::new(*field),
        MetricSpec::Swirl(field) => Box::new(*field),
        MetricSpec::Shock(field) => Box::new(*field),
        MetricSpec::Formula(field) => Box::new(field.clone()),
        MetricSpec::Boundary(sizes) => Box::new(Boundary::new(&domain.boundary(), *sizes)?),
        MetricSpec::Hessian(function) => return optimal(&function.clone().into(), domain, norm),
        MetricSpec::File(path) | MetricSpec::RecoveredHessian(path) => {
            unreachable!("{} is read with its mesh", path.display())
        }
    };
    Ok((field, None))
}

fn optimal(function: &Snapshot, domain: &Domain, norm: Norm) -> Result<Named> {
    let field = Hessian::new(function.clone(), norm, &domain.triangles())?;
    Ok((Box::new(field), Some(Box::new(function.clone()))))
}

fn recovered(mesh: &Mesh, values: &[f64], options: &MetricOptions) -> Result<Named> {
    let function = Recovered::new(mesh, values, options.recovery)?;
    Ok((Box::new(function.metric(options.norm)?), Some(Box::new(function))))
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
    (field, function): Named,
    domain: &Domain,
    own: Option<&Mesh>,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    options.bounds.check()?;
    let field: Box<dyn MetricField> =
        if options.bounds == Bounds::default() { field } else { Box::new(Bounded::new(field, options.bounds)?) };
    let field = smooth_metric(field, domain, own, options.smooth_metric)?;
    let field = grade_metric(field, domain, own, options.gradation, at)?;
    let is_free = options.bounds == Bounds::default() && options.smooth_metric == 0 && options.gradation.is_none();
    Ok(PlanarMetric { field, function: function.filter(|_| is_free) })
}
