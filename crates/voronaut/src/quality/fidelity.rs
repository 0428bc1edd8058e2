//! How far the boundary of a mesh strays from that of its domain.

use crate::geometry::{Aabb, BoxTree, Point};
use crate::mesh::{Edges, Mesh};

/// Euclidean distances between two boundaries, measured at the ends and the midpoint of every edge and segment: a lower
/// bound of the Hausdorff distance, exact where the one boundary subdivides the other.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Fidelity {
    /// The greatest distance from an edge of the mesh's boundary to the domain's segments; `None` where either has none.
    pub mesh_to_domain: Option<Farthest>,
    /// The greatest distance from a segment of the domain to the mesh's boundary and labelled edges (interfaces).
    pub domain_to_mesh: Option<Farthest>,
}

/// The greatest of some distances.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Farthest {
    /// Euclidean distance.
    pub distance: f64,
    /// The point that is so far away.
    pub at: [f64; 2],
}

/// Compares the boundary of a planar mesh, its edges with a single triangle, with the segments of its domain.
/// What is not finite or does not exist (vertex numbers) is left out.
pub fn fidelity(mesh: &Mesh, segments: &[(Point, Point)]) -> Fidelity {
    let exists = |numbers: &[u32]| numbers.iter().all(|&v| (v as usize) < mesh.points.len());
    let triangles: Vec<[u32; 3]> = mesh.triangles.iter().copied().filter(|t| exists(t)).collect();
    let edges = Edges::of(&triangles);
    let place = |ends: [u32; 2]| ends.map(|v| mesh.point(v));
    let boundary = finite(edges.boundary().map(|side| place(side.directed())));
    let labelled = finite(mesh.edges.iter().copied().filter(|e| exists(e)).map(place));
    let segments = finite(segments.iter().map(|&(a, b)| [a, b]));
    let all_edges = boundary.iter().chain(&labelled).copied();
    Fidelity {
        mesh_to_domain: farthest(&boundary, segments.iter().copied()),
        domain_to_mesh: farthest(&segments, all_edges),
    }
}

fn finite(segments: impl Iterator<Item = [Point; 2]>) -> Vec<[Point; 2]> {
    segments.filter(|ends| ends.iter().all(|p| p.is_finite())).collect()
}

/// The first of the sample points of segments with the greatest distance to others.
fn farthest(segments: &[[Point; 2]], others: impl Iterator<Item = [Point; 2]>) -> Option<Farthest> {
    let tree = BoxTree::new(others.filter_map(|ends| Some((Aabb::of(ends)?.into(), ends))));
    let from = |p: Point, &[a, b]: &[Point; 2]| p - p.nearest_between(a, b);
    let sample = |p: Point| {
        let nearest = tree.nearest([p.x, p.y], |other| from(p, other).dot(from(p, other)))?;
        Some(Farthest { distance: from(p, nearest).norm(), at: [p.x, p.y] })
    };
    let samples = segments.iter().flat_map(|&[a, b]| [a, a.midpoint(b), b]).filter_map(sample);
    samples.reduce(|best, next| if next.distance > best.distance { next } else { best })
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the truths are exact")]
mod tests {
    use super::super::test_meshes::{fan, grid, with_hole};
    use super::*;

    fn square(side: f64) -> Vec<(Point, Point)> {
        let corners = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]].map(|[x, y]| Point::new(x, y));
        (0..4).map(|i| (corners[i], corners[(i + 1) % 4])).collect()
    }

    #[test]
    fn subdivided_boundary_is_the_boundary() {
        let found = fidelity(&grid(7, 7), &square(7.0));
        assert!(found.mesh_to_domain.unwrap().distance < 1e-14);
        assert!(found.domain_to_mesh.unwrap().distance < 1e-14);
    }

    #[test]
    fn differences_are_seen_from_both_sides() {
        let found = fidelity(&grid(3, 3), &square(4.0));
        assert_eq!(found.domain_to_mesh.unwrap().distance, 2.0_f64.sqrt());
        assert_eq!(found.domain_to_mesh.unwrap().at, [4.0, 4.0]);
        assert_eq!(found.mesh_to_domain.unwrap().distance, 1.0);
        let missing_hole = fidelity(&with_hole(), &square(3.0));
        assert_eq!(missing_hole.mesh_to_domain.unwrap().distance, 1.0);
        assert_eq!(missing_hole.domain_to_mesh.unwrap().distance, 0.0);
    }

    #[test]
    fn nothing_and_nonsense_have_no_distance() {
        assert_eq!(fidelity(&grid(1, 1), &[]).mesh_to_domain, None);
        assert_eq!(fidelity(&Mesh::default(), &square(1.0)).domain_to_mesh, None);
        let mut broken = fan(5, 1);
        broken.triangles.push([0, 1, 99]);
        broken.points[2][0] = f64::NAN;
        assert!(fidelity(&broken, &square(1.0)).mesh_to_domain.is_some());
    }
}
