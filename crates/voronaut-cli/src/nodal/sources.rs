//! Metrics at the vertices of a mesh, from texts and files.

use super::args::{LimitText, MetricArgs};
use std::path::Path;
use voronaut::domain::{Domain, from_mesh, read_text};
use voronaut::formats::sol::{self, SolutionValues};
use voronaut::geometry::{Point3, Tensor};
use voronaut::mesh::Mesh;
use voronaut::metric::nodal::{Limit, Limits, Source, implied, isotropic};
use voronaut::metric::{Expression, MetricSpec, Recovery, Variables, recover_hessian};
use voronaut::recipe::{self, GradedAt, MetricOptions};
use voronaut::{Error, Result};

/// What a METRIC text says at the vertices.
pub(super) fn source(text: &str, mesh: &Mesh, args: &MetricArgs) -> Result<Source> {
    let text = text.trim();
    if text == "implied" {
        return Ok(Source::Metric(implied(mesh)?));
    }
    if let Some(of) = text.strip_prefix("hessian:") {
        return Ok(Source::Hessian(hessian(of.trim(), mesh, args.recovery)?));
    }
    let spec = MetricSpec::parse(text)?;
    if let (MetricSpec::File(path), None) = (&spec, &args.background) {
        return Ok(Source::Metric(own(path, mesh)?));
    }
    let options = MetricOptions {
        background: args.background.clone().filter(|_| matches!(spec, MetricSpec::File(_))),
        ..MetricOptions::default()
    };
    let field = recipe::metric(&spec, &Domain::new(&from_mesh(mesh)?)?, None, &options, GradedAt::Scale(1.0))?.field;
    Ok(Source::Metric((0..mesh.points.len() as u32).map(|v| field.at(mesh.point(v))).collect()))
}

/// Second derivatives of a solution in a file, or of an expression.
fn hessian(of: &str, mesh: &Mesh, recovery: Option<Recovery>) -> Result<Vec<Tensor>> {
    if of.to_ascii_lowercase().ends_with(".sol") {
        let values = scalars(Path::new(of), "a Hessian is recovered from a scalar solution")?;
        return recover_hessian(mesh, &values, recovery.unwrap_or_default());
    }
    let expression = Expression::parse(of, Variables::Plane)?;
    if let Some(recovery) = recovery {
        let values: Vec<f64> = mesh.points.iter().map(|&[x, y, _]| expression.at(x, y, 0.0)).collect();
        return recover_hessian(mesh, &values, recovery);
    }
    let exact = |&[x, y, _]: &[f64; 3]| {
        let h = expression.jet(Point3::new(x, y, 0.0)).hessian;
        Tensor::new(h.xx, h.xy, h.yy)
    };
    Ok(mesh.points.iter().map(exact).collect())
}

/// A metric of one value for each vertex of the mesh itself.
fn own(path: &Path, mesh: &Mesh) -> Result<Vec<Tensor>> {
    match sol::read(&read_text(path)?, &path.display().to_string())?.values {
        SolutionValues::Scalar(sizes) => isotropic(mesh, &sizes),
        SolutionValues::Tensor(entries) => Ok(entries.iter().map(|&[xx, xy, yy]| Tensor::new(xx, xy, yy)).collect()),
        SolutionValues::Vector(_) | SolutionValues::Tensor3(_) => {
            let help = "give one size (type 1) or one tensor m11 m12 m22 (type 3) per vertex, in dimension 2";
            Err(Error::parse(path.display().to_string(), "the values are no planar metric", help))
        }
    }
}

/// One number per vertex from a file.
fn scalars(path: &Path, need: &str) -> Result<Vec<f64>> {
    let place = path.display().to_string();
    match sol::read(&read_text(path)?, &place)?.values {
        SolutionValues::Scalar(values) => Ok(values),
        _ => Err(Error::parse(
            place,
            format!("the values are no scalars; {need}"),
            "write one number (type 1) per vertex",
        )),
    }
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
