//! The edges that are not of unit length, over a mesh, and a legend of their causes.

use super::frame::{Frame, PathData};
use super::strokes::{self, Pen};
use super::{colours, letters};
use crate::mesh::Mesh;
use crate::quality::{Cause, CauseFigures, Edges, Unmet};
use std::fmt::Write;

/// Edges of a cause: wider than those of the mesh, and never too thin to be seen. In pixels.
const PEN: Pen = Pen { widest: 2.4, share: 0.26, thinnest: 0.55 };
/// Height of the legend, and of a unit of its letters, as shares of the picture's width.
const LEGEND: f64 = 0.075;
const UNIT: f64 = 0.0011;
/// How opaque the mesh is under these edges.
pub(super) const PALE: f64 = 0.3;

/// Edges by cause, the too long ones light, the too short ones, which are small, dark and over them; `heights` holds each
/// triangle's least height in pixels.
pub(super) fn edges(svg: &mut String, mesh: &Mesh, edges: &Edges, unmet: &Unmet, heights: &[f64], frame: &Frame) {
    let all: Vec<_> = edges.iter().collect();
    for is_short in [false, true] {
        for cause in Cause::ALL {
            let found = unmet.edges.iter().filter(|edge| edge.cause == cause && edge.is_short() == is_short);
            let found = found.filter_map(|edge| all.binary_search_by_key(&edge.edge, |(ends, _)| *ends).ok());
            let ink = colours::cause(cause as usize, is_short);
            strokes::lines(svg, mesh, found.map(|i| all[i]), PEN, &ink, heights, frame);
        }
    }
}

/// How high the legend is, in pixels: it is drawn below a frame.
pub(super) fn legend_height(frame: &Frame) -> f64 {
    (LEGEND * frame.size()[0]).ceil()
}

/// The causes with their colours and shares, under the picture.
pub(super) fn legend(svg: &mut String, unmet: &Unmet, frame: &Frame) {
    let [width, top] = frame.size();
    let (unit, row) = (UNIT * width, LEGEND * width / 3.3);
    let figures = unmet.figures();
    let mut words = PathData::default();
    let title = format!("{:.1} % of all edges are not of unit length", 100.0 * figures.share);
    letters::write(&mut words, &title, [0.02 * width, top + 0.55 * row], unit, frame);
    for (column, (cause, found)) in figures.by_cause.into_iter().enumerate() {
        let left = (0.02 + 0.245 * column as f64) * width;
        let rows = [("too short", found.short, true), ("too long", found.long, false)];
        let share = 100.0 * found.share;
        letters::write(&mut words, &format!("{}: {share:.1} %", cause.name()), [left, top + 1.4 * row], unit, frame);
        let mut at = left;
        for (what, count, is_short) in rows {
            let share = 100.0 * share_of(count, found);
            let y = top + 2.3 * row;
            let swatch = [[at, y - 2.0 * unit], [at + 14.0 * unit, y - 2.0 * unit]].map(|p| frame.quanta_at(p));
            let mut line = PathData::default();
            line.polyline(&swatch, false);
            let (ink, thick) = (colours::cause(cause as usize, is_short), frame.quanta(2.6 * unit));
            let _ = writeln!(svg, r#"<path fill="none" stroke="{ink}" stroke-width="{thick:.1}" d="{}"/>"#, line.text());
            let says = format!("{share:.1} % {what}");
            letters::write(&mut words, &says, [at + 17.0 * unit, y], unit, frame);
            at += 0.12 * width;
        }
    }
    let (ink, thick) = (colours::TEXT, frame.quanta(0.75 * unit));
    let style = r#"fill="none" stroke-linecap="round" stroke-linejoin="round""#;
    let _ = writeln!(svg, r#"<path {style} stroke="{ink}" stroke-width="{thick:.1}" d="{}"/>"#, words.text());
}

/// A count of a cause's edges as a share of all edges of the mesh.
fn share_of(count: usize, found: CauseFigures) -> f64 {
    if found.count > 0 { found.share * count as f64 / found.count as f64 } else { 0.0 }
}
