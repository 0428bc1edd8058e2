//! A metric given at the vertices of the surface.

use super::{CurvatureFigures, SurfaceMetric};
use crate::error::{Error, Result};
use crate::geometry::Tensor3;
use crate::mesh::{Solution, SolutionValues};
use crate::metric::{check_sizes, check_tensor3};
use crate::surface::input::check_count;
use crate::surface::{Place, Surface};

/// Tensors at the vertices of a surface; inside triangles the log-Euclidean interpolation (Arsigny 2006), exp of the linear
/// interpolation of log M, which is positive definite and between the sizes at the corners.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// Logarithms, one per vertex slot.
    logs: Vec<Tensor3>,
    /// Corners, one triple per face slot.
    corners: Vec<[u32; 3]>,
    figures: Option<CurvatureFigures>,
}

impl Sampled {
    /// The field of one tensor per vertex slot; places refer to this very surface.
    ///
    /// # Errors
    /// [`Error::Metric`] where numbers of tensors and vertices differ, or that of a vertex of a triangle is no metric.
    pub(crate) fn new(surface: &Surface, tensors: &[Tensor3]) -> Result<Self> {
        check_count(tensors.len(), surface.positions().len())?;
        let t = surface.topology();
        for v in t.vertices() {
            check_tensor3(tensors[v.index()], || format!("vertex {} {}", v.0 + 1, surface.position(v)))?;
        }
        let mut corners = vec![[0; 3]; t.face_slots()];
        for f in t.faces() {
            corners[f.index()] = t.corners(f).map(|v| v.0);
        }
        Ok(Self { logs: tensors.iter().map(|tensor| tensor.log()).collect(), corners, figures: None })
    }

    /// The same field, of curvatures that were bounded so.
    #[must_use]
    pub(super) fn with_figures(self, figures: CurvatureFigures) -> Self {
        Self { figures: Some(figures), ..self }
    }

    /// The field of a solution in space: tensors, or sizes h as identity / h^2.
    ///
    /// # Errors
    /// As [`Sampled::new`]; [`Error::Metric`] of a size that is not positive and finite, and of vectors or planar tensors.
    pub(crate) fn from_solution(surface: &Surface, solution: &Solution) -> Result<Self> {
        match &solution.values {
            SolutionValues::Tensor3(entries) => {
                let tensors: Vec<Tensor3> = entries.iter().map(|&entries| Tensor3::from_disk(entries)).collect();
                Self::new(surface, &tensors)
            }
            SolutionValues::Scalar(sizes) => {
                check_sizes(sizes, |i| format!("vertex {}", i + 1))?;
                let tensors: Vec<Tensor3> = sizes.iter().map(|&h| Tensor3::isotropic(h)).collect();
                Self::new(surface, &tensors)
            }
            SolutionValues::Tensor(_) | SolutionValues::Vector { .. } => {
                let help = "save the metric with Dimension 3, as scalars (1 1) or as symmetric tensors (1 3)";
                Err(Error::metric("neither sizes nor tensors of space", "the metric of a surface", help))
            }
        }
    }
}

impl SurfaceMetric for Sampled {
    fn at(&self, place: &Place) -> Tensor3 {
        let corners = self.corners[place.face.index()];
        let weighted = corners.iter().zip(place.weights).map(|(&v, weight)| self.logs[v as usize] * weight);
        weighted.fold(Tensor3::default(), |sum, log| sum + log).exp()
    }

    fn curvature_figures(&self) -> Option<CurvatureFigures> {
        self.figures
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::sphere;
    use crate::triangulation::FaceId;

    #[test]
    fn tensors_at_vertices_and_between() {
        let surface = sphere(1.0, 2.0).unwrap();
        let size = |v: usize| 1.0 + v as f64;
        let values = SolutionValues::Scalar((0..12).map(size).collect());
        let field = Sampled::from_solution(&surface, &Solution { dimension: 3, values }).unwrap();
        for v in surface.topology().vertices() {
            let found = field.at(&surface.place_of(v).unwrap());
            assert!((found.xx * size(v.index()).powi(2) - 1.0).abs() < 1e-12 && found.xy.abs() < 1e-12);
        }
        let product: f64 = surface.topology().corners(FaceId(3)).iter().map(|v| size(v.index())).product();
        let middle = field.at(&surface.place(FaceId(3), [1.0 / 3.0; 3]));
        assert!((middle.yy * product.powf(2.0 / 3.0) - 1.0).abs() < 1e-12, "the geometric mean of sizes");
    }

    #[test]
    fn what_is_no_metric_of_the_surface_is_named() {
        let surface = sphere(1.0, 2.0).unwrap();
        let message = |values| {
            let error = Sampled::from_solution(&surface, &Solution { dimension: 3, values }).unwrap_err();
            assert!(!error.help().is_empty());
            error.to_string()
        };
        let mut tensors = vec![[1.0, 0.0, 1.0, 0.0, 0.0, 1.0]; 12];
        tensors[4][5] = -1.0;
        for (message, expected) in [
            (message(SolutionValues::Scalar(vec![1.0; 11])), "11 values for 12 vertices at the surface"),
            (message(SolutionValues::Scalar(vec![0.0; 12])), "the size h = 0 is not positive and finite at vertex 1"),
            (message(SolutionValues::Tensor(vec![])), "neither sizes nor tensors of space"),
            (message(SolutionValues::Tensor3(tensors)), "m33 = -1 is not positive definite at vertex 5 ("),
        ] {
            assert!(message.contains(expected), "{message}");
        }
    }
}
