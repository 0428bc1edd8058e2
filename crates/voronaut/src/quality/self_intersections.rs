//! Triangles of a surface that meet where they are not neighbours, and lines in the plane that cross, decided exactly.

use super::faults::Fault;
use crate::geometry::{Aabb, Bounds, Corners, Orientation, Point, Point3, contacts, meeting_pairs, orientation};
use crate::mesh::{Edges, Mesh};
use crate::parallel::prelude::*;

/// Two triangles that meet, the smaller number first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair {
    /// Which.
    pub(super) triangles: [usize; 2],
    /// A point that both have, rounded.
    pub(super) at: Point3,
}

impl Pair {
    /// Whether they have a vertex in common, by its number.
    pub(super) fn are_neighbours(&self, mesh: &Mesh) -> bool {
        let [t, u] = self.triangles.map(|t| mesh.triangles[t]);
        t.iter().any(|v| u.contains(v))
    }

    /// What to say of them.
    pub(super) fn fault(&self) -> Fault {
        let [i, j] = self.triangles;
        Fault { what: format!("triangles {} and {} meet", i + 1, j + 1), place: self.at.to_string() }
    }
}

/// The pairs of triangles that have more in common than a vertex or an edge that both name, in order. Neighbours that lie flat
/// on each other count. Needs finite positions and triangles that are not flat.
pub(super) fn pairs(mesh: &Mesh) -> Vec<Pair> {
    let corners = |&t: &[u32; 3]| Corners { vertices: t, points: mesh.positions_of(t) };
    let corners: Vec<Corners> = mesh.triangles.par_iter().with_min_len(1024).map(corners).collect();
    contacts(&corners, |_| true).into_iter().map(|(triangles, at)| Pair { triangles, at }).collect()
}

/// Two polylines that meet elsewhere than at a common point of both.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Crossing {
    /// The two polylines, the smaller number first.
    pub paths: [u32; 2],
    /// The number of the segment of each that meets the other one.
    pub segments: [u32; 2],
}

/// All places where two of these polylines meet, in order: pairs of segments that have a point in common that is not an end
/// of both, by exact predicates. Polylines that share a seed, or bend around the same corner, do not cross there; those
/// that run along each other do. A polyline is not held against itself. Points that are not finite meet nothing.
pub(crate) fn crossings<P: AsRef<[Point]> + Sync>(paths: &[P]) -> Vec<Crossing> {
    let mut origins = Vec::new();
    for (path, points) in (0..).zip(paths) {
        let segments = (0..).zip(points.as_ref().windows(2)).map(|(i, ends)| ([path, i], [ends[0], ends[1]]));
        origins.extend(segments.filter(|(_, ends)| ends.iter().all(|p| p.is_finite())));
    }
    let boxes: Vec<Bounds<2>> = origins.iter().filter_map(|origin| Some(Aabb::of(origin.1)?.into())).collect();
    let crossing = |[i, j]: [usize; 2]| {
        let (([path, segment], ends), ([other, with], others)) = (origins[i], origins[j]);
        (path != other && meet(ends, others)).then_some(Crossing { paths: [path, other], segments: [segment, with] })
    };
    let mut all: Vec<Crossing> = meeting_pairs(&boxes, |_| true, crossing).into_iter().map(|found| found.1).collect();
    all.sort_unstable();
    all
}

/// The pairs of straight edges without a common vertex that cross or touch, in order: where a dual does not embed. Edges
/// with a vertex that does not exist are left out.
pub fn crossing_edges(mesh: &Mesh) -> Vec<[[u32; 2]; 2]> {
    let exists = |t: &&[u32; 3]| t.iter().all(|&v| (v as usize) < mesh.points.len());
    let triangles: Vec<[u32; 3]> = mesh.triangles.iter().filter(exists).copied().collect();
    let edges: Vec<[u32; 2]> = Edges::of(&triangles).ends().filter(|[a, b]| a != b).collect();
    let paths: Vec<[Point; 2]> = edges.iter().map(|e| e.map(|v| mesh.point(v))).collect();
    let pairs = crossings(&paths).into_iter().map(|c| c.paths.map(|i| edges[i as usize]));
    pairs.filter(|[e, f]| !e.iter().any(|v| f.contains(v))).collect()
}

