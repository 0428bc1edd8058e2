//! The logarithm map of a metric field: which way a geodesic sets out.

use super::curve::PathLength;
use super::path::{Fineness, Paths};
use crate::geometry::{Point, Vector};
use crate::metric::MetricField;

/// See [`Paths::logarithm`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Logarithm {
    /// The velocity at p of the geodesic that arrives at q after the time 1: in the tensor at p it is as long as the geodesic,
    /// up to errors.
    pub velocity: Vector,
    /// The length of the geodesic, with its error.
    pub length: PathLength,
}

impl Paths {
    /// The logarithm of q at p, of the geodesic that [`Paths::length`] finds. `None` where that finds none or where p is q.
    pub(crate) fn logarithm(
        &self,
        field: &dyn MetricField,
        p: Point,
        q: Point,
        fineness: Fineness,
    ) -> Option<Logarithm> {
        let solved = self.solve(field, p, q, fineness)?;
        // Half the squared length falls fastest, in the tensor at p, where p moves along the geodesic (Gauss's lemma).
        let velocity = -field.at(p).inverse().apply(solved.pull);
        (velocity.x.is_finite() && velocity.y.is_finite()).then_some(Logarithm { velocity, length: solved.length })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Tensor;

    #[test]
    fn in_a_uniform_metric_it_is_the_difference() {
        let (p, q) = (Point::new(0.2, -0.3), Point::new(1.0, 0.7));
        let found = Paths::default().logarithm(&|_: Point| Tensor::new(4.0, 1.0, 2.0), p, q, Fineness::MIDDLE).unwrap();
        assert!((found.velocity - (q - p)).norm() < 1e-9, "{:?}", found.velocity);
    }

    #[test]
    fn half_plane_geodesics_leave_along_their_circles() {
        // The circle around the origin through both points.
        let (p, q) = (Point::new(-0.6, 0.8), Point::new(0.6, 0.8));
        let half_plane = |p: Point| Tensor::isotropic(p.y);
        let found = Paths::default().logarithm(&half_plane, p, q, Fineness::FINEST).unwrap();
        let length = (1.0 + 1.2_f64.powi(2) / (2.0 * 0.64)).acosh();
        let tangent = Vector::new(0.8, 0.6) * (0.8 * length);
        assert!((found.velocity - tangent).norm() < 1e-5, "{:?} is not {tangent:?}", found.velocity);
    }

    #[test]
    fn there_is_none_from_a_point_to_itself() {
        let p = Point::new(0.5, 0.5);
        assert_eq!(Paths::default().logarithm(&|_: Point| Tensor::IDENTITY, p, p, Fineness::MIDDLE), None);
    }
}
