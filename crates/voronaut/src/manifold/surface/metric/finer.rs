//! A metric that is finer where a mesh came out too far from its surface.

use super::gradation::grade;
use super::{CurvatureFigures, SurfaceMetric};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geometry::{TangentPlane, Tensor3};
use crate::manifold::Place;
use crate::manifold::surface::Surface;
use crate::triangulation::VertexId;

/// Distances of smooth surfaces fall as sizes squared, as the inverse of the factor on the metric, and those over kinks between facets
/// as sizes: this is between.
const POWER: f64 = 1.5;
/// Distances are to come out so much lower than they have to, and where they are not they are taken for too great: the mesh will be another one, and
/// edges may cross kinks elsewhere. With 1.1 other places are too far round after round.
const MARGIN: f64 = 1.4;
/// The greatest factor at a time.
const MOST: f64 = 4.0;
/// No size at all, as a multiple of the diagonal.
const FAR: f64 = 1e3;
/// Sizes grow from there by this factor along an edge: mmg's default.
const GROWTH: f64 = 1.3;

/// A field times factors that are given at the vertices of the surface; inside triangles their logarithms are interpolated.
#[derive(Clone, Copy)]
pub struct Finer<'a> {
    /// The field.
    pub field: &'a dyn SurfaceMetric,
    /// The surface that its places are on.
    pub surface: &'a Surface,
    /// Logarithms of the factors, one per vertex slot; none where all are one.
    pub logs: &'a [f64],
}

impl SurfaceMetric for Finer<'_> {
    fn at(&self, place: &Place) -> Tensor3 {
        let tensor = self.field.at(place);
        if self.logs.is_empty() {
            return tensor;
        }
        let corners = self.surface.topology().corners(place.face);
        let log: f64 = corners.iter().zip(place.weights).map(|(v, weight)| weight * self.logs[v.index()]).sum();
        tensor * log.exponential()
    }

    fn curvature_figures(&self) -> Option<CurvatureFigures> {
        self.field.curvature_figures()
    }
}

impl Finer<'_> {
    /// The logarithms of the factors, with those that distances ask for, which are given at vertices as multiples of the one allowed. The least
    /// sizes of tensors, where they shrink, grow from there slowly.
    ///
    /// # Errors
    /// None of surfaces.
    pub(crate) fn asked(&self, ratios: &[f64]) -> Result<Vec<f64>> {
        let size = |v: VertexId| {
            let place = self.surface.place_of(v)?;
            let tensor = TangentPlane::new(place.normal).restrict(self.at(&place));
            Some(1.0 / tensor.eigen().large.sqrt())
        };
        let before: Vec<f64> = (0..ratios.len() as u32).map(|v| size(VertexId(v)).unwrap_or(1.0)).collect();
        let far = FAR * self.surface.bounds().diagonal();
        let smaller = |(&size, &ratio): (&f64, &f64)| {
            if MARGIN * ratio > 1.0 { size / (MARGIN * ratio).raised_to(POWER).min(MOST).sqrt() } else { far }
        };
        let mut sizes: Vec<f64> = before.iter().zip(ratios).map(smaller).collect();
        grade(self.surface, &mut sizes, GROWTH)?;
        let old = |i: usize| self.logs.get(i).copied().unwrap_or(0.0);
        let new = |i: usize| old(i) + 2.0 * (before[i] / sizes[i]).logarithm().max(0.0);
        Ok((0..sizes.len()).map(new).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::surface::metric::Constant;
    use crate::manifold::surface::sphere;

    #[test]
    fn factors_are_around_what_is_too_far_and_add_up() {
        let surface = sphere(1.0, 0.1).unwrap();
        let field = Constant(Tensor3::isotropic(0.05));
        let mut ratios = vec![0.5; surface.positions().len()];
        ratios[7] = 1.5;
        let once = Finer { field: &field, surface: &surface, logs: &[] }.asked(&ratios).unwrap();
        let wanted = (MARGIN * 1.5).raised_to(POWER).logarithm();
        assert!((once[7] - wanted).abs() < 1e-9, "{} {wanted}", once[7]);
        let at = surface.position(VertexId(7));
        let sizes: Vec<f64> = once.iter().map(|log| 0.05 * (-0.5 * log).exponential()).collect();
        for v in surface.topology().vertices() {
            // From there sizes grow by the law; what is farther stays.
            let away = surface.position(v).distance(at);
            let grown = sizes[7] + away * GROWTH.logarithm();
            assert!(sizes[v.index()] >= grown.min(0.05) - 1e-6 && sizes[v.index()] <= 0.05 + 1e-12, "{away}");
            assert!(away < 0.2 || once[v.index()] < 1e-12, "{away} {}", once[v.index()]);
        }
        let finer = Finer { field: &field, surface: &surface, logs: &once };
        let twice = finer.asked(&ratios).unwrap();
        assert!((twice[7] - 2.0 * wanted).abs() < 1e-9);
        let place = surface.place_of(VertexId(7)).unwrap();
        assert!((finer.at(&place).xx / field.at(&place).xx - wanted.exponential()).abs() < 1e-9);
        // A greater distance at once is not trusted.
        ratios[7] = 1e3;
        assert!((finer.asked(&ratios).unwrap()[7] - wanted - MOST.logarithm()).abs() < 1e-9);
    }
}
