//! What is wrong with a mesh, and where: faults and their places, vertices at one position.

use crate::geometry::Point3;
use crate::mesh::{Mesh, coincident};
use std::fmt;

/// What is wrong, and where.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Fault {
    /// What, with numbers from 1 as in files.
    pub what: String,
    /// Coordinates, or an entry of an array.
    pub place: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at {}", self.what, self.place)
    }
}

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

/// Vertices that lie exactly where one with a smaller number lies, behind that one; finite ones.
pub(super) fn duplicates(mesh: &Mesh) -> Vec<[u32; 2]> {
    let positions = (0..mesh.points.len() as u32).map(|v| (v, mesh.position(v)));
    coincident(positions.filter(|(_, p)| p.is_finite()))
}
