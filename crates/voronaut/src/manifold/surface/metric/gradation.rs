//! Sizes that grow slowly.

use super::TangentPlanes;
use crate::error::Result;
use crate::geometry::Tensor3;
use crate::manifold::surface::Surface;
use crate::mesh::coincident;
use crate::metric::Neighbours;
use crate::metric::nodal::{Gradation, Limits, Vertices};
use crate::triangulation::VertexId;

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
    // Only what is cut has copies, and a cut is a border.
    let border = t.vertices().filter(|&v| t.is_border_vertex(v)).map(|v| (v.0, surface.position(v)));
    let around = Neighbours::of_triangles(sizes.len(), triangles, coincident(border));
    let length = |v, w| surface.position(VertexId(v)).distance(surface.position(VertexId(w)));
    Gradation::of_sizes(around, length, hgrad)?.apply_to_sizes(sizes)
}

/// The same of tensors, by the law in tangent planes: within limits, which come first. What they say of normals becomes the larger
/// eigenvalue.
///
/// # Errors
/// As of [`grade`](crate::metric::nodal::grade).
pub(crate) fn grade_tensors(surface: &Surface, tensors: &mut [Tensor3], hgrad: f64, limits: &Limits) -> Result<()> {
    let vertices = TangentPlanes::of(surface);
    let mut flat = vertices.seen(tensors);
    vertices.gradation(hgrad)?.apply(&mut flat, limits)?;
    tensors.copy_from_slice(&vertices.extended(&flat));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::surface::torus;
    use crate::mesh::Mesh;
    use crate::test_cases::cases;
    use proptest::prelude::*;

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
