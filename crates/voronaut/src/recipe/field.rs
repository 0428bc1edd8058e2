//! From what the user says of a metric to the field itself, with its files read.

use super::graded::{GradedAt, grade_metric};
use crate::canvas::Canvas;
use crate::domain::{Domain, read_text};
use crate::error::{Error, Result};
use crate::formats::medit;
use crate::formats::sol::{self, Solution, SolutionValues};
use crate::geometry::{Aabb, Tensor};
use crate::mesh::Mesh;
use crate::metric::{
    Boundary, Bounded, Bounds, Hessian, MetricField, MetricSpec, Norm, Recovered, Recovery, Sampled, ScalarField,
    smoothed,
};
use std::path::{Path, PathBuf};

/// What is done to a metric in the plane, in this order: recovery of second derivatives and the norm they are weighted for, limits,
/// smoothing, gradation. Every parameter has one name (flag, TOML key, Python keyword).
#[derive(Clone, Debug, Default, PartialEq)]
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
/// [`smoothed`] and [`crate::metric::nodal::Pipeline::run`].
pub fn metric(
    spec: &MetricSpec,
    domain: &Domain,
    own: Option<&Path>,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    options.bounds.check()?;
    let is_in_file = matches!(spec, MetricSpec::File(_) | MetricSpec::RecoveredHessian(_));
    let background = options.background.as_deref().or(own.filter(|_| is_in_file));
    if let (Some(mesh), false) = (background, is_in_file) {
        let what = "only a .sol metric is given on a background mesh";
        return Err(Error::parse(format!("background {}", mesh.display()), what, "leave the background out"));
    }
    let (field, function) = named(spec, domain, background, options)?;
    let field: Box<dyn MetricField> =
        if options.bounds == Bounds::default() { field } else { Box::new(Bounded::new(field, options.bounds)?) };
    let field = smooth_metric(field, domain, background, options.smooth_metric)?;
    let field = grade_metric(field, domain, background, options.gradation, at)?;
    let is_free = options.bounds == Bounds::default() && options.smooth_metric == 0 && options.gradation.is_none();
    Ok(PlanarMetric { field, function: function.filter(|_| is_free) })
}

/// The field that a text names on a domain, when nothing else is asked of it and there is no file.
///
/// # Errors
/// As of [`MetricSpec::parse`] and [`metric`].
pub fn metric_named(text: &str, domain: &Domain) -> Result<Box<dyn MetricField>> {
    let made = metric(&MetricSpec::parse(text)?, domain, None, &MetricOptions::default(), GradedAt::Scale(1.0))?;
    Ok(made.field)
}

type Named = (Box<dyn MetricField>, Option<Box<dyn ScalarField>>);

/// The field itself, and the function that it is for.
fn named(spec: &MetricSpec, domain: &Domain, background: Option<&Path>, options: &MetricOptions) -> Result<Named> {
    let field: Box<dyn MetricField> = match spec {
        MetricSpec::Uniform(field) => Box::new(*field),
        MetricSpec::Swirl(field) => Box::new(*field),
        MetricSpec::Shock(field) => Box::new(*field),
        MetricSpec::Formula(field) => Box::new(field.clone()),
        MetricSpec::Boundary(sizes) => Box::new(Boundary::new(&domain.boundary(), *sizes)?),
        MetricSpec::File(path) => Box::new(sampled(path, background, domain)?),
        MetricSpec::Hessian(function) => {
            let field = Hessian::new(function.clone(), options.norm, &domain.triangles())?;
            return Ok((Box::new(field), Some(Box::new(function.clone()))));
        }
        MetricSpec::RecoveredHessian(path) => {
            let (mesh, solution) = solution(path, background, domain)?;
            let SolutionValues::Scalar(values) = solution.values else {
                let help = "give one number (type 1) per vertex";
                return Err(Error::parse(path.display().to_string(), "the values are no scalars", help));
            };
            let function = Recovered::new(&mesh, &values, options.recovery)?;
            return Ok((Box::new(function.metric(options.norm)?), Some(Box::new(function))));
        }
    };
    Ok((field, None))
}

/// Sweeps of smoothing (`--smooth-metric`, TOML key and Python keyword `smooth_metric`) unless told otherwise.
pub const SMOOTH_METRIC: u32 = 0;
/// Vertices of the background on which a metric is smoothed that has none of its own.
pub const BACKGROUND_VERTICES: usize = 40_000;

