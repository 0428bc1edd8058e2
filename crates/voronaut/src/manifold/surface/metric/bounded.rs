//! Fields of which what they say of tangents is changed: kept within limits, or made finer where a mesh would else stray from its
//! surface.

use super::{CurvatureFigures, Sampled, Sizing, SurfaceMetric};
use crate::error::Result;
use crate::geometry::{TangentPlane, Tensor, Tensor3};
use crate::manifold::{Manifold, Place};
use crate::metric::Bounded;

/// What a field says of the normal becomes the larger tangential eigenvalue where limits change it.
impl<F: SurfaceMetric> SurfaceMetric for Bounded<F> {
    fn at(&self, place: &Place) -> Tensor3 {
        changed(self.field.at(place), place, |_, tangential| self.bounds.clamp(tangential))
    }

    fn curvature_figures(&self) -> Option<CurvatureFigures> {
        self.field.curvature_figures()
    }
}

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
    pub(crate) fn new(field: &'a dyn SurfaceMetric, manifold: &Manifold, hausd: f64) -> Result<Self> {
        let [h_min, h_max] = LIMITS.map(|share| share * manifold.diagonal());
        let sizing = Sizing { hausd, h_min, h_max, hgrad: None, anisotropic: true };
        let sizes = sizing.sizes(&manifold.surface, None)?.field(&manifold.surface)?;
        Ok(Self { field, sizes })
    }
}

impl SurfaceMetric for Closer<'_> {
    fn at(&self, place: &Place) -> Tensor3 {
        changed(self.field.at(place), place, |plane, wanted| {
            let needed = || plane.restrict(self.sizes.at(place));
            if wanted.is_positive_definite() { wanted.intersection(needed()) } else { wanted }
        })
    }
}

/// A tensor with another part in the tangent plane; what it says of the normal becomes the larger eigenvalue of that, where it is
/// another.
fn changed(tensor: Tensor3, place: &Place, change: impl Fn(&TangentPlane, Tensor) -> Tensor) -> Tensor3 {
    let plane = TangentPlane::new(place.normal);
    let before = plane.restrict(tensor);
    let after = change(&plane, before);
    if after == before { tensor } else { plane.extend(after, after.eigen().large) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::Manifold;
    use crate::manifold::surface::metric::Constant;
    use crate::manifold::surface::metric::sizing::SAGITTA;
    use crate::manifold::surface::sphere;
    use crate::manifold::surface::torus;
    use crate::metric::Bounds;

    /// Thin along the normal, Euclidean in the plane.
    struct Thin;

    impl SurfaceMetric for Thin {
        fn at(&self, place: &Place) -> Tensor3 {
            Tensor3::IDENTITY + Tensor3::square(place.normal) * 1e6
        }
    }

    #[test]
    fn tangents_are_within_limits_and_normals_do_not_count() {
        let bounds = Bounds { h_min: Some(0.1), h_max: Some(2.0), a_max: Some(5.0) };
        let wild = Tensor3::from_disk([1e6, 0.0, 1e-6, 0.0, 0.0, 1.0]);
        let field = Bounded::new(Constant(wild), bounds).unwrap();
        let surface = sphere(1.0, 0.3).unwrap();
        for f in surface.topology().faces() {
            let place = surface.place(f, [0.2, 0.3, 0.5]);
            let tangential = TangentPlane::new(place.normal).restrict(field.at(&place)).eigen();
            let sizes = [tangential.large, tangential.small].map(|e| 1.0 / e.sqrt());
            assert!(sizes[0] >= 0.1 - 1e-9 && sizes[1] <= 2.0 + 1e-9 && sizes[1] / sizes[0] <= 5.0 + 1e-9, "{sizes:?}");
            assert!(field.at(&place).is_positive_definite());
        }
        // Thin along the normal only: within the limits in the plane, and left alone to the bit.
        let field = Bounded::new(Thin, bounds).unwrap();
        let place = surface.place_of(crate::triangulation::VertexId(5)).unwrap();
        assert_eq!(field.at(&place), Thin.at(&place));
    }

    #[test]
    fn senseless_limits_are_named() {
        let bounds = Bounds { h_min: Some(-1.0), ..Bounds::default() };
        assert!(Bounded::new(Constant(Tensor3::IDENTITY), bounds).unwrap_err().to_string().contains("h_min = -1"));
    }

    #[test]
    fn fine_fields_stay_and_coarse_ones_become_fine() {
        let manifold = Manifold::new(torus(2.0, 0.5, 0.1).unwrap(), None);
        let place = manifold.closest(crate::geometry::Point3::new(2.5, 0.0, 0.0)).unwrap();
        let plane = TangentPlane::new(place.normal);
        let fine = Constant(Tensor3::isotropic(0.01));
        assert_eq!(Closer::new(&fine, &manifold, 0.01).unwrap().at(&place), fine.0);
        let coarse = Constant(Tensor3::isotropic(10.0));
        let found = plane.restrict(Closer::new(&coarse, &manifold, 0.01).unwrap().at(&place)).eigen();
        // Around the tube the curvature is 2, along the ring 0.4.
        for (eigenvalue, curvature) in [(found.large, 2.0), (found.small, 0.4)] {
            let truth = curvature / (SAGITTA * 0.01);
            assert!((eigenvalue / truth - 1.0).abs() < 0.05, "{eigenvalue} {truth}");
        }
    }
}
