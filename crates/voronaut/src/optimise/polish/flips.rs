//! Flips that lower the error.

use super::error::Place;
use super::{Work, is_allowed};
use crate::triangulation::{HalfEdge, VertexId};
use rayon::prelude::*;

/// Rounds of flips in a sweep, at most: the next sweep has more.
const ROUNDS: usize = 8;
/// A flip gains this share of the two triangles' error at least.
const GAIN: f64 = 1e-9;

impl Work<'_> {
    /// Flips until no edge gains by it; the greatest gains first. Returns how many flips.
    pub(super) fn flip_all(&mut self) -> u64 {
        let mut flips = 0;
        let mut is_new = vec![true; self.planar.topology.face_slots()];
        for _ in 0..ROUNDS {
            let edges: Vec<HalfEdge> = self.flippable(&is_new);
            let gains: Vec<(f64, HalfEdge)> =
                edges.par_iter().with_min_len(64).filter_map(|&h| Some((self.gain(h)?, h))).collect();
            is_new = self.flip_each(gains);
            let done = is_new.iter().filter(|&&face| face).count() as u64 / 2;
            flips += done;
            if done == 0 {
                break;
            }
        }
        flips
    }

    fn flippable(&self, is_new: &[bool]) -> Vec<HalfEdge> {
        let topology = &self.planar.topology;
        let is_near = |h: HalfEdge| {
            is_new[h.face().index()] || topology.twin(h).is_some_and(|t: HalfEdge| is_new[t.face().index()])
        };
        topology.edges().filter(|&h| is_near(h) && !topology.is_fixed(h)).collect()
    }

    /// By how much a flip would lower the error; `None` where it would not, or may not be.
    fn gain(&self, h: HalfEdge) -> Option<f64> {
        let topology = &self.planar.topology;
        let t = topology.twin(h)?;
        let ids = [topology.origin(h), topology.target(h), topology.apex(h), topology.apex(t)];
        let [a, b, c, d] = ids;
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

    /// Flips those of which no face was changed by one before; says which faces are new.
    fn flip_each(&mut self, mut gains: Vec<(f64, HalfEdge)>) -> Vec<bool> {
        gains.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let topology = &mut self.planar.topology;
        let mut is_new = vec![false; topology.face_slots()];
        for (_, h) in gains {
            let Some(t) = topology.twin(h) else { continue };
            let faces = [h.face().index(), t.face().index()];
            if faces.iter().all(|&face| !is_new[face]) {
                topology.flip(h);
                for face in faces {
                    is_new[face] = true;
                }
            }
        }
        is_new
    }
}
