//! A point of a manifold.

use crate::geometry::{Point3, Vector3};
use crate::triangulation::FaceId;

/// A point of a surface, and where on it that is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Where it is in space.
    pub position: Point3,
    /// The triangle that holds it.
    pub face: FaceId,
    /// Its barycentric coordinates there; their sum is one.
    pub weights: [f64; 3],
    /// The triangle's unit normal.
    pub normal: Vector3,
}
