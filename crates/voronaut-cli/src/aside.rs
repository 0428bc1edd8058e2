//! What is said beside the output.

use std::io::Write;

/// Says a line on stderr. Who has closed it does not hear it: that must not keep a run from its end.
pub(crate) fn say_aside(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
