//! What a mesh is in a metric, in the plane or on a surface.

use super::histogram::{self, Histograms};
use super::planar_quality::{self, MetricQuality};
use super::surface_quality;
use super::unmet::{self, Unmet};
use crate::error::Result;
use crate::manifold::Riemannian;
use crate::mesh::Mesh;

/// Measures a mesh in a metric, in parallel; the same bits for any number of threads. In the plane `on` is a metric field, on a surface a manifold and a metric
/// on it, from which the mesh may stray.
///
/// On a surface the metric along a straight edge is that of the closest places of the surface, seen by the edge's direction in their
/// tangent planes: an edge keeps its Euclidean length, and never sees the eigenvalue of the normal. The metric of a triangle is
/// the log-Euclidean mean of those at its corners, each restricted to its tangent plane and turned into the triangle's plane by
/// the smallest rotation. Triangles have no side there: their quality is never negative.
///
/// # Errors
/// [`Error::Mesh`](crate::Error::Mesh) where the mesh has no triangles, names vertices that do not exist, or has positions on a surface that are not finite;
/// [`Error::Unsupported`](crate::Error::Unsupported) in the plane where it is not planar; [`Error::Metric`](crate::Error::Metric) where a tensor is not
/// positive definite at a vertex or at a Gauss point.
pub fn metric_quality<'a>(mesh: &Mesh, on: impl Into<Riemannian<'a>>) -> Result<MetricQuality> {
    match on.into() {
        Riemannian::Plane(metric) => planar_quality::in_plane(mesh, metric),
        Riemannian::Surface(manifold, metric) => surface_quality::on_surface(mesh, manifold, metric),
    }
}

/// Measures the edges and angles of a mesh in a metric, in parallel; the same bits for any number of threads. Straight ones are measured as by
/// [`metric_quality`](metric_quality()).
///
/// Geodesics are found from the metric alone (`Paths::logarithm`, from the chord on), some 500 evaluations of the field for each edge, or a few thousand
/// where it has kinks. They know no domain but on its border: the edges of one triangle that [`Mesh::edges`] has. On a surface they are those of the chart
/// at the middle of an edge, between the places of the surface that its ends are closest to, and angles those in the tangent plane at a
/// vertex. A mesh without triangles has empty histograms.
///
/// # Errors
/// As for [`metric_quality`](metric_quality()), but for meshes without triangles.
pub fn histograms<'a>(mesh: &Mesh, on: impl Into<Riemannian<'a>>) -> Result<Histograms> {
    match on.into() {
        Riemannian::Plane(metric) => histogram::in_plane(mesh, metric),
        Riemannian::Surface(manifold, metric) => histogram::on_surface(mesh, manifold, metric),
    }
}

/// Finds the edges of a mesh that are not of unit length in a metric, and why, in parallel; the same bits for any number
/// of threads. `see` is shown the quality and the smallest angle (degrees) of each triangle, in order. Corners of the mesh's borders and
/// labelled edges are those in its lists, and wherever these edges end, fork, turn, or change their label. Sides of curved triangles are measured along
/// their curves; where a metric turns too fast for straight edges, and they are not of unit length either, that is the cause. On a surface
/// features turn in a corner where they turn by more than [`FeatureOptions::DEFAULT_ANGLE`](crate::manifold::surface::FeatureOptions::DEFAULT_ANGLE), for
/// curves of a surface are curved.
///
/// # Errors
/// As [`metric_quality`](metric_quality()), but that a mesh without triangles has no such edges.
pub fn unmet<'a>(mesh: &Mesh, on: impl Into<Riemannian<'a>>, see: impl FnMut([f64; 2])) -> Result<Unmet> {
    match on.into() {
        Riemannian::Plane(metric) => unmet::in_plane(mesh, metric, see),
        Riemannian::Surface(manifold, metric) => unmet::on_surface(mesh, manifold, metric, see),
    }
}
