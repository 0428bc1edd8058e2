//! Finer triangles: edges split and flipped.

use super::UPRIGHT;
use super::work::{Vertex, Work, leaning, quality};
use crate::geometry::NEEDLE;
use crate::parallel::prelude::*;
use crate::triangulation::{Flipping, HalfEdge, Lawson, Limit, Triangulation, VertexId};
use std::cmp::Reverse;

/// Edges longer than this (metric) are split: contraction then has vertices to choose from.
const LONG: f64 = 1.0;
/// Passes over all edges that are too long, at most: each halves them.
const HALVINGS: usize = 40;
/// Middles that are looked for together, on all cores.
const TOGETHER: usize = 256;
/// Margins closer to zero than this are ties.
const TIE: f64 = 1e-9;
/// In fans, of which long borders are made at first, a slot has as many flips as they have triangles.
const LIMIT: Limit = Limit::OfSlot(u8::MAX);

impl Work<'_> {
    /// Splits edges inside patches in the middle, the longest first, and flips, until none is too long, but for those of triangles with
    /// a longer edge on the border: as that stays, fans of ever smaller triangles would grow on it.
    pub(super) fn split_long(&mut self, most: usize) {
        self.flip_all();
        for _ in 0..HALVINGS {
            let new = self.split_once(LONG, most.saturating_sub(self.vertex_count()));
            if new.is_empty() {
                return;
            }
            // Elsewhere nothing has changed that would ask for flips.
            let t = &self.topology;
            let around = new.iter().flat_map(|&v| t.star(v)).flat_map(|h| [h, h.next()]).collect();
            self.flip_from(around);
        }
    }

    /// Splits edges longer than so much, no more than so many; the vertices on them.
    pub(super) fn split_once(&mut self, longer: f64, most: usize) -> Vec<VertexId> {
        let long = self.longest_first(|h| self.is_long(h, longer)).into_iter();
        let long: Vec<(HalfEdge, [VertexId; 2])> = long.map(|h| (h, self.topology.ends(h))).collect();
        let (mut new, mut next) = (Vec::new(), long.as_slice());
        while new.len() < most && !next.is_empty() {
            // Not many more middles are looked for than may be wanted.
            let (now, later) = next.split_at((most - new.len()).max(TOGETHER).min(next.len()));
            next = later;
            let middles = now.par_iter().with_min_len(16).map(|&(h, _)| self.middle(h));
            for (&(h, ends), vertex) in now.iter().zip(middles.collect::<Vec<Option<Vertex>>>()) {
                // Splits beside it may have put another edge into this slot.
                let is_same = self.topology.ends(h) == ends;
                if new.len() < most
                    && self.is_long(h, longer)
                    && let Some(vertex) = if is_same { vertex } else { self.middle(h) }
                {
                    new.extend(self.split_at(h, vertex));
                }
            }
        }
        new
    }

    /// The edges for which something holds, the longest first.
    pub(super) fn longest_first(&self, holds: impl Fn(HalfEdge) -> bool + Sync) -> Vec<HalfEdge> {
        let edges = self.topology.edges_with(holds).into_par_iter().with_min_len(256);
        // Bits of positive numbers are in their order.
        let mut keyed: Vec<(Reverse<u64>, HalfEdge)> =
            edges.map(|h| (Reverse(self.length_of(h).to_bits()), h)).collect();
        keyed.par_sort_unstable();
        keyed.into_iter().map(|(_, h)| h).collect()
    }

    fn length_of(&self, h: HalfEdge) -> f64 {
        let [v, w] = self.topology.ends(h);
        self.length(v, w)
    }

    /// Whether an edge inside a patch is longer than so much.
    pub(super) fn exceeds(&self, h: HalfEdge, length: f64) -> bool {
        self.topology.twin(h).is_some() && self.length_of(h) > length
    }

    fn is_long(&self, h: HalfEdge, longer: f64) -> bool {
        let t = &self.topology;
        let Some(twin) = t.twin(h) else { return false };
        let length = self.length_of(h);
        let is_longest = |other: HalfEdge| t.twin(other).is_some() || self.length_of(other) <= length;
        length > longer && [h.next(), h.prev(), twin.next(), twin.prev()].into_iter().all(is_longest)
    }

    /// The vertex in the middle of an edge.
    pub(super) fn middle(&self, h: HalfEdge) -> Option<Vertex> {
        let [p, q] = self.topology.ends(h).map(|v| self.at(v).place);
        let middle = p.position.lerp(q.position, 0.5);
        let place = if self.keeps_edges {
            self.manifold.place_on_triangles(&p, middle)
        } else {
            self.manifold.lift(&p, middle)
        }?;
        Some(self.vertex(place))
    }

    /// Splits an edge, but not where that would turn a triangle away from the surface, or make the first needle.
    pub(super) fn split_at(&mut self, h: HalfEdge, vertex: Vertex) -> Option<VertexId> {
        let t = &self.topology;
        let halves = |side: HalfEdge| {
            let [a, b, c] = [t.origin(side), t.target(side), t.apex(side)].map(|v| self.at(v));
            [[a, &vertex, c], [&vertex, b, c]]
        };
        let faces: Vec<[VertexId; 3]> = t.sides(h).map(|side| t.corners(side.face())).collect();
        let before = faces.iter().map(|&corners| self.leaning(corners)).fold(UPRIGHT, f64::min);
        let least = self.least_of_parts(&faces);
        let may_split = t.sides(h).flat_map(halves).all(|half| leaning(half) >= before && quality(half) >= least);
        may_split.then(|| {
            let behind = self.split(h, vertex);
            self.topology.origin(behind)
        })
    }

    /// The least quality that parts of triangles may have. Needles have poorer parts at first: a fan of them on a border must be split for all that.
    /// So must what has needles for parts, where flips mend these.
    pub(super) fn least_of_parts(&self, whole: &[[VertexId; 3]]) -> f64 {
        let poor = if self.keeps_edges { NEEDLE } else { 2.0 * NEEDLE };
        if whole.iter().any(|&corners| self.quality(corners) < poor) { 0.0 } else { NEEDLE }
    }

    /// Flips edges that are not Delaunay ([`Work::margin`]), where no triangle turns away from the surface.
    pub(super) fn flip_all(&mut self) {
        self.flip_from(self.topology.edges_with(|_| true));
    }

    /// Flips edges that are not Delaunay, and what follows from them.
    fn flip_from(&mut self, edges: Vec<HalfEdge>) {
        // Others are looked at again when a flip beside them has changed what they are between.
        let may_be_wanted = |&h: &HalfEdge| self.topology.quad(h).is_some_and(|quad| self.margin(quad) < -TIE);
        let edges = edges.into_par_iter().with_min_len(256).filter(may_be_wanted);
        let mut lawson = Lawson::default();
        lawson.queue(edges.collect::<Vec<_>>());
        lawson.pass(self, LIMIT);
    }
}

impl Flipping for Work<'_> {
    fn topology(&mut self) -> &mut Triangulation {
        &mut self.topology
    }

    fn wants_flip(&mut self, h: HalfEdge) -> bool {
        let Some([a, b, c, d]) = self.topology.quad(h) else { return false };
        let is_held = self.keeps_edges || self.at(a).is_held && self.at(b).is_held;
        if is_held || self.margin([a, b, c, d]) >= -TIE || !self.topology.can_flip(h) {
            return false;
        }
        let (now, then) = ([[a, b, c], [b, a, d]], [[d, b, c], [c, a, d]]);
        let upright = |[t, u]: [[VertexId; 3]; 2]| self.leaning(t).min(self.leaning(u));
        let worst =
            |pair: [[VertexId; 3]; 2]| pair.map(|corners| self.quality(corners)).into_iter().fold(1.0, f64::min);
        let least = worst(then);
        least > 0.0 && least >= worst(now).min(NEEDLE) && upright(then) >= upright(now).min(UPRIGHT)
    }
}
