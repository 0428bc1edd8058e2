//! Lawson's flips by the metric in-circle test, on a triangulation that stays embedded.

use super::margin::pair;
use super::{Dual, Effort};
use crate::geodesic::Margin;
use crate::geometry::Tensor;
use crate::triangulation::{Flipping, HalfEdge, Limit, Triangulation, VertexId};

/// Margins closer to zero than this are ties: flipping them gains nothing and could go on for ever.
const TIE: f64 = 1e-9;

/// Inconsistent tests can make flips go round in a circle.
const LIMIT: Limit = Limit::OfSlot(6);

/// A flip may not leave a triangle whose quality is below this if both were better before: where lengths of straight
/// edges contradict each other, or geodesics bend away from them, it would leave slivers.
const POOR: f64 = 0.5;

impl Dual<'_> {
    /// Flips every edge that the metric wants flipped and the plane allows. Returns the number of flips.
    pub(crate) fn flip_all(&mut self, effort: Effort) -> u64 {
        let before = self.counters.flips;
        if effort == Effort::Full {
            // Cheap flips first: few margins are then left to be measured one by one.
            self.flip_all(Effort::Chord);
            self.measure_margins();
        }
        self.lawson.queue(self.planar.topology.edges());
        self.flip_queued(effort);
        self.counters.flips - before
    }

    /// Flips around a vertex and onwards.
    pub(crate) fn flip_around(&mut self, v: VertexId, effort: Effort) -> u64 {
        self.lawson.queue(self.planar.topology.star(v).flat_map(|h| [h, h.next()]));
        self.flip_queued(effort)
    }

    /// Edges that the metric wants flipped and the plane forbids, with their margins, certain or not.
    pub(crate) fn blocked_flips(&mut self, effort: Effort) -> Vec<(HalfEdge, Margin)> {
        let forbidden: Vec<HalfEdge> = self.free_edges().filter(|&h| !self.allows_flip(h)).collect();
        let with_margin = forbidden.into_iter().map(|h| (h, self.margin(h, effort)));
        with_margin.filter(|(_, margin)| margin.value < -TIE).collect()
    }

    /// The smallest margin among all edges that are not constrained; `None` of none.
    pub(crate) fn smallest_margin(&mut self, effort: Effort) -> Option<f64> {
        let edges: Vec<HalfEdge> = self.free_edges().collect();
        edges.into_iter().map(|h| self.margin(h, effort).value).reduce(f64::min)
    }

    /// The edges that a flip may remove.
    pub(super) fn free_edges(&self) -> impl Iterator<Item = HalfEdge> + '_ {
        self.planar.topology.edges().filter(|&h| !self.planar.topology.is_fixed(h) && !self.is_held(h))
    }

    pub(super) fn is_held(&self, h: HalfEdge) -> bool {
        let topology = &self.planar.topology;
        !self.held.is_empty() && self.held.contains(&pair(topology.origin(h), topology.target(h)))
    }

    fn flip_queued(&mut self, effort: Effort) -> u64 {
        let mut lawson = std::mem::take(&mut self.lawson);
        let flips = lawson.pass(&mut ByMargin { dual: self, effort }, LIMIT).len() as u64;
        self.lawson = lawson;
        flips
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
        let tensor = corners.iter().fold(Tensor::default(), |sum, &v| sum + self.local(v).tensor) * (1.0 / 3.0);
        tensor.shape(corners.map(|v| self.position(v)))
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
        self.dual.touched.extend([Some(h), topology.twin(h)].into_iter().flatten().map(HalfEdge::face));
    }
}
