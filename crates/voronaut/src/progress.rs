//! Progress of long work, told to whoever wants to show it. The library itself never prints.

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
}

/// Progress that nobody watches.
pub struct Silent;

impl Progress for Silent {
    fn stage(&self, _name: &'static str, _total: u64) {}
    fn done(&self, _units: u64) {}
}
