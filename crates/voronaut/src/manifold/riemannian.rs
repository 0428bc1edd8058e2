//! Metrics on what meshes live on.

use super::Manifold;
use super::surface::metric::SurfaceMetric;
use crate::metric::MetricField;

/// A Riemannian manifold: what a mesh lives on, with a metric, by which lengths are measured.
#[derive(Clone, Copy)]
pub enum Riemannian<'a> {
    /// The plane, or a part of it.
    Plane(&'a dyn MetricField),
    /// A surface.
    Surface(&'a Manifold, &'a dyn SurfaceMetric),
}

impl<'a, F: MetricField> From<&'a F> for Riemannian<'a> {
    fn from(metric: &'a F) -> Self {
        Self::Plane(metric)
    }
}

impl<'a> From<&'a dyn MetricField> for Riemannian<'a> {
    fn from(metric: &'a dyn MetricField) -> Self {
        Self::Plane(metric)
    }
}

impl<'a, F: SurfaceMetric> From<(&'a Manifold, &'a F)> for Riemannian<'a> {
    fn from((manifold, metric): (&'a Manifold, &'a F)) -> Self {
        Self::Surface(manifold, metric)
    }
}

impl<'a> From<(&'a Manifold, &'a dyn SurfaceMetric)> for Riemannian<'a> {
    fn from((manifold, metric): (&'a Manifold, &'a dyn SurfaceMetric)) -> Self {
        Self::Surface(manifold, metric)
    }
}
