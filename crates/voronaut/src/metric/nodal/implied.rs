//! Metrics from meshes and from sizes.

use crate::error::{Error, Result};
use crate::geometry::{Point, Tensor};
use crate::mesh::Mesh;
use crate::metric::validate::{check_at_vertices, check_background, check_count, check_sizes};

/// The metric that a mesh implies: that of a triangle is the one in which it is equilateral with edges of length one (its Steiner
/// tensor), that of a vertex the log-Euclidean mean of those around it, weighted by (Euclidean) areas. A vertex that no triangle
/// uses gets the identity; it does not matter.
///
/// # Errors
/// As of [`Sampled::new`](crate::metric::Sampled::new) of what is not a planar mesh; [`Error::Mesh`] of a triangle without area.
pub fn implied(mesh: &Mesh) -> Result<Vec<Tensor>> {
    check_background(mesh)?;
    implied_by(mesh.points.len(), mesh.triangles.iter().map(|&t| (t, mesh.corners_of(t))), |_, _, tensor| tensor)
}

/// The same of so many vertices and triangles that are laid out flat each; `seen` is what the tensor of a triangle, by its number, is at a
/// vertex.
///
/// # Errors
/// [`Error::Mesh`] of a triangle without area.
pub(crate) fn implied_by(
    count: usize,
    triangles: impl Iterator<Item = ([u32; 3], [Point; 3])>,
    seen: impl Fn(usize, u32, Tensor) -> Tensor,
) -> Result<Vec<Tensor>> {
    let mut sums = vec![(Tensor::default(), 0.0); count];
    for (i, (t, corners)) in triangles.enumerate() {
        let tensor = of_triangle(corners);
        if !tensor.is_positive_definite() {
            let place = format!("triangle {} at {}", i + 1, corners[0]);
            let help = "remove triangles without area: voronaut check names them";
            return Err(Error::mesh("a triangle has no area", place, help));
        }
        let [a, b, c] = corners;
        let area = (b - a).cross(c - a).abs();
        for v in t {
            let (sum, total) = &mut sums[v as usize];
            *sum = *sum + seen(i, v, tensor).log() * area;
            *total += area;
        }
    }
    Ok(sums
        .into_iter()
        .map(|(sum, total)| if total > 0.0 { (sum * (1.0 / total)).exp() } else { Tensor::IDENTITY })
        .collect())
}

/// The metric in which all edges of a triangle have length one.
fn of_triangle([a, b, c]: [Point; 3]) -> Tensor {
    // With J = (b - a, c - a) and G = ((1, 1/2), (1/2, 1)), the products of the edges of the unit triangle: J^-T G J^-1.
    let (u, v) = (b - a, c - a);
    let twice = u.cross(v);
    let (p, q) = (v.perpendicular() * (-1.0 / twice), u.perpendicular() * (1.0 / twice));
    Tensor::new(
        p.x * p.x + p.x * q.x + q.x * q.x,
        p.x * p.y + 0.5 * (p.x * q.y + p.y * q.x) + q.x * q.y,
        p.y * p.y + p.y * q.y + q.y * q.y,
    )
}

/// The metric of one size per vertex: identity / h^2.
///
/// # Errors
/// [`Error::Metric`](crate::Error::Metric) of a size that is not positive and finite, or of more or fewer than vertices.
pub fn isotropic(mesh: &Mesh, sizes: &[f64]) -> Result<Vec<Tensor>> {
    check_count(mesh, "sizes", sizes.len())?;
    check_sizes(sizes, |v| mesh.describe(v))?;
    let tensors: Vec<Tensor> = sizes.iter().map(|&h| Tensor::isotropic(h)).collect();
    check_at_vertices(mesh, &tensors)?;
    Ok(tensors)
}

