//! What metrics at vertices see of a mesh, of the plane or of a surface.

use super::Gradation;
use crate::error::Result;
use crate::geometry::Tensor;
use crate::mesh::Mesh;
use crate::metric::validate::check_at_vertices;

/// Vertices with one plane tensor each: in the plane, or in their tangent planes.
pub(crate) trait Vertices {
    /// How many there are.
    fn count(&self) -> usize;

    /// Triangles between them, and twice their areas.
    fn triangles(&self) -> impl Iterator<Item = ([u32; 3], f64)>;

    /// The law by which sizes grow from one to the next.
    ///
    /// # Errors
    /// [`Error::Parse`](crate::Error::Parse) unless the factor is finite and at least 1.
    fn gradation(&self, factor: f64) -> Result<Gradation<'_>>;

    /// Whether these are a metric.
    ///
    /// # Errors
    /// [`Error::Metric`](crate::Error::Metric) that names the vertex; as of what makes no mesh.
    fn check(&self, tensors: &[Tensor]) -> Result<()>;

    /// Makes one metric of those of vertices that are one, seen from several sides: as fine as each.
    fn join(&self, tensors: Vec<Tensor>) -> Vec<Tensor>;
}

/// Of a planar mesh, which has one side.
impl Vertices for Mesh {
    fn count(&self) -> usize {
        self.points.len()
    }

    fn triangles(&self) -> impl Iterator<Item = ([u32; 3], f64)> {
        self.triangles.iter().map(|&t| (t, self.double_area(t)))
    }

    fn gradation(&self, factor: f64) -> Result<Gradation<'_>> {
        Gradation::on(self, factor)
    }

    fn check(&self, tensors: &[Tensor]) -> Result<()> {
        check_at_vertices(self, tensors)
    }

    fn join(&self, tensors: Vec<Tensor>) -> Vec<Tensor> {
        tensors
    }
}
