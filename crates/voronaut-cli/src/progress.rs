//! How far a run is: a progress bar on a terminal.

use crate::aside::say_aside;
use crate::options::Run;
use crate::watch;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::Instant;
use voronaut::progress::Progress;

/// Shows the current stage on stderr if that is a terminal; says each stage in a line of its own if verbose.
pub(crate) struct Bar {
    line: ProgressBar,
    verbose: bool,
    start: Instant,
}

impl Bar {
    pub(crate) fn new(run: &Run) -> Self {
        let shown = !run.quiet && std::io::stderr().is_terminal();
        let line = if shown { ProgressBar::new(0) } else { ProgressBar::hidden() };
        if let Ok(style) = ProgressStyle::with_template("{msg:<16} {bar:40} {percent:>3} %  {elapsed}") {
            line.set_style(style.progress_chars("━╸ "));
        }
        Self { line, verbose: run.verbose, start: Instant::now() }
    }
}

impl Progress for Bar {
    fn stage(&self, name: &'static str, total: u64) {
        watch::stage(name, total);
        self.line.set_length(total);
        self.line.set_position(0);
        self.line.set_message(name);
        if self.verbose {
            self.line.suspend(|| say_aside(&format!("{name} ({total})")));
        }
    }

    fn done(&self, units: u64) {
        watch::done(units);
        self.line.inc(units);
    }

    fn seconds(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.line.finish_and_clear();
    }
}
