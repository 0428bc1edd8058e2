//! How large a surface is in its metric.

use super::CanvasCounters;
use super::draped::{Draped, Size};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::surface::metric::SurfaceMetric;
use crate::surface::{Input, Surface};
use crate::triangulation::{FaceId, Triangulation, VertexId};

/// The metric area of a face with its lengths.
pub(crate) fn metric_area(topology: &Triangulation, f: FaceId) -> f64 {
    let [a, b, c] = f.half_edges().map(|h| topology.length(h));
    0.25 * ((a + b + c) * (a + b - c) * (a - b + c) * (b + c - a)).max(0.0).sqrt()
}

/// The metric area of a surface, the integral of sqrt(det M) over it: by the trapezoidal rule on triangles with so many vertices,
/// even in the metric, or on the surface's own where these have more.
///
/// # Errors
/// [`Error::Metric`](crate::Error::Metric) where the metric is not positive definite at a vertex.
pub(crate) fn area_of_surface(input: &Input, metric: &dyn SurfaceMetric, vertices: usize) -> Result<f64> {
    let mut draped = Draped::new(input, metric)?;
    draped.refine(Size::Metric, vertices, &mut CanvasCounters::default())?;
    Ok(draped.topology.faces().map(|f| draped.metric_area(f)).sum())
}

impl Draped<'_> {
    fn metric_area(&self, f: FaceId) -> f64 {
        let corners = self.topology.corners(f);
        let [a, b, c] = corners.map(|v| self.position(v));
        let at = |v: VertexId| 0.5 * self.tensor(v).area(b - a, c - a);
        corners.map(at).iter().sum::<f64>() / 3.0
    }

    /// As a surface of its own: every face a triangle.
    ///
    /// # Errors
    /// [`Error::Domain`](crate::Error::Domain) of faces without area.
    pub(crate) fn to_surface(&self) -> Result<Surface> {
        Surface::new(&Mesh {
            points: (0..self.topology.vertex_slots() as u32).map(|v| self.position(VertexId(v)).to_array()).collect(),
            triangles: self.topology.faces().map(|f| self.topology.corners(f).map(|v| v.0)).collect(),
            ..Mesh::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point3, Tensor3};
    use crate::surface::metric::Constant;

    #[test]
    fn areas_are_those_of_closed_forms() {
        let sphere = Input::shape("sphere:1", None).unwrap();
        let area = |metric: &dyn SurfaceMetric| area_of_surface(&sphere, metric, 20_000).unwrap();
        let exact = 4.0 * std::f64::consts::PI;
        assert!((area(&Constant(Tensor3::IDENTITY * 9.0)) / (9.0 * exact) - 1.0).abs() < 1e-3);
        // The integral of exp(a z) over the sphere is its area times sinh(a) / a.
        let steep = |p: Point3| Tensor3::IDENTITY * (6.0 * p.z).exp();
        assert!((area(&steep) / (exact * 6.0_f64.sinh() / 6.0) - 1.0).abs() < 2e-3);
    }
}
