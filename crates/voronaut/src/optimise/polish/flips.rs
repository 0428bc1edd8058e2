//! Flips that lower the error.

use super::error::Place;
use super::{Work, is_allowed};
use crate::parallel::prelude::*;
use crate::triangulation::{HalfEdge, Rounds, Triangulation, VertexId, flip_in_rounds};

/// Rounds of flips in a sweep, at most: the next sweep has more.
const ROUNDS: usize = 8;
/// A flip gains this share of the two triangles' error at least.
const GAIN: f64 = 1e-9;

impl Work<'_> {
    /// Flips until no edge gains by it; the greatest gains first. Returns how many flips.
    pub(super) fn flip_all(&mut self) -> u64 {
        flip_in_rounds(self, ROUNDS)
    }

    /// By how much a flip would lower the error; `None` where it would not, or may not be.
    fn gain(&self, h: HalfEdge) -> Option<f64> {
        let [a, b, c, d] = self.planar.topology.quad(h).filter(|_| !self.planar.topology.is_fixed(h))?;
        let of = |vertices: [VertexId; 3]| self.objective.of(self.places_of(vertices));
        let (old, new) = ([[a, b, c], [b, a, d]], [[d, b, c], [c, a, d]]);
        if !self.planar.is_convex(h) {
            return None;
        }
        let before: f64 = old.into_iter().map(of).sum();
        let gain = before - new.into_iter().map(of).sum::<f64>();
        if gain.is_nan() || gain <= GAIN * before {
            return None;
        }
        let least = |faces: [[VertexId; 3]; 2]| {
            faces.into_iter().map(|f| self.shape(f, self.places_of(f))).fold(f64::INFINITY, f64::min)
        };
        is_allowed(least(old), least(new)).then_some(gain)
    }

    fn places_of(&self, vertices: [VertexId; 3]) -> [Place; 3] {
        vertices.map(|v| self.place(v))
    }
}

impl Rounds for Work<'_> {
    fn topology(&self) -> &Triangulation {
        &self.planar.topology
    }

    fn wanted(&mut self, edges: &[HalfEdge]) -> Vec<(f64, HalfEdge)> {
        edges.par_iter().with_min_len(64).filter_map(|&h| Some((-self.gain(h)?, h))).collect()
    }

    fn flip(&mut self, h: HalfEdge) -> bool {
        self.planar.topology.flip(h);
        true
    }
}
