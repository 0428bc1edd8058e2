//! How the tangent planes at the vertices of a surface hang together.

use crate::geometry::{Point3, TangentPlane, Tensor, Vector};
use crate::metric::Neighbours;
use crate::metric::nodal::Connection;
use crate::surface::Surface;
use crate::triangulation::VertexId;
use std::collections::{BTreeMap, HashMap};

/// The edges of a surface, over cuts as if there were none. Tensors are transported by the smallest rotation that takes one
/// normal to the other.
pub(super) struct SurfaceConnection<'a> {
    surface: &'a Surface,
    planes: &'a [TangentPlane],
    around: Neighbours,
}

impl<'a> SurfaceConnection<'a> {
    /// Of a surface with a plane for each vertex slot.
    pub(super) fn of(surface: &'a Surface, planes: &'a [TangentPlane]) -> Self {
        let t = surface.topology();
        let triangles = t.faces().map(|f| t.corners(f).map(|v| v.0));
        let around = Neighbours::of_triangles(planes.len(), triangles, Copies::of(surface).pairs(surface));
        Self { surface, planes, around }
    }

    fn position(&self, v: u32) -> Point3 {
        self.surface.position(VertexId(v))
    }
}

impl Connection for SurfaceConnection<'_> {
    fn around(&self) -> &Neighbours {
        &self.around
    }

    fn offset(&self, v: u32, w: u32) -> Vector {
        let way = self.position(w) - self.position(v);
        let flat = self.planes[v as usize].flatten(way);
        // An edge along the normal has no direction there, but a length.
        let [length, seen] = [way.norm(), flat.norm()];
        if seen > f64::EPSILON * length { flat * (length / seen) } else { Vector::new(length, 0.0) }
    }

    fn transported(&self, v: u32, w: u32, tensor: Tensor) -> Tensor {
        let [from, to] = [v, w].map(|v| &self.planes[v as usize]);
        // Opposite normals, as in a fold, know no smallest rotation.
        if 1.0 + from.normal.dot(to.normal) < f64::EPSILON.sqrt() {
            return tensor;
        }
        let turned = from.turned(to.normal);
        let [u, v] = [to.u, to.v].map(|axis| turned.flatten(axis));
        Tensor::new(tensor.dot(u, u), tensor.dot(u, v), tensor.dot(v, v))
    }
}

/// Vertices at equal positions, as they are where a surface was cut.
struct Copies {
    groups: Vec<Vec<u32>>,
    /// Of a vertex with copies.
    group: HashMap<u32, usize>,
}

impl Copies {
    fn of(surface: &Surface) -> Self {
        let t = surface.topology();
        let mut at: BTreeMap<[u64; 3], Vec<u32>> = BTreeMap::new();
        // Only what is cut has copies, and a cut is a border.
        for v in t.vertices().filter(|&v| t.is_border_vertex(v)) {
            // Adding 0 makes one zero of both.
            let key = surface.position(v).to_array().map(|x| (x + 0.0).to_bits());
            at.entry(key).or_default().push(v.0);
        }
        let groups: Vec<Vec<u32>> = at.into_values().filter(|group| group.len() > 1).collect();
        let group = groups.iter().enumerate().flat_map(|(i, all)| all.iter().map(move |&v| (v, i))).collect();
        Self { groups, group }
    }

    /// A vertex and its copies.
    fn all<'b>(&'b self, v: &'b u32) -> &'b [u32] {
        self.group.get(v).map_or(std::slice::from_ref(v), |&i| &self.groups[i])
    }

