//! How large a surface is in its metric.

use super::draped::Draped;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::surface::Surface;
use crate::triangulation::{FaceId, Triangulation, VertexId};

/// The metric area of a face with its lengths.
pub(crate) fn metric_area(topology: &Triangulation, f: FaceId) -> f64 {
    let [a, b, c] = f.half_edges().map(|h| topology.length(h));
    0.25 * ((a + b + c) * (a + b - c) * (a - b + c) * (b + c - a)).max(0.0).sqrt()
}

impl Draped<'_> {
    /// The metric area: the integral of sqrt(det M) over the surface.
    pub(crate) fn area(&self) -> f64 {
        self.topology.faces().map(|f| metric_area(&self.topology, f)).sum()
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
