//! Second derivatives of a solution that is known at the vertices of a mesh.

mod fit;
mod projection;
mod stencil;

pub(crate) use fit::hessian_around;
pub(crate) use stencil::least_squares;

use super::validate::check_background;
use crate::error::{Error, Result, named};
use crate::geometry::Tensor;
use crate::mesh::Mesh;

/// How second derivatives are recovered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Recovery {
    /// A double L2 projection (with lumped masses, extrapolated to the border).
    L2,
    /// A quadratic polynomial through the value at the vertex, fitted to those around it.
    #[default]
    Fit,
}

named!(Recovery, "recovery", [L2 = "l2", Fit = "fit"]);

/// The second derivatives, at the vertices of a planar mesh, of a function given by its values there: symmetric, and
/// indefinite where the function is a saddle.
///
/// # Errors
/// As for [`Sampled::new`](super::Sampled::new) of what is not a planar mesh; [`Error::Metric`] unless there is one finite value
/// per vertex.
pub fn recover_hessian(mesh: &Mesh, values: &[f64], recovery: Recovery) -> Result<Vec<Tensor>> {
    check_background(mesh)?;
    let (found, needed) = (values.len(), mesh.points.len());
    if found != needed {
        let help = "give one value for each vertex of the mesh, in the same order";
        return Err(Error::metric(format!("{found} values for {needed} vertices"), "the solution", help));
    }
    if let Some(v) = values.iter().position(|value| !value.is_finite()) {
        let what = format!("the solution's value {} is not finite", values[v]);
        return Err(Error::metric(what, mesh.describe(v), "correct the solution"));
    }
    Ok(match recovery {
        Recovery::L2 => projection::project(mesh, values),
        Recovery::Fit => fit::fit(mesh, values),
    })
}

#[cfg(test)]
mod tests;
