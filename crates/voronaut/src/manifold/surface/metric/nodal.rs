//! Metrics at vertices on a surface, each seen in the tangent plane there: what [`crate::metric::nodal`] does in the plane is done to these.

use crate::error::{Error, Result};
use crate::geometry::{Point, Point3, Seen, TangentPlane, Tensor, Tensor3, Vector, Vector3};
use crate::manifold::surface::Surface;
use crate::manifold::{Manifold, Place};
use crate::mesh::coincident;
use crate::metric::nodal::{Gradation, Vertices, implied_by};
use crate::metric::{Neighbours, check_tensor3};
use crate::triangulation::VertexId;
use std::collections::BTreeMap;

/// Normals whose cosine is this near to -1 are opposite.
const OPPOSITE: f64 = 1e-9;

/// Vertices on a surface, which may have been cut: then those at creases have copies, one for each side.
pub(crate) struct TangentPlanes {
    positions: Vec<Point3>,
    planes: Vec<TangentPlane>,
    triangles: Vec<[u32; 3]>,
    /// Pairs of vertices that are one.
    copies: Vec<[u32; 2]>,
    /// Whether these are to have one tensor of space.
    is_joined: bool,
}

impl TangentPlanes {
    pub(crate) fn new(
        positions: Vec<Point3>,
        planes: Vec<TangentPlane>,
        triangles: Vec<[u32; 3]>,
        copies: Vec<[u32; 2]>,
    ) -> Self {
        Self { positions, planes, triangles, copies, is_joined: false }
    }

    /// Of a surface that was cut, as they will be in a file for the surface before.
    pub(crate) fn to_join(manifold: &Manifold) -> Self {
        let before = (0..manifold.seams().vertices_before() as u32).map(VertexId);
        let with_first = |v: VertexId| manifold.seams().copies(v)[1..].iter().map(move |w| [v.0, w.0]);
        Self { copies: before.flat_map(with_first).collect(), is_joined: true, ..Self::of(&manifold.surface) }
    }

    /// Of a surface as it is; vertices at equal positions, as they are where it was cut, are one.
    pub(crate) fn of(surface: &Surface) -> Self {
        let t = surface.topology();
        // Only what is cut has copies, and a cut is a border.
        let border = t.vertices().filter(|&v| t.is_border_vertex(v)).map(|v| (v.0, surface.position(v)));
        let up = Vector3::new(0.0, 0.0, 1.0);
        let plane = |v: u32| TangentPlane::new(surface.vertex_normal(VertexId(v)).unwrap_or(up));
        Self::new(
            surface.positions().to_vec(),
            (0..t.vertex_slots() as u32).map(plane).collect(),
            t.faces().map(|f| t.corners(f).map(|v| v.0)).collect(),
            coincident(border),
        )
    }

    /// The place of a vertex, with the normal of its plane; nothing of one without triangles.
    pub(crate) fn place(&self, manifold: &Manifold, v: u32) -> Option<Place> {
        Some(Place { normal: self.planes[v as usize].normal, ..manifold.place_of(VertexId(v))? })
    }

    /// Which vertices share a triangle or are one.
    pub(crate) fn around(&self) -> Neighbours {
        Neighbours::of_triangles(self.planes.len(), self.triangles.iter().copied(), self.copies.iter().copied())
    }

    /// What tensors of space say of tangents.
    pub(crate) fn seen(&self, tensors: &[Tensor3]) -> Vec<Tensor> {
        tensors.iter().zip(&self.planes).map(|(&m, plane)| plane.restrict(m)).collect()
    }

    /// Tensors of space that say this of tangents; of the normal the larger eigenvalue.
    pub(crate) fn extended(&self, tensors: &[Tensor]) -> Vec<Tensor3> {
        tensors.iter().zip(&self.planes).map(|(&m, plane)| plane.extend(m, m.eigen().large)).collect()
    }

