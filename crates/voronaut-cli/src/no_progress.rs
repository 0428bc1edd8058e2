//! Progress where there is no terminal, in a browser: callers watch by progress of their own.

use crate::options::Run;
use crate::watch;
use voronaut::progress::Progress;

/// Shows nothing.
pub(crate) struct Bar;

impl Bar {
    pub(crate) fn new(_: &Run) -> Self {
        Self
    }
}

impl Progress for Bar {
    fn stage(&self, name: &'static str, total: u64) {
        watch::stage(name, total);
    }

    fn done(&self, units: u64) {
        watch::done(units);
    }
}
