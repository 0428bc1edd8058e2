//! Closest points on triangles whose vertices move, found from a triangle nearby.

use crate::geometry::{Point3, Vector3};
use crate::surface::{Surface, closest_weights};
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};

/// Triangles with positions of their own.
#[derive(Clone)]
pub(super) struct Sheet<'a> {
    pub(super) topology: &'a Triangulation,
    pub(super) positions: Vec<Point3>,
}

/// The closest point of a triangle to some point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    pub(super) face: FaceId,
    /// Its barycentric coordinates.
    pub(super) weights: [f64; 3],
    /// From it to the point.
    pub(super) offset: Vector3,
}

/// A barycentric coordinate up to this is zero.
const ON_BORDER: f64 = 1e-9;

impl Foot {
    /// The square of the distance.
    pub(super) fn square(&self) -> f64 {
        self.offset.dot(self.offset)
    }

    /// Whether it is off the triangle's border, so that the offset is along the normal.
    fn is_inside(&self) -> bool {
        self.held_by().all(|held| held)
    }

    /// Which corners it is not opposite to, but for rounding.
    fn held_by(&self) -> impl Iterator<Item = bool> {
        self.weights.into_iter().map(|w| w > ON_BORDER)
    }
}

impl<'a> Sheet<'a> {
    /// A surface's triangles, where they are.
    pub(super) fn of(surface: &'a Surface) -> Self {
        Self { topology: surface.topology(), positions: surface.positions().to_vec() }
    }

    /// The corners of a triangle.
    pub(super) fn triangle(&self, f: FaceId) -> [Point3; 3] {
        self.topology.corners(f).map(|v| self.positions[v.index()])
    }

    /// The normal with the length of twice the area.
    pub(super) fn area_vector(&self, f: FaceId) -> Vector3 {
        area_vector(self.triangle(f))
    }

    /// The closest point of one triangle.
    pub(super) fn foot(&self, face: FaceId, p: Point3) -> Foot {
        let corners = self.triangle(face);
        let weights = closest_weights(corners, p);
        Foot { face, weights, offset: p - Point3::weighted(corners, weights) }
    }

    /// A closest point among the triangles around: from triangle to triangle while that comes nearer, until none comes nearer that
    /// shares a corner with the one that was reached. Beyond a gap or a bulge there may be nearer ones, so the distance is an upper
    /// bound.
    pub(super) fn descend(&self, start: FaceId, p: Point3) -> Foot {
        let mut best = self.foot(start, p);
        while let Some(nearer) = self.nearer_beside(&best, p).or_else(|| self.nearer_around(&best, p)) {
            best = nearer;
        }
        best
    }

    /// The nearest, if nearer, across the sides of a triangle that holds its foot inside, or of those that share an end of the side
    /// that holds it: mostly the way goes on there.
    fn nearer_beside(&self, foot: &Foot, p: Point3) -> Option<Foot> {
        let t = self.topology;
        if foot.is_inside() {
            return self.nearer(foot, p, foot.face.half_edges().into_iter().filter_map(|h| t.twin(h)));
        }
        let held = foot.held_by().zip(t.corners(foot.face)).filter(|&(held, _)| held);
        self.nearer(foot, p, held.flat_map(|(_, v)| t.star(v)))
    }

    /// The nearest, if nearer, of all triangles that share a corner with one. Those whose planes are farther than the foot are not.
    fn nearer_around(&self, foot: &Foot, p: Point3) -> Option<Foot> {
        let may_be = |h: &HalfEdge| {
            let corners = self.triangle(h.face());
            let normal = area_vector(corners);
            let height = normal.dot(p - corners[0]);
            height * height < foot.square() * normal.dot(normal)
        };
        let around = self.topology.corners(foot.face).into_iter().flat_map(|v| self.topology.star(v));
        self.nearer(foot, p, around.filter(may_be))
    }

    fn nearer(&self, foot: &Foot, p: Point3, among: impl Iterator<Item = HalfEdge>) -> Option<Foot> {
        let mut best = *foot;
        for h in among.filter(|h| h.face() != foot.face) {
            let other = self.foot(h.face(), p);
            if other.square() < best.square() {
                best = other;
            }
        }
        (best.face != foot.face).then_some(best)
    }

