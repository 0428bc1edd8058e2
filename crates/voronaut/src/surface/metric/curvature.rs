//! The metric of principal curvatures.

use super::{Sampled, SurfaceMetric, fit_curvatures};
use crate::error::Result;
use crate::geometry::Tensor3;
use crate::surface::{Implicit, Place, Surface, curvatures};

/// The smallest curvature that counts, unless told otherwise, over the bounding box's diagonal: a radius of ten diagonals
/// is flat.
pub const FLOOR: f64 = 0.1;

/// The curvature metric of RR-9103, 15.1, of a surface f = 0, from exact derivatives of f at the place, which is on the
/// surface or near it (then of the level surface there); see [`Curvatures::metric`](crate::surface::Curvatures::metric).
/// Where grad f = 0 (a cone's apex) there are no curvatures: the value there is not finite.
#[derive(Clone, Debug)]
pub struct ImplicitCurvature<I> {
    /// f.
    pub f: I,
    /// Smaller curvatures count as this; positive, in units of 1 / length.
    pub floor: f64,
}

impl<I: Implicit> SurfaceMetric for ImplicitCurvature<I> {
    fn at(&self, place: &Place) -> Tensor3 {
        let found = curvatures(&self.f.jet(place.position));
        found.map_or(Tensor3::IDENTITY * f64::NAN, |c| c.metric(self.floor))
    }
}

/// The curvature metric of a mesh: from [`fit_curvatures`] at vertices, log-Euclidean between them.
///
/// # Errors
/// As [`Sampled::new`]: where curvatures are not finite, or `floor` is not positive.
pub fn sampled_curvature(surface: &Surface, floor: f64) -> Result<Sampled> {
    let fitted = fit_curvatures(surface);
    let tensors: Vec<Tensor3> =
        fitted.iter().map(|c| c.map_or(Tensor3::IDENTITY * floor, |c| c.metric(floor))).collect();
    Sampled::new(surface, &tensors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::TangentPlane;
    use crate::metric::{Expression, Variables};
    use crate::surface::torus;

    #[test]
    fn meshes_and_equations_agree() {
        let f = Expression::parse("(sqrt(x^2+y^2)-2)^2+z^2-0.49", Variables::Space).unwrap();
        let exact = ImplicitCurvature { f, floor: 0.05 };
        let error = |edge: f64| {
            let surface = torus(2.0, 0.7, edge).unwrap();
            let fitted = sampled_curvature(&surface, 0.05).unwrap();
            let difference = |v| {
                let place = surface.place_of(v)?;
                let plane = TangentPlane::new(surface.vertex_normal(v)?);
                let [a, b] = [exact.at(&place), fitted.at(&place)].map(|m| plane.restrict(m));
                Some((a.xx - b.xx).abs().max((a.xy - b.xy).abs()).max((a.yy - b.yy).abs()))
            };
            surface.topology().vertices().filter_map(difference).fold(0.0, f64::max)
        };
        let errors = [0.2, 0.1, 0.05].map(error);
        println!("curvature metric of a torus, fitted, largest errors: {errors:?}");
        assert!(errors[1] < 0.5 * errors[0] && errors[2] < 0.5 * errors[1] && errors[2] < 0.05, "{errors:?}");
    }

    #[test]
    fn an_apex_has_no_metric() {
        let f = Expression::parse("x^2+y^2-z^2", Variables::Space).unwrap();
        let surface = torus(2.0, 0.7, 1.0).unwrap();
        let place = Place {
            position: crate::geometry::Point3::default(),
            ..surface.place(crate::triangulation::FaceId(0), [1.0, 0.0, 0.0])
        };
        assert!(!ImplicitCurvature { f, floor: 0.1 }.at(&place).is_positive_definite());
    }
}
