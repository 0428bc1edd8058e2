//! Cells of a diagram, their witnesses, and geodesics between seeds.

use super::colours::{self, Tint};
use super::frame::{Frame, PathData};
use super::palette;
use super::shades::{Protection, in_order};
use super::simplify::simplify;
use super::strokes::{Pen, ROUND, ROUND_JOINS};
use std::collections::BTreeMap;
use voronaut::diagram::{Cells, Outline};
use voronaut::geometry::Point;
use voronaut::quality::Unmet;

/// Lines are straightened by at most so many pixels.
const TOLERANCE: f64 = 0.12;
/// The lines between cells and the dots at seeds, by the cell's thickness.
const BORDER: Pen = Pen { widest: 1.1, share: 0.09, thinnest: 1.1 / 64.0 };
const DOT: Pen = Pen { widest: 4.2, share: 0.34, thinnest: 4.2 / 64.0 };

/// What of a diagram a picture shows besides a mesh.
#[derive(Clone, Debug, Default)]
pub struct Layers {
    /// Cells, as filled regions under everything else, with dots at the seeds; orphans in red over paler ones.
    pub cells: Option<Cells>,
    /// Canvas faces that witness Voronoi vertices (red) and Voronoi edges (grey); cells are paler then.
    pub witnesses: Option<[Vec<[Point; 3]>; 2]>,
    /// Polylines drawn over the cells, such as the geodesic edges of the dual.
    pub geodesics: Vec<Vec<Point>>,
    /// Triangles by their power protection, instead of their size.
    pub protection: Option<Protection>,
    /// Triangles by a value at the mesh's points, from strong (the least) to pale, instead of their size.
    pub values: Option<Vec<f64>>,
    /// Fainter polylines under those, such as lines of equal barycentric coordinates in Riemannian triangles.
    pub grids: Vec<Vec<Point>>,
    /// Cells by a factor, 1 where conditions just hold, instead of colours that differ; those without one are grey.
    pub factors: Option<BTreeMap<u32, f64>>,
    /// The edges that are not of unit length by cause, over a paler mesh, with a legend below it.
    pub unmet: Option<Unmet>,
}

/// The cells, coloured so that neighbours differ: one SVG path per colour and width of line.
pub(super) fn cells(svg: &mut String, cells: &Cells, frame: &Frame, tint: Tint) {
    let hues = palette::colour(cells.outlines.len(), &cells.neighbours, colours::HUES, colours::likeness);
    let ink = if tint == Tint::Pale { colours::PALE_BORDER } else { colours::CELL_BORDER };
    svg.push_str("<g stroke-linejoin=\"round\">\n");
    for ((class, (hue, shade)), path) in regions(cells, frame, |i| (hues[i], shade(i))) {
        path.draw(svg, &frame.paint([&colours::cell(hue, shade, tint), ink], BORDER.width(class)));
    }
    svg.push_str("</g>\n");
    // Orphans over the cells, so that even the smallest is seen.
    let orphans = cells.outlines.iter().flatten().filter(|outline| outline.is_orphan);
    let path = PathData::of(orphans.map(|orphan| place(&orphan.points, &orphan.corners, true, frame)), true);
    if !path.text().is_empty() {
        path.draw(svg, &(frame.paint(colours::ORPHAN, 0.5) + ROUND_JOINS));
    }
}

/// The cells by the factors that they have: one SVG path per colour and width of line.
pub(super) fn factors(svg: &mut String, cells: &Cells, factors: &BTreeMap<u32, f64>, frame: &Frame) {
    let fill = |i: usize| colours::factor_fill(factors.get(&(i as u32)).copied().unwrap_or(f64::NAN));
    for ((class, fill), path) in regions(cells, frame, fill) {
        path.draw(svg, &(frame.paint([&fill, colours::CELL_BORDER], BORDER.width(class)) + ROUND_JOINS));
    }
}

/// The cells by the width of the lines around them and by a key, in the order in which they are drawn: fine ones last, for the wide
/// lines of coarse ones would cover them.
fn regions<K: Ord>(cells: &Cells, frame: &Frame, key: impl Fn(usize) -> K) -> BTreeMap<(usize, K), PathData> {
    let mut paths: BTreeMap<(usize, K), PathData> = BTreeMap::new();
    for (i, outlines) in cells.outlines.iter().enumerate() {
        let path = paths.entry((BORDER.class(thickness(outlines, frame)), key(i))).or_default();
        for outline in outlines {
            path.polyline(&place(&outline.points, &outline.corners, true, frame), true);
        }
    }
    paths
}

