//! Lines whose width follows the local size, so that fine parts stay crisp; of the edges of a mesh, and of its boundary.

use super::colours;
use super::curves::Curves;
use super::frame::{Frame, PathData};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use voronaut::geometry::Point;
use voronaut::mesh::{EdgeSide, Edges, Mesh};

/// Attributes of lines that are round where they turn, and there and at their ends.
pub(super) const ROUND_JOINS: &str = r#" stroke-linejoin="round""#;
pub(super) const ROUND: &str = r#" stroke-linejoin="round" stroke-linecap="round""#;

/// How wide lines are that follow the local size. Widths come in classes, each 1/sqrt 2 of the one before.
#[derive(Clone, Copy)]
pub(super) struct Pen {
    /// The widest line, in pixels.
    pub(super) widest: f64,
    /// Width of a line as a share of the thickness of what it bounds.
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

/// A mesh on paper.
pub(super) struct Sheet<'a> {
    pub(super) mesh: &'a Mesh,
    /// Of the triangles that are drawn.
    pub(super) edges: &'a Edges<'a>,
    /// The least height of each of these triangles, in pixels.
    pub(super) heights: &'a [f64],
    pub(super) frame: &'a Frame,
    pub(super) curves: &'a Curves,
}

impl Sheet<'_> {
    /// One SVG path per class of line width: all edges between at least so many triangles.
    pub(super) fn edges_of(&self, svg: &mut String, sides: usize) {
        let inner = self.edges.iter().filter(|edge| edge.len() >= sides);
        self.lines(svg, inner, INNER, colours::EDGE);
    }

    /// The same of some edges, by a pen, for the height of the flatter triangle at each, and in a colour.
    pub(super) fn lines(&self, svg: &mut String, edges: impl Iterator<Item: AsRef<[EdgeSide]>>, pen: Pen, ink: &str) {
        let mut classes: BTreeMap<usize, PathData> = BTreeMap::new();
        for edge in edges {
            let sides = edge.as_ref();
            let heights = sides.iter().map(|side| self.heights[side.triangle()]);
            let path = classes.entry(pen.class(heights.fold(f64::INFINITY, f64::min))).or_default();
            self.trace(path, &sides[0].ends, false);
        }
        pen.draw(svg, &classes, ink, self.frame);
    }

    /// Boundary edges and labelled edges, stronger than the rest.
    pub(super) fn boundary(&self, svg: &mut String) {
        let labelled = self.mesh.edges.iter().copied().filter(|&ends| !self.edges.at(ends).is_empty());
        let boundary = self.edges.boundary().map(|side| side.ends);
        let all: BTreeSet<[u32; 2]> = boundary.chain(labelled).map(|[a, b]| [a.min(b), a.max(b)]).collect();
        let mut path = PathData::default();
        for ends in all {
            self.trace(&mut path, &ends, false);
        }
        let (ink, width) = (colours::BOUNDARY, self.frame.quanta(BOUNDARY_WIDTH));
        path.draw(svg, &format!(r#"fill="none" stroke-linecap="round" stroke="{ink}" stroke-width="{width:.1}""#));
    }

    /// Adds the edges between vertices to a path, all around a triangle if it is closed.
    pub(super) fn trace(&self, path: &mut PathData, vertices: &[u32], is_closed: bool) {
        let place = |v: u32| self.frame.place(self.mesh.point(v));
        if self.mesh.curved.is_none() {
            let points: Vec<[i64; 2]> = vertices.iter().map(|&v| place(v)).collect();
            return path.polyline(&points, is_closed);
        }
        let edges = if is_closed { vertices.len() } else { vertices.len() - 1 };
        let curve = |i: usize| {
            let ends = [vertices[i], vertices[(i + 1) % vertices.len()]];
            let controls = self.curves.between(ends).into_iter().map(|p| self.frame.place(Point::new(p.x, p.y)));
            controls.chain([place(ends[1])]).collect()
        };
        path.curves(place(vertices[0]), &(0..edges).map(curve).collect::<Vec<_>>(), is_closed);
    }
}
