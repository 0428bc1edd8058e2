//! Another field where it keeps a mesh close enough to its surface, finer where it does not.

use super::{Sampled, Sizing, SurfaceMetric};
use crate::error::Result;
use crate::geometry::{TangentPlane, Tensor3};
use crate::surface::{Input, Place};

/// The intersection, in the tangent planes, of a field with the sizes that keep a mesh within a distance of the surface
/// ([`Sizing`], along the principal directions); what it says of the normal becomes the larger tangential eigenvalue where
/// they are less.
pub(crate) struct Closer<'a> {
    field: &'a dyn SurfaceMetric,
    sizes: Sampled,
}

/// The least sizes and those of flat parts, as multiples of the diagonal: no limits in earnest.
const LIMITS: [f64; 2] = [1e-6, 1e3];

impl<'a> Closer<'a> {
    /// The field for a distance (Euclidean, positive).
    ///
    /// # Errors
    /// As [`Sizing::sizes`].
    pub(crate) fn new(field: &'a dyn SurfaceMetric, input: &Input, hausd: f64) -> Result<Self> {
        let [h_min, h_max] = LIMITS.map(|share| share * input.diagonal());
        let sizing = Sizing { hausd, h_min, h_max, hgrad: None, anisotropic: true };
        let sizes = sizing.sizes(&input.surface, None)?.field(&input.surface)?;
        Ok(Self { field, sizes })
    }
}

impl SurfaceMetric for Closer<'_> {
    fn at(&self, place: &Place) -> Tensor3 {
        let tensor = self.field.at(place);
        let plane = TangentPlane::new(place.normal);
        let [wanted, needed] = [tensor, self.sizes.at(place)].map(|m| plane.restrict(m));
        if !wanted.is_positive_definite() {
            return tensor;
        }
        let both = wanted.intersection(needed);
        if both == wanted { tensor } else { plane.extend(both, both.eigen().large) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::metric::Constant;
    use crate::surface::metric::sizing::SAGITTA;
    use crate::surface::{Input, torus};

    #[test]
    fn fine_fields_stay_and_coarse_ones_become_fine() {
        let input = Input::new(torus(2.0, 0.5, 0.1).unwrap(), None);
        let place = input.closest(crate::geometry::Point3::new(2.5, 0.0, 0.0)).unwrap();
        let plane = TangentPlane::new(place.normal);
        let fine = Constant(Tensor3::isotropic(0.01));
        assert_eq!(Closer::new(&fine, &input, 0.01).unwrap().at(&place), fine.0);
        let coarse = Constant(Tensor3::isotropic(10.0));
        let found = plane.restrict(Closer::new(&coarse, &input, 0.01).unwrap().at(&place)).eigen();
        // Around the tube the curvature is 2, along the ring 0.4.
        for (eigenvalue, curvature) in [(found.large, 2.0), (found.small, 0.4)] {
            let truth = curvature / (SAGITTA * 0.01);
            assert!((eigenvalue / truth - 1.0).abs() < 0.05, "{eigenvalue} {truth}");
        }
    }
}
