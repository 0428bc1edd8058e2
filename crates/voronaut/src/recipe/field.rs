//! From what the user says of a metric to the field itself, with its files read.

use crate::domain::Domain;
use crate::error::{Error, Result};
use crate::formats::medit;
use crate::formats::sol::{self, SolutionValues};
use crate::geometry::Tensor;
use crate::mesh::Mesh;
use crate::metric::{Boundary, Bounded, Bounds, MetricField, MetricSpec, Sampled};
use std::path::Path;

/// The field that a specification names on a domain, within limits. `background` is the mesh a `.sol` file belongs to.
///
/// # Errors
/// A file is missing or not what it should be; the values are no metric; the limits contradict each other.
pub fn metric(
    spec: &MetricSpec,
    domain: &Domain,
    background: Option<&Path>,
    bounds: Bounds,
) -> Result<Box<dyn MetricField>> {
    let field: Box<dyn MetricField> = match spec {
        MetricSpec::Uniform(field) => Box::new(*field),
        MetricSpec::Swirl(field) => Box::new(*field),
        MetricSpec::Shock(field) => Box::new(*field),
        MetricSpec::Formula(field) => Box::new(field.clone()),
        MetricSpec::Boundary(sizes) => Box::new(Boundary::new(&domain.boundary(), *sizes)?),
        MetricSpec::File(path) => Box::new(sampled(path, background)?),
    };
    if bounds == Bounds::default() { Ok(field) } else { Ok(Box::new(Bounded::new(field, bounds)?)) }
}

fn sampled(path: &Path, background: Option<&Path>) -> Result<Sampled> {
    let solution = sol::read(&text(path)?, &path.display().to_string())?;
    let is_mesh = |p: &&Path| p.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mesh"));
    let Some(file) = background.filter(is_mesh) else {
        let help = "name the mesh that the values belong to: --background FILE.mesh";
        return Err(Error::parse(path.display().to_string(), "a .sol file needs a .mesh it belongs to", help));
    };
    let mesh: Mesh = medit::read(&text(file)?, &file.display().to_string())?;
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

fn text(path: &Path) -> Result<String> {
    std::fs::read_to_string(path).map_err(|source| Error::Io { path: path.into(), source })
}
