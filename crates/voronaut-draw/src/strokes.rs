//! Lines whose width follows the local size, so that fine parts stay crisp; of the edges of a mesh, and of its boundary.

use super::colours;
use super::frame::{Frame, PathData};
use std::collections::BTreeMap;
use std::fmt::Write;
use voronaut::mesh::Mesh;
use voronaut::quality::Edges;

/// Attributes of lines that are round where they turn, and there and at their ends.
pub(super) const ROUND_JOINS: &str = r#" stroke-linejoin="round""#;
pub(super) const ROUND: &str = r#" stroke-linejoin="round" stroke-linecap="round""#;

/// How wide lines are that follow the local size. Widths come in classes, each 1/sqrt 2 of the one before.
#[derive(Clone, Copy)]
pub(super) struct Pen {
    /// The widest line, in pixels.
    pub(super) widest: f64,
    /// Width of a line as a share of how thick it is what it bounds.
    pub(super) share: f64,
    /// The thinnest line, in pixels.
    pub(super) thinnest: f64,
}

/// The lines of inner edges.
const INNER: Pen = Pen { widest: 0.8, share: 0.085, thinnest: 0.025 };
/// Width of boundary and interfaces, in pixels.
const BOUNDARY_WIDTH: f64 = 1.3;

impl Pen {
    /// The class of a line that bounds what is so many pixels thick.
    pub(super) fn class(self, thickness: f64) -> usize {
        let class = |width: f64| (2.0 * (self.widest / width).log2()).round();
        class(self.share * thickness).clamp(0.0, class(self.thinnest)) as usize
    }

    /// The width of a class, in pixels.
    pub(super) fn width(self, class: usize) -> f64 {
        self.widest * 0.5_f64.powf(0.5 * class as f64)
    }

    /// Draws paths by their classes.
    pub(super) fn draw(self, svg: &mut String, classes: &BTreeMap<usize, PathData>, ink: &str, frame: &Frame) {
        let _ = writeln!(svg, r#"<g fill="none" stroke="{ink}" stroke-linecap="round">"#);
        for (&class, path) in classes {
            path.draw(svg, &format!(r#"stroke-width="{:.1}""#, frame.quanta(self.width(class))));
        }
        svg.push_str("</g>\n");
    }
}

/// One SVG path per class of line width: all edges between at least so many triangles; `heights` holds each triangle's
/// least height in pixels.
pub(super) fn edges_of(svg: &mut String, mesh: &Mesh, edges: &Edges, sides: usize, heights: &[f64], frame: &Frame) {
    let inner = edges.iter().filter(|(_, half_edges)| half_edges.len() >= sides);
    lines(svg, mesh, inner, INNER, colours::EDGE, heights, frame);
}

/// The same of some edges, by a pen, for the height of the flatter triangle at each, and in a colour.
pub(super) fn lines<'a>(
    svg: &mut String,
    mesh: &Mesh,
    edges: impl Iterator<Item = ([u32; 2], &'a [(u64, u32)])>,
    pen: Pen,
    ink: &str,
    heights: &[f64],
    frame: &Frame,
) {
    let mut classes: BTreeMap<usize, PathData> = BTreeMap::new();
    for (ends, half_edges) in edges {
        let height = half_edges.iter().map(|&(_, h)| heights[h as usize / 3]).fold(f64::INFINITY, f64::min);
        let path = classes.entry(pen.class(height)).or_default();
        path.polyline(&ends.map(|v| frame.place(mesh.point(v))), false);
    }
    pen.draw(svg, &classes, ink, frame);
}

/// Boundary edges and labelled edges, stronger than the rest; thinner where the boundary itself is fine.
pub(super) fn boundary(svg: &mut String, mesh: &Mesh, edges: &Edges, frame: &Frame) {
    let labelled = mesh.edges.iter().copied().filter(|&[a, b]| edges.contains(a, b));
    let boundary = edges.boundary().into_iter().map(|h| edges.ends(h));
    let mut all: Vec<[u32; 2]> = boundary.chain(labelled).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    all.sort_unstable();
    all.dedup();
    let mut path = PathData::default();
    for ends in all {
        path.polyline(&ends.map(|v| frame.place(mesh.point(v))), false);
    }
    let (ink, width) = (colours::BOUNDARY, frame.quanta(BOUNDARY_WIDTH));
    path.draw(svg, &format!(r#"fill="none" stroke-linecap="round" stroke="{ink}" stroke-width="{width:.1}""#));
}
