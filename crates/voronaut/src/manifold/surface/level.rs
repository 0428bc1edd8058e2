//! A triangulation whose vertices are on a surface f = 0, in a box: how good its triangles are, how fine they should be,
//! and how points come onto it.

use super::implicit::{Pins, project_pinned, unpinned};
use super::{Implicit, Surface, curvatures};
use crate::error::Result;
use crate::geometry::{Aabb3, Point3, Vector3};
use crate::mesh::Mesh;
use crate::parallel::prelude::*;
use crate::triangulation::{HalfEdge, Triangulation, VertexId};

/// A vertex of the triangulation.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Vertex {
    pub(super) position: Point3,
    /// grad f / |grad f|.
    pub(super) normal: Vector3,
    /// The larger principal curvature, absolute.
    pub(super) curvature: f64,
    /// How long edges should be here.
    pub(super) size: f64,
    /// Of a vertex on the border: the coordinates that it has from the box.
    pub(super) pins: Pins,
}

/// A triangulation of f = 0.
pub(super) struct Level<'a> {
    pub(super) topology: Triangulation,
    pub(super) vertices: Vec<Vertex>,
    f: &'a dyn Implicit,
    bounds: Aabb3,
    tolerance: f64,
}

/// A triangle is folded where its normal makes a larger angle than 45 degrees with that of the surface at a corner: then
/// neighbours, which have two corners in common, meet at less than 90 degrees. This is the angle's cosine.
const FOLDED: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Steps along a ray, in search of where it leaves or meets the surface.
const RAY_STEPS: u32 = 16;

/// What is nearer to an end of an edge than this part of its length is not its middle.
const APART: f64 = 0.25;

/// Normals with a smaller product are so different that Newton's method might lead to another part of the surface.
const BENT: f64 = 0.85;

impl<'a> Level<'a> {
    /// Vertices on the border have those coordinates of the box that they have now; all others are free.
    pub(super) fn new(surface: &Surface, f: &'a dyn Implicit, bounds: Aabb3, tolerance: f64) -> Self {
        let topology = surface.topology().clone();
        let vertices = vec![Vertex::default(); topology.vertex_slots()];
        let mut level = Self { topology, vertices, f, bounds, tolerance };
        for v in surface.topology().vertices() {
            let position = surface.position(v);
            let pins = if level.topology.is_border_vertex(v) { level.pins(position) } else { Pins::default() };
            // Where the gradient is zero: a cone's apex.
            let normal = surface.vertex_normal(v).unwrap_or_default();
            let singular = Vertex { position, normal, curvature: f64::INFINITY, pins, ..Vertex::default() };
            level.vertices[v.index()] = level.vertex(position, pins).unwrap_or(singular);
        }
        level
    }

    fn pins(&self, p: Point3) -> Pins {
        /// Rounding, as part of the box.
        const NEAR: f64 = 1e-12;
        let [p, low, high] = [p, self.bounds.min, self.bounds.max].map(Point3::to_array);
        [0, 1, 2].map(|i| (p[i] - low[i]).min(high[i] - p[i]) <= NEAR * (high[i] - low[i]))
    }

    /// A vertex at a point of the surface; `None` where f has no gradient.
    fn vertex(&self, position: Point3, pins: Pins) -> Option<Vertex> {
        let bend = curvatures(&self.f.jet(position))?;
        Some(Vertex { position, normal: bend.normal, curvature: bend.values[0].abs(), size: f64::INFINITY, pins })
    }

    /// The vertex where Newton's method leads, not farther than `reach`, within the box.
    pub(super) fn land(&self, p: Point3, pins: Pins, reach: f64) -> Option<Vertex> {
        let q = project_pinned(self.f, p, pins, reach, self.tolerance)?;
        self.vertex(q, pins).filter(|_| self.bounds.contains(q))
    }

    /// The vertex above the middle of an edge. Where the surface bends much between the ends, that is where the ray along
    /// their mean normal meets it: from within a thin rim the gradient leads to one side, not to the rim. `None` where that
    /// leads out of the box, nowhere, or near to an end.
    pub(super) fn middle(&self, h: HalfEdge) -> Option<Vertex> {
        let [a, b] = self.ends(h);
        let is_border = self.topology.twin(h).is_none();
        let pins = if is_border { [0, 1, 2].map(|i| a.pins[i] && b.pins[i]) } else { Pins::default() };
        if is_border && pins == Pins::default() {
            return None;
        }
        self.between([a, b], pins)
    }

