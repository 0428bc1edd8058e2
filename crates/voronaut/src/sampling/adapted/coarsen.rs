//! Coarser triangles: vertices contracted onto their neighbours.

use super::UPRIGHT;
use super::work::Work;
use crate::geometry::NEEDLE;
use crate::parallel::prelude::*;
use crate::triangulation::{HalfEdge, VertexId};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Contraction makes no edge longer than this (metric), as long as there is another way.
const LONGEST: f64 = 2.0;
/// New triangles of less quality in the metric have to be better than those before.
const FAIR: f64 = 0.2;
/// Passes over all that may be contracted, at most: what one does makes room for the next.
const PASSES: usize = 8;
/// Vertices with more triangles together are not made one: all would gather at a few.
const CROWD: usize = 24;

/// How much a contraction has to look to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Manner {
    /// Triangles stay upright and fair, edges not too long.
    Fair,
    /// Triangles stay upright, and become no needles.
    Upright,
}

impl Work<'_> {
    /// Contracts the vertices of the border that are not given along it. Where others stand behind a chord of the border, these go first.
    pub(super) fn contract_border(&mut self) {
        for pass in 0..PASSES {
            let (stuck, before) = (self.stuck(), self.vertex_count());
            for v in stuck {
                if !self.contract_along_border(v) && pass > 0 {
                    self.clear_around(v);
                }
            }
            if self.stuck().is_empty() || pass > 0 && self.vertex_count() == before {
                return;
            }
            self.flip_all();
        }
    }

    /// Contracts a vertex of the border onto the neighbour along it with which triangles turn away least, if they may.
    fn contract_along_border(&mut self, v: VertexId) -> bool {
        let t = &self.topology;
        let ways = t.spokes(v).filter(|&h| t.twin(h).is_none() && t.can_collapse(h));
        let worst = |h: HalfEdge| {
            let to = if t.origin(h) == v { t.target(h) } else { t.origin(h) };
            self.moved(v, to).map(|after| self.leaning(after)).fold(1.0, f64::min)
        };
        let best = ways.map(|h| (worst(h), h)).max_by(|x, y| x.0.total_cmp(&y.0).then(y.1.cmp(&x.1)));
        let before = t.star(v).map(|h| self.leaning([v, t.target(h), t.apex(h)])).fold(1.0, f64::min);
        let Some((_, h)) = best.filter(|&(after, _)| after >= before.min(UPRIGHT)) else { return false };
        self.collapse(v, h);
        true
    }

    /// Contracts neighbours of a vertex of the border onto it that are not on the border.
    fn clear_around(&mut self, v: VertexId) {
        let around: Vec<VertexId> = self.topology.around(v).collect();
        for other in around {
            let t = &self.topology;
            let is_there = t.is_vertex(other) && !t.is_border_vertex(other);
            if let Some(h) = is_there.then(|| t.find(other, v)).flatten() {
                self.contract(h, Manner::Upright);
            }
        }
    }

    fn collapse(&mut self, gone: VertexId, h: HalfEdge) {
        if self.topology.origin(h) == gone { self.topology.collapse(h) } else { self.topology.collapse_back(h) }
    }

    /// Contracts vertices inside patches until so many are left, or no more may be contracted; where many are held, others do not make up
    /// for these at the cost of shapes.
    pub(super) fn contract_to(&mut self, count: usize) {
        self.contract_inside(count, Manner::Fair);
        self.contract_inside(count + self.held_in_excess(), Manner::Upright);
    }

    /// Contracts vertices inside patches over their edges, the shortest first, until so many vertices are left.
    fn contract_inside(&mut self, count: usize, manner: Manner) {
        for _ in 0..PASSES {
            if self.vertex_count() <= count {
                return;
            }
            let before = self.vertex_count();
            let edges = self.topology.edges_with(|_| true).into_par_iter().with_min_len(256);
            let entries = edges.map(|h| self.topology.ends(h)).map(|[v, w]| self.entry(v, w));
            let mut queue = BinaryHeap::from(entries.collect::<Vec<_>>());
            while self.vertex_count() > count
                && let Some(Reverse((_, v, w))) = queue.pop()
            {
                let t = &self.topology;
                let is_there = |v| t.is_vertex(v);
                let edge = (is_there(v) && is_there(w)).then(|| t.edge_between(v, w)).flatten();
                let Some(h) = edge else { continue };
                let around: Vec<VertexId> = [v, w].into_iter().flat_map(|v| t.around(v)).collect();
                if let Some(kept) = self.contract(h, manner) {
                    let others = around.into_iter().filter(|&v| v != kept && self.topology.is_vertex(v));
                    queue.extend(others.map(|other| self.entry(kept, other)));
                }
            }
            self.flip_all();
            if self.vertex_count() == before {
                return;
            }
        }
    }

    /// Positive numbers have the order of their bits.
    fn entry(&self, v: VertexId, w: VertexId) -> Reverse<(u64, VertexId, VertexId)> {
        Reverse((self.length(v, w).to_bits(), v.min(w), v.max(w)))
    }

    /// Contracts one end of an edge onto the other, if that may be: the end with which the worst triangle is the better.
    /// Returns the end that is left.
    fn contract(&mut self, h: HalfEdge, manner: Manner) -> Option<VertexId> {
        let t = &self.topology;
        let [v, w] = t.ends(h);
        let may_go = |v: VertexId| self.at(v).may_go() && !t.is_border_vertex(v);
        let faces = |v: VertexId| t.star(v).take(CROWD + 1).count();
        let is_crowded = faces(v) + faces(w) > CROWD;
        if is_crowded || !(may_go(v) || may_go(w)) || !t.can_collapse(h) {
            return None;
        }
        let ways = [(v, w), (w, v)].into_iter().filter(|&(gone, _)| may_go(gone));
        let allowed = ways.filter_map(|(gone, kept)| Some((self.worth(gone, kept, manner)?, gone, kept)));
        let (_, gone, kept) = allowed.max_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)))?;
        self.collapse(gone, h);
        Some(kept)
    }

    /// The least quality of the triangles that would be there if a vertex went to the place of a neighbour; nothing if they may not.
    fn worth(&self, gone: VertexId, kept: VertexId, manner: Manner) -> Option<f64> {
        let t = &self.topology;
        let star = || t.star(gone).map(|h| [gone, t.target(h), t.apex(h)]);
        let upright = star().map(|corners| self.leaning(corners)).fold(1.0, f64::min).min(UPRIGHT);
        let fair = star().map(|corners| self.quality(corners)).fold(1.0, f64::min).min(FAIR);
        let mut worst = 1.0_f64;
        for corners in self.moved(gone, kept) {
            let quality = self.quality(corners);
            let is_long = || self.length(corners[0], corners[1]).max(self.length(corners[0], corners[2])) > LONGEST;
            let is_poor = quality <= 0.0 || quality < fair.min(NEEDLE);
            let leans = self.leaning(corners) < upright;
            if leans || is_poor || manner == Manner::Fair && (quality < fair || is_long()) {
                return None;
            }
            worst = worst.min(quality);
        }
        Some(worst)
    }

    /// The triangles around a vertex that stay when it goes to another's place, with that one first.
    fn moved(&self, gone: VertexId, kept: VertexId) -> impl Iterator<Item = [VertexId; 3]> {
        let t = &self.topology;
        let links = t.star(gone).map(|h| [t.target(h), t.apex(h)]);
        links.filter(move |link| !link.contains(&kept)).map(move |[a, b]| [kept, a, b])
    }
}
