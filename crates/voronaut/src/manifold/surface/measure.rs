//! Size and shape of a surface: area, normals, components, borders, genus.

use super::super::Place;
use super::Surface;
use crate::elementary::Elementary;
use crate::geometry::{Aabb3, Vector3};
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, HalfEdge, VertexId};

/// A place whose weight (barycentric) at a corner is less is on the side opposite.
const ON_SIDE: f64 = 1e-9;

/// A connected part of a surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Component {
    /// Its triangles, in the order in which neighbours were found.
    pub faces: Vec<FaceId>,
    /// Vertices minus edges plus triangles.
    pub euler_characteristic: isize,
    /// How many closed curves its border consists of; 0 of a closed surface.
    pub borders: usize,
}

impl Component {
    /// How many handles it has: 0 of a sphere or a disk, 1 of a torus.
    pub fn genus(&self) -> isize {
        (2 - self.borders.cast_signed() - self.euler_characteristic) / 2
    }
}

impl Surface {
    /// The triangle's normal with the length of twice its area, to the side from which it is counter-clockwise.
    pub(crate) fn area_vector(&self, f: FaceId) -> Vector3 {
        let [a, b, c] = self.triangle(f);
        (b - a).cross(c - a)
    }

    /// The triangle's unit normal.
    pub(crate) fn normal(&self, f: FaceId) -> Vector3 {
        self.normals[f.index()]
    }

    /// The unit normals of all triangles.
    pub(super) fn normals_of_faces(&self) -> Box<[Vector3]> {
        let faces = (0..self.topology.face_slots() as u32).into_par_iter().with_min_len(1024).map(FaceId);
        // Areas were found positive; where the square of one underflows the direction does not matter any more.
        let normal = |f| self.area_vector(f).unit().unwrap_or(Vector3::new(0.0, 0.0, 1.0));
        faces.map(|f| if self.topology.is_face(f) { normal(f) } else { Vector3::default() }).collect()
    }

    /// The mean of the normals of a vertex's triangles, weighted by their angles there (Thurmer and Wuthrich 1998), so
    /// that cutting a flat part differently changes nothing. `None` without triangles, or where the mean is zero.
    pub(crate) fn vertex_normal(&self, v: VertexId) -> Option<Vector3> {
        let weighted = self.topology.star(v).map(|h| self.normal(h.face()) * self.angle(h));
        weighted.fold(Vector3::default(), |sum, normal| sum + normal).unit()
    }

    /// Vertices whose normal is farther than an angle (degrees) from those of all their triangles, in order; and the least cosine between
    /// the two.
    pub(crate) fn tips(&self, angle: f64) -> Vec<(VertexId, f64)> {
        let most = angle.to_radians().cosine();
        let tip = |v: VertexId| {
            let normal = self.vertex_normal(v)?;
            let cosines = self.topology.star(v).map(|h| self.normal(h.face()).dot(normal));
            let [least, greatest] = cosines.fold([1.0_f64, -1.0], |[l, g], c| [l.min(c), g.max(c)]);
            (greatest < most && !self.topology.is_border_vertex(v)).then_some((v, least))
        };
        let vertices: Vec<VertexId> = self.topology.vertices().collect();
        vertices.into_par_iter().with_min_len(256).filter_map(tip).collect()
    }

    /// The unit normal at a place: that of its triangle, on an edge the mean of both, at a vertex [`Surface::vertex_normal`].
    pub(crate) fn normal_at(&self, place: &Place) -> Vector3 {
        let own = self.normal(place.face);
        let is_off = place.weights.map(|weight| weight < ON_SIDE);
        let corners = place.face.half_edges();
        match (0..3).filter(|&k| is_off[k]).collect::<Vec<usize>>()[..] {
            [k] => {
                let across = self.topology.twin(corners[(k + 1) % 3]).map(|h| self.normal(h.face()));
                across.and_then(|other| (own + other).unit()).unwrap_or(own)
            }
            [j, k] => self.vertex_normal(self.topology.origin(corners[3 - j - k])).unwrap_or(own),
            _ => own,
        }
    }