    /// Pairs of copies, and what the two ends of an edge are to each other, all copies of theirs are.
    fn pairs(&self, surface: &Surface) -> Vec<[u32; 2]> {
        let product = |a: &[u32], b: &[u32]| a.iter().flat_map(|&x| b.iter().map(move |&y| [x, y])).collect::<Vec<_>>();
        let t = surface.topology();
        let edges = t.edges().map(|h| [t.origin(h).0, t.target(h).0]);
        let cut = edges.filter(|ends| ends.iter().any(|v| self.group.contains_key(v)));
        let copies = self.groups.iter().flat_map(|group| product(group, group)).filter(|[x, y]| x < y);
        cut.flat_map(|[a, b]| product(self.all(&a), self.all(&b))).chain(copies).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector3;
    use crate::mesh::Mesh;
    use crate::metric::nodal::{Gradation, Limits};
    use crate::surface::torus;
    use crate::test_cases::cases;
    use proptest::prelude::*;

    /// The torus, its triangles apart but for their positions.
    fn soup(surface: &Surface) -> Surface {
        let mesh = surface.to_mesh();
        let points = mesh.triangles.iter().flatten().map(|&v| mesh.points[v as usize]).collect();
        let triangles = (0..mesh.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Surface::new(&Mesh { points, triangles, ..Mesh::default() }).unwrap()
    }

    /// Of a torus of radii 2 and 0.7.
    fn plane(p: Point3) -> TangentPlane {
        let r = p.x.hypot(p.y);
        TangentPlane::new((p - Point3::new(2.0 * p.x / r, 2.0 * p.y / r, 0.0)) * (1.0 / 0.7))
    }

    fn graded(surface: &Surface, given: &[Tensor], factor: f64) -> Vec<Tensor> {
        let planes: Vec<TangentPlane> = surface.positions().iter().map(|&p| plane(p)).collect();
        let mut tensors = given.to_vec();
        let gradation = Gradation::new(SurfaceConnection::of(surface, &planes), factor).unwrap();
        gradation.apply(&mut tensors, &Limits::default()).unwrap();
        tensors
    }

    fn size(tensor: Tensor) -> f64 {
        1.0 / tensor.xx.sqrt()
    }

    proptest! {
        #![proptest_config(cases(24))]
        #[test]
        fn sizes_obey_the_law_and_no_more(seed in 0..1_000_000_u32, hgrad in 1.0..3.0_f64, spread in 0.1..6.0_f64) {
            let surface = torus(2.0, 0.7, 0.4).unwrap();
            let noise = |i: usize| ((i as f64 + f64::from(seed)) * 12.9898).sin() * spread;
            let given: Vec<f64> = (0..surface.positions().len()).map(|i| noise(i).exp()).collect();
            let tensors: Vec<Tensor> = given.iter().map(|&h| Tensor::isotropic(h)).collect();
            let sizes: Vec<f64> = graded(&surface, &tensors, hgrad).into_iter().map(size).collect();
            let t = surface.topology();
            for v in t.vertices() {
                let (size, given) = (sizes[v.index()], given[v.index()]);
                // The most that any neighbour allows.
                let reach = |w: VertexId| sizes[w.index()] + hgrad.ln() * surface.position(v).distance(surface.position(w));
                let around = t.star(v).flat_map(|h| [t.target(h), t.apex(h)]);
                let most = around.map(reach).fold(f64::INFINITY, f64::min);
                prop_assert!(size <= most * (1.0 + 1e-5), "{} over {}", size, most);
                prop_assert!((size - given.min(most)).abs() <= 1e-5 * size, "{}, not {} or {}", size, given, most);
            }
        }
    }

    #[test]
    fn a_cut_surface_is_graded_as_the_whole() {
        let surface = torus(2.0, 0.7, 0.4).unwrap();
        let of = |surface: &Surface| {
            let thin = |p: &Point3| {
                if p.x > 2.6 {
                    plane(*p).restrict(crate::geometry::Tensor3::square(Vector3::new(0.0, 99.0, 9.0)))
                } else {
                    Tensor::default()
                }
            };
            let given: Vec<Tensor> = surface.positions().iter().map(|p| thin(p) + Tensor::isotropic(5.0)).collect();
            graded(surface, &given, 1.3)
        };
        let (whole, apart) = (of(&surface), of(&soup(&surface)));
        for (i, &v) in surface.to_mesh().triangles.iter().flatten().enumerate() {
            let (one, other) = (apart[i], whole[v as usize]);
            assert!((one.determinant() / other.determinant() - 1.0).abs() < 1e-6, "{one:?} {other:?}");
        }
        assert!(whole.iter().any(|m| m.anisotropy() > 5.0) && whole.iter().all(|m| m.eigen().small > 1.0 / 25.0));
    }

    /// What is transported keeps its sizes, and turns as little as the surface does.
    #[test]
    fn tensors_turn_with_the_surface() {
        let surface = torus(2.0, 0.7, 0.2).unwrap();
        let planes: Vec<TangentPlane> = surface.positions().iter().map(|&p| plane(p)).collect();
        let connection = SurfaceConnection::of(&surface, &planes);
        let ring = |v: u32| {
            let p = connection.position(v);
            let along = planes[v as usize].flatten(Vector3::new(-p.y, p.x, 0.0));
            Tensor::from_axis(along * (1.0 / along.norm()), 100.0, 1.0)
        };
        for v in 0..planes.len() as u32 {
            for &w in connection.around().at(v as usize) {
                let (found, truth) = (connection.transported(v, w, ring(v)), ring(w));
                let (found, expected) = (found.eigen(), truth.eigen());
                assert!((found.large / 100.0 - 1.0).abs() < 1e-12 && (found.small - 1.0).abs() < 1e-9);
                // Rings are no geodesics: they turn by the length of the edge over their distance from the axis, at most.
                let turn = found.axis.cross(expected.axis).abs() / (found.axis.norm() * expected.axis.norm());
                let edge = connection.position(v).distance(connection.position(w));
                assert!(turn <= edge / 1.3, "{turn} over {edge}");
                assert!((connection.offset(v, w).norm() / edge - 1.0).abs() < 1e-12);
            }
        }
    }
}
