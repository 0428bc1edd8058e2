//! Seeds come, go and move, edges are flipped (Lawson) by the metric in-circle test, and the mesh leaves the program. Each verb says whether
//! it was done; what would not be embedded is not done.

use super::{Dual, Effort, Kind, LIMIT, Moving, POOR, TIE};
use crate::geodesic::Margin;
use crate::geometry::{Point, Tensor, Vector};
use crate::lists::in_order;
use crate::parallel::prelude::*;
use crate::planar::Planar;
use crate::triangulation::{Constraint, FaceId, Flipping, HalfEdge, Triangulation, VertexId};

impl Dual<'_> {
    /// Puts a free seed strictly inside a face.
    pub(crate) fn insert_in_face(&mut self, f: FaceId, p: Point) -> Option<VertexId> {
        let v = self.planar.insert_in_face(f, p)?;
        self.settle(v, Kind::Free);
        Some(v)
    }

    /// Puts a seed on an edge: a curve's if the edge is constrained, else a free one. The edge of a required segment stays whole.
    pub(crate) fn insert_on_edge(&mut self, h: HalfEdge, p: Point) -> Option<VertexId> {
        if self.planar.topology.constraint(h).is_some_and(|c| self.required[c.0 as usize]) {
            return None;
        }
        let kind = if self.planar.topology.is_fixed(h) { Kind::Curve } else { Kind::Free };
        let v = self.planar.insert_on_edge(h, p)?;
        self.settle(v, kind);
        Some(v)
    }

    /// Leaves a segment and the vertices on it as they are from now on.
    pub(crate) fn hold(&mut self, segment: Constraint, vertices: &[VertexId]) {
        self.required[segment.0 as usize] = true;
        for v in vertices {
            self.kinds[v.index()] = Kind::Held;
        }
    }

    /// Takes over a triangulation of the same vertices and constraints that was changed by other rules than the metric's.
    pub(crate) fn take_over(&mut self, planar: Planar) {
        self.planar = planar;
        self.touched.clear();
        self.measure_all();
    }

    /// Where a curve's seed comes to lie that is moved by a vector: on the segment, and, for its two edges there, only as far as
    /// they stay within `lengths` (metric), or get no farther out; half of that, for neighbours may slide as well.
    pub(crate) fn slid(&self, v: VertexId, by: Vector, lengths: [f64; 2]) -> Point {
        let from = self.position(v);
        let Some([a, b]) = self.planar.neighbours_on_segment(v) else { return from };
        let tensor = self.local(v).tensor;
        let (whole, behind) = (tensor.length(b - a), tensor.length(from - a));
        let ahead = whole - behind;
        let [least, most] = lengths;
        let step = by.dot(b - a) / (b - a).dot(b - a) * whole;
        let room = |shrinks: f64, grows: f64| (0.5 * (shrinks - least).min(most - grows)).max(0.0);
        let step = step.clamp(-room(behind, ahead), room(ahead, behind));
        a.lerp(b, (behind + step) / whole)
    }

    /// Moves a seed if all its faces stay counter-clockwise; what the metric is there its derivatives tell, until the caller measures it.
    pub(crate) fn shift(&mut self, v: VertexId, to: Point) -> bool {
        debug_assert!(!matches!(self.kind(v), Kind::Corner(_) | Kind::Held), "corners stay");
        self.forget();
        let by = to - self.position(v);
        let is_moved = self.planar.move_vertex(v, to);
        if is_moved {
            self.locals[v.index()] = self.locals[v.index()].carried(by);
        }
        is_moved
    }

    /// Moves a free seed if all its faces stay counter-clockwise, measures the metric there, and flips around it.
    pub(crate) fn relocate(&mut self, v: VertexId, to: Point) -> bool {
        if !self.shift(v, to) {
            return false;
        }
        self.settle_move(v);
        true
    }

    /// Removes a free seed.
    pub(crate) fn remove(&mut self, v: VertexId) -> bool {
        if self.kind(v) != Kind::Free {
            return false;
        }
        let topology = &self.planar.topology;
        let link: Vec<VertexId> = topology.star(v).map(|h| topology.target(h)).collect();
        let removed = self.planar.remove_vertex(v);
        self.forget();
        for &u in &link {
            self.flip_around(u, Effort::Local);
        }
        for u in link {
            self.touched.extend(self.planar.topology.star(u).map(HalfEdge::face));
        }
        removed
    }

    fn settle(&mut self, v: VertexId, kind: Kind) {
        let local = self.measure(v);
        let slots = self.planar.topology.vertex_slots();
        self.locals.resize(slots, local);
        self.kinds.resize(slots, kind);
        self.locals[v.index()] = local;
        self.kinds[v.index()] = kind;
        self.touched.extend(self.planar.topology.star(v).map(HalfEdge::face));
        self.flip_around(v, Effort::Local);
    }

    /// The point of the domain's graph that a vertex is.
    pub(crate) fn corner(&self, v: VertexId) -> Option<u32> {
        if let Kind::Corner(point) = self.kind(v) { Some(point) } else { None }
    }

    /// Flips every edge that the metric wants flipped and the plane allows. Returns the number of flips.
    pub(crate) fn flip_all(&mut self, effort: Effort) -> u64 {
        let before = self.counters.flips;
        if effort == Effort::Full {
            // Cheap flips first: few margins are then left to be measured one by one.
            self.flip_all(Effort::Chord);
            self.measure_margins();
        }
        let wanted = if effort == Effort::Full { self.wanted_fully() } else { self.wanted(effort) };
        self.lawson.queue(wanted);
        self.flip_queued(effort);
        self.counters.flips - before
    }

    /// Flips around a vertex and onwards.
    pub(super) fn flip_around(&mut self, v: VertexId, effort: Effort) {
        self.lawson.queue(self.planar.topology.star(v).flat_map(|h| [h, h.next()]));
        self.flip_queued(effort);
    }

    /// Edges that the metric wants flipped and the plane forbids, with their margins, certain or not.
    pub(crate) fn blocked_flips(&mut self, effort: Effort) -> Vec<(HalfEdge, Margin)> {
        let edges = self.free_edges();
        let forbidden = edges.into_par_iter().with_min_len(1024).filter(|&h| !self.allows_flip(h));
        let forbidden: Vec<HalfEdge> = forbidden.collect();
        let mut wanted = Vec::new();
        self.each_margin(&forbidden, effort, |h, margin| wanted.extend((margin.value < -TIE).then_some((h, margin))));
        wanted
    }

    /// The smallest margin among all edges that are not constrained; `None` of none.
    pub(crate) fn smallest_margin(&mut self, effort: Effort) -> Option<f64> {
        let edges = self.free_edges();
        let mut smallest: Option<f64> = None;
        self.each_margin(&edges, effort, |_, margin| {
            smallest = Some(smallest.map_or(margin.value, |least| least.min(margin.value)));
        });
        smallest
    }

    /// The edges that a flip may remove.
    pub(super) fn free_edges(&self) -> Vec<HalfEdge> {
        let topology = &self.planar.topology;
        topology.edges_with(|h| !topology.is_fixed(h) && !self.is_held(h))
    }

    pub(super) fn is_held(&self, h: HalfEdge) -> bool {
        let topology = &self.planar.topology;
        !self.held.is_empty() && self.held.contains(&in_order(topology.ends(h)))
    }

    fn flip_queued(&mut self, effort: Effort) {
        let mut lawson = std::mem::take(&mut self.lawson);
        lawson.pass(&mut ByMargin { dual: self, effort }, LIMIT);
        self.lawson = lawson;
    }

    /// Whether the plane allows a flip: the quadrilateral is strictly convex, and the flip leaves no straight triangle
    /// that is poor in the metric and poorer than both of before.
    pub(super) fn allows_flip(&self, h: HalfEdge) -> bool {
        let Some([a, b, c, d]) = self.topology().quad(h).filter(|_| self.planar.is_convex(h)) else { return false };
        let after = self.shape([d, b, c]).min(self.shape([c, a, d]));
        after > POOR || after > self.shape([a, b, c]).min(self.shape([b, a, d]))
    }

    /// Quality of a straight triangle in the mean tensor of its corners: 1 of an equilateral one.
    pub(super) fn shape(&self, corners: [VertexId; 3]) -> f64 {
        self.mean_tensor(corners).shape(corners.map(|v| self.position(v)))
    }

    /// The mean of the tensors at some vertices.
    pub(crate) fn mean_tensor<const N: usize>(&self, vertices: [VertexId; N]) -> Tensor {
        vertices.iter().fold(Tensor::default(), |sum, &v| sum + self.local(v).tensor) * (1.0 / N as f64)
    }
}

/// A dual that flips by margins measured with some effort.
struct ByMargin<'a, 'b> {
    dual: &'a mut Dual<'b>,
    effort: Effort,
}

impl Flipping for ByMargin<'_, '_> {
    fn topology(&mut self) -> &mut Triangulation {
        &mut self.dual.planar.topology
    }

    fn wants_flip(&mut self, h: HalfEdge) -> bool {
        let is_held = self.dual.planar.topology.is_fixed(h) || self.dual.is_held(h);
        !is_held && self.dual.margin(h, self.effort).value < -TIE && self.dual.allows_flip(h)
    }

    fn flip(&mut self, h: HalfEdge) {
        let topology = &mut self.dual.planar.topology;
        topology.flip(h);
        self.dual.counters.flips += 1;
        self.dual.touched.extend(topology.sides(h).map(HalfEdge::face));
    }
}
