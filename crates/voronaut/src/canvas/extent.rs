//! How large a surface is in its metric.

use super::draped::Draped;
use crate::error::Result;
use crate::geometry::Vector3;
use crate::mesh::Mesh;
use crate::surface::Surface;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};

/// A border turns by more than this angle (degrees) at a corner.
const CORNER: f64 = 45.0;

/// The metric area of a face with its lengths.
pub fn metric_area(topology: &Triangulation, f: FaceId) -> f64 {
    let [a, b, c] = f.half_edges().map(|h| topology.length(h));
    0.25 * ((a + b + c) * (a + b - c) * (a - b + c) * (b + c - a)).max(0.0).sqrt()
}

impl Draped<'_> {
    /// The metric area: the integral of sqrt(det M) over the surface.
    pub fn area(&self) -> f64 {
        self.topology.faces().map(|f| metric_area(&self.topology, f)).sum()
    }

    /// As a surface of its own: every face a triangle.
    ///
    /// # Errors
    /// [`Error::Domain`](crate::Error::Domain) of faces without area.
    pub fn to_surface(&self) -> Result<Surface> {
        Surface::new(&Mesh {
            points: (0..self.topology.vertex_slots() as u32).map(|v| self.position(VertexId(v)).to_array()).collect(),
            triangles: self.topology.faces().map(|f| self.topology.corners(f).map(|v| v.0)).collect(),
            ..Mesh::default()
        })
    }

    /// The closed curves of the border, each as its half-edges in order, beginning at a corner where it has one.
    pub fn borders(&self) -> Vec<Vec<HalfEdge>> {
        let mut loops = self.topology.border_loops();
        for curve in &mut loops {
            let begin = (0..curve.len()).find(|&i| self.is_corner(curve, i)).unwrap_or(0);
            curve.rotate_left(begin);
        }
        loops
    }

    /// Whether a border turns where its i-th half-edge begins.
    pub fn is_corner(&self, curve: &[HalfEdge], i: usize) -> bool {
        let along = |h: HalfEdge| -> Vector3 {
            let [a, b] = [self.topology.origin(h), self.topology.target(h)].map(|v: VertexId| self.position(v));
            (b - a).unit().unwrap_or_default()
        };
        let before = curve[(i + curve.len() - 1) % curve.len()];
        along(before).dot(along(curve[i])) < CORNER.to_radians().cos()
    }
}
