//! The time that steps take.

use crate::progress::Progress;
use std::cell::RefCell;

/// Stages in the order in which they first began, with the seconds spent in each by the clock of who watches.
pub(super) struct Stopwatch<'a> {
    pub(super) progress: &'a dyn Progress,
    seconds: RefCell<Vec<(&'static str, f64)>>,
}

impl<'a> Stopwatch<'a> {
    /// Nothing has begun.
    pub(super) fn new(progress: &'a dyn Progress) -> Self {
        Self { progress, seconds: RefCell::default() }
    }

    /// Does the work, whose time the stage takes.
    pub(super) fn time<T>(&self, stage: &'static str, work: impl FnOnce() -> T) -> T {
        let start = self.progress.seconds();
        let result = work();
        let took = self.progress.seconds() - start;
        let mut seconds = self.seconds.borrow_mut();
        match seconds.iter_mut().find(|(name, _)| *name == stage) {
            Some((_, seconds)) => *seconds += took,
            None => seconds.push((stage, took)),
        }
        result
    }

    /// All stages so far.
    pub(super) fn seconds(&self) -> Vec<(&'static str, f64)> {
        self.seconds.borrow().clone()
    }
}
