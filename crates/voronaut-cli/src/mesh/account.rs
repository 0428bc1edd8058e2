//! What is reported of any mesh that we made.

use serde_json::Value;
use voronaut::Error;
use voronaut::figures::NetFigures;
use voronaut::recipe::Meshed;
use voronaut_io::Report;

/// A mesh of ours that is not valid is our fault, not the user's.
pub(crate) fn ours(error: Error) -> Error {
    match error {
        Error::Mesh { what, place, .. } => {
            let help = "this is a fault of voronaut: nothing was written; please report it with the input";
            Error::Mesh { what, place, help: help.into() }
        }
        other => other,
    }
}

/// The parts of a report that are of the mesh alone, and the options as used.
pub(crate) fn fill_in(report: &mut Report, meshed: &Meshed, options: Value) {
    report.star_set = meshed.star_set;
    if meshed.star_set.is_none() {
        report.dual = Some(meshed.dual.clone());
        report.relaxation = Some(meshed.relaxation.clone());
        report.polished.clone_from(&meshed.polished);
    }
    report.canvas.clone_from(&meshed.canvas);
    report.diagram.clone_from(&meshed.diagram);
    report.metric_scale = Some(meshed.metric_scale);
    report.net = meshed.net.as_ref().map(NetFigures::of);
    report.protection = meshed.protection;
    report.notes.clone_from(&meshed.notes);
    report.options = options;
}
