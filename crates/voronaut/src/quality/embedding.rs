//! Whether counter-clockwise triangles cover every point of the plane at most once, decided exactly.
//!
//! Of triangles whose edges are manifold it is enough to look at those on the boundary. By Stokes the number of triangles over a
//! point is the winding number of the boundary around it, which changes only there: where two cover a point, somewhere on the way out
//! of the mesh they become fewer, and the triangle that ends there lies on another one.

use crate::geometry::{Aabb, BoxTree, Orientation, Point, orientation};
use crate::lists::{distinct, in_order};
use crate::mesh::{Edges, Mesh};
use crate::parallel::prelude::*;

/// Pairs of triangles that have more in common than a vertex or an edge of both, in order: for each triangle the first on the
/// boundary. None if the mesh is embedded. Needs finite positions, no two vertices at one, manifold edges and counter-clockwise
/// triangles.
pub(super) fn overlaps(mesh: &Mesh, edges: &Edges) -> Vec<[usize; 2]> {
    let bounds = |t: usize| Aabb::of(mesh.corners_of(mesh.triangles[t])).expect("three corners").into();
    let outer = distinct(edges.boundary().map(|side| side.triangle()));
    let tree = BoxTree::new(outer.into_iter().map(|t| (bounds(t), t)));
    let first = |t: usize| {
        let others = tree.meeting(bounds(t)).copied();
        let first = others.filter(|&u| overlap(mesh, mesh.triangles[t], mesh.triangles[u])).min()?;
        Some(in_order([t, first]))
    };
    distinct((0..mesh.triangles.len()).into_par_iter().filter_map(first).collect::<Vec<_>>())
}

/// Whether two triangles of such a mesh do.
fn overlap(mesh: &Mesh, t: [u32; 3], u: [u32; 3]) -> bool {
    match t.iter().filter(|v| u.contains(v)).count() {
        0 => !(is_apart(mesh, t, u) || is_apart(mesh, u, t)),
        1 => cones_overlap(mesh, t, u),
        // Neighbours over an edge pass it in opposite directions, and lie on both sides of it.
        _ => false,
    }
}

/// Whether an edge has another triangle strictly to its right; of two triangles without a common point one has such an edge.
fn is_apart(mesh: &Mesh, t: [u32; 3], other: [u32; 3]) -> bool {
    let ([a, b, c], points) = (mesh.corners_of(t), mesh.corners_of(other));
    let is_beyond = |(a, b): (Point, Point)| points.iter().all(|&p| orientation(a, b, p) == Orientation::Right);
    [(a, b), (b, c), (c, a)].into_iter().any(is_beyond)
}

/// Whether triangles with one common vertex have more in common: then the angle of one there holds an edge of the other.
fn cones_overlap(mesh: &Mesh, t: [u32; 3], u: [u32; 3]) -> bool {
    let from_shared = |t: [u32; 3], other: [u32; 3]| {
        let i = (0..3).find(|&i| other.contains(&t[i])).unwrap_or(0);
        mesh.corners_of([t[i], t[(i + 1) % 3], t[(i + 2) % 3]])
    };
    let ([at, a, b], [_, c, d]) = (from_shared(t, u), from_shared(u, t));
    let holds = |from: Point, to: Point, p: Point| {
        orientation(at, from, p) != Orientation::Right && orientation(at, p, to) != Orientation::Right
    };
    holds(a, b, c) || holds(a, b, d) || holds(c, d, a) || holds(c, d, b)
}

#[cfg(test)]
mod tests {
    use super::super::test_meshes::{fan, grid, mesh};
    use super::super::validity::validity;
    use crate::mesh::Mesh;

    fn union(mut first: Mesh, second: &Mesh) -> Mesh {
        let shift = first.points.len() as u32;
        first.points.extend(&second.points);
        first.point_labels.extend(&second.point_labels);
        first.triangles.extend(second.triangles.iter().map(|t| t.map(|v| v + shift)));
        first.triangle_labels.extend(&second.triangle_labels);
        first
    }

    fn moved(mut mesh: Mesh, scale: f64, [x, y]: [f64; 2]) -> Mesh {
        mesh.points.iter_mut().for_each(|p| *p = [p[0] * scale + x, p[1] * scale + y, 0.0]);
        mesh
    }

