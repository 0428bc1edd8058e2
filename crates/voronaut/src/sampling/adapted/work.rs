//! A triangulation of a surface in the making: its vertices, and what is measured of its triangles.

use super::{Adapted, Holding, Wanted};
use crate::geometry::{BoxTree, Point3, Tensor3, Vector3};
use crate::manifold::surface::metric::SurfaceMetric;
use crate::manifold::{Manifold, Place};
use crate::parallel::prelude::*;
use crate::triangulation::{HalfEdge, Triangulation, VertexId};
use std::collections::BTreeMap;

/// A triangulation in the making.
pub(super) struct Work<'a> {
    pub(super) manifold: &'a Manifold,
    metric: &'a dyn SurfaceMetric,
    /// The root of the factor on the metric.
    root: f64,
    pub(super) topology: Triangulation,
    pub(super) vertices: Vec<Vertex>,
    /// Vertices of the surface that no triangle has.
    pub(super) unused: usize,
    /// Whether no edge is flipped.
    pub(super) keeps_edges: bool,
}

#[derive(Clone, Copy)]
pub(super) struct Vertex {
    pub(super) place: Place,
    /// What its triangles are to face.
    pub(super) facing: Vector3,
    pub(super) tensor: Tensor3,
    /// The number of the given place that it is.
    pub(super) given: Option<u32>,
    /// Whether it stays.
    pub(super) is_held: bool,
}

impl Vertex {
    /// Whether it may be contracted.
    pub(super) fn may_go(&self) -> bool {
        self.given.is_none() && !self.is_held
    }
}

impl<'a> Work<'a> {
    pub(super) fn new(manifold: &'a Manifold, metric: &'a dyn SurfaceMetric, wanted: &Wanted) -> Option<Self> {
        let topology = manifold.topology().clone();
        let nowhere = manifold.place(topology.faces().next()?, [1.0, 0.0, 0.0]);
        let slots = (0..topology.vertex_slots() as u32).map(VertexId);
        let places: Vec<Place> = slots.map(|v| manifold.place_of(v).unwrap_or(nowhere)).collect();
        let mut work = Self::of(manifold, metric, wanted.factor, topology, places);
        work.keeps_edges = matches!(wanted.held, Holding::All);
        let is_near: Box<dyn Fn(Point3) -> bool + Sync> = match wanted.held {
            Holding::Near(held) => {
                let tree = BoxTree::new(held.iter().map(|held| (held.bounds(), held)));
                Box::new(move |p| tree.meeting([p.to_array(); 2]).any(|held| held.holds(p)))
            }
            Holding::All => Box::new(|_| true),
        };
        work.vertices
            .par_iter_mut()
            .with_min_len(64)
            .for_each(|vertex| vertex.is_held = is_near(vertex.place.position));
        work.put_given(wanted.given)?;
        Some(work)
    }

    pub(super) fn of(
        manifold: &'a Manifold,
        metric: &'a dyn SurfaceMetric,
        factor: f64,
        topology: Triangulation,
        places: Vec<Place>,
    ) -> Self {
        let unused = topology.vertex_count() - topology.vertices().count();
        let mut work =
            Self { manifold, metric, root: factor.sqrt(), topology, vertices: Vec::new(), unused, keeps_edges: false };
        work.vertices = places.into_par_iter().with_min_len(64).map(|place| work.vertex(place)).collect();
        work
    }

    /// Makes the given places vertices: those at corners are some already, others cut edges, in their order along these.
    fn put_given(&mut self, given: &[Place]) -> Option<()> {
        let mut on_edges: BTreeMap<[VertexId; 2], Vec<(f64, u32)>> = BTreeMap::new();
        for (i, place) in (0..).zip(given) {
            let corners = self.topology.corners(place.face);
            if let Some(k) = (0..3).find(|&k| place.weights[k] >= 1.0) {
                let vertex = &mut self.vertices[corners[k].index()];
                if vertex.given.replace(i).is_some() {
                    return None;
                }
                continue;
            }
            let least = (0..3).min_by(|&j, &k| place.weights[j].total_cmp(&place.weights[k]))?;
            let ends = [corners[(least + 1) % 3], corners[(least + 2) % 3]];
            on_edges.entry(ends).or_default().push((place.weights[(least + 2) % 3], i));
        }
        for ([from, to], mut stations) in on_edges {
            stations.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            let mut h = self.topology.find(from, to)?;
            for (_, i) in stations {
                let vertex = Vertex { given: Some(i), ..self.vertex(given[i as usize]) };
                h = self.split(h, vertex);
            }
        }
        Some(())
    }

    pub(super) fn vertex(&self, place: Place) -> Vertex {
        let (facing, tensor) = (self.manifold.facing(&place), self.metric.at(&place));
        Vertex { place, facing, tensor, given: None, is_held: false }
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.topology.vertex_count() - self.unused
    }

    pub(super) fn at(&self, v: VertexId) -> &Vertex {
        &self.vertices[v.index()]
    }

    /// Puts a vertex on an edge; what is left of the edge behind it.
    pub(super) fn split(&mut self, h: HalfEdge, vertex: Vertex) -> HalfEdge {
        let v = self.topology.add_vertex();
        if v.index() >= self.vertices.len() {
            self.vertices.resize(v.index() + 1, vertex);
        }
        self.vertices[v.index()] = vertex;
        self.topology.split_edge(h, v)
    }

