//! Time per stage, by the clock of who watches.

/// Stages in the order in which they first began, with the seconds spent in each.
#[derive(Clone, Debug, Default)]
pub(super) struct Stopwatch {
    pub(super) seconds: Vec<(&'static str, f64)>,
}

impl Stopwatch {
    /// Adds the time that a stage took.
    pub(super) fn add(&mut self, stage: &'static str, took: f64) {
        match self.seconds.iter_mut().find(|(name, _)| *name == stage) {
            Some((_, seconds)) => *seconds += took,
            None => self.seconds.push((stage, took)),
        }
    }
}
