//! A metric, or sizes, given at the vertices of the surface.

use super::{CurvatureFigures, SurfaceMetric};
use crate::error::{Error, Result};
use crate::geometry::{Point3, Tensor3};
use crate::manifold::Place;
use crate::manifold::surface::{Nearest, Surface, check_count};
use crate::mesh::{Solution, SolutionValues};
use crate::metric::{check_sizes, check_tensor3};
use crate::triangulation::VertexId;

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

    /// The field of tensors at some vertices; the others have the mean of their neighbours' logarithms, or `otherwise` where these
    /// have none either.
    ///
    /// # Errors
    /// As [`Sampled::new`].
    pub(super) fn filled(surface: &Surface, known: &[Option<Tensor3>], otherwise: Tensor3) -> Result<Self> {
        Self::new(surface, &filled(surface, known, otherwise))
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
        Sizes::of(solution)?.field(surface)
    }
}

impl SurfaceMetric for Sampled {
    fn at(&self, place: &Place) -> Tensor3 {
        let logs = self.corners[place.face.index()].map(|v| self.logs[v as usize]);
        Tensor3::weighted(logs, place.weights).exp()
    }

    fn curvature_figures(&self) -> Option<CurvatureFigures> {
        self.figures
    }
}

/// Tensors at some vertices, and at the others the mean of their neighbours' logarithms, or `otherwise`.
pub(crate) fn filled(surface: &Surface, known: &[Option<Tensor3>], otherwise: Tensor3) -> Vec<Tensor3> {
    let t = surface.topology();
    let tensor = |v: u32| {
        let around = || t.around(VertexId(v)).filter_map(|w| known[w.index()]);
        known[v as usize].or_else(|| mean(around())).unwrap_or(otherwise)
    };
    (0..known.len() as u32).map(tensor).collect()
}

/// The log-Euclidean mean.
fn mean(tensors: impl Iterator<Item = Tensor3>) -> Option<Tensor3> {
    let (count, sum) = tensors.fold((0.0, Tensor3::default()), |(count, sum), m| (count + 1.0, sum + m.log()));
    (count > 0.0).then(|| (sum * (1.0 / count)).exp())
}

/// What is asked for at the vertices of a surface, one entry per vertex slot.
#[derive(Clone, Debug, PartialEq)]
pub enum Sizes {
    /// Lengths of edges, the same in all directions.
    Isotropic(Vec<f64>),
    /// Metrics.
    Anisotropic(Vec<Tensor3>),
}

impl Sizes {
    /// Those of a solution in space: tensors, or sizes.
    ///
    /// # Errors
    /// [`Error::Metric`] of a size that is not positive and finite, and of vectors or planar tensors.
    pub(super) fn of(solution: &Solution) -> Result<Self> {
        match &solution.values {
            SolutionValues::Tensor3(entries) => {
                Ok(Self::Anisotropic(entries.iter().map(|&entries| Tensor3::from_disk(entries)).collect()))
            }
            SolutionValues::Scalar(sizes) => {
                check_sizes(sizes, |i| format!("vertex {}", i + 1))?;
                Ok(Self::Isotropic(sizes.clone()))
            }
            SolutionValues::Tensor(_) | SolutionValues::Vector { .. } => {
                let help = "save the metric with Dimension 3, as scalars (1 1) or as symmetric tensors (1 3)";
                Err(Error::metric("neither sizes nor tensors of space", "the metric of a surface", help))
            }
        }
    }

    /// What is asked for at a vertex, as a metric.
    pub(super) fn tensor(&self, v: usize) -> Tensor3 {
        match self {
            Self::Isotropic(sizes) => Tensor3::isotropic(sizes[v]),
            Self::Anisotropic(tensors) => tensors[v],
        }
    }

    /// The field of these values, log-Euclidean (geometric, of sizes) between vertices.
    ///
    /// # Errors
    /// [`Error::Metric`] where numbers of values and vertices differ, or one is no metric.
    pub fn field(&self, surface: &Surface) -> Result<Sampled> {
        let count = match self {
            Self::Isotropic(sizes) => sizes.len(),
            Self::Anisotropic(tensors) => tensors.len(),
        };
        Sampled::new(surface, &(0..count).map(|v| self.tensor(v)).collect::<Vec<_>>())
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
    use crate::manifold::Manifold;
    use crate::manifold::surface::sphere;
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

    /// The values at the vertices of a surface are the field that it was.
    #[test]
    fn solutions_are_the_same_field() {
        let surface = Manifold::shape("torus:2,0.7", Some(0.5)).unwrap().surface;
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
