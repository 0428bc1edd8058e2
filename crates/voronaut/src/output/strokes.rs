//! The edges of a mesh as lines whose width follows the local size, so that fine parts stay crisp.

use super::colours;
use super::frame::{Frame, PathData};
use crate::mesh::Mesh;
use crate::quality::Edges;
use std::fmt::Write;

/// The widest line of an inner edge, in pixels.
const WIDEST: f64 = 0.8;
/// Width of a line as a share of the height of the flatter triangle at the edge.
const SHARE: f64 = 0.085;
/// Line widths: each class is 1/sqrt 2 of the one before.
const CLASSES: usize = 11;
/// Width of boundary and interfaces, in pixels.
const BOUNDARY_WIDTH: f64 = 1.3;

/// One SVG path per class of line width: all edges between at least so many triangles; `heights` holds each triangle's
/// least height in pixels.
pub(super) fn edges_of(svg: &mut String, mesh: &Mesh, edges: &Edges, sides: usize, heights: &[f64], frame: &Frame) {
    let mut classes = vec![PathData::default(); CLASSES];
    for ([a, b], half_edges) in edges.iter().filter(|(_, half_edges)| half_edges.len() >= sides) {
        let height = half_edges.iter().map(|&(_, h)| heights[h as usize / 3]).fold(f64::INFINITY, f64::min);
        let class = (2.0 * (WIDEST / (SHARE * height)).log2()).round().clamp(0.0, (CLASSES - 1) as f64);
        classes[class as usize].polyline(&[a, b].map(|v| frame.place(mesh.point(v))), false);
    }
    let _ = writeln!(svg, r#"<g fill="none" stroke="{}" stroke-linecap="round">"#, colours::EDGE);
    for (class, path) in classes.iter().enumerate().filter(|(_, path)| !path.text().is_empty()) {
        let width = frame.quanta(WIDEST * 0.5_f64.powf(0.5 * class as f64));
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