    /// The same of an edge at the border along an edge of the box, which the surface grazes: on the side there that the triangle has
    /// not, or else on the other.
    pub(super) fn middle_beside(&self, h: HalfEdge) -> Option<Vertex> {
        let [a, b] = self.ends(h);
        let sides = (0..3).filter(|&i| self.topology.twin(h).is_none() && a.pins[i] && b.pins[i]);
        let apex = self.vertices[self.topology.apex(h).index()].pins;
        let (kept, free): (Vec<usize>, Vec<usize>) = sides.partition(|&i| apex[i]);
        free.into_iter().chain(kept).find_map(|i| self.between([a, b], [0, 1, 2].map(|j| i == j)))
    }

    /// The point of the surface in the middle of two, with some coordinates pinned.
    fn between(&self, [a, b]: [&Vertex; 2], pins: Pins) -> Option<Vertex> {
        let (middle, length) = (a.position.lerp(b.position, 0.5), a.position.distance(b.position));
        let met = (a.normal.dot(b.normal) < BENT)
            .then(|| unpinned(a.normal + b.normal, pins).unit())
            .flatten()
            .and_then(|along| self.ray(middle, along * length));
        let landed = self.land(met.unwrap_or(middle), pins, 0.5 * length)?;
        let apart = [a, b].iter().all(|end| end.position.distance(landed.position) >= APART * length);
        apart.then_some(Vertex { size: f64::midpoint(a.size, b.size), ..landed })
    }

    /// Where the ray from a point changes sides first, about: forwards from where f < 0, else backwards.
    fn ray(&self, from: Point3, along: Vector3) -> Option<Point3> {
        let inner = self.f.value(from) < 0.0;
        let at = |t: f64| from + along * if inner { t } else { -t };
        let step = 1.0 / f64::from(RAY_STEPS);
        let beyond = |t: f64| (self.f.value(at(t)) < 0.0) != inner;
        let mut high = (1..=RAY_STEPS).map(|i| step * f64::from(i)).find(|&t| beyond(t))?;
        let mut low = high - step;
        for _ in 0..12 {
            let t = f64::midpoint(low, high);
            *(if beyond(t) { &mut high } else { &mut low }) = t;
        }
        Some(at(high))
    }

    /// Lets all vertices be as near to the surface as `tolerance`, but those where Newton's method fails.
    pub(super) fn settle(&mut self, tolerance: f64) {
        let (f, reach) = (self.f, 100.0 * self.tolerance);
        self.vertices.par_iter_mut().for_each(|vertex| {
            let landed = project_pinned(f, vertex.position, vertex.pins, reach, tolerance);
            vertex.position = landed.unwrap_or(vertex.position);
        });
    }

    pub(super) fn ends(&self, h: HalfEdge) -> [&Vertex; 2] {
        [self.topology.origin(h), self.topology.target(h)].map(|v| &self.vertices[v.index()])
    }

    pub(super) fn length(&self, h: HalfEdge) -> f64 {
        let [a, b] = self.ends(h);
        a.position.distance(b.position)
    }

    /// The quality of the triangle left of a half-edge, some of whose corners may be others than they are.
    pub(super) fn quality<'b>(&'b self, h: HalfEdge, at: impl Fn(VertexId) -> Option<&'b Vertex>) -> f64 {
        let t = &self.topology;
        quality([t.origin(h), t.target(h), t.apex(h)].map(|v| at(v).unwrap_or(&self.vertices[v.index()])))
    }

    /// The triangles as a surface.
    pub(super) fn to_surface(&self) -> Result<Surface> {
        let t = &self.topology;
        let mut number = vec![0; t.vertex_slots()];
        for (new, v) in t.vertices().enumerate() {
            number[v.index()] = new as u32;
        }
        Surface::new(&Mesh {
            points: t.vertices().map(|v| self.vertices[v.index()].position.to_array()).collect(),
            triangles: t.faces().map(|f| t.corners(f).map(|v| number[v.index()])).collect(),
            triangle_labels: vec![1; t.face_count()],
            ..Mesh::default()
        })
    }
}

/// 1 of an equilateral triangle, nearly 0 of a needle (4 sqrt(3) area / sum of squared edges), and negative of a folded one,
/// the more the more it is folded.
pub(super) fn quality([a, b, c]: [&Vertex; 3]) -> f64 {
    let [u, v, w] = [b.position - a.position, c.position - b.position, a.position - c.position];
    let normal = u.cross(v);
    let double_area = normal.norm();
    if double_area <= 0.0 {
        return -2.0;
    }
    let cosine = [a, b, c].iter().map(|corner| corner.normal.dot(normal)).fold(f64::INFINITY, f64::min) / double_area;
    let shape = 2.0 * 3.0_f64.sqrt() * double_area / (u.dot(u) + v.dot(v) + w.dot(w));
    if cosine < FOLDED { cosine - 1.0 } else { shape }
}
