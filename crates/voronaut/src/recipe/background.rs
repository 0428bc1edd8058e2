//! Meshes that metrics are known on, and those they are sampled on to be smoothed or graded.

use crate::canvas::Canvas;
use crate::domain::Domain;
use crate::error::{Error, Result};
use crate::formats::{self, Format};
use crate::geometry::Aabb;
use crate::mesh::Mesh;
use crate::metric::{MetricField, smoothed};
use std::borrow::Cow;
use std::path::Path;

/// Vertices of the background on which a metric is smoothed or graded that has none of its own.
pub const BACKGROUND_VERTICES: usize = 40_000;
/// How far a domain may reach beyond its background mesh, as a share of the mesh's extent: curves are meshed by chords.
const OVERHANG: f64 = 0.05;

/// The mesh that the values in `values` belong to.
///
/// # Errors
/// There is no `.mesh` file, it is not one, or the domain reaches beyond it.
pub(super) fn read(file: Option<&Path>, values: &Path, domain: &Domain) -> Result<Mesh> {
    let is_mesh = |p: &&Path| Format::of_ending(p).is_some_and(Format::may_be_planar);
    let Some(file) = file.filter(is_mesh) else {
        let help = "name the mesh that the values belong to: --background FILE.mesh";
        return Err(Error::parse(values.display().to_string(), "a .sol file needs a .mesh it belongs to", help));
    };
    let mesh = formats::read(file)?.mesh;
    demand_cover(&mesh, file, domain)?;
    Ok(mesh)
}

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