/// Whether two segments whose bounding boxes meet have a point in common that is not an end of both, exactly.
fn meet([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    let shared = [(a, b, c, d), (a, b, d, c), (b, a, c, d), (b, a, d, c)].into_iter().find(|s| s.0 == s.2);
    if let Some((at, p, _, q)) = shared {
        let same_side = p.x > at.x && q.x > at.x
            || p.x < at.x && q.x < at.x
            || p.y > at.y && q.y > at.y
            || p.y < at.y && q.y < at.y;
        return same_side && orientation(at, p, q) == Orientation::Collinear;
    }
    let apart = |a: Point, b: Point, c: Point, d: Point| {
        let (left, right) = (orientation(a, b, c), orientation(a, b, d));
        left == right && left != Orientation::Collinear
    };
    !apart(a, b, c, d) && !apart(c, d, a, b)
}

#[cfg(test)]
mod tests {
    use super::super::test_meshes::{grid, mesh};
    use super::super::validity::validity;
    use super::*;
    use crate::manifold::surface::{Surface, sphere, torus};
    use crate::mesh::Mesh;

    fn scaled(mut mesh: Mesh, scale: f64) -> Mesh {
        mesh.points.as_flattened_mut().iter_mut().for_each(|x| *x *= scale);
        mesh
    }

    /// The torus of radii 2 and 0.7 with another tube: one thicker than the ring goes through itself.
    fn with_tube(tube: f64) -> Mesh {
        let mut mesh = torus(2.0, 0.7, 0.3).unwrap().to_mesh();
        for p in &mut mesh.points {
            let from_axis = p[0].hypot(p[1]);
            let factor = (2.0 + (from_axis - 2.0) / 0.7 * tube) / from_axis;
            *p = [p[0] * factor, p[1] * factor, p[2] / 0.7 * tube];
        }
        mesh
    }

    #[test]
    fn spheres_and_tori_are_clean() {
        let surfaces = [sphere(1.0, 2.0), sphere(3.0, 0.3), torus(2.0, 0.7, 0.2), torus(5.0, 0.1, 1.0)];
        for mesh in surfaces.map(|surface: crate::Result<Surface>| surface.unwrap().to_mesh()) {
            for scale in [1e-9, 1.0, 1e9] {
                let found = validity(&scaled(mesh.clone(), scale));
                assert!(found.valid, "{found:?}");
            }
        }
    }

    #[test]
    fn a_torus_through_itself_is_found_with_the_place() {
        assert!(validity(&with_tube(1.9)).valid);
        for scale in [1e-9, 1.0, 1e9] {
            let found = validity(&scaled(with_tube(2.5), scale));
            assert!(!found.valid && found.overlaps > 50, "{found:?}");
            let fault = found.first_fault.unwrap();
            assert!(fault.what.starts_with("triangles ") && fault.what.ends_with(" meet"), "{fault:?}");
            let at: Vec<f64> = fault.place[1..fault.place.len() - 1].split(", ").map(|x| x.parse().unwrap()).collect();
            // It meets itself on the axis, and there about 1.5 above and below the middle.
            assert!(at[0].hypot(at[1]) < 0.7 * scale && at[2].abs() < 2.5 * scale, "{fault:?}");
        }
    }

    #[test]
    fn what_is_doubled_overlaps() {
        let mut mesh = sphere(1.0, 0.5).unwrap().to_mesh();
        let count = mesh.points.len() as u32;
        mesh.points.extend(mesh.points.clone());
        mesh.point_labels.extend(vec![0; count as usize]);
        mesh.triangles.extend(mesh.triangles.clone().into_iter().map(|t| t.map(|v| v + count)));
        mesh.triangle_labels.extend(vec![0; mesh.triangle_labels.len()]);
        let found = validity(&mesh);
        assert_eq!((found.duplicate_vertices, found.non_manifold_vertices), (count as usize, 0));
        assert!(found.overlaps >= mesh.triangles.len() / 2, "{found:?}");
    }

    #[test]
    fn two_tetrahedra_that_share_a_vertex_are_no_surface() {
        let points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]];
        let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
        let other = tetrahedron.map(|t| t.map(|v: u32| if v == 0 { 0 } else { v + 3 }));
        let mesh = Mesh {
            points: points.map(|p| p.map(f64::from)).to_vec(),
            point_labels: vec![0; 7],
            triangles: [tetrahedron, other.map(|[a, b, c]| [a, c, b])].concat(),
            triangle_labels: vec![0; 8],
            ..Mesh::default()
        };
        let found = validity(&mesh);
        assert_eq!((found.non_manifold_vertices, found.non_manifold_edges, found.overlaps), (1, 0, 0), "{found:?}");
        assert_eq!(
            found.first_fault.unwrap().to_string(),
            "the triangles around vertex 1 are not one fan at (0, 0, 0)"
        );
    }

    #[test]
    fn flat_triangles_are_faults() {
        let mut mesh = sphere(1.0, 2.0).unwrap().to_mesh();
        let [a, b, c] = mesh.triangles[0];
        let middle = |axis: usize| 0.5 * (mesh.points[a as usize][axis] + mesh.points[b as usize][axis]);
        mesh.points[c as usize] = [middle(0), middle(1), middle(2)];
        let found = validity(&mesh);
        assert!(found.inverted >= 1 && !found.valid, "{found:?}");
    }

    fn line(points: &[(f64, f64)]) -> Vec<Point> {
        points.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    #[test]
    fn lines_cross_touch_and_share_ends() {
        let first = line(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]);
        let count = |second: &[(f64, f64)]| crossings(&[first.clone(), line(second)]).len();
        assert_eq!(count(&[(0.5, -1.0), (0.5, 1.0)]), 1);
        assert_eq!(count(&[(0.5, 0.0), (0.5, 1.0)]), 1, "an end on it");
        assert_eq!(count(&[(1.0, 0.0), (1.0, 1.0)]), 0, "an end in common");
        assert_eq!(count(&[(0.0, 0.0), (0.3, 0.5), (0.6, -0.5)]), 1, "a common end, and a crossing");
        assert_eq!(count(&[(0.0, 0.0), (0.5, 0.0)]), 1, "along it");
        assert_eq!(count(&[(0.0, 0.0), (-0.5, 0.0)]), 0, "away from it");
        assert_eq!(count(&[(0.5, 1e-300), (0.5, 1.0)]), 0, "near it");
        assert_eq!(count(&[(f64::NAN, 0.0), (0.5, 1.0)]), 0);
        assert!(crossings::<Vec<Point>>(&[]).is_empty());
        let found = crossings(&[line(&[(1.5, 1.0), (1.5, -1.0)]), line(&[(9.0, 9.0), (8.0, 8.0)]), first]);
        assert_eq!(found, [Crossing { paths: [0, 2], segments: [0, 1] }]);
    }

    #[test]
    fn meshes_do_not_cross_and_folded_ones_do() {
        assert!(crossing_edges(&grid(5, 4)).is_empty());
        // The apex of the second triangle lies beyond the other side of the first.
        let folded = mesh(&[[0.0, 0.0], [1.0, 0.0], [0.5, 1.0], [0.4, -0.5]], &[[0, 1, 2], [1, 2, 3], [9, 1, 2]]);
        assert_eq!(crossing_edges(&folded), [[[0, 1], [2, 3]]]);
    }
}
