//! Places in reports.

use crate::geometry::Point3;
use crate::mesh::Mesh;

/// A place: two coordinates on a planar mesh, three on a surface.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Position {
    /// x and y.
    Plane([f64; 2]),
    /// x, y and z.
    Space([f64; 3]),
}

impl Position {
    /// The coordinates in order.
    pub fn coordinates(&self) -> &[f64] {
        match self {
            Position::Plane(at) => at,
            Position::Space(at) => at,
        }
    }

    /// x and y of a point.
    pub(super) fn in_plane(p: Point3) -> Self {
        Position::Plane([p.x, p.y])
    }
}

impl From<Point3> for Position {
    fn from(p: Point3) -> Self {
        Position::Space(p.to_array())
    }
}

/// The middle of some vertices.
pub(super) fn middle(mesh: &Mesh, vertices: &[u32]) -> Point3 {
    let sum = |axis: usize| vertices.iter().map(|&v| mesh.points[v as usize][axis]).sum::<f64>();
    Point3::from([0, 1, 2].map(|axis| sum(axis) / vertices.len() as f64))
}
