//! Metrics as the package holds them: a kind, and what it is made of.

use crate::arrays::{mesh_of, values_of};
use crate::work::Course;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use voronaut::geometry::{Point, Tensor};
use voronaut::manifold::Manifold;
use voronaut::manifold::domain::Domain;
use voronaut::manifold::surface::metric::SurfaceMetric;
use voronaut::mesh::{Mesh, Solution, SolutionValues, TensorOrder};
use voronaut::metric::nodal::{self, implied};
use voronaut::metric::{Bounded, Bounds, MetricField, MetricSpec, Recovery, Uniform, recover_hessian};
use voronaut::recipe::{self, GradedAt, MetricOptions, Origin, PlanarMetric, SurfaceSource};
use voronaut::{Error, Result};
use voronaut_cli::HeldMetric;
use voronaut_io::{MetricFiles, MetricSource, metric_origin, surface_metric};

/// A metric.
pub(crate) enum Metric {
    /// As users write it.
    Text(String),
    /// Sizes or tensors at the vertices of a mesh, or of the surface's own.
    Values(Option<Mesh>, SolutionValues),
    /// A solution at the vertices of a mesh, whose interpolation counts.
    Solution(Mesh, SolutionValues),
    /// A function of many points.
    Function(Py<PyAny>, Arc<Course>),
    /// As fine as each of them, or their mean with weights.
    Combined(Option<Vec<f64>>, Vec<Metric>),
    /// Within limits.
    Limited(Bounds, Box<Metric>),
    /// Graded.
    Graded(f64, Box<Metric>),
    /// Scaled to a complexity.
    Scaled(f64, Box<Metric>),
}

impl Metric {
    /// The metric of a tuple of the package: its kind, and what it is made of.
    pub(crate) fn of(given: &Bound<PyAny>, course: &Arc<Course>) -> PyResult<Self> {
        let (kind, parts): (String, Vec<Bound<PyAny>>) = given.extract()?;
        let own = |part: &Bound<PyAny>| Ok::<_, PyErr>(Box::new(Self::of(part, course)?));
        let mesh = |part: &Bound<PyAny>| mesh_of(part.cast::<PyDict>()?);
        let some = |part: &Bound<PyAny>| (!part.is_none()).then(|| mesh(part)).transpose();
        Ok(match (kind.as_str(), &parts[..]) {
            ("text", [text]) => Self::Text(text.extract()?),
            ("values", [on, values]) => Self::Values(some(on)?, values_of(values)?),
            ("solution", [on, values]) => Self::Solution(mesh(on)?, values_of(values)?),
            ("function", [function]) => Self::Function(function.clone().unbind(), course.clone()),
            ("implied", [on]) => {
                let on = mesh(on)?;
                let tensors = implied(&on).map_err(|error| crate::faults::exception(given.py(), &error))?;
                Self::Values(Some(on), SolutionValues::Tensor(tensors.iter().map(|m| [m.xx, m.xy, m.yy]).collect()))
            }
            ("combined", [weights, all]) => {
                let all: Vec<Bound<PyAny>> = all.extract()?;
                Self::Combined(weights.extract()?, all.iter().map(|m| Self::of(m, course)).collect::<PyResult<_>>()?)
            }
            ("limited", [limits, metric]) => {
                let (h_min, h_max, a_max) = limits.extract()?;
                Self::Limited(Bounds { h_min, h_max, a_max }, own(metric)?)
            }
            ("graded", [factor, metric]) => Self::Graded(factor.extract()?, own(metric)?),
            ("scaled", [target, metric]) => Self::Scaled(target.extract()?, own(metric)?),
            _ => return Err(PyValueError::new_err(format!("no metric is made like this: {kind}"))),
        })
    }

    /// The field alone, for others that are made of it.
    fn field(&self, domain: &Domain, at: GradedAt) -> Result<Box<dyn MetricField>> {
        Ok(self.in_plane(domain, &MetricOptions::default(), at)?.field)
    }
}

impl HeldMetric for Metric {
    fn origin(&self) -> Origin {
        match self {
            Self::Solution(..) => Origin::Values,
            Self::Text(text) => metric_origin(text),
            _ => Origin::Sizes,
        }
    }