/// The field after so many sweeps of smoothing ([`smoothed`]), on its own background mesh if it is a `.sol` file; else on a
/// triangulation of the domain with [`BACKGROUND_VERTICES`] (and all of the domain's own) that is even in the metric. With
/// no sweeps, the field as it is, to the bit.
///
/// There, K sweeps smooth with a standard deviation of about sqrt(K) / 400 of the domain's width in the metric, or half the
/// square root of K N / 40,000 edges of a mesh that has N vertices.
///
/// # Errors
/// As for [`smoothed`]; the background is missing or no mesh.
fn smooth_metric(
    field: Box<dyn MetricField>,
    domain: &Domain,
    background: Option<&Path>,
    sweeps: u32,
) -> Result<Box<dyn MetricField>> {
    if sweeps == 0 {
        return Ok(field);
    }
    Ok(Box::new(smoothed(field.as_ref(), &background_mesh(field.as_ref(), domain, background)?, sweeps)?))
}

/// A mesh to sample a field on: its own, or a triangulation of the domain that is even in the metric.
pub(super) fn background_mesh(field: &dyn MetricField, domain: &Domain, background: Option<&Path>) -> Result<Mesh> {
    match background {
        Some(file) => medit::read(&read_text(file)?, &file.display().to_string()),
        None => Ok(embedded(&Canvas::straight(domain, field, BACKGROUND_VERTICES)?)),
    }
}

/// The positions and triangles of a canvas.
fn embedded(canvas: &Canvas) -> Mesh {
    let planar = canvas.embedded();
    Mesh {
        points: planar.positions.iter().map(|p| [p.x, p.y, 0.0]).collect(),
        triangles: planar.topology.faces().map(|face| planar.topology.corners(face).map(|v| v.0)).collect(),
        ..Mesh::default()
    }
}

/// A `.sol` file and the mesh that its values belong to, which covers the domain.
fn solution(path: &Path, background: Option<&Path>, domain: &Domain) -> Result<(Mesh, Solution)> {
    let solution = sol::read(&read_text(path)?, &path.display().to_string())?;
    let is_mesh = |p: &&Path| p.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mesh"));
    let Some(file) = background.filter(is_mesh) else {
        let help = "name the mesh that the values belong to: --background FILE.mesh";
        return Err(Error::parse(path.display().to_string(), "a .sol file needs a .mesh it belongs to", help));
    };
    let mesh: Mesh = medit::read(&read_text(file)?, &file.display().to_string())?;
    demand_cover(&mesh, file, domain)?;
    Ok((mesh, solution))
}

fn sampled(path: &Path, background: Option<&Path>, domain: &Domain) -> Result<Sampled> {
    let (mesh, solution) = solution(path, background, domain)?;
    match solution.values {
        SolutionValues::Scalar(sizes) => Sampled::sizes(&mesh, &sizes),
        SolutionValues::Tensor(entries) => {
            let tensors: Vec<Tensor> = entries.iter().map(|&[xx, xy, yy]| Tensor::new(xx, xy, yy)).collect();
            Sampled::new(&mesh, &tensors)
        }
        SolutionValues::Vector(_) | SolutionValues::Tensor3(_) => {
            let help = "give one size (type 1) or one tensor m11 m12 m22 (type 3) per vertex, in dimension 2";
            Err(Error::parse(path.display().to_string(), "the values are no planar metric", help))
        }
    }
}

/// How far a domain may reach beyond its background mesh, as a share of the mesh's extent: curves are meshed by chords.
const OVERHANG: f64 = 0.05;

/// Beyond its mesh a sampled field goes on with the nearest value: right for a sliver along a curved boundary, a
/// mistake anywhere else.
fn demand_cover(background: &Mesh, file: &Path, domain: &Domain) -> Result<()> {
    let Some(cover) = Aabb::of((0..background.points.len() as u32).map(|v| background.point(v))) else { return Ok(()) };
    let (bounds, allowed) = (domain.bounds(), cover.extent() * OVERHANG);
    let (lower, upper) = (cover.min - bounds.min, bounds.max - cover.max);
    if lower.x.max(upper.x) <= allowed.x && lower.y.max(upper.y) <= allowed.y {
        return Ok(());
    }
    let what = format!("the domain ({} to {}) reaches beyond the background mesh", bounds.min, bounds.max);
    let place = format!("{} ({} to {})", file.display(), cover.min, cover.max);
    Err(Error::metric(what, place, "give the mesh on which the values were computed, in the coordinates of the domain"))
}
