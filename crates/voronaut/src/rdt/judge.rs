//! What a triangulation of seeds knows of where they are.

use crate::geometry::Vector;
use crate::in_circle::InCircle;

/// Seeds of the plane in a metric field, or of a surface.
pub(crate) trait Judge: InCircle {
    /// Whether there is such a seed, and a metric there.
    fn is_seed(&self, i: u32) -> bool;
    /// The direction of a seed seen from another, in a frame there.
    fn direction(&self, from: u32, to: u32) -> Vector;
    /// The squared circumradius of a triangle, roughly, in the metric there; infinite where it is turned over.
    fn size(&self, triangle: [u32; 3]) -> f64;
    /// Whether a loop of seeds turns so that there are triangles missing within it.
    fn encloses(&self, outline: &[u32]) -> bool;
    /// The greatest error of a margin whose sign is followed although it is not certain.
    fn doubt(&self) -> f64;
}
