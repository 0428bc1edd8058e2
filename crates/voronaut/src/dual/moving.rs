//! What relaxation asks of a triangulation whose seeds it moves, in the plane or on a surface, and what mending its worst triangles
//! asks, which tries one seed at a time elsewhere: how good triangles and edges are as a mesh's are measured.

use super::{Dual, Effort, Kind};
use crate::error::Result;
use crate::geodesic::{LocalMetric, chord_between};
use crate::geometry::{Point, Tensor, Vector};
use crate::metric::MetricField;
use crate::parallel::{copy_over, prelude::*};
use crate::planar::Planar;
use crate::progress::Sketch;
use crate::triangulation::{Triangulation, VertexId};

/// Seeds that can move, with their triangulation. Vectors at a seed are in its own coordinates: those of the plane, or of a
/// chart there.
pub(crate) trait Moving: Sync {
    /// Seeds, edges, and the metric at the seeds, to come back to.
    type Saved: Sync;
    /// A place with what the metric is there.
    type Site: Copy + PartialEq + Send + Sync;

    /// Where the seeds are, by id, and the triangles.
    fn sketch(&self) -> Sketch;
    /// Topology.
    fn topology(&self) -> &Triangulation;
    /// The metric around a seed, in units of the wanted edge length.
    fn local(&self, v: VertexId) -> &LocalMetric;
    /// What holds a seed.
    fn kind(&self, v: VertexId) -> Kind;
    /// Where another seed is, seen from a seed.
    fn offset(&self, from: VertexId, to: VertexId) -> Vector;
    /// The factor on the metric.
    fn factor(&self) -> f64;
    /// The direction of the segment that a curve's seed is on: from one neighbour there to the other; where there are segments.
    fn along_segment(&self, _v: VertexId) -> Option<Vector> {
        None
    }

    /// Moves a seed, unless a triangle would turn over; says whether it did.
    fn shift_by(&mut self, v: VertexId, by: Vector) -> bool;
    /// Moves seeds all at once; says which moved. Others would turn a triangle over, or may be moved one by one.
    fn shift_together(&mut self, moves: &[(VertexId, Vector)]) -> Vec<bool> {
        vec![false; moves.len()]
    }
    /// Moves a curve's seed along its segment, as far as its edges there stay within these lengths (metric).
    fn slide_by(&mut self, _v: VertexId, _by: Vector, _lengths: [f64; 2]) -> bool {
        false
    }
    /// Measures what has to be known before cells are cut.
    fn measure(&mut self);
    /// After seeds have moved: measures the metric there and flips. Returns how many flips.
    ///
    /// # Errors
    /// The metric is found invalid at a seed.
    fn settle_moves(&mut self) -> Result<u64>;

    /// What moves and flips change.
    fn save(&self) -> Self::Saved;

    /// The same in place of what was saved before, in the memory of that.
    fn save_over(&self, saved: &mut Self::Saved) {
        *saved = self.save();
    }
    /// Takes back what was done since.
    fn take_back(&mut self, saved: &Self::Saved);
    /// How a seed has moved since.
    fn moved_since(&self, saved: &Self::Saved, v: VertexId) -> Vector;

    /// Where a seed is.
    fn site(&self, v: VertexId) -> Self::Site;
    /// Where a seed would be after a move; `None` where it cannot go.
    fn site_after(&self, v: VertexId, by: Vector) -> Option<Self::Site>;
    /// The quality of a straight triangle in the log-Euclidean mean of the tensors at its corners: 1 of an equilateral one,
    /// negative of one that is turned over.
    fn quality(&self, corners: [Self::Site; 3]) -> f64;
    /// The metric length of a straight edge.
    fn straight_length(&self, ends: [Self::Site; 2]) -> f64;
    /// The same as a mesh's is measured, by the metric along it; the first end is near a seed.
    fn chord(&self, _near: VertexId, ends: [Self::Site; 2]) -> f64 {
        self.straight_length(ends)
    }
    /// A site that several edges are measured from, with what these have in common.
    fn ready(&self, site: Self::Site) -> Self::Site {
        site
    }
    /// After a seed has moved: measures the metric there and flips around it.
    fn settle_move(&mut self, v: VertexId);
}

/// Where all seeds are, by id, in parallel; in slots without a seed that of some other.
pub(crate) fn sites<M: Moving>(dual: &M) -> Vec<M::Site> {
    let topology = dual.topology();
    let some = topology.vertices().next().unwrap_or(VertexId(0));
    let seed = |v: u32| if topology.is_vertex(VertexId(v)) { VertexId(v) } else { some };
    let slots = (0..topology.vertex_slots() as u32).into_par_iter();
    slots.with_min_len(64).map(|v| dual.site(seed(v))).collect()
}

