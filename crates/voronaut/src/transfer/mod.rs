//! Solutions carried from one mesh of a planar domain, or of a surface, to another: values at vertices (continuous, linear on triangles) and values on triangles.
//!
//! | | at vertices | on triangles |
//! |---|---|---|
//! | [`interpolate`] | the value of the old field at the new vertex | the value of the old triangle that holds the centroid |
//! | [`conservative`] | the field with the least L2 distance to the old one | the mean over the new triangle |
//!
//! Interpolation is fast and keeps every bound, but the integral over the domain (the *mass*) drifts. Conservative transfer keeps
//! it, by exact integrals over the intersections of old and new triangles (Farrell and Maddison 2011; Alauzet 2016). A metric is
//! no density: it is interpolated either way, log-Euclidean, as [`crate::metric::Sampled`] has it.
//!
//! Beyond the old mesh (curved boundaries have other chords in another mesh) the nearest value goes on.
//!
//! On a surface the value at a point is that at the closest one, and old triangles are intersected with each new one in its plane, those
//! that face its way. Where both meshes have their vertices in the same flat facets that is exact; elsewhere areas differ as the square
//! of the edges: [`Shares`] has how much, and the mass is corrected for it as where domains differ.

mod clip;
mod cover;
mod field;
mod ground;
mod interpolation;
mod loads;
mod mass;
mod projection;
mod solutions;
#[cfg(test)]
mod test_surfaces;
#[cfg(test)]
mod tests;

pub use cover::{Cover, Shares};
pub use field::{Carried, Extent, Field, Kind, Place};
pub use solutions::{TransferOptions, carry};

use crate::error::Result;
use crate::mesh::Mesh;
use ground::Ground;

/// What [`conservative`] does where the projection leaves the bounds of the old field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Overshoot {
    /// The excess moves to vertices nearby, and the mass stays: no new vertex is above or below all values that the old field has
    /// on the triangles around it.
    #[default]
    Spread,
    /// Nothing: values next to a front are beyond those on both its sides, and the L2 distance is the least there is.
    Kept,
}

/// Fields of `old` interpolated to `new`, and how well the one covers the other.
///
/// Linear functions are reproduced, values stay within those of the old triangle they come from, and to the same mesh values come
/// back to the last bit (metrics to rounding). Errors for smooth functions are of second order in the size of triangles.
///
/// # Errors
/// [`crate::Error::Domain`] where a mesh has no triangles, is planar and the other is not, not finite, refers to vertices it does not have, or `new`
/// reaches far beyond `old`; [`crate::Error::Mesh`] where a field does not have as many values as `old` has vertices or triangles, or
/// one is not finite; [`crate::Error::Metric`] where a tensor is no metric.
pub fn interpolate(old: &Mesh, new: &Mesh, fields: &[Field]) -> Result<(Vec<Carried>, Cover)> {
    let ground = checked(old, new, fields)?;
    let (carried, cover) = interpolation::interpolate(&ground, old, new, fields);
    Ok((field::compared(old, new, fields, carried), cover))
}

/// Fields of `old` carried to `new` with the same integral over the domain, component by component, to rounding.
///
/// Linear functions are reproduced, and to the same mesh values come back to rounding. Errors for smooth functions are of second
/// order in the size of triangles. Where the meshes cover different domains, each value is changed by one share of its magnitude so
/// that the mass is that on `old`: signs and zeros stay (a field that is zero on all of `new` is raised evenly).
///
/// # Errors
/// As [`interpolate`]; [`crate::Error::Domain`] too where more than a few per cent of either mesh's area are not covered by the
/// other, or of `new` covered twice.
pub fn conservative(old: &Mesh, new: &Mesh, fields: &[Field], overshoot: Overshoot) -> Result<(Vec<Carried>, Cover)> {
    let ground = checked(old, new, fields)?;
    let (interpolated, cover) = interpolation::interpolate(&ground, old, new, fields);
    let (carried, cover) = projection::project(&ground, [old, new], fields, interpolated, cover, overshoot)?;
    Ok((field::compared(old, new, fields, carried), cover))
}

fn checked(old: &Mesh, new: &Mesh, fields: &[Field]) -> Result<Ground> {
    let ground = Ground::new(old, new)?;
    cover::demand_extent(old, new)?;
    fields.iter().enumerate().try_for_each(|(i, field)| field.check(old, i + 1, ground.is_planar()))?;
    Ok(ground)
}
