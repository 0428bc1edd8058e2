//! Meshes that metrics are sampled on to be smoothed or graded.

use crate::canvas::Canvas;
use crate::domain::Domain;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::metric::{MetricField, smoothed};
use std::borrow::Cow;

/// Vertices of the background on which a metric is smoothed or graded that has none of its own.
pub(crate) const BACKGROUND_VERTICES: usize = 40_000;

/// A mesh to sample a field on: its own, or a triangulation of the domain with [`BACKGROUND_VERTICES`] (and all of the domain's
/// own) that is even in the metric.
pub(super) fn sampling<'a>(field: &dyn MetricField, domain: &Domain, own: Option<&'a Mesh>) -> Result<Cow<'a, Mesh>> {
    match own {
        Some(mesh) => Ok(Cow::Borrowed(mesh)),
        None => Ok(Cow::Owned(even(field, domain, BACKGROUND_VERTICES)?)),
    }
}

/// A triangulation of the domain that is even in the metric, with so many vertices, and all of the domain's own.
pub(super) fn even(field: &dyn MetricField, domain: &Domain, vertices: usize) -> Result<Mesh> {
    Ok(embedded(&Canvas::straight(domain, field, vertices)?))
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

/// The field after so many sweeps of smoothing ([`smoothed`]), on its own mesh or one of [`sampling`]. With no sweeps, the field as it
/// is, to the bit.
///
/// On the latter, K sweeps smooth with a standard deviation of about sqrt(K) / 400 of the domain's width in the metric, or half the
/// square root of K N / 40,000 edges of a mesh that has N vertices.
///
/// # Errors
/// As for [`smoothed`].
pub(super) fn smooth_metric(
    field: Box<dyn MetricField>,
    domain: &Domain,
    own: Option<&Mesh>,
    sweeps: u32,
) -> Result<Box<dyn MetricField>> {
    if sweeps == 0 {
        return Ok(field);
    }
    Ok(Box::new(smoothed(field.as_ref(), sampling(field.as_ref(), domain, own)?.as_ref(), sweeps)?))
}
