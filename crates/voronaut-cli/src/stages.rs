//! The times of a run's stages, by the clock of its world.

use crate::world::World;
use voronaut_io::Seconds;

/// The stages of a run, each from the end of the one before.
pub(crate) struct Stages<'a> {
    world: &'a World<'a>,
    start: f64,
    last: f64,
    ended: Vec<(&'static str, f64)>,
}

impl<'a> Stages<'a> {
    pub(crate) fn start(world: &'a World<'a>) -> Self {
        let start = world.seconds();
        Self { world, start, last: start, ended: Vec::new() }
    }

    pub(crate) fn end(&mut self, name: &'static str) {
        let now = self.world.seconds();
        self.ended.push((name, now - self.last));
        self.last = now;
    }

    /// The times of all stages, then of parts of them, and in total.
    pub(crate) fn seconds(mut self, parts: Vec<(&'static str, f64)>) -> Seconds {
        self.ended.extend(parts);
        Seconds { stages: self.ended, total: self.world.seconds() - self.start }
    }
}
