//! The metric at a place, as straight ways from there are measured with it.

use crate::geometry::{Point3, TangentPlane, Tensor, Vector3};

/// The metric that a tangent plane has at a place, by which straight ways from there are measured.
#[derive(Clone, Copy, Debug)]
pub struct Frozen {
    /// The place.
    pub(crate) at: Point3,
    /// Its tangent plane.
    pub(crate) plane: TangentPlane,
    /// The metric in the coordinates of that.
    pub(crate) tensor: Tensor,
}

impl Frozen {
    /// The length of a way: in the direction of its projection onto the plane, as long as it is in space. What the metric says of
    /// the normal no surface sees; a way along the normal is as if in the direction of greatest length.
    pub(crate) fn length(&self, way: Vector3) -> f64 {
        let flat = self.plane.flatten(way);
        let (norm, projected) = (way.norm(), flat.norm());
        if projected > 0.0 {
            self.tensor.length(flat) * (norm / projected)
        } else {
            norm * self.tensor.eigen().large.sqrt()
        }
    }

    /// How far the ball reaches along x, y and z of a metric of space in which no way is longer: that of the plane, and its
    /// small eigenvalue across.
    pub(super) fn reach(&self) -> [f64; 3] {
        let inverse = self.plane.extend(self.tensor.inverse(), self.tensor.eigen().small.recip());
        [inverse.xx, inverse.yy, inverse.zz].map(f64::sqrt)
    }
}
