//! The edges of a mesh as lines whose width follows the local size, so that fine parts stay crisp.

use super::colours;
use super::frame::{Frame, PathData};
use std::fmt::Write;
use voronaut::mesh::Mesh;
use voronaut::quality::Edges;

/// How wide lines are that follow the local size.
#[derive(Clone, Copy)]
pub(super) struct Pen {
    /// The widest line, in pixels.
    pub(super) widest: f64,
    /// Width of a line as a share of the height of the flatter triangle at the edge.
    pub(super) share: f64,
    /// The thinnest line, in pixels.
    pub(super) thinnest: f64,
}

/// The lines of inner edges.
const INNER: Pen = Pen { widest: 0.8, share: 0.085, thinnest: 0.025 };
/// Width of boundary and interfaces, in pixels.
const BOUNDARY_WIDTH: f64 = 1.3;

/// One SVG path per class of line width: all edges between at least so many triangles; `heights` holds each triangle's
/// least height in pixels.
pub(super) fn edges_of(svg: &mut String, mesh: &Mesh, edges: &Edges, sides: usize, heights: &[f64], frame: &Frame) {
    let inner = edges.iter().filter(|(_, half_edges)| half_edges.len() >= sides);
    lines(svg, mesh, inner, INNER, colours::EDGE, heights, frame);
}

/// The same of some edges, by a pen and in a colour. Widths come in classes, each 1/sqrt 2 of the one before.
pub(super) fn lines<'a>(
    svg: &mut String,
    mesh: &Mesh,
    edges: impl Iterator<Item = ([u32; 2], &'a [(u64, u32)])>,
    pen: Pen,
    ink: &str,
    heights: &[f64],
    frame: &Frame,
) {
    let class_of = |width: f64| (2.0 * (pen.widest / width).log2()).round();
    let last = class_of(pen.thinnest);
    let mut classes = vec![PathData::default(); last as usize + 1];
    for ([a, b], half_edges) in edges {
        let height = half_edges.iter().map(|&(_, h)| heights[h as usize / 3]).fold(f64::INFINITY, f64::min);
        let class = class_of(pen.share * height).clamp(0.0, last);
        classes[class as usize].polyline(&[a, b].map(|v| frame.place(mesh.point(v))), false);
    }
    let _ = writeln!(svg, r#"<g fill="none" stroke="{ink}" stroke-linecap="round">"#);
    for (class, path) in classes.iter().enumerate().filter(|(_, path)| !path.text().is_empty()) {
        let width = frame.quanta(pen.widest * 0.5_f64.powf(0.5 * class as f64));
        let _ = writeln!(svg, r#"<path stroke-width="{width:.1}" d="{}"/>"#, path.text());
    }
    svg.push_str("</g>\n");
}

/// Boundary edges and labelled edges, stronger than the rest; thinner where the boundary itself is fine.
pub(super) fn boundary(svg: &mut String, mesh: &Mesh, edges: &Edges, frame: &Frame) {
    let labelled = mesh.edges.iter().copied().filter(|&[a, b]| edges.contains(a, b));
    let boundary = edges.boundary().into_iter().map(|h| edges.ends(h));
    let mut all: Vec<[u32; 2]> = boundary.chain(labelled).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    all.sort_unstable();
    all.dedup();
    let mut path = PathData::default();
    for [a, b] in all {
        path.polyline(&[a, b].map(|v| frame.place(mesh.point(v))), false);
    }
    let width = frame.quanta(BOUNDARY_WIDTH);
    let ink = colours::BOUNDARY;
    let style = r#"fill="none" stroke-linecap="round""#;
    let _ = writeln!(svg, r#"<path {style} stroke="{ink}" stroke-width="{width:.1}" d="{}"/>"#, path.text());
}
