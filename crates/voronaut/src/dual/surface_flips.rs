//! Flips of the mesh in the making: by its own lengths, by a test of the caller's, and away from folds.

use super::Moving;
use super::on_surface::{FOLDED, SurfaceDual, TIE, UPRIGHT};
use crate::geodesic::Margin;
use crate::rdt::Quad;
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use rayon::prelude::*;

/// How often one pass flips the edge in one slot.
const FLIPS_PER_SLOT: u8 = 6;
/// A flip may not leave a triangle whose quality is below this if both were better before.
const POOR: f64 = 0.5;
/// Flips that unfold, at most, as a multiple of the number of faces.
const UNFOLDINGS: u64 = 8;

impl SurfaceDual<'_> {
    /// Flips every edge that the metric wants flipped and the surface allows. Returns the number of flips.
    pub fn flip_all(&mut self) -> u64 {
        self.measure();
        let edges: Vec<HalfEdge> = self.topology().edges().collect();
        let topology = &self.state.topology;
        let wants = |&h: &HalfEdge| !topology.is_fixed(h) && self.margin(h).is_some_and(|margin| margin < -TIE);
        let stack: Vec<HalfEdge> = edges.into_par_iter().with_min_len(64).filter(wants).collect();
        self.flip_stacked(stack, Self::margin)
    }

    /// Flips around a seed and onwards.
    pub(super) fn flip_around(&mut self, v: VertexId) -> u64 {
        let star: Vec<HalfEdge> = self.topology().star(v).flat_map(|h| [h, h.next()]).collect();
        self.flip_stacked(star, Self::margin)
    }

    /// Flips by a test of the caller's: every edge with a certainly negative margin whose flip the surface allows. Returns the
    /// number of flips.
    pub fn settle_by(&mut self, test: impl Fn(&Quad) -> Margin) -> u64 {
        let edges: Vec<HalfEdge> = self.topology().edges().collect();
        self.flip_stacked(edges, |dual, h| certain(&test(&dual.seeds_around(h)?)))
    }

    /// How many edges a test wants flipped.
    pub fn disagreeing(&self, test: impl Fn(&Quad) -> Margin) -> usize {
        let wants = |&h: &HalfEdge| {
            let margin = self.seeds_around(h).and_then(|quad| certain(&test(&quad)));
            !self.topology().is_fixed(h) && margin.is_some_and(|value| value < -TIE)
        };
        self.topology().edges().filter(wants).count()
    }

    /// How many edges their own lengths want flipped and the surface forbids, and the smallest margin of the others; 1 of none.
    pub fn unsettled(&self) -> (usize, f64) {
        let margins = self.topology().edges().filter(|&h| !self.topology().is_fixed(h)).filter_map(|h| self.margin(h));
        let (blocked, settled): (Vec<f64>, Vec<f64>) = margins.partition(|&margin| margin < -TIE);
        (blocked.len(), settled.into_iter().fold(1.0, f64::min))
    }

    fn seeds_around(&self, h: HalfEdge) -> Option<Quad> {
        let [a, b, c, d] = self.quad(h)?.map(|v| v.0);
        Some(Quad { a, b, c, d })
    }

    /// Flips edges and what follows from them as long as a test gives a negative margin and the surface allows it.
    fn flip_stacked(&mut self, mut stack: Vec<HalfEdge>, margin: impl Fn(&Self, HalfEdge) -> Option<f64>) -> u64 {
        let mut flips_of_slot = vec![0_u8; 3 * self.topology().face_slots()];
        let before = self.flips;
        while let Some(h) = stack.pop() {
            let Some(t) = self.topology().twin(h).filter(|_| !self.topology().is_fixed(h)) else { continue };
            let slot = h.min(t).index();
            let is_wanted = flips_of_slot[slot] < FLIPS_PER_SLOT && margin(self, h).is_some_and(|m| m < -TIE);
            if !is_wanted || !self.allows_flip(h) {
                continue;
            }
            flips_of_slot[slot] += 1;
            self.state.topology.flip(h);
            self.flips += 1;
            self.measure_edge(h);
            stack.extend([h.next(), h.prev(), t.next(), t.prev()]);
        }
        self.flips - before
    }

    /// Whether a flip leaves a triangulation without doubled edges whose triangles stand upright on the surface, and makes
    /// none that is poor in the metric and poorer than both of before.
    fn allows_flip(&self, h: HalfEdge) -> bool {
        let Some(Flip { now, then }) = self.flip_of(h) else { return false };
        let [before, after] = [now, then].map(|pair| self.leaning(pair));
        if before.upright <= FOLDED {
            return after.is_better_than(&before);
        }
        if after.upright < UPRIGHT && after.upright < before.upright {
            return false;
        }
        let [before, after] = [now, then].map(|pair| pair.map(|t| self.shape(t)).into_iter().fold(1.0, f64::min));
        after > POOR || after > before
    }

    /// The triangles of an edge, and those after its flip, if that makes no edge double.
    fn flip_of(&self, h: HalfEdge) -> Option<Flip> {
        let [a, b, c, d] = self.quad(h)?;
        let topology = self.topology();
        let joins =
            |u: VertexId, v: VertexId| topology.star(u).any(|e| topology.target(e) == v || topology.apex(e) == v);
        let is_lost = |v: &VertexId| topology.star(*v).count() <= if topology.is_border_vertex(*v) { 1 } else { 3 };
        if c == d || joins(c, d) || [a, b].iter().any(is_lost) {
            return None;
        }
        Some(Flip { now: [[a, b, c], [b, a, d]], then: [[d, b, c], [c, a, d]] })
    }

    fn leaning(&self, triangles: [[VertexId; 3]; 2]) -> Leaning {
        let mut found = Leaning { area: 0.0, upright: 1.0 };
        for t in triangles {
            let [a, b, c] = t.map(|v| self.position(v));
            let upright = self.upright(t);
            found.area += (b - a).cross(c - a).norm() * (UPRIGHT - upright).max(0.0);
            found.upright = found.upright.min(upright);
        }
        found
    }

    /// Flips edges of triangles that are folded over, whatever the metric says, as long as less of their area leans over.
    /// Returns the number of flips.
    pub fn unfold(&mut self) -> u64 {
        let is_down = |dual: &Self, f: FaceId| dual.upright(dual.topology().corners(f)) <= FOLDED;
        let mut stack: Vec<FaceId> = self.topology().faces().filter(|&f| is_down(self, f)).collect();
        let before = self.flips;
        let most = before + UNFOLDINGS * self.topology().face_count() as u64;
        while let Some(f) = stack.pop().filter(|_| self.flips < most) {
            if !is_down(self, f) {
                continue;
            }
            let better = |&h: &HalfEdge| {
                let Flip { now, then } = self.flip_of(h).filter(|_| !self.topology().is_fixed(h))?;
                let [before, after] = [now, then].map(|pair| self.leaning(pair));
                after.is_better_than(&before).then_some((h, before.area - after.area))
            };
            let best = f.half_edges().iter().filter_map(better).max_by(|x, y| x.1.total_cmp(&y.1));
            if let Some((h, _)) = best {
                let twin = self.topology().twin(h);
                self.state.topology.flip(h);
                self.flips += 1;
                let around = [Some(h.face()), twin.map(HalfEdge::face)].into_iter().flatten();
                let beyond = around.clone().flat_map(FaceId::half_edges).filter_map(|e| self.topology().twin(e));
                stack.extend(beyond.map(HalfEdge::face).chain(around));
            }
        }
        self.flips - before
    }
}

/// Two triangles before and after a flip.
struct Flip {
    now: [[VertexId; 3]; 2],
    then: [[VertexId; 3]; 2],
}

/// How far two triangles are from standing upright.
struct Leaning {
    /// Their areas, each weighted by how far it leans over; 0 of upright ones. In a plane this is twice what is covered too often,
    /// and flips that make it less lead to a triangulation that is embedded.
    area: f64,
    /// The least cosine between their normals and those of the surface; 0 of triangles without area.
    upright: f64,
}

impl Leaning {
    fn is_better_than(&self, other: &Self) -> bool {
        let rounding = 1e-9 * other.area;
        self.area < other.area - rounding || (self.area <= other.area + rounding && self.upright > other.upright)
    }
}

/// The value of a margin whose sign is certain.
fn certain(margin: &Margin) -> Option<f64> {
    margin.is_certain().then_some(margin.value)
}
