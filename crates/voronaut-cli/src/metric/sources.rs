//! Metrics at the vertices of a mesh, from texts and files.

use super::{LimitText, MetricArgs};
use crate::options::refuse;
use std::path::Path;
use voronaut::geometry::Tensor;
use voronaut::manifold::domain::{Domain, from_mesh};
use voronaut::manifold::surface::Implicit;
use voronaut::manifold::surface::metric::Spec;
use voronaut::mesh::{Mesh, Solution, SolutionValues, TensorOrder};
use voronaut::metric::nodal::{Limit, Limits, Source, implied, isotropic};
use voronaut::metric::{MetricSpec, Recovery, ScalarField, Snapshot, recover_hessian};
use voronaut::recipe::{GradedAt, MetricOptions, SurfaceSource};
use voronaut::{Error, Result};
use voronaut_io::{MetricFiles, MetricSource, read_metric, sol};

/// What a METRIC text says at the vertices.
pub(super) fn source(text: &str, mesh: &Mesh, args: &MetricArgs) -> Result<Source> {
    let text = text.trim();
    if text == "implied" {
        return Ok(Source::Metric(implied(mesh)?));
    }
    let given = MetricSource::parse(text)?;
    match given {
        MetricSource::Hessian(path) => {
            let values = scalars(&path, "a Hessian is recovered from a scalar solution")?;
            Ok(Source::Hessian(recover_hessian(mesh, &values, args.recovery.unwrap_or_default())?))
        }
        MetricSource::Named(MetricSpec::Hessian(function)) => {
            Ok(Source::Hessian(hessian(&function.into(), mesh, args.recovery)?))
        }
        MetricSource::File(path) if args.background.is_none() => {
            Ok(Source::Metric(own(&path, mesh, args.tensor_order)?))
        }
        _ => {
            let background = args.background.as_deref().filter(|_| matches!(given, MetricSource::File(_)));
            let files = MetricFiles { own: None, background, order: args.tensor_order };
            let domain = Domain::new(&from_mesh(mesh)?)?;
            let field = files.metric(&given, &domain, &MetricOptions::default(), GradedAt::Scale(1.0))?.field;
            Ok(Source::Metric((0..mesh.points.len() as u32).map(|v| field.at(mesh.point(v))).collect()))
        }
    }
}

/// Second derivatives of a function: exact, or recovered from its values.
fn hessian(function: &Snapshot, mesh: &Mesh, recovery: Option<Recovery>) -> Result<Vec<Tensor>> {
    let points = (0..mesh.points.len() as u32).map(|v| mesh.point(v));
    if let Some(recovery) = recovery {
        let values: Vec<f64> = points.map(|p| function.value(p)).collect();
        return recover_hessian(mesh, &values, recovery);
    }
    Ok(points.map(|p| function.second_derivatives(p)).collect())
}

/// What a METRIC text says of a surface: names, and values at its vertices.
pub(super) enum OnSurface {
    Implied,
    Named(Spec),
    Values(Solution),
    Function(Vec<f64>),
}

impl OnSurface {
    /// Reads a text and its files.
    pub(super) fn read(text: &str, mesh: &Mesh, args: &MetricArgs) -> Result<Self> {
        let text = text.trim();
        let is_file = |text: &str| matches!(voronaut_io::ending(Path::new(text)).as_deref(), Some("sol" | "solb"));
        match text.strip_prefix("hessian:") {
            _ if text == "implied" => Ok(Self::Implied),
            Some(file) if is_file(file) => {
                Ok(Self::Function(scalars(Path::new(file), "a Hessian is recovered from a scalar solution")?))
            }
            None if is_file(text) => Ok(Self::Values(read_metric(Path::new(text), args.tensor_order)?)),
            _ => match (Spec::parse(text)?, args.recovery) {
                (Spec::Hessian(function), Some(_)) => {
                    Ok(Self::Function(mesh.points.iter().map(|&p| function.value(p.into())).collect()))
                }
                (spec, _) => Ok(Self::Named(spec)),
            },
        }
    }

    pub(super) fn source(&self) -> SurfaceSource<'_> {
        match self {
            Self::Implied => SurfaceSource::Implied,
            Self::Named(spec) => SurfaceSource::Named(spec),
            Self::Values(solution) => SurfaceSource::Values(solution),
            Self::Function(values) => SurfaceSource::Function(values),
        }
    }
}

/// Refuses what is not there on surfaces.
pub(super) fn demand_for_surfaces(args: &MetricArgs) -> Result<()> {
    refuse([
        (args.recovery == Some(Recovery::L2), "--recovery l2 on a surface", "leave it out: quadratics are fitted"),
        (args.background.is_some(), "--background on a surface", "give the mesh that the values belong to as MESH"),
    ])
}

/// A metric of one value for each vertex of the mesh itself.
fn own(path: &Path, mesh: &Mesh, order: TensorOrder) -> Result<Vec<Tensor>> {
    match read_metric(path, order)?.values {
        SolutionValues::Scalar(sizes) => isotropic(mesh, &sizes),
        SolutionValues::Tensor(entries) => Ok(entries.iter().map(|&[xx, xy, yy]| Tensor::new(xx, xy, yy)).collect()),
        SolutionValues::Vector { .. } | SolutionValues::Tensor3(_) => {
            let help = "give one size (type 1) or one tensor m11 m12 m22 (type 3) per vertex, in dimension 2";
            Err(Error::parse(path.display().to_string(), "the values are no planar metric", help))
        }
    }
}

/// One number per vertex from a file.
fn scalars(path: &Path, need: &str) -> Result<Vec<f64>> {
    let SolutionValues::Scalar(values) = sol::read(voronaut_io::open(path)?, &path.display().to_string())?.values
    else {
        let what = format!("the values are no scalars; {need}");
        return Err(Error::parse(path.display().to_string(), what, "write one number (type 1) per vertex"));
    };
    Ok(values)
}

/// The limits, with their files read.
pub(super) fn limits(args: &MetricArgs) -> Result<Limits> {
    let limit = |text: &Option<LimitText>| match text {
        None => Ok(None),
        Some(LimitText::Number(value)) => Ok(Some(Limit::Number(*value))),
        Some(LimitText::File(path)) => Ok(Some(Limit::Field(scalars(path, "a limit is one number per vertex")?))),
    };
    Ok(Limits { h_min: limit(&args.h_min)?, h_max: limit(&args.h_max)?, a_max: limit(&args.a_max)? })
}