    /// The metric length of the chord between two vertices: the mean of those in the metrics at its ends.
    pub(super) fn length(&self, v: VertexId, w: VertexId) -> f64 {
        let [v, w] = [v, w].map(|v| self.at(v));
        let chord = w.place.position - v.place.position;
        0.5 * self.root * (v.tensor.length(chord) + w.tensor.length(chord))
    }

    pub(super) fn leaning(&self, corners: [VertexId; 3]) -> f64 {
        leaning(corners.map(|v| self.at(v)))
    }

    /// Quality in the mean metric of the corners: 1 of an equilateral triangle.
    pub(super) fn quality(&self, corners: [VertexId; 3]) -> f64 {
        quality(corners.map(|v| self.at(v)))
    }

    /// Area in that metric.
    fn area(&self, corners: [VertexId; 3]) -> f64 {
        let [a, b, c] = corners.map(|v| self.at(v).place.position);
        0.5 * self.root * self.root * mean(corners.map(|v| self.at(v))).area(b - a, c - a)
    }

    /// The sine of the sum of the angles that face an edge a-b from c and d, in the mean metric of the four: negative where it is
    /// not Delaunay. Lengths that know how the metric changes would not meet the triangle inequality where it changes much.
    pub(super) fn margin(&self, [a, b, c, d]: [VertexId; 4]) -> f64 {
        let tensor = mean([a, b, c, d].map(|v| self.at(v)));
        let facing = |apex: VertexId| {
            let [u, v] = [a, b].map(|end| self.at(end).place.position - self.at(apex).place.position);
            let (uu, uv, vv) = (tensor.dot(u, u), tensor.dot(u, v), tensor.dot(v, v));
            let size = (uu * vv).sqrt().max(f64::MIN_POSITIVE);
            (uv / size, (uu * vv - uv * uv).max(0.0).sqrt() / size)
        };
        let [at_c, at_d] = [c, d].map(facing);
        at_c.0 * at_d.1 + at_c.1 * at_d.0
    }

    /// How many vertices are held beyond those that the metric asks for where they are: one for two unit triangles, each of the area
    /// `sqrt(3) / 4`.
    pub(super) fn held_in_excess(&self) -> usize {
        let held = self.topology.vertices().filter(|&v| self.at(v).is_held).count();
        if held == 0 {
            return 0;
        }
        let corners = self.topology.faces().map(|f| self.topology.corners(f));
        let inside = corners.filter(|corners| corners.iter().all(|&v| self.at(v).is_held));
        let asked = 2.0 / 3.0_f64.sqrt() * inside.map(|corners| self.area(corners)).sum::<f64>();
        held.saturating_sub(asked as usize)
    }

    /// Vertices of the border that are not given.
    pub(super) fn stuck(&self) -> Vec<VertexId> {
        let is_extra = |v: &VertexId| self.topology.is_border_vertex(*v) && self.at(*v).given.is_none();
        self.topology.vertices().filter(is_extra).collect()
    }

    pub(super) fn finished(self) -> Adapted {
        let t = &self.topology;
        let ranked = |v: VertexId| {
            let vertex = self.at(v);
            (vertex.given.unwrap_or(u32::MAX), !vertex.is_held, v)
        };
        let mut order: Vec<(u32, bool, VertexId)> = t.vertices().map(ranked).collect();
        order.par_sort_unstable();
        let mut number = vec![u32::MAX; t.vertex_slots()];
        for (i, (_, _, v)) in (0..).zip(&order) {
            number[v.index()] = i;
        }
        let places: Vec<Place> = order.iter().map(|&(_, _, v)| self.at(v).place).collect();
        let staying = order.iter().filter(|(_, _, v)| !self.at(*v).may_go()).count();
        let triangles: Vec<[u32; 3]> = t.faces().map(|f| t.corners(f).map(|v| number[v.index()])).collect();
        let topology = Triangulation::from_triangles(places.len(), &triangles, &vec![0; triangles.len()]);
        Adapted { places, staying, topology, stuck: self.stuck() }
    }
}

fn mean<const N: usize>(corners: [&Vertex; N]) -> Tensor3 {
    corners.iter().fold(Tensor3::default(), |sum, corner| sum + corner.tensor) * (1.0 / N as f64)
}

/// Quality in the mean metric of the corners: 1 of an equilateral triangle.
pub(super) fn quality(corners: [&Vertex; 3]) -> f64 {
    mean(corners).shape(corners.map(|corner| corner.place.position))
}

/// A triangle is flat, and its normal rounding, if its height is so small a part of an edge.
const FLAT: f64 = 1e-9;

/// The least cosine between a triangle's normal and those of the surface at its corners; -1 without area, but for rounding.
pub(super) fn leaning(corners: [&Vertex; 3]) -> f64 {
    let [a, b, c] = corners.map(|corner| corner.place.position);
    let normal = (b - a).cross(c - a);
    let Some(normal) = normal.unit().filter(|_| normal.norm() > FLAT * Point3::longest_side([a, b, c]).powi(2)) else {
        return -1.0;
    };
    corners.iter().map(|corner| corner.facing.dot(normal)).fold(1.0, f64::min)
}
