//! Whether counter-clockwise triangles cover every point of the plane at most once, decided exactly.
//!
//! A manifold triangle list whose triangles are all counter-clockwise is embedded if and only if
//! 1. the fans of triangles around each vertex do not cover a direction twice,
//! 2. no two boundary edges touch but at a vertex they share, and
//! 3. outside each connected piece of the boundary no triangle covers it: by Stokes, the number of triangles over a
//!    point is the winding number of the whole boundary around it, and it changes only at the boundary.

use super::faults::{Fault, Piece, Segments};
use super::self_intersections::meet;
use crate::geometry::{Aabb, Orientation, Point, orientation};
use crate::lists::{Classes, distinct, marked};
use crate::mesh::{Edges, Mesh};
use crate::parallel::prelude::*;
use std::collections::BTreeMap;

/// The faults of the first of the three conditions that does not hold; empty if the mesh is embedded.
/// Needs finite positions, no two vertices at one, manifold edges and counter-clockwise triangles.
pub(super) fn overlaps(mesh: &Mesh, edges: &Edges) -> Vec<Fault> {
    let mut boundary: Vec<[u32; 2]> = edges.boundary().map(|side| side.directed()).collect();
    boundary.sort_unstable();
    let turns = turns(mesh);
    let faults = overlapping_fans(mesh, &boundary, &turns);
    if !faults.is_empty() {
        return faults;
    }
    let segments = Segments::new(boundary.iter().map(|ends| ends.map(|v| mesh.point(v))));
    let faults = touching_edges(mesh, &boundary, &segments);
    if faults.is_empty() { covered_components(mesh, &boundary, &segments, &turns) } else { faults }
}

/// For each vertex, how many of its triangles cover the direction +x: those whose link edge comes from below the
/// vertex and ends not below it. Each full turn of a fan has exactly one.
fn turns(mesh: &Mesh) -> Vec<u32> {
    let mut turns = vec![0; mesh.points.len()];
    for &[a, b, c] in &mesh.triangles {
        for [v, from, to] in [[a, b, c], [b, c, a], [c, a, b]] {
            let y = mesh.point(v).y;
            turns[v as usize] += u32::from(mesh.point(from).y < y && mesh.point(to).y >= y);
        }
    }
    turns
}

/// Vertices whose triangles cover +x twice, or cover the first edge of one of their fans with more than the one
/// triangle that begins there.
fn overlapping_fans(mesh: &Mesh, boundary: &[[u32; 2]], turns: &[u32]) -> Vec<Fault> {
    let mut covers = vec![0; boundary.len()];
    let on_boundary = marked(mesh.points.len(), boundary.iter().map(|&[v, _]| v));
    for &[a, b, c] in &mesh.triangles {
        for [v, from, to] in [[a, b, c], [b, c, a], [c, a, b]] {
            if on_boundary[v as usize] {
                let first = boundary.partition_point(|edge| edge[0] < v);
                for (i, edge) in boundary.iter().enumerate().skip(first).take_while(|(_, edge)| edge[0] == v) {
                    covers[i] += u32::from(covers_direction(mesh, [v, from, to], edge[1]));
                }
            }
        }
    }
    let twice = (0..).zip(turns).filter(|&(_, &turns)| turns > 1).map(|(v, _)| v);
    let starts = boundary.iter().zip(&covers).filter(|&(_, &covers)| covers != 1).map(|(&[v, _], _)| v);
    let vertices = distinct(twice.chain(starts));
    let what = |v: u32| format!("the triangles around vertex {} overlap", v + 1);
    vertices.into_iter().map(|v| Fault { what: what(v), place: mesh.point(v).to_string() }).collect()
}

/// Whether the cone of a counter-clockwise triangle at v, with its first and without its last ray, holds the ray
/// from v to `target`.
fn covers_direction(mesh: &Mesh, [v, from, to]: [u32; 3], target: u32) -> bool {
    let [v, from, to, target] = [v, from, to, target].map(|v| mesh.point(v));
    orientation(v, target, to) == Orientation::Left && orientation(v, from, target) != Orientation::Right
}

