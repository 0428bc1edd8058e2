//! Insertion, removal and moves of seeds. Each says whether it was done; what would not be embedded is not done.

use super::{Dual, Effort, Kind};
use crate::geodesic::LocalMetric;
use crate::geometry::{Point, Vector};
use crate::planar::Planar;
use crate::triangulation::{FaceId, HalfEdge, VertexId};

/// Seeds, edges and the metric at the seeds, with its factor.
pub(crate) struct Saved {
    planar: Planar,
    locals: Vec<LocalMetric>,
    kinds: Vec<Kind>,
    factor: f64,
}

impl Saved {
    /// Where a seed was.
    pub(crate) fn position(&self, v: VertexId) -> Point {
        self.planar.position(v)
    }
}

impl Dual<'_> {
    /// Puts a free seed strictly inside a face.
    pub(crate) fn insert_in_face(&mut self, f: FaceId, p: Point) -> Option<VertexId> {
        let v = self.planar.insert_in_face(f, p)?;
        self.settle(v, Kind::Free);
        Some(v)
    }

    /// Puts a seed on an edge: a curve's if the edge is constrained, else a free one. Returns it and the half-edge from
    /// it to the old target of h. The edge of a required segment stays whole.
    pub(crate) fn insert_on_edge(&mut self, h: HalfEdge, p: Point) -> Option<(VertexId, HalfEdge)> {
        if self.planar.topology.constraint(h).is_some_and(|c| self.required[c.0 as usize]) {
            return None;
        }
        let kind = if self.planar.topology.is_fixed(h) { Kind::Curve } else { Kind::Free };
        let target = self.planar.topology.target(h);
        let (v, _) = self.planar.insert_on_edge(h, p)?;
        self.settle(v, kind);
        // A constrained half still stands after the flips; that of a free edge may be gone.
        Some((v, self.planar.topology.find(v, target).unwrap_or(h)))
    }

    /// What insertions, removals, moves and flips change, to be [restored](Dual::restore).
    pub(crate) fn saved(&self) -> Saved {
        Saved {
            planar: self.planar.clone(),
            locals: self.locals.clone(),
            kinds: self.kinds.clone(),
            factor: self.field.factor,
        }
    }

    /// Takes back what was done since.
    pub(crate) fn restore(&mut self, saved: &Saved) {
        self.planar.clone_from(&saved.planar);
        self.locals.clone_from(&saved.locals);
        self.kinds.clone_from(&saved.kinds);
        self.field.factor = saved.factor;
        self.forget();
        self.touched.clear();
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

    /// Moves a seed if all its faces stay counter-clockwise; the metric there is to be measured by the caller
    /// ([`Dual::measure_all`]).
    pub(crate) fn shift(&mut self, v: VertexId, to: Point) -> bool {
        debug_assert!(!matches!(self.kind(v), Kind::Corner(_)), "corners stay");
        self.forget();
        self.planar.move_vertex(v, to)
    }

    /// Moves a free seed if all its faces stay counter-clockwise, measures the metric there, and flips around it.
    pub(crate) fn relocate(&mut self, v: VertexId, to: Point) -> bool {
        if !self.shift(v, to) {
            return false;
        }
        self.locals[v.index()] = self.measure(to);
        self.flip_around(v, Effort::Local);
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
        let local = self.measure(self.position(v));
        let slots = self.planar.topology.vertex_slots();
        self.locals.resize(slots, local);
        self.kinds.resize(slots, kind);
        self.locals[v.index()] = local;
        self.kinds[v.index()] = kind;
        let star: Vec<FaceId> = self.planar.topology.star(v).map(HalfEdge::face).collect();
        self.touched.extend(star);
        self.flip_around(v, Effort::Local);
    }
}
