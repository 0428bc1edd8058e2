//! Sizes or tensors at the vertices of a surface, as they stand in a `.sol` file.

use super::{Sampled, SurfaceMetric};
use crate::error::{Error, Result};
use crate::geometry::{Point3, Tensor3};
use crate::mesh::{Solution, SolutionValues};
use crate::surface::{Nearest, Surface};

/// What is asked for at the vertices of a surface, one entry per vertex slot.
#[derive(Clone, Debug, PartialEq)]
pub enum Sizes {
    /// Lengths of edges, the same in all directions.
    Isotropic(Vec<f64>),
    /// Metrics.
    Anisotropic(Vec<Tensor3>),
}

impl Sizes {
    /// The field of these values, log-Euclidean (geometric, of sizes) between vertices.
    ///
    /// # Errors
    /// [`Error::Metric`] where numbers of values and vertices differ, or one is no metric.
    pub fn field(&self, surface: &Surface) -> Result<Sampled> {
        match self {
            Self::Isotropic(sizes) => {
                Sampled::new(surface, &sizes.iter().map(|&h| Tensor3::isotropic(h)).collect::<Vec<_>>())
            }
            Self::Anisotropic(tensors) => Sampled::new(surface, tensors),
        }
    }

    /// A field with values of this kind, at the places of the surface that points are closest to: sizes h or tensors, of the field
    /// times `factor`. Points of a mesh that was fitted are off the surface, and may be far from it.
    ///
    /// # Errors
    /// [`Error::Domain`] of a point that is not finite.
    pub fn solution(
        &self,
        field: &dyn SurfaceMetric,
        factor: f64,
        surface: &Surface,
        points: &[[f64; 3]],
    ) -> Result<Solution> {
        let nearest = Nearest::new(surface);
        let at = |&p: &[f64; 3]| {
            let found = nearest.closest(surface, Point3::from(p));
            let help = "correct the coordinates";
            let found =
                found.ok_or_else(|| Error::domain("a coordinate is not finite", Point3::from(p).to_string(), help))?;
            Ok(field.at(&found.place) * factor)
        };
        let tensors = points.iter().map(at).collect::<Result<Vec<Tensor3>>>()?;
        let values = match self {
            Self::Isotropic(_) => SolutionValues::Scalar(tensors.iter().map(|m| 1.0 / m.xx.sqrt()).collect()),
            Self::Anisotropic(_) => SolutionValues::Tensor3(tensors.iter().map(|m| m.to_disk()).collect()),
        };
        Ok(Solution { dimension: 3, values })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector3;
    use crate::surface::Input;

    /// The values at the vertices of a surface are the field that it was.
    #[test]
    fn solutions_are_the_same_field() {
        let surface = Input::shape("torus:2,0.7", Some(0.5)).unwrap().surface;
        let count = surface.positions().len();
        let tilted =
            |i: usize| Tensor3::square(Vector3::new(0.6, 0.8 * (i as f64).cos(), 0.1)) * 3.0 + Tensor3::IDENTITY;
        for sizes in [
            Sizes::Isotropic((0..count).map(|i| 1.5 + (i as f64).sin()).collect()),
            Sizes::Anisotropic((0..count).map(tilted).collect()),
        ] {
            let field = sizes.field(&surface).unwrap();
            let points = surface.to_mesh().points;
            let solution = sizes.solution(&field, 4.0, &surface, &points).unwrap();
            let again = Sampled::from_solution(&surface, &solution).unwrap();
            for f in surface.topology().faces() {
                let place = surface.place(f, [0.2, 0.5, 0.3]);
                let (found, truth) = (again.at(&place), field.at(&place) * 4.0);
                assert!(
                    (found + truth * -1.0).map_eigenvalues(f64::abs).length(Vector3::new(1.0, 2.0, 3.0)) < 1e-5,
                    "{found:?} {truth:?}"
                );
            }
        }
    }
}