/// Boundary edges that meet another one elsewhere than at a shared vertex.
fn touching_edges(mesh: &Mesh, boundary: &[[u32; 2]], segments: &Segments) -> Vec<Fault> {
    let touched = |(i, &edge): (usize, &[u32; 2])| {
        let bounds = Aabb::of(edge.map(|v| mesh.point(v)))?;
        let others = segments.meeting(bounds).map(|piece| piece.id as usize).filter(|&other| other > i);
        let ends = |edge: [u32; 2]| edge.map(|v| mesh.point(v));
        let other = others.filter(|&other| meet(ends(edge), ends(boundary[other]))).min()?;
        let [[a, b], [c, d]] = [edge, boundary[other]].map(|edge| edge.map(|v| v + 1));
        let what = format!("boundary edges {a} {b} and {c} {d} cross or touch");
        Some(Fault { what, place: mesh.point(edge[0]).midpoint(mesh.point(edge[1])).to_string() })
    };
    boundary.par_iter().enumerate().filter_map(touched).collect()
}

/// Connected pieces of the boundary that lie on triangles which are not theirs. Just right of a piece's rightmost
/// vertex the winding number of the boundary counts all triangles, `turns` those of the vertex itself.
fn covered_components(mesh: &Mesh, boundary: &[[u32; 2]], segments: &Segments, turns: &[u32]) -> Vec<Fault> {
    let covered = |&v: &u32| i64::from(turns[v as usize]) != winding_right_of(mesh, boundary, segments, v);
    let what = |v: u32| format!("triangles overlap around the boundary through vertex {}", v + 1);
    rightmost_vertices(mesh, boundary)
        .into_par_iter()
        .filter(covered)
        .map(|v| Fault { what: what(v), place: mesh.point(v).to_string() })
        .collect()
}

/// The winding number of the boundary just right of a vertex with no boundary edge to its right.
fn winding_right_of(mesh: &Mesh, boundary: &[[u32; 2]], segments: &Segments, vertex: u32) -> i64 {
    let p = mesh.point(vertex);
    let ray = Aabb { min: p, max: Point::new(segments.right_end(), p.y) };
    let crossing = |piece: &Piece| {
        let [from, to] = boundary[piece.id as usize];
        let (a, b) = (mesh.point(from), mesh.point(to));
        if from == vertex || to == vertex {
            0
        } else if a.y <= p.y && p.y < b.y {
            i64::from(orientation(a, b, p) == Orientation::Left)
        } else if b.y <= p.y && p.y < a.y {
            -i64::from(orientation(a, b, p) == Orientation::Right)
        } else {
            0
        }
    };
    segments.meeting(ray).map(crossing).sum()
}

/// The lexicographically largest vertex of each connected piece of the boundary, in increasing order of number.
fn rightmost_vertices(mesh: &Mesh, boundary: &[[u32; 2]]) -> Vec<u32> {
    let mut parts = Classes::new(mesh.points.len());
    for &[a, b] in boundary {
        parts.join(a, b);
    }
    let place = |v: u32| (mesh.point(v).x, mesh.point(v).y);
    let mut rightmost: BTreeMap<u32, u32> = BTreeMap::new();
    for &[v, _] in boundary {
        let known = rightmost.entry(parts.shorten(v)).or_insert(v);
        *known = if place(*known) < place(v) { v } else { *known };
    }
    distinct(rightmost.into_values())
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
        assert_eq!(overlaps(&union(grid(2, 2), &moved(grid(1, 1), 0.3, [0.2, 0.4]))), 1, "one inside the other");
        assert_eq!(overlaps(&union(moved(grid(1, 1), 0.3, [0.2, 0.4]), &grid(2, 2))), 1, "either way round");
    }

    #[test]
    fn an_island_in_a_hole_is_fine_but_not_on_the_land() {
        let land = super::super::test_meshes::with_hole();
        assert_eq!(overlaps(&union(land.clone(), &moved(grid(1, 1), 0.5, [1.25, 1.25]))), 0);
        assert_eq!(overlaps(&union(land, &moved(grid(1, 1), 0.5, [2.25, 1.25]))), 1);
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
