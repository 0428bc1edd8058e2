//! Progress of long work, told to whoever wants to show it, who may stop it. The library itself never prints.

use crate::error::{Error, Result};

/// Points, and triangles of them.
pub(crate) type Sketch = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// Told about progress; called from one thread at a time.
pub trait Progress: Sync {
    /// A stage began, with so many units of work.
    fn stage(&self, name: &'static str, total: u64);
    /// So many more units of the current stage are done.
    fn done(&self, units: u64);
    /// What a clock says, in seconds from any moment on: times of stages are differences of it. The library reads no clock by
    /// itself; without one all times are zero.
    fn seconds(&self) -> f64 {
        0.0
    }
    /// Whether to stop: asked whenever a stage begins and every so many units of work, which then ends in
    /// [`Error::Stopped`]. A deadline is an answer by the clock.
    fn is_stopped(&self) -> bool {
        false
    }
    /// Shown the mesh in the making every so many units of work: points, of which some may be none's, and triangles. Whoever wants to
    /// see them calls `draw`; nothing is drawn otherwise.
    fn sketch(&self, _draw: &dyn Fn() -> Sketch) {}
}

impl dyn Progress + '_ {
    /// [`Progress::stage`], unless the work is to stop.
    pub(crate) fn begin(&self, name: &'static str, total: u64) -> Result<()> {
        self.go_on()?;
        self.stage(name, total);
        Ok(())
    }

    /// [`Progress::done`], unless the work is to stop.
    pub(crate) fn advance(&self, units: u64) -> Result<()> {
        self.done(units);
        self.go_on()
    }

    fn go_on(&self) -> Result<()> {
        if self.is_stopped() { Err(Error::Stopped) } else { Ok(()) }
    }
}

/// Progress within a stage: work that is not counted, but stops and is shown.
pub(crate) struct Within<'a>(pub(crate) &'a dyn Progress);

impl Progress for Within<'_> {
    fn stage(&self, _name: &'static str, _total: u64) {}
    fn done(&self, _units: u64) {}
    fn is_stopped(&self) -> bool {
        self.0.is_stopped()
    }
    fn sketch(&self, draw: &dyn Fn() -> Sketch) {
        self.0.sketch(draw);
    }
}

/// Progress that nobody watches.
pub struct Silent;

impl Progress for Silent {
    fn stage(&self, _name: &'static str, _total: u64) {}
    fn done(&self, _units: u64) {}
}
