//! The last pass: which edges the mesh has, by both roads, and how sure that is.

use super::MeshOptions;
use crate::canvas::CanvasFigures;
use crate::domain::Domain;
use crate::dual::{Consultation, Disagreement, Dual, Effort};
use crate::error::Result;
use crate::figures;
use crate::geodesic::Margin;
use crate::progress::Progress;
use crate::triangulation::VertexId;

/// Flips by the most careful tests, asks the diagram where the road says so, and tells what came of it.
///
/// # Errors
/// The canvas finds the metric invalid somewhere.
pub(super) fn settle(
    dual: &mut Dual,
    domain: &Domain,
    options: &MeshOptions,
    progress: &dyn Progress,
) -> Result<Settled> {
    progress.begin("settling edges", 1)?;
    dual.flip_all(Effort::Full);
    let found = dual.consult_diagram(options.dual, options.canvas, options.canvas_size, options.geodesic)?;
    let made = found.made;
    let canvas = made.map(|m| m.canvas);
    let diagram = made.map(|m| figures::Diagram {
        orphans: m.orphans,
        orphan_components: m.orphan_components,
        raw_nerve: None,
        counters: m.diagram,
    });
    Ok(Settled { dual: account(dual, domain, found), canvas, diagram })
}

/// What the report says of the last pass.
#[derive(Clone, Debug, Default)]
pub(super) struct Settled {
    pub(super) dual: figures::Dual,
    pub(super) canvas: Option<CanvasFigures>,
    pub(super) diagram: Option<figures::Diagram>,
}

fn account(dual: &mut Dual, domain: &Domain, found: Consultation) -> figures::Dual {
    let number = dual.numbering(domain);
    let ends = |edge: [VertexId; 2]| edge.map(|v| number[v.index()]);
    let disagreement = |d: Disagreement| figures::Disagreement {
        edge: ends(d.edge),
        instead: d.instead.map(ends),
        margin: d.margin.value,
        error: d.margin.error,
        settled_by: d.settled_by,
    };
    let uncertain = |(edge, Margin { value: margin, error }): ([VertexId; 2], Margin)| {
        let edge = ends(edge);
        figures::UncertainEdge { edge, margin, error }
    };
    figures::Dual {
        min_margin: dual.smallest_margin(Effort::Full).unwrap_or(0.0),
        blocked_flips: dual.blocked_flips(Effort::Full).len() + found.impossible.len(),
        geodesic_tests: dual.counters().tests.to_vec(),
        compared: found.compared,
        disagreements: found.disagreements.into_iter().map(disagreement).collect(),
        uncertain: found.uncertain.len(),
        uncertain_edges: found.uncertain.into_iter().map(uncertain).collect(),
        ..figures::Dual::default()
    }
}