#[cfg(test)]
mod tests {
    use super::super::complexity;
    use super::super::test_meshes::grid;
    use super::*;
    use crate::geometry::Vector;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn edges_of_a_triangle_have_length_one(x in proptest::array::uniform6(-3.0..3.0_f64)) {
            let corners @ [a, b, c] = [(x[0], x[1]), (x[2], x[3]), (x[4], x[5])].map(|(x, y)| Point::new(x, y));
            prop_assume!((b - a).cross(c - a).abs() > 1e-3);
            prop_assert!(worst_length(corners) < 1.0, "{}", worst_length(corners));
        }
    }

    /// By how much edges are not of length one, in what rounding allows: terms of e' M e are as large as the fourth power of the
    /// longest edge over the square of the area, and cancel.
    fn worst_length(corners @ [a, b, c]: [Point; 3]) -> f64 {
        let (m, edges) = (of_triangle(corners), [b - a, c - b, a - c]);
        let longest = edges.iter().map(|e| e.dot(*e)).fold(0.0, f64::max);
        let rounding = 8.0 * f64::EPSILON * (longest / (b - a).cross(c - a)).powi(2);
        edges.iter().map(|&edge| (m.length(edge) - 1.0).abs() / rounding).fold(0.0, f64::max)
    }

    /// A height below 1e-4 of the longest edge.
    #[test]
    fn thin_triangles_have_lengths_up_to_rounding() {
        let corners =
            [(-2.448_974_821_526_372_5, 2.732_323_903_484_75), (1.387_525_733_323_791_6, -1.405_903_006_869_531_7)];
        let [a, b] = corners.map(|(x, y)| Point::new(x, y));
        assert!(worst_length([a, b, Point::new(-0.040_301_151_312_951_436, 0.134_766_317_986_956_82)]) < 1.0);
    }

    /// Rows of equilateral triangles under a linear map.
    fn even(map: [Vector; 2]) -> Mesh {
        let mut mesh = grid(6, 0.0);
        for [x, y, _] in &mut mesh.points {
            // Squares with a diagonal from (0, 0) to (1, 1) are sheared to rhombi of two equilateral triangles.
            let (p, q) = (*x - 0.5 * *y, 0.75_f64.sqrt() * *y);
            let moved = map[0] * p + map[1] * q;
            (*x, *y) = (moved.x, moved.y);
        }
        mesh
    }

    #[test]
    fn of_an_even_mesh_it_is_its_metric() {
        let map = [Vector::new(3.0, 1.0), Vector::new(-0.02, 0.05)];
        let mesh = even(map);
        for (v, m) in implied(&mesh).unwrap().into_iter().enumerate() {
            let (p, q) = (map[0] * (1.0 / 6.0), map[1] * (1.0 / 6.0));
            assert!((m.length(p) - 1.0).abs() < 1e-9 && (m.length(q) - 1.0).abs() < 1e-9, "{v}");
            assert!(m.dot(p, q).abs() < 1e-9);
        }
    }

    #[test]
    fn its_complexity_counts_triangles() {
        // An equilateral unit triangle has area sqrt(3) / 4; means over vertices make it a little less.
        let mesh = grid(20, 0.1);
        let count = complexity(&mesh, &implied(&mesh).unwrap()) / (0.75_f64.sqrt() / 2.0);
        assert!((count / mesh.triangles.len() as f64 - 1.0).abs() < 0.02, "{count}");
    }

    #[test]
    fn flat_triangles_and_wrong_sizes_are_named() {
        let mut mesh = grid(1, 0.0);
        mesh.points.push([9.0, 9.0, 0.0]);
        assert_eq!(implied(&mesh).unwrap()[4], Tensor::IDENTITY);
        assert!(isotropic(&mesh, &[0.5; 5]).unwrap().iter().all(|&m| m == Tensor::isotropic(0.5)));
        let error = isotropic(&mesh, &[1.0, 1.0, 0.0, 1.0, 1.0]).unwrap_err();
        assert!(error.to_string().contains("h = 0 is not positive and finite at vertex 3"), "{error}");
        mesh.points[3] = mesh.points[0];
        let error = implied(&mesh).unwrap_err();
        assert!(error.to_string().contains("a triangle has no area at triangle 1 at (0, 0)"), "{error}");
    }
}
