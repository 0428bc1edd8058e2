//! Wall time per stage.

use std::time::Instant;

/// Stages in the order in which they first began, with the seconds spent in each.
#[derive(Clone, Debug, Default)]
pub(super) struct Stopwatch {
    pub(super) seconds: Vec<(&'static str, f64)>,
}

impl Stopwatch {
    /// Adds the time since a stage began.
    pub(super) fn add(&mut self, stage: &'static str, start: Instant) {
        let took = start.elapsed().as_secs_f64();
        match self.seconds.iter_mut().find(|(name, _)| *name == stage) {
            Some((_, seconds)) => *seconds += took,
            None => self.seconds.push((stage, took)),
        }
    }
}