    /// The metric that the triangles imply, as [`crate::metric::nodal::implied`] has it of the plane.
    ///
    /// # Errors
    /// [`Error::Mesh`] of a triangle without area.
    pub(crate) fn implied(&self) -> Result<Vec<Tensor>> {
        let corners = |i: usize| self.triangles[i].map(|v| self.positions[v as usize]);
        let plane = |i: usize| {
            let [a, b, c] = corners(i);
            let help = "remove triangles without area: voronaut check names them";
            let normal = (b - a).cross(c - a).unit();
            let place = || format!("triangle {} at {a}", i + 1);
            Ok(TangentPlane::new(normal.ok_or_else(|| Error::mesh("a triangle has no area", place(), help))?))
        };
        let planes = (0..self.triangles.len()).map(plane).collect::<Result<Vec<TangentPlane>>>()?;
        let laid_out = |i: usize| {
            let [a, ..] = corners(i);
            (self.triangles[i], corners(i).map(|p| Point::default() + planes[i].flatten(p - a)))
        };
        let seen = |i: usize, v: u32, tensor: Tensor| {
            let in_space = planes[i].extend(tensor, tensor.eigen().large);
            Seen { tensor: in_space, normal: planes[i].normal }.in_plane(&self.planes[v as usize])
        };
        implied_by(self.planes.len(), (0..planes.len()).map(laid_out), seen)
    }

    /// The tensors of space of vertices that are one, as fine in each of their planes as that asks for: no finer where planes meet at right
    /// angles and axes lie along the crease.
    pub(crate) fn joined(&self, tensors: &[Tensor]) -> Vec<Tensor3> {
        let mut all = self.extended(tensors);
        // Of the normal as little as any side asks for: others have it for a tangent.
        let mut least: BTreeMap<u32, f64> = BTreeMap::new();
        for &[v, w] in &self.copies {
            let small = [v, w].map(|v| tensors[v as usize].eigen().small);
            let least = least.entry(v).or_insert(f64::INFINITY);
            *least = small.into_iter().fold(*least, f64::min);
        }
        for &[v, w] in &self.copies {
            for side in [v, w] {
                all[side as usize] = self.planes[side as usize].extend(tensors[side as usize], least[&v]);
            }
        }
        for &[v, w] in &self.copies {
            all[v as usize] = all[v as usize].intersection(all[w as usize]);
        }
        for &[v, w] in &self.copies {
            all[w as usize] = all[v as usize];
        }
        all
    }

    /// The way from a vertex to a neighbour in the plane of the latter, as long as it is, for it goes along the surface.
    fn offset(&self, v: u32, w: u32) -> Vector {
        let way = self.positions[w as usize] - self.positions[v as usize];
        let flat = self.planes[w as usize].flatten(way);
        if flat.norm() > 0.0 { flat * (way.norm() / flat.norm()) } else { Vector::new(way.norm(), 0.0) }
    }

    /// The x axis of a vertex's plane in that of a neighbour, to which the smallest rotation takes it.
    fn turn(&self, v: u32, w: u32) -> Vector {
        let [from, to] = [v, w].map(|v| &self.planes[v as usize]);
        // Opposite sides, as of the edge of a sheet, have no smallest rotation.
        let is_opposite = from.normal.dot(to.normal) < -1.0 + OPPOSITE;
        let x = if is_opposite { from.u } else { from.turned(to.normal).u };
        let x = to.flatten(x);
        if x.norm() > 0.0 { x * (1.0 / x.norm()) } else { Vector::new(1.0, 0.0) }
    }
}

impl Vertices for TangentPlanes {
    fn count(&self) -> usize {
        self.planes.len()
    }

    fn triangles(&self) -> impl Iterator<Item = ([u32; 3], f64)> {
        let with_area = |&t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| self.positions[v as usize]);
            (t, (b - a).cross(c - a).norm())
        };
        self.triangles.iter().map(with_area)
    }

    fn gradation(&self, factor: f64) -> Result<Gradation<'_>> {
        Gradation::between_planes(self.around(), |v, w| self.offset(v, w), |v, w| self.turn(v, w), factor)
    }

    fn check(&self, tensors: &[Tensor]) -> Result<()> {
        let named = |(v, m): (usize, Tensor3)| check_tensor3(m, || format!("vertex {} {}", v + 1, self.positions[v]));
        self.extended(tensors).into_iter().enumerate().try_for_each(named)
    }

    fn join(&self, mut tensors: Vec<Tensor>) -> Vec<Tensor> {
        if self.is_joined {
            let joined = self.joined(&tensors);
            for &v in self.copies.iter().flatten() {
                tensors[v as usize] = self.planes[v as usize].restrict(joined[v as usize]);
            }
        }
        tensors
    }
}