    fn in_plane(&self, domain: &Domain, options: &MetricOptions, at: GradedAt) -> Result<PlanarMetric> {
        let (same, whole) =
            (MetricOptions::default(), |field| recipe::metric_of_field(field, None, domain.planar(), options, at));
        match self {
            Self::Text(text) => MetricFiles::default().metric(&MetricSource::parse(text)?, domain, options, at),
            Self::Values(Some(mesh), values) => {
                recipe::metric_of_values(mesh, values, "the metric's values", domain.planar(), options, at)
            }
            Self::Values(None, _) => {
                let help = "give the mesh that they belong to: Metric.from_array(values, mesh)";
                Err(Error::unsupported("values of a metric without their mesh, in the plane", help))
            }
            Self::Solution(mesh, values) => recipe::metric_of_solution(mesh, values, domain.planar(), options, at),
            Self::Function(function, course) => {
                let sample = |points: &[Point]| {
                    let flat: Vec<f64> = points.iter().flat_map(|p| [p.x, p.y]).collect();
                    planar(&called(function, course, &flat, 2)?)
                };
                recipe::metric_of_samples(sample, domain.planar(), options, at)
            }
            Self::Combined(weights, all) => {
                let fields: Vec<_> = all.iter().map(|metric| metric.field(domain, at)).collect::<Result<_>>()?;
                whole(Box::new(combined(weights.clone(), fields)?))
            }
            Self::Limited(bounds, metric) => whole(Box::new(Bounded::new(metric.field(domain, at)?, *bounds)?)),
            Self::Graded(factor, metric) => {
                let graded = MetricOptions { gradation: Some(*factor), ..same };
                whole(metric.in_plane(domain, &graded, at)?.field)
            }
            Self::Scaled(target, metric) => {
                recipe::metric_of_field(metric.field(domain, at)?, Some(*target), domain.planar(), options, at)
            }
        }
    }

    fn on_surface(&self, input: &Manifold, options: &MetricOptions, at: GradedAt) -> Result<Box<dyn SurfaceMetric>> {
        let made = |source| recipe::metric_on_surface(source, input, options, at);
        let solution = |values: &SolutionValues| Solution { dimension: 3, values: values.clone() };
        match self {
            Self::Text(text) => surface_metric(&of_space(text), input, options, TensorOrder::default(), at),
            Self::Values(_, values) => made(SurfaceSource::Values(&solution(values))),
            Self::Solution(mesh, values) => made(SurfaceSource::Solution(mesh, values)),
            Self::Function(function, course) => made(SurfaceSource::Samples(Box::new(|points| {
                let flat: Vec<f64> = points.iter().flat_map(|p| p.to_array()).collect();
                called(function, course, &flat, 3)
            }))),
            Self::Limited(bounds, metric) if options.bounds == Bounds::default() => {
                metric.on_surface(input, &MetricOptions { bounds: *bounds, ..options.clone() }, at)
            }
            Self::Graded(factor, metric) if options.gradation.is_none() => {
                metric.on_surface(input, &MetricOptions { gradation: Some(*factor), ..options.clone() }, at)
            }
            _ => {
                let help = "on surfaces a metric is a text, values at the vertices, or a function; combine its values";
                Err(Error::unsupported("a metric made of others, on a surface", help))
            }
        }
    }
}

/// One size for all directions of the plane as one for those of space; other texts as they are.
fn of_space(text: &str) -> String {
    match MetricSource::parse(text) {
        Ok(MetricSource::Named(MetricSpec::Uniform(Uniform(m)))) if m == Tensor::new(m.xx, 0.0, m.xx) => {
            format!("formula:{0}; 0; {0}; 0; 0; {0}", m.xx)
        }
        _ => text.to_owned(),
    }
}