    fn overlaps(mesh: &Mesh) -> usize {
        let found = validity(mesh);
        assert_eq!((found.inverted, found.non_manifold_edges), (0, 0));
        assert_eq!(found.valid, found.overlaps == 0, "{found:?}");
        found.overlaps
    }

    #[test]
    fn separate_pieces_may_lie_side_by_side_but_not_on_each_other() {
        assert_eq!(overlaps(&union(grid(2, 2), &moved(grid(2, 2), 1.0, [5.0, 0.0]))), 0);
        assert_ne!(overlaps(&union(grid(2, 2), &moved(grid(2, 2), 1.0, [0.7, 0.3]))), 0, "crossing");
        assert_ne!(overlaps(&union(grid(2, 2), &moved(grid(1, 1), 0.3, [0.2, 0.4]))), 0, "one inside the other");
        assert_ne!(overlaps(&union(moved(grid(1, 1), 0.3, [0.2, 0.4]), &grid(2, 2))), 0, "either way round");
    }

    #[test]
    fn an_island_in_a_hole_is_fine_but_not_on_the_land() {
        let land = super::super::test_meshes::with_hole();
        assert_eq!(overlaps(&union(land.clone(), &moved(grid(1, 1), 0.5, [1.25, 1.25]))), 0);
        assert_ne!(overlaps(&union(land, &moved(grid(1, 1), 0.5, [2.25, 1.25]))), 0);
    }

    #[test]
    fn hanging_vertices_touch() {
        let hanging = mesh(
            &[[0.0, 0.0], [2.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.5, -1.0], [1.5, -1.0]],
            &[[0, 1, 2], [0, 4, 3], [3, 4, 5], [3, 5, 1]],
        );
        assert_ne!(overlaps(&hanging), 0);
    }

    #[test]
    fn strip_that_winds_over_itself_is_caught() {
        let spiral = |turn: f64| {
            let steps = 40;
            let points: Vec<[f64; 2]> = (0..=steps)
                .flat_map(|i| {
                    let angle = turn * f64::from(i) / f64::from(steps);
                    [[angle.cos(), angle.sin()], [2.0 * angle.cos(), 2.0 * angle.sin()]]
                })
                .collect();
            let strip: Vec<[u32; 3]> = (0..steps as u32)
                .flat_map(|i| [[2 * i, 2 * i + 1, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 2]])
                .collect();
            mesh(&points, &strip)
        };
        assert_eq!(overlaps(&spiral(6.0)), 0);
        assert_ne!(overlaps(&spiral(7.0)), 0);
    }

    #[test]
    fn open_fans_of_more_than_a_turn_and_pinched_vertices() {
        let open = |count: u32, step: f64| {
            let mut points = vec![[0.0, 0.0]];
            points.extend((0..=count).map(|i| {
                let angle = step * f64::from(i);
                [(1.0 + 0.1 * f64::from(i)) * angle.cos(), (1.0 + 0.1 * f64::from(i)) * angle.sin()]
            }));
            mesh(&points, &(0..count).map(|i| [0, i + 1, i + 2]).collect::<Vec<_>>())
        };
        assert_eq!(overlaps(&open(6, 1.0)), 0);
        assert_ne!(overlaps(&open(7, 1.0)), 0);
        let pinched = |x: f64, y: f64| {
            mesh(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [x, y], [x - 0.5, y - 0.5]], &[[0, 1, 2], [0, 3, 4]])
        };
        assert_eq!(overlaps(&pinched(-1.0, 0.0)), 0);
        assert_ne!(
            overlaps(&mesh(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [2.0, 1.0], [1.0, 2.0]], &[[0, 1, 2], [0, 3, 4]])),
            0
        );
    }

    #[test]
    fn a_second_fan_over_a_closed_one_is_caught() {
        let mut covered = fan(6, 1);
        let first = covered.points.len() as u32;
        covered.points.extend([[0.3, 0.1, 0.0], [0.2, 0.3, 0.0]]);
        covered.point_labels.extend([0, 0]);
        covered.triangles.push([0, first, first + 1]);
        covered.triangle_labels.push(1);
        assert_ne!(overlaps(&covered), 0);
    }
}
