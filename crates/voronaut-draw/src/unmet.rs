//! The edges that are not of unit length, over a mesh, and a legend of their causes.

use super::frame::{Frame, PathData};
use super::strokes::{Pen, Sheet};
use super::{colours, letters};
use std::fmt::Write;
use voronaut::quality::{Cause, CauseFigures, Unmet};

/// Edges of a cause: wider than those of the mesh, and never too thin to be seen; those of the boundary wider than that, too.
/// In pixels.
const PEN: Pen = Pen { widest: 2.4, share: 0.26, thinnest: 0.55 };
const KEPT_PEN: Pen = Pen { widest: 3.4, share: 0.3, thinnest: 2.4 };
/// The legend, as shares of the picture's width: a unit of its letters, a row, all of it.
const UNIT: f64 = 0.0014;
const ROW: f64 = 0.0185;
const LEGEND: f64 = 0.083;
/// What begins at its columns, in shares of the width: margin, and the distance from one to the next.
const COLUMNS: [f64; 2] = [0.02, 0.245];
/// How opaque the mesh is under these edges.
pub(super) const PALE: f64 = 0.3;

/// Edges by cause, the too long ones light, the too short ones, which are small, dark and over them.
pub(super) fn edges(svg: &mut String, sheet: &Sheet, unmet: &Unmet) {
    for is_short in [false, true] {
        for cause in Cause::ALL {
            let found = unmet.edges.iter().filter(|edge| edge.cause == cause && edge.is_short() == is_short);
            let sides = found.map(|edge| sheet.edges.at(edge.edge)).filter(|sides| !sides.is_empty());
            let ink = colours::cause(cause as usize, is_short);
            let pen = if cause == Cause::Boundary { KEPT_PEN } else { PEN };
            sheet.lines(svg, sides, pen, &ink);
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
    let unit = UNIT * width;
    let place = |column: usize, row: usize| {
        [(COLUMNS[0] + COLUMNS[1] * column as f64) * width, top + (0.65 + row as f64) * ROW * width]
    };
    // A window shows a part only: what lies below it is covered.
    let [y, w, h] = [top, width, legend_height(frame)].map(|pixels| frame.quanta(pixels).round());
    let _ = writeln!(svg, "<rect y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>");
    let figures = unmet.figures();
    let mut words = PathData::default();
    let title = format!("{:.1} % of all edges are not of unit length in the metric", 100.0 * figures.share);
    letters::write(&mut words, &title, place(0, 0), unit, frame);
    for (column, (cause, found)) in figures.by_cause.into_iter().enumerate() {
        letters::write(&mut words, &format!("{}:", cause.name()), place(column, 1), unit, frame);
        for (row, is_short) in [(2, true), (3, false)] {
            let [x, y] = place(column, row);
            let swatch = [x, x + 12.0 * unit].map(|x| frame.quanta_at([x, y - 2.0 * unit]));
            PathData::of([swatch], false)
                .draw(svg, &frame.paint(["none", &colours::cause(cause as usize, is_short)], 2.4 * unit));
            let (count, what) = if is_short { (found.short, "too short") } else { (found.long, "too long") };
            let says = format!("{:.1} % {what}", 100.0 * share_of(count, found));
            letters::write(&mut words, &says, [x + 16.0 * unit, y], unit, frame);
        }
    }
    let (ink, thick) = (colours::TEXT, frame.quanta(0.75 * unit));
    let style = r#"fill="none" stroke-linecap="round" stroke-linejoin="round""#;
    words.draw(svg, &format!(r#"{style} stroke="{ink}" stroke-width="{thick:.1}""#));
}

/// A count of a cause's edges as a share of all edges of the mesh.
fn share_of(count: usize, found: CauseFigures) -> f64 {
    if found.count > 0 { found.share * count as f64 / found.count as f64 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::super::{Layers, Picture, svg_with};
    use super::*;
    use crate::test_meshes::grid;
    use voronaut::geometry::{Point, Tensor};
    use voronaut::quality::{UnmetEdge, unmet};

    /// How many paths have the colour of each cause, for what is too short and too long: one is the legend's.
    fn paths(found: &Unmet) -> [[usize; 2]; 4] {
        let layers = Layers { unmet: Some(found.clone()), ..Layers::default() };
        let text = svg_with(&grid(4, 4), None, &Picture::default(), &layers).unwrap();
        assert!(text.ends_with("</svg>\n") && !text.contains("NaN"));
        let group = |cause: usize, is_short: bool| {
            let start = format!("<g fill=\"none\" stroke=\"{}\"", colours::cause(cause, is_short));
            text.split(&start).skip(1).map(|rest| rest.split("</g>").next().unwrap().matches("<path").count()).sum()
        };
        [0, 1, 2, 3].map(|cause| [true, false].map(|is_short| group(cause, is_short)))
    }

    #[test]
    fn edges_have_the_colour_of_their_cause() {
        let none = Unmet::default();
        assert_eq!(paths(&none), [[0; 2]; 4]);
        let fine = unmet(&grid(4, 4), &|_: Point| Tensor::isotropic(0.5), |_| ()).unwrap();
        assert_eq!(paths(&fine), [[0, 0], [0, 1], [0, 0], [0, 0]]);
        let mut one = fine.clone();
        one.edges.truncate(1);
        one.edges[0] = UnmetEdge { cause: Cause::Turning, length: 0.1, ..one.edges[0] };
        assert_eq!(paths(&one), [[0, 0], [0, 0], [1, 0], [0, 0]]);
        // No edge of this mesh.
        one.edges[0].edge = [0, 99];
        assert_eq!(paths(&one), [[0; 2]; 4]);
    }
}
