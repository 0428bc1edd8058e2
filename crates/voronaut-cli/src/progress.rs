//! A progress bar on a terminal.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use voronaut::progress::Progress;

/// Shows the current stage on stderr if that is a terminal; says each stage in a line of its own if verbose.
pub(crate) struct Bar {
    bar: ProgressBar,
    verbose: bool,
}

impl Bar {
    pub(crate) fn new(quiet: bool, verbose: bool) -> Self {
        let shown = !quiet && std::io::stderr().is_terminal();
        let bar = if shown { ProgressBar::new(0) } else { ProgressBar::hidden() };
        if let Ok(style) = ProgressStyle::with_template("{msg:<16} {bar:40} {percent:>3} %  {elapsed}") {
            bar.set_style(style.progress_chars("━╸ "));
        }
        Self { bar, verbose }
    }
}

impl Progress for Bar {
    fn stage(&self, name: &'static str, total: u64) {
        self.bar.set_length(total);
        self.bar.set_position(0);
        self.bar.set_message(name);
        if self.verbose {
            self.bar.suspend(|| eprintln!("{name} ({total})"));
        }
    }

    fn done(&self, units: u64) {
        self.bar.inc(units);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