/// Of more seeds what was taken back is not kept: a million for a hard shock take 1.39 GB with it, and 1.14 without.
pub(super) const KEPT: usize = 1 << 18;

/// Seeds, edges and the metric at the seeds, with its factor.
#[derive(Default)]
pub(crate) struct Saved {
    planar: Planar,
    locals: Vec<LocalMetric>,
    kinds: Vec<Kind>,
    factor: f64,
}

/// A point with the tensor there, and its logarithm.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Site {
    at: Point,
    tensor: Tensor,
    log: Tensor,
}

impl Dual<'_> {
    /// Takes over the metric at seeds that have come to where moves that were taken back had led them.
    fn recall(&mut self) {
        let Self { tried, planar, locals, .. } = self;
        if tried.factor.to_bits() != self.field.factor.to_bits() {
            return;
        }
        let seeds = locals.iter_mut().zip(&planar.positions).zip(tried.locals.iter().zip(&tried.planar.positions));
        for ((local, at), (known, then)) in seeds {
            if local.is_due() && at == then {
                *local = *known;
            }
        }
    }

    /// The length of an edge in the state that was taken back, between seeds that are where they were then, from the same one to the other: the other way
    /// rounding differs.
    pub(super) fn recalled_length(&self, ends: [VertexId; 2]) -> Option<f64> {
        let Saved { planar, locals, factor, .. } = &self.tried;
        let is_there = |v: VertexId| {
            let [then, now] = [locals.get(v.index()), Some(self.local(v))];
            planar.positions.get(v.index()) == Some(&self.position(v)) && then == now
        };
        let is_known = factor.to_bits() == self.field().factor.to_bits() && ends.into_iter().all(is_there);
        let topology = &planar.topology;
        let edge = is_known.then(|| topology.edge_between(ends[0], ends[1])).flatten();
        let edge = edge.map(|h| topology.canonical(h)).filter(|&h| topology.ends(h) == ends);
        edge.map(|h| topology.length(h)).filter(|length| !length.is_nan())
    }

    fn site_at(&self, at: Point, beside: VertexId) -> Site {
        let tensor = self.field().at_near(at, &mut self.local(beside).near.clone());
        Site { at, tensor, log: tensor.log() }
    }
}

