//! Lengths and in-circle tests of a triangulation, for the next one of which few seeds have moved.

use crate::geometry::Point;
use crate::in_circle::{TestCounters, Tests};

/// What a triangulation has found. It is of one field and one [`Trust`](super::Trust).
#[derive(Clone, Default)]
pub(crate) struct Memory {
    seeds: Vec<Point>,
    pub(super) tests: Tests,
}

impl Memory {
    /// Forgets what depends on seeds that are not where they were.
    pub(super) fn keep_for(&mut self, seeds: &[Point]) {
        let is_there = |i: u32| self.seeds.get(i as usize).is_some_and(|p| seeds.get(i as usize) == Some(p));
        self.tests.keep(is_there);
        self.tests.counters = TestCounters::default();
        self.seeds = seeds.to_vec();
    }
}