/// Several fields as one.
fn combined(weights: Option<Vec<f64>>, fields: Vec<Box<dyn MetricField>>) -> Result<impl MetricField + 'static> {
    if let Some(weights) = &weights {
        let one = [Tensor::isotropic(1.0)];
        nodal::average(&vec![one.as_slice(); fields.len()], weights)?;
    }
    Ok(move |p: Point| {
        let tensors: Vec<[Tensor; 1]> = fields.iter().map(|field| [field.at(p)]).collect();
        let tensors: Vec<&[Tensor]> = tensors.iter().map(<[Tensor; 1]>::as_slice).collect();
        let made = match &weights {
            None => nodal::intersect(&tensors),
            Some(weights) => nodal::average(&tensors, weights),
        };
        // What is no metric is named where it is used.
        made.map_or(Tensor::new(f64::NAN, f64::NAN, f64::NAN), |made| made[0])
    })
}

/// What a function of the user's says of points, checked by the package.
fn called(function: &Py<PyAny>, course: &Course, points: &[f64], dimension: usize) -> Result<SolutionValues> {
    let call = |py: Python| -> PyResult<SolutionValues> {
        let array = PyArray1::from_slice(py, points).reshape([points.len() / dimension, dimension])?;
        values_of(&function.call1(py, (array,))?.into_bound(py))
    };
    course.call(call)
}

/// Sizes and tensors as tensors of the plane.
fn planar(values: &SolutionValues) -> Result<Vec<Tensor>> {
    match values {
        SolutionValues::Scalar(sizes) => Ok(sizes.iter().map(|&h| Tensor::isotropic(h)).collect()),
        SolutionValues::Tensor(all) => Ok(all.iter().map(|&[xx, xy, yy]| Tensor::new(xx, xy, yy)).collect()),
        _ => Err(Error::unsupported("tensors of space as a metric of the plane", "give 3 entries: m11, m12, m22")),
    }
}

/// The metric that several make at the vertices of a mesh, as `voronaut metric` does it: tensors, and their complexity.
pub(crate) fn at_vertices(pipeline: &nodal::Pipeline, mesh: &Mesh, metrics: &[Metric]) -> Result<nodal::Outcome> {
    let domain = Domain::new(&voronaut::manifold::domain::from_mesh(mesh)?)?;
    let sources = metrics.iter().map(|metric| match metric {
        Metric::Solution(on, SolutionValues::Scalar(values)) if on == mesh => {
            Ok(nodal::Source::Hessian(recover_hessian(mesh, values, Recovery::default())?))
        }
        _ => {
            let field = metric.field(&domain, GradedAt::Scale(1.0))?;
            Ok(nodal::Source::Metric((0..mesh.points.len() as u32).map(|v| field.at(mesh.point(v))).collect()))
        }
    });
    pipeline.run(mesh, &sources.collect::<Result<Vec<_>>>()?)
}

/// What becomes of metrics at vertices, as the package says it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Shaping<'py> {
    /// Of a mean; none of an intersection.
    weights: Option<Vec<f64>>,
    norm: String,
    h_min: Option<Bound<'py, PyAny>>,
    h_max: Option<Bound<'py, PyAny>>,
    a_max: Option<Bound<'py, PyAny>>,
    complexity: Option<f64>,
    gradation: Option<f64>,
}

impl Shaping<'_> {
    pub(crate) fn pipeline(self, py: Python) -> PyResult<nodal::Pipeline> {
        let norm = self.norm.parse().map_err(|error| crate::faults::exception(py, &error))?;
        let [h_min, h_max, a_max] = [self.h_min, self.h_max, self.a_max].map(limit);
        Ok(nodal::Pipeline {
            norm,
            target_complexity: self.complexity,
            combination: self.weights.map_or(nodal::Combination::Intersect, nodal::Combination::Average),
            limits: nodal::Limits { h_min: h_min?, h_max: h_max?, a_max: a_max? },
            gradation_factor: self.gradation,
        })
    }
}

/// A limit: a number, or one for each vertex.
fn limit(given: Option<Bound<PyAny>>) -> PyResult<Option<nodal::Limit>> {
    let Some(given) = given else { return Ok(None) };
    if let Ok(number) = given.extract::<f64>() {
        return Ok(Some(nodal::Limit::Number(number)));
    }
    let values: PyReadonlyArray2<f64> = given.extract()?;
    Ok(Some(nodal::Limit::Field(values.as_slice()?.to_vec())))
}