    /// The unit direction along which the distance of a foot changes most: the normal inside a triangle, at its border from
    /// the foot to the point. Where these are hardly apart (beside `near`) that says nothing, and the mean normal there
    /// takes its place, without a jump.
    pub(super) fn direction(&self, foot: &Foot, near: f64) -> Vector3 {
        if foot.is_inside() {
            return self.area_vector(foot.face).unit().unwrap_or_default();
        }
        let normal = self.mean_normal(foot);
        let side = if normal.dot(foot.offset) < 0.0 { -near } else { near };
        (foot.offset + normal * side).unit().unwrap_or(normal)
    }

    /// The mean of the normals at a point of an edge, or at a vertex, there weighted by angles (Baerentzen and Aanaes 2005).
    fn mean_normal(&self, foot: &Foot) -> Vector3 {
        let t = self.topology;
        let at = |v: VertexId| self.positions[v.index()];
        let corners = foot.held_by().zip(t.corners(foot.face)).filter(|&(held, _)| held).map(|(_, v)| v);
        let corners: Vec<VertexId> = corners.collect();
        let around = t.star(corners[0]).filter(|h| corners.iter().all(|v| t.corners(h.face()).contains(v)));
        let weighted = around.map(|h| {
            let [u, v] = [t.target(h), t.apex(h)].map(|v| at(v) - at(t.origin(h)));
            let angle = if corners.len() == 1 { u.cross(v).norm().atan2(u.dot(v)) } else { 1.0 };
            self.area_vector(h.face()).unit().unwrap_or_default() * angle
        });
        weighted.fold(Vector3::default(), |sum, n| sum + n).unit().unwrap_or_default()
    }
}

/// The normal of a triangle with the length of twice its area.
pub(super) fn area_vector([a, b, c]: [Point3; 3]) -> Vector3 {
    (b - a).cross(c - a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::surface::{Nearest, torus};
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    proptest! {
        #[test]
        fn descents_from_nearby_find_the_closest(u in 0.0..TAU, v in 0.0..TAU, off in -0.2..0.2, face in 0_u32..100) {
            let surface = torus(2.0, 0.7, 0.4).unwrap();
            let sheet = Sheet::of(&surface);
            let tree = Nearest::new(&surface);
            let at = |u: f64, v: f64, tube: f64| {
                let ring = 2.0 + tube * v.cos();
                Point3::new(ring * u.cos(), ring * u.sin(), tube * v.sin())
            };
            let p = at(u, v, 0.7 + off);
            let truth = tree.closest(&surface, p).unwrap();
            let near = tree.closest(&surface, at(u + 0.3, v - 0.4, 0.7)).unwrap().place.face;
            let foot = sheet.descend(near, p);
            prop_assert!((foot.square().sqrt() - truth.distance).abs() < 1e-12);
            prop_assert!((foot.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            prop_assert!((sheet.direction(&foot, 0.0).dot(foot.offset).abs() - truth.distance).abs() < 1e-12);
            // From anywhere: never nearer than the closest of all, nor farther than where it began.
            let far = sheet.descend(FaceId(face), p);
            prop_assert!(far.square().sqrt() > truth.distance - 1e-12);
            prop_assert!(far.square() <= sheet.foot(FaceId(face), p).square());
            let around = surface.topology().corners(far.face).into_iter().flat_map(|v| surface.topology().star(v));
            for h in around {
                prop_assert!(sheet.foot(h.face(), p).square() >= far.square() * (1.0 - 1e-12));
            }
        }
    }

    /// A fan with one triangle that leans over the one below the point: they share the corner, and what is between them is farther.
    #[test]
    fn a_triangle_that_only_shares_a_corner_is_found() {
        let rim =
            [[1.0, 0.0, 0.0], [0.5, 0.9, 0.0], [-0.5, 0.9, 0.0], [0.0, 0.4, 0.9], [0.4, 0.0, 0.9], [0.5, -0.9, 0.0]];
        let points = std::iter::once([0.0; 3]).chain(rim).collect();
        let triangles = (0..6).map(|i| [0, i + 1, (i + 1) % 6 + 1]).collect();
        let surface = Surface::new(&Mesh { points, triangles, ..Mesh::default() }).unwrap();
        let sheet = Sheet::of(&surface);
        let p = Point3::new(0.17, 0.1, 0.5);
        let below = FaceId(0);
        assert!(sheet.foot(below, p).is_inside());
        assert!(sheet.nearer_beside(&sheet.foot(below, p), p).is_none());
        let truth = Nearest::new(&surface).closest(&surface, p).unwrap().distance;
        assert!((sheet.descend(below, p).square().sqrt() - truth).abs() < 1e-14 && truth < 0.1);
    }
}
