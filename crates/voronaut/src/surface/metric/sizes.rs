//! Sizes or tensors at the vertices of a surface, as they stand in a `.sol` file; sizes that grow slowly.

use super::{Sampled, SurfaceMetric};
use crate::error::{Error, Result};
use crate::geometry::{Point3, Tensor3};
use crate::mesh::{Solution, SolutionValues};
use crate::metric::Neighbours;
use crate::metric::nodal::Gradation;
use crate::surface::{Nearest, Surface};
use crate::triangulation::VertexId;
use std::collections::BTreeMap;

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

/// Lowers sizes, one per vertex slot, until along every edge of length l they grow by no more than l ln(hgrad), the law of
/// [`grade`](crate::metric::nodal::grade) for sizes that are the same in all directions. The result is the largest such field
/// below the given one, to a millionth along every edge.
///
/// Vertices at equal positions, as they are where a surface was cut, end with equal sizes. Sizes are positive, and finite
/// where there are triangles.
///
/// # Errors
/// As of [`grade`](crate::metric::nodal::grade).
pub(crate) fn grade(surface: &Surface, sizes: &mut [f64], hgrad: f64) -> Result<()> {
    let t = surface.topology();
    let triangles = t.faces().map(|f| t.corners(f).map(|v| v.0));
    let around = Neighbours::of_triangles(sizes.len(), triangles, copies(surface));
    let length = |v, w| surface.position(VertexId(v)).distance(surface.position(VertexId(w)));
    Gradation::of_sizes(around, length, hgrad)?.apply_to_sizes(sizes)
}

/// Vertices at equal positions, each with the first of them; only what is cut has copies, and a cut is a border.
fn copies(surface: &Surface) -> Vec<[u32; 2]> {
    let t = surface.topology();
    let mut first: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let pair = |v: VertexId| {
        // Adding 0 makes one zero of both.
        let key = surface.position(v).to_array().map(|x| (x + 0.0).to_bits());
        let one = *first.entry(key).or_insert(v.0);
        (one != v.0).then_some([one, v.0])
    };
    t.vertices().filter(|&v| t.is_border_vertex(v)).filter_map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector3;
    use crate::mesh::Mesh;
    use crate::surface::Input;
    use crate::surface::torus;
    use crate::test_cases::cases;
    use proptest::prelude::*;

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

    /// The torus, its triangles apart but for their positions.
    fn soup(surface: &Surface) -> Surface {
        let mesh = surface.to_mesh();
        let points = mesh.triangles.iter().flatten().map(|&v| mesh.points[v as usize]).collect();
        let triangles = (0..mesh.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Surface::new(&Mesh { points, triangles, ..Mesh::default() }).unwrap()
    }

    proptest! {
        #![proptest_config(cases(24))]
        #[test]
        fn sizes_obey_the_law_and_no_more(seed in 0..1_000_000_u32, hgrad in 1.0..3.0_f64, spread in 0.1..6.0_f64) {
            let surface = torus(2.0, 0.7, 0.4).unwrap();
            let noise = |i: usize| ((i as f64 + f64::from(seed)) * 12.9898).sin() * spread;
            let given: Vec<f64> = (0..surface.positions().len()).map(|i| noise(i).exp()).collect();
            let mut sizes = given.clone();
            grade(&surface, &mut sizes, hgrad).unwrap();
            for v in surface.topology().vertices() {
                let (size, given) = (sizes[v.index()], given[v.index()]);
                // The most that any neighbour allows.
                let reach = |w: VertexId| sizes[w.index()] + hgrad.ln() * surface.position(v).distance(surface.position(w));
                let t = surface.topology();
                let around = t.star(v).flat_map(|h| [t.target(h), t.apex(h)]);
                let most = around.map(reach).fold(f64::INFINITY, f64::min);
                prop_assert!(size <= most * (1.0 + 1e-6), "{} over {}", size, most);
                prop_assert!((size - given.min(most)).abs() <= 1e-6 * size, "{}, not {} or {}", size, given, most);
            }
        }
    }

    #[test]
    fn a_cut_surface_is_graded_as_the_whole() {
        let surface = torus(2.0, 0.7, 0.4).unwrap();
        let given: Vec<f64> = surface.positions().iter().map(|p| if p.x > 2.6 { 0.01 } else { 5.0 }).collect();
        let mut whole = given.clone();
        grade(&surface, &mut whole, 1.3).unwrap();
        let soup = soup(&surface);
        let mut apart: Vec<f64> = soup.positions().iter().map(|p| if p.x > 2.6 { 0.01 } else { 5.0 }).collect();
        grade(&soup, &mut apart, 1.3).unwrap();
        let mesh = surface.to_mesh();
        for (i, &v) in mesh.triangles.iter().flatten().enumerate() {
            assert!((apart[i] / whole[v as usize] - 1.0).abs() < 1e-6);
        }
        assert!(whole.iter().any(|&h| h > 0.5) && whole.iter().all(|&h| h < 5.0));
    }
}
