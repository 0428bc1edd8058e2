//! Progress as the page sees it.

use std::sync::Mutex;
use voronaut::progress::Progress;

/// What the page shows while there is work, and its clock.
pub trait Window: Sync {
    /// Seconds since any moment.
    fn seconds(&self) -> f64;
    /// A stage begins, with so many units of work.
    fn stage(&self, name: &str, total: u64);
    /// So many more units of it are done.
    fn done(&self, units: u64);
    /// The mesh in the making: points, and triangles of them.
    fn sketch(&self, points: &[[f64; 3]], triangles: &[[u32; 3]]);
}

/// Sketches are drawn no more often than once in so many seconds.
const PERIOD: f64 = 0.2;

/// Progress that is seen through a window.
pub(crate) struct Watch<'a> {
    window: &'a dyn Window,
    /// When the last sketch was drawn.
    drawn: Mutex<f64>,
}

impl<'a> Watch<'a> {
    pub(crate) fn new(window: &'a dyn Window) -> Self {
        Self { window, drawn: Mutex::new(f64::NEG_INFINITY) }
    }
}

impl Progress for Watch<'_> {
    fn stage(&self, name: &'static str, total: u64) {
        self.window.stage(name, total);
    }

    fn done(&self, units: u64) {
        self.window.done(units);
    }

    fn seconds(&self) -> f64 {
        self.window.seconds()
    }

    fn sketch(&self, draw: &dyn Fn() -> (Vec<[f64; 3]>, Vec<[u32; 3]>)) {
        let now = self.window.seconds();
        let Ok(mut drawn) = self.drawn.lock() else { return };
        if now - *drawn >= PERIOD {
            let (points, triangles) = draw();
            self.window.sketch(&points, &triangles);
            *drawn = self.window.seconds();
        }
    }
}
