//! Lengths and in-circle tests of a triangulation, for the next one of which few seeds have moved.

use super::judge::{Judge, Lengths, Quad};
use super::{Rdt, Tested};
use crate::geometry::Point;
use std::collections::HashMap;

/// What a triangulation has found. It is of one field and one [`Trust`](super::Trust).
#[derive(Clone, Default)]
pub struct Memory {
    seeds: Vec<Point>,
    pub(super) lengths: Lengths,
    tests: HashMap<[u32; 4], Tested>,
}

impl Memory {
    /// Forgets what depends on seeds that are not where they were.
    pub(super) fn keep_for(&mut self, seeds: &[Point]) {
        let is_there = |i: u32| self.seeds.get(i as usize).is_some_and(|p| seeds.get(i as usize) == Some(p));
        self.lengths.retain(|&(i, j), _| is_there(i) && is_there(j));
        self.tests.retain(|quad, _| quad.iter().all(|&i| is_there(i)));
        self.seeds = seeds.to_vec();
    }

    /// The test of an edge, all levels of it.
    pub(super) fn test(&self, quad: &Quad) -> Option<Tested> {
        self.tests.get(&key(quad)).copied()
    }
}

impl<J: Judge> Rdt<J> {
    /// What was found, for [`Rdt::again`].
    pub fn into_memory(mut self) -> Memory {
        let edges: Vec<_> = self.topology.edges().collect();
        let known = edges.into_iter().filter_map(|h| Some((key(&self.quad(h)?), self.tested[h.index()]?)));
        let tests: Vec<([u32; 4], Tested)> = known.collect();
        self.memory.tests.extend(tests);
        self.memory.lengths = self.lengths;
        self.memory
    }
}

/// The same for the edge in both directions.
fn key(&Quad { a, b, c, d }: &Quad) -> [u32; 4] {
    if a < b { [a, b, c, d] } else { [b, a, d, c] }
}