/// A dot at each seed, smaller in thin cells.
pub(super) fn seeds(svg: &mut String, cells: &Cells, frame: &Frame) {
    let mut classes: BTreeMap<usize, PathData> = BTreeMap::new();
    for (outlines, seed) in cells.outlines.iter().zip(&cells.seeds) {
        if let (Some(seed), false) = (seed, outlines.is_empty()) {
            classes.entry(DOT.class(thickness(outlines, frame))).or_default().dot(frame.place(*seed));
        }
    }
    DOT.draw(svg, &classes, colours::SEED, frame);
}

/// Canvas faces: those that witness Voronoi edges in grey, those that witness Voronoi vertices in red, over them.
pub(super) fn witnesses(svg: &mut String, [vertices, edges]: &[Vec<[Point; 3]>; 2], frame: &Frame) {
    for (faces, paint) in [(edges, colours::EDGE_WITNESS), (vertices, colours::VERTEX_WITNESS)] {
        let path = PathData::of(faces.iter().map(|face| face.map(|p| frame.place(p))), true);
        path.draw(svg, &(frame.paint(paint, 0.35) + ROUND_JOINS));
    }
}

/// Polylines over the cells, geodesics over fainter ones, as wide as typical cells of this thickness (pixels) bear.
pub(super) fn polylines(svg: &mut String, layers: &Layers, thickness: f64, frame: &Frame) {
    let grids = (&layers.grids, (0.05 * thickness).clamp(0.1, 0.6), colours::GRID);
    let geodesics = (&layers.geodesics, (0.12 * thickness).clamp(0.25, 1.3), colours::GEODESIC);
    for (lines, width, ink) in [grids, geodesics].into_iter().filter(|(lines, ..)| !lines.is_empty()) {
        let path = PathData::of(lines.iter().map(|line| place(line, &[], false, frame)), false);
        path.draw(svg, &(frame.paint(["none", ink], width) + ROUND));
    }
}

/// The border of the domain and its features.
pub(super) fn border(svg: &mut String, cells: &Cells, frame: &Frame) {
    let mut path = PathData::of(cells.border.iter().map(|line| place(line, &[], true, frame)), true);
    for piece in &cells.features {
        path.polyline(&piece.map(|p| frame.place(p)), false);
    }
    path.draw(svg, &(frame.paint(["none", colours::BOUNDARY], 1.3) + ROUND));
}

/// How thick a cell is, in pixels: twice its area by half its circumference, the height of a long rectangle.
fn thickness(outlines: &[Outline], frame: &Frame) -> f64 {
    let (mut area, mut length) = (0.0, 0.0);
    for outline in outlines {
        let next = outline.points.iter().cycle().skip(1);
        for (p, q) in outline.points.iter().zip(next) {
            area += 0.5 * (p.x * q.y - q.x * p.y);
            length += p.distance(*q);
        }
    }
    if length > 0.0 { frame.pixels(2.0 * area.max(0.0) / length) } else { 0.0 }
}

/// The thickness that half of the cells reach, and that which one in fifty does not, in pixels.
pub(super) fn typical(cells: &Cells, frame: &Frame) -> [f64; 2] {
    let all = in_order(cells.outlines.iter().filter(|c| !c.is_empty()).map(|c| thickness(c, frame)));
    [2, 50].map(|part| all.get(all.len() / part).copied().unwrap_or(1.0))
}

/// A little variation within a hue, the same for a seed at every run.
fn shade(i: usize) -> usize {
    (0.618_034 * i as f64 * colours::SHADES as f64) as usize % colours::SHADES
}

fn place(points: &[Point], corners: &[u32], is_closed: bool, frame: &Frame) -> Vec<[i64; 2]> {
    let placed: Vec<[i64; 2]> = points.iter().map(|&p| frame.place(p)).collect();
    simplify(&placed, corners, is_closed, frame.quanta(TOLERANCE))
}
