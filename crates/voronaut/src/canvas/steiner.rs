//! Points put into an embedded triangulation by Delaunay refinement, with care for what is fixed (Ruppert 1995): a point
//! that would lie in the diametral circle of a fixed edge, or beyond it, is not inserted; the edge is halved instead.

use super::flip::{FROZEN_LIMIT, Frozen};
use crate::error::Result;
use crate::geometry::{Point, Tensor};
use crate::lists::distinct;
use crate::metric::{MetricField, Near, check_tensor};
use crate::parallel::prelude::*;
use crate::planar::{Location, Planar};
use crate::triangulation::{FaceId, HalfEdge, Lawson, VertexId};

/// Fixed edges shorter than this share of the circle that asks for it are not halved: under a small angle between
/// two of them halving would go on for long.
const SHORTEST: f64 = 0.05;

/// What became of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Placed {
    /// It is this vertex.
    Inserted(VertexId),
    /// It was not inserted: a fixed edge was halved, at this vertex.
    Halved(VertexId),
    /// Rounding leaves no room, or the fixed edge in its way is too short.
    Refused,
}

/// A triangulation under refinement: Delaunay in the Euclidean plane, or about so in a metric.
pub(super) struct Steiner<'a> {
    pub(super) planar: Planar,
    /// The metric by which edges flip and circles are measured; `None` for the Euclidean plane.
    field: Option<&'a dyn MetricField>,
    /// One per vertex slot, where there is a metric.
    pub(super) tensors: Vec<Tensor>,
    /// Where the metric found each of them.
    pub(super) nears: Vec<Near>,
    lawson: Lawson,
    /// Faces that are new, in the Euclidean plane.
    changed: Vec<FaceId>,
}

impl<'a> Steiner<'a> {
    /// In the Euclidean plane, from a constrained Delaunay triangulation.
    pub(super) fn euclidean(planar: Planar) -> Self {
        let (tensors, nears) = (Vec::new(), Vec::new());
        Self { planar, field: None, tensors, nears, lawson: Lawson::default(), changed: Vec::new() }
    }

    /// In a metric, from any triangulation.
    ///
    /// # Errors
    /// The metric is not positive definite at a vertex.
    pub(super) fn metric(planar: Planar, field: &'a dyn MetricField) -> Result<Self> {
        let positions = planar.positions.par_iter().with_min_len(1024);
        let found = positions.map(|&p| {
            let mut near = Near::default();
            (field.at_near(p, &mut near), near)
        });
        let (tensors, nears): (Vec<Tensor>, Vec<Near>) = found.collect::<Vec<_>>().into_iter().unzip();
        for v in planar.topology.vertices() {
            check_tensor(tensors[v.index()], planar.position(v))?;
        }
        Ok(Self { field: Some(field), tensors, nears, ..Self::euclidean(planar) })
    }

    /// Inserts a point that is seen from a face, unless it encroaches a fixed edge: then that is halved. `radius` is that
    /// of the circle (in the metric) whose centre the point is, or near to which it is.
    ///
    /// # Errors
    /// The metric is not positive definite at the new vertex.
    pub(super) fn place(&mut self, from: FaceId, p: Point, radius: f64) -> Result<Placed> {
        let placed = match self.planar.walk(from, p, true) {
            Location::Behind(h) => return self.halve(h, radius),
            Location::Vertex(_) => return Ok(Placed::Refused),
            Location::Edge(h) if self.planar.topology.is_fixed(h) => return self.halve(h, radius),
            Location::Edge(h) => self.planar.insert_on_edge(h, p),
            Location::Face(f) => self.planar.insert_in_face(f, p),
        };
        let Some(v) = placed else { return Ok(Placed::Refused) };
        self.added(v, None)?;
        let encroached = self.planar.topology.star(v).map(HalfEdge::next).find(|&h| self.is_encroached(h, p, radius));
        let Some(h) = encroached else { return Ok(Placed::Inserted(v)) };
        let [a, b] = self.planar.topology.ends(h);
        if !self.take_out(v) {
            return Ok(Placed::Inserted(v));
        }
        match self.planar.topology.edge_between(a, b) {
            Some(h) => self.halve(h, radius),
            None => Ok(Placed::Refused),
        }
    }

    /// The faces that are new since this was asked last, and those around the last new vertex.
    pub(super) fn take_changed(&mut self) -> Vec<FaceId> {
        let topology = &self.planar.topology;
        distinct(std::mem::take(&mut self.changed).into_iter().filter(|&f| topology.is_face(f)))
    }