    /// The angle of a half-edge's triangle at its origin, in radians.
    pub(crate) fn angle(&self, h: HalfEdge) -> f64 {
        let at = self.position(self.topology.origin(h));
        let [u, v] = [self.topology.target(h), self.topology.apex(h)].map(|v| self.position(v) - at);
        u.cross(v).norm().arctangent_over(u.dot(v))
    }

    /// The sum of the triangles' areas.
    pub(crate) fn area(&self) -> f64 {
        self.topology.faces().map(|f| 0.5 * self.area_vector(f).norm()).sum()
    }

    /// The smallest axis-aligned box around the triangles.
    pub fn bounds(&self) -> Aabb3 {
        let used = self.topology.vertices().map(|v| self.position(v));
        Aabb3::of(used).expect("a surface has at least one triangle")
    }

    /// `Triangulation::euler_characteristic`.
    pub fn euler_characteristic(&self) -> isize {
        self.topology.euler_characteristic()
    }

    /// `Triangulation::border_loops`.
    pub(crate) fn border_loops(&self) -> Vec<Vec<HalfEdge>> {
        self.topology.border_loops()
    }

    /// The connected parts, in the order of their first triangles.
    pub fn components(&self) -> Vec<Component> {
        let t = &self.topology;
        let (part, parts) = t.parts(|_| true);
        let component = |faces: Vec<FaceId>| {
            let euler_characteristic = faces.len().cast_signed();
            Component { faces, euler_characteristic, borders: 0 }
        };
        let mut components: Vec<Component> = parts.into_iter().map(component).collect();
        let part_of = |h: HalfEdge| part[h.face().index()] as usize;
        for v in t.vertices() {
            let start = t.start(v).expect("a vertex of a face");
            components[part_of(start)].euler_characteristic += 1;
        }
        for h in t.edges() {
            components[part_of(h)].euler_characteristic -= 1;
        }
        for curve in self.border_loops() {
            components[part_of(curve[0])].borders += 1;
        }
        components
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::Vector3;
    use crate::manifold::surface::Surface;
    use crate::mesh::Mesh;
    use crate::triangulation::VertexId;

    /// A square ring of eight triangles in the plane, and a triangle apart.
    fn ring_and_triangle() -> Surface {
        let outer = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 3.0, 0.0], [0.0, 3.0, 0.0]];
        let inner = [[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [2.0, 2.0, 0.0], [1.0, 2.0, 0.0]];
        let apart = [[9.0, 0.0, 0.0], [9.0, 2.0, 0.0], [9.0, 0.0, 2.0]];
        let ring = (0..4).flat_map(|i| {
            let j = (i + 1) % 4;
            [[i, j, 4 + j], [i, 4 + j, 4 + i]]
        });
        let triangles = ring.chain([[8, 9, 10]]).collect();
        Surface::new(&Mesh { points: [&outer[..], &inner, &apart].concat(), triangles, ..Mesh::default() }).unwrap()
    }

    #[test]
    fn components_and_borders() {
        let surface = ring_and_triangle();
        let found: Vec<_> = surface
            .components()
            .iter()
            .map(|c| (c.faces.len(), c.euler_characteristic, c.borders, c.genus()))
            .collect();
        assert_eq!(found, [(8, 0, 2, 0), (1, 1, 1, 0)]);
        assert_eq!(surface.euler_characteristic(), 1);
        let loops = surface.border_loops();
        assert_eq!(loops.iter().map(Vec::len).collect::<Vec<_>>(), [4, 4, 3]);
        for curve in loops {
            for (i, &h) in curve.iter().enumerate() {
                let next = curve[(i + 1) % curve.len()];
                assert_eq!(surface.topology().target(h), surface.topology().origin(next));
            }
        }
    }

    #[test]
    fn sizes_and_normals() {
        let surface = ring_and_triangle();
        assert!((surface.area() - 10.0).abs() < 1e-14);
        assert_eq!(surface.bounds().extent(), Vector3::new(9.0, 3.0, 2.0));
        assert_eq!(surface.vertex_normal(VertexId(1)), Some(Vector3::new(0.0, 0.0, 1.0)));
        assert_eq!(surface.vertex_normal(VertexId(9)), Some(Vector3::new(1.0, 0.0, 0.0)));
    }
}