impl Moving for Dual<'_> {
    type Saved = Saved;
    type Site = Site;

    fn sketch(&self) -> Sketch {
        let is_vertex = |v: &u32| self.topology().is_vertex(VertexId(*v));
        let place = |v: u32| {
            Some(v).filter(is_vertex).map_or([0.0; 3], |v| {
                let p = self.position(VertexId(v));
                [p.x, p.y, 0.0]
            })
        };
        let points = (0..self.topology().vertex_slots() as u32).map(place).collect();
        let corners = |f| self.topology().corners(f).map(|v| v.0);
        (points, self.topology().faces().map(corners).collect())
    }

    fn topology(&self) -> &Triangulation {
        &self.planar.topology
    }

    fn local(&self, v: VertexId) -> &LocalMetric {
        &self.locals[v.index()]
    }

    fn kind(&self, v: VertexId) -> Kind {
        self.kinds[v.index()]
    }

    fn offset(&self, from: VertexId, to: VertexId) -> Vector {
        self.position(to) - self.position(from)
    }

    fn factor(&self) -> f64 {
        self.field().factor
    }

    fn along_segment(&self, v: VertexId) -> Option<Vector> {
        self.planar().neighbours_on_segment(v).map(|[a, b]| b - a)
    }

    fn shift_by(&mut self, v: VertexId, by: Vector) -> bool {
        self.shift(v, self.position(v) + by)
    }

    fn shift_together(&mut self, moves: &[(VertexId, Vector)]) -> Vec<bool> {
        self.forget();
        let targets = moves.par_iter().with_min_len(1024).map(|&(v, by)| (v, self.position(v) + by));
        let targets: Vec<(VertexId, Point)> = targets.collect();
        let moved = self.planar.move_together(&targets);
        let mut carried = vec![Vector::default(); self.locals.len()];
        for (&(v, by), _) in moves.iter().zip(&moved).filter(|(_, moved)| **moved) {
            carried[v.index()] = by;
        }
        self.locals.par_iter_mut().zip(&carried).with_min_len(1024).for_each(|(local, &by)| {
            if by != Vector::default() {
                *local = local.carried(by);
            }
        });
        moved
    }

    fn slide_by(&mut self, v: VertexId, by: Vector, lengths: [f64; 2]) -> bool {
        self.shift(v, self.slid(v, by, lengths))
    }

    fn measure(&mut self) {
        self.measure_rough_edges();
    }

    fn settle_moves(&mut self) -> Result<u64> {
        self.recall();
        // Where the metric was rough it counts as rough still.
        self.measure_each(|local, field, p| if local.is_due() { local.moved(field, p) } else { *local });
        self.verdict()?;
        let flips = self.flip_all(Effort::Local);
        self.take_touched();
        self.measure_rough_edges();
        Ok(flips)
    }

    fn save(&self) -> Saved {
        let mut saved = Saved::default();
        self.save_over(&mut saved);
        saved
    }

    fn save_over(&self, saved: &mut Saved) {
        saved.planar.copy_from(&self.planar);
        copy_over(&mut saved.locals, &self.locals);
        saved.kinds.clone_from(&self.kinds);
        saved.factor = self.field.factor;
    }

    fn take_back(&mut self, saved: &Saved) {
        if self.locals.len() <= KEPT {
            std::mem::swap(&mut self.tried.planar, &mut self.planar);
            std::mem::swap(&mut self.tried.locals, &mut self.locals);
            self.tried.factor = self.field.factor;
        }
        self.planar.copy_from(&saved.planar);
        copy_over(&mut self.locals, &saved.locals);
        self.kinds.clone_from(&saved.kinds);
        self.field.factor = saved.factor;
        self.forget();
        self.touched.clear();
    }

    fn moved_since(&self, saved: &Saved, v: VertexId) -> Vector {
        self.position(v) - saved.planar.position(v)
    }

    fn site(&self, v: VertexId) -> Site {
        self.site_at(self.position(v), v)
    }

    fn site_after(&self, v: VertexId, by: Vector) -> Option<Site> {
        Some(self.site_at(self.position(v) + by, v))
    }

    fn quality(&self, [a, b, c]: [Site; 3]) -> f64 {
        ((a.log + b.log + c.log) * (1.0 / 3.0)).exp().shape([a.at, b.at, c.at])
    }

    fn straight_length(&self, [a, b]: [Site; 2]) -> f64 {
        ((a.log + b.log) * 0.5).exp().length(b.at - a.at)
    }

    fn chord(&self, near: VertexId, [a, b]: [Site; 2]) -> f64 {
        chord_between(self.field(), [a.at, b.at], [a.tensor, b.tensor], self.local(near).near)
    }

    fn settle_move(&mut self, v: VertexId) {
        self.locals[v.index()] = self.measure(v);
        self.flip_around(v, Effort::Local);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::from_frame;
    use crate::manifold::domain::Domain;
    use crate::metric::{Scaled, Swirl};
    use crate::progress::Silent;
    use crate::sampling::{Fill, Plan, Target, refine, sample_segments};

    #[test]
    fn the_next_try_finds_what_it_would_find_alone_to_the_last_bit() {
        let (domain, field) = (Domain::shape("rect:-2,-2,2,2").unwrap(), Swirl::default());
        let made = || {
            let plan = Plan::new(domain.clone(), Vec::new(), &field, Target::Vertices(300)).unwrap();
            let scaled = Scaled { field: &field, factor: plan.scale_for(300.0) };
            let mut dual = Dual::new(domain.corners(), scaled).unwrap();
            sample_segments(&mut dual, &plan.edges, &plan.arcs, scaled.factor, 0);
            refine(&mut dual, Fill::AtMost(300), &Silent).unwrap();
            Moving::measure(&mut dual);
            dual
        };
        let step = |dual: &mut Dual, moves: &[(VertexId, Vector)]| {
            dual.shift_together(moves);
            dual.settle_moves().unwrap();
        };
        let (mut alone, mut second) = (made(), made());
        let way = |v: VertexId| {
            let (sine, cosine) = f64::from(v.0).sin_cos();
            from_frame(second.local(v).tensor.cholesky(), Vector::new(cosine, sine)) * 0.1
        };
        let free = second.topology().vertices().filter(|&v| second.kind(v) == Kind::Free);
        let all: Vec<(VertexId, Vector)> = free.map(|v| (v, way(v))).collect();
        let some: Vec<(VertexId, Vector)> = all.iter().copied().filter(|(v, _)| v.0 % 16 > 0).collect();
        let before = second.save();
        step(&mut second, &all);
        second.take_back(&before);
        step(&mut alone, &some);
        step(&mut second, &some);
        let topology = alone.topology();
        let is_known = |&h: &crate::triangulation::HalfEdge| second.recalled_length(topology.ends(h)).is_some();
        assert!(2 * topology.edges().filter(is_known).count() > topology.edges().count(), "of rough edges next to all");
        for v in topology.vertices() {
            assert!(alone.position(v) == second.position(v) && alone.local(v) == second.local(v));
        }
        let length = |dual: &Dual, h| dual.topology().length(h).to_bits();
        assert!(topology.edges().all(|h| topology.ends(h) == second.topology().ends(h)));
        assert!(topology.edges().all(|h| length(&alone, h) == length(&second, h)));
    }
}
