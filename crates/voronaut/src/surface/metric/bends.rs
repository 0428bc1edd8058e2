//! How curves on a surface bend: borders, and edges that are fixed.

use crate::geometry::Vector3;
use crate::surface::Surface;
use crate::triangulation::{HalfEdge, VertexId};

/// How a curve bends at a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bend {
    /// Its curvature, in 1 / length.
    pub(super) curvature: f64,
    /// Unit tangent.
    pub(super) tangent: Vector3,
}

/// Turns by more than this, in degrees, are corners, which ask for nothing: they are kept as they are.
const CORNER: f64 = 45.0;

/// How the curve bends on which a vertex lies: that of the border and of fixed edges. The circle through the vertex and its
/// neighbours on the curve has the curvature 2 sin(turn) / |chord| (Menger 1930), exact where all are on a circle. `None` off
/// curves, where other than two of their edges meet, and at corners.
pub(super) fn bend(surface: &Surface, v: VertexId) -> Option<Bend> {
    let t = surface.topology();
    let is_of_curve = |h: HalfEdge| t.twin(h).is_none() || t.is_fixed(h);
    let mut ends = Vec::new();
    for h in t.star(v) {
        // The side that comes back to the vertex has a half-edge of the star on its other side, but for the border.
        ends.extend(is_of_curve(h).then(|| t.target(h)));
        ends.extend(t.twin(h.prev()).is_none().then(|| t.apex(h)));
    }
    let &[before, after] = ends.as_slice() else { return None };
    let at = surface.position(v);
    let [u, w] = [at - surface.position(before), surface.position(after) - at];
    let turn = u.cross(w).norm().atan2(u.dot(w));
    let chord = u + w;
    let tangent = chord.unit().filter(|_| turn.to_degrees() <= CORNER)?;
    Some(Bend { curvature: 2.0 * turn.sin() / chord.norm(), tangent })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use std::f64::consts::TAU;

    /// A fan of triangles around the origin: its rim a circle of this radius with vertices at uneven angles.
    fn plate(radius: f64, count: u32) -> Surface {
        let angle = |i: u32| TAU * (f64::from(i) + 0.3 * f64::from(i).sin()) / f64::from(count);
        let rim = (0..count).map(|i| [radius * angle(i).cos(), radius * angle(i).sin(), 1.0]);
        let points = [[0.0, 0.0, 1.0]].into_iter().chain(rim).collect();
        let triangles = (0..count).map(|i| [0, 1 + i, 1 + (i + 1) % count]).collect();
        Surface::new(&Mesh { points, triangles, ..Mesh::default() }).unwrap()
    }

    #[test]
    fn circles_have_the_curvature_of_their_radius() {
        let surface = plate(3.0, 24);
        assert_eq!(bend(&surface, VertexId(0)), None, "off the border");
        for v in (1..25).map(VertexId) {
            let found = bend(&surface, v).unwrap();
            assert!((found.curvature * 3.0 - 1.0).abs() < 1e-12, "{found:?}");
            assert!(found.tangent.dot(surface.position(v) - crate::geometry::Point3::new(0.0, 0.0, 1.0)).abs() < 0.3);
        }
    }

    #[test]
    fn corners_and_forks_do_not_bend() {
        let square = plate(1.0, 5);
        assert!((1..6).all(|v| bend(&square, VertexId(v)).is_none()), "turns of 72 degrees, about");
        let fork = Mesh { edges: vec![[0, 1], [0, 9], [0, 17]], ..plate(1.0, 24).to_mesh() };
        let surface = Surface::new(&fork).unwrap();
        assert!([0, 1, 9, 17].into_iter().all(|v| bend(&surface, VertexId(v)).is_none()));
        let line = Mesh { edges: vec![[0, 1], [0, 13]], ..plate(1.0, 24).to_mesh() };
        let found = bend(&Surface::new(&line).unwrap(), VertexId(0)).unwrap();
        assert!(found.curvature < 0.3, "nearly straight through the middle: {found:?}");
    }
}