    fn tensor_at(&self, p: Point) -> Tensor {
        self.field.map_or(Tensor::isotropic(1.0), |field| field.at(p))
    }

    /// Whether a point sees a fixed edge, long enough to be halved, under an obtuse angle.
    fn is_encroached(&self, h: HalfEdge, p: Point, radius: f64) -> bool {
        if !self.planar.topology.is_fixed(h) {
            return false;
        }
        let [a, b] = self.planar.ends(h);
        let tensor = self.tensor_at(p);
        tensor.dot(a - p, b - p) < 0.0 && tensor.length(b - a) > SHORTEST * radius
    }

    /// Halves a fixed edge.
    pub(super) fn halve(&mut self, h: HalfEdge, radius: f64) -> Result<Placed> {
        let [a, b] = self.planar.ends(h);
        let middle = a.midpoint(b);
        if self.tensor_at(middle).length(b - a) <= SHORTEST * radius {
            return Ok(Placed::Refused);
        }
        let Some(v) = self.planar.insert_on_edge(h, middle) else { return Ok(Placed::Refused) };
        self.added(v, None)?;
        Ok(Placed::Halved(v))
    }

    /// Flips around a vertex that was just inserted, in a metric only edges opposite to `around`, if there is one. In a metric it
    /// says how many.
    ///
    /// # Errors
    /// The metric is not positive definite at the vertex.
    pub(super) fn added(&mut self, v: VertexId, around: Option<VertexId>) -> Result<u64> {
        if let Some(field) = self.field {
            let p = self.planar.position(v);
            // A neighbour tells where to look, of a vertex that is new itself.
            let mut beside = self.planar.topology.star(v).map(|h| self.planar.topology.target(h).index());
            let mut near = beside.next().and_then(|u| self.nears.get(u).copied()).unwrap_or_default();
            let tensor = field.at_near(p, &mut near);
            check_tensor(tensor, p)?;
            self.tensors.resize(self.planar.positions.len(), tensor);
            self.nears.resize(self.planar.positions.len(), near);
            (self.tensors[v.index()], self.nears[v.index()]) = (tensor, near);
        }
        self.lawson.queue(self.planar.topology.star(v).map(HalfEdge::next));
        let flips = self.flip(around);
        if self.field.is_none() {
            self.changed.extend(self.planar.topology.star(v).map(HalfEdge::face));
        }
        Ok(flips)
    }

    /// Flips every edge that the test wants flipped.
    pub(super) fn flip_all(&mut self) {
        self.lawson.queue(self.planar.topology.edges());
        self.flip(None);
    }

    fn flip(&mut self, around: Option<VertexId>) -> u64 {
        let Self { planar, tensors, lawson, .. } = self;
        if self.field.is_none() {
            planar.legalise(lawson);
            return 0;
        }
        lawson.pass(&mut Frozen { planar, tensors, around }, FROZEN_LIMIT).len() as u64
    }

    /// Moves a vertex, without flips; says whether it could.
    ///
    /// # Errors
    /// The metric is not positive definite at the new place.
    pub(super) fn shift(&mut self, v: VertexId, to: Point) -> Result<bool> {
        let is_moved = self.planar.move_vertex(v, to);
        if let Some(field) = self.field.filter(|_| is_moved) {
            self.tensors[v.index()] = field.at(to);
            check_tensor(self.tensors[v.index()], to)?;
        }
        Ok(is_moved)
    }

    /// Puts a vertex where it was, with the metric that is known there.
    pub(super) fn put(&mut self, v: VertexId, at: Point, tensor: Tensor) {
        self.planar.positions[v.index()] = at;
        self.tensors[v.index()] = tensor;
    }

    /// Removes a vertex that was just inserted, and flips as before; says whether it could.
    pub(super) fn take_out(&mut self, v: VertexId) -> bool {
        let topology = &self.planar.topology;
        let link: Vec<[VertexId; 2]> = topology.star(v).map(HalfEdge::next).map(|h| topology.ends(h)).collect();
        if !self.planar.remove_vertex(v) {
            return false;
        }
        let inside: Vec<HalfEdge> = link.iter().filter_map(|&[a, b]| self.planar.topology.find(a, b)).collect();
        self.lawson.queue(inside.iter().flat_map(|h| h.face().half_edges()));
        self.flip(None);
        for [a, b] in link {
            self.changed.extend(self.planar.topology.find(a, b).map(HalfEdge::face));
        }
        true
    }
}
