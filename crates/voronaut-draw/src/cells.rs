//! Cells of a diagram, their witnesses, and geodesics between seeds.

use super::colours::{self, Cell, Tint};
use super::frame::{Frame, PathData};
use super::palette;
use super::protection::Protection;
use super::simplify::simplify;
use std::collections::BTreeMap;
use std::fmt::Write;
use voronaut::diagram::{Cells, Outline};
use voronaut::geometry::Point;
use voronaut::quality::Unmet;

/// Lines are straightened by at most so many pixels.
const TOLERANCE: f64 = 0.12;
/// Width of the lines between cells, as a share of the cell's thickness, and at most, in pixels.
const BORDER_SHARE: f64 = 0.09;
const WIDEST_BORDER: f64 = 1.1;
/// Diameter of the dots at seeds, likewise.
const DOT_SHARE: f64 = 0.34;
const WIDEST_DOT: f64 = 4.2;
/// Classes of width: each is 1/sqrt 2 of the one before.
const CLASSES: usize = 13;

/// What of a diagram a picture shows besides a mesh.
#[derive(Clone, Copy, Debug, Default)]
pub struct Layers<'a> {
    /// Cells, as filled regions under everything else, with dots at the seeds; orphans in red over paler ones.
    pub cells: Option<&'a Cells>,
    /// Canvas faces that witness Voronoi vertices (red) and Voronoi edges (grey); cells are paler then.
    pub witnesses: Option<[&'a [[Point; 3]]; 2]>,
    /// Polylines drawn over the cells, such as the geodesic edges of the dual.
    pub geodesics: &'a [Vec<Point>],
    /// Triangles by their power protection, instead of their size.
    pub protection: Option<&'a Protection>,
    /// Triangles by a value at the mesh's points, from strong (the least) to pale, instead of their size.
    pub values: Option<&'a [f64]>,
    /// Fainter polylines under those, such as lines of equal barycentric coordinates in Riemannian triangles.
    pub grids: &'a [Vec<Point>],
    /// Cells by a factor, 1 where conditions just hold, instead of colours that differ; those without one are grey.
    pub factors: Option<&'a BTreeMap<u32, f64>>,
    /// The edges that are not of unit length by cause, over a paler mesh, with a legend below it.
    pub unmet: Option<&'a Unmet>,
}

/// The cells, coloured so that neighbours differ: one SVG path per colour and width of line.
pub(super) fn cells(svg: &mut String, cells: &Cells, frame: &Frame, tint: Tint) {
    let hues = palette::colour(cells.outlines.len(), &cells.neighbours, Cell::HUES, Cell::likeness);
    let mut paths: BTreeMap<(usize, usize, usize), PathData> = BTreeMap::new();
    for (i, outlines) in cells.outlines.iter().enumerate() {
        let width = class(WIDEST_BORDER, BORDER_SHARE * thickness(outlines, frame));
        let path = paths.entry((width, hues[i], shade(i))).or_default();
        for outline in outlines {
            path.polyline(&place(&outline.points, &outline.corners, true, frame), true);
        }
    }
    svg.push_str("<g stroke-linejoin=\"round\">\n");
    // Fine cells last: the wide lines of coarse ones would cover them.
    for ((class, hue, shade), path) in paths {
        let fill = Cell { hue, shade, tint }.fill();
        let width = frame.quanta(width(WIDEST_BORDER, class));
        let ink = if tint == Tint::Pale { colours::PALE_BORDER } else { colours::CELL_BORDER };
        let _ = writeln!(svg, r#"<path fill="{fill}" stroke="{ink}" stroke-width="{width:.1}" d="{}"/>"#, path.text());
    }
    svg.push_str("</g>\n");
    orphans(svg, cells, frame);
}

/// Orphans over the cells, so that even the smallest is seen.
fn orphans(svg: &mut String, cells: &Cells, frame: &Frame) {
    let mut path = PathData::default();
    for outline in cells.outlines.iter().flatten().filter(|outline| outline.is_orphan) {
        path.polyline(&place(&outline.points, &outline.corners, true, frame), true);
    }
    if !path.text().is_empty() {
        let ([fill, ink], width) = (colours::ORPHAN, frame.quanta(0.5));
        let style = format!(r#"fill="{fill}" stroke="{ink}" stroke-width="{width:.1}" stroke-linejoin="round""#);
        let _ = writeln!(svg, r#"<path {style} d="{}"/>"#, path.text());
    }
}

/// The cells by the factors that they have: one SVG path per colour and width of line.
pub(super) fn factors(svg: &mut String, cells: &Cells, factors: &BTreeMap<u32, f64>, frame: &Frame) {
    let mut paths: BTreeMap<(usize, String), PathData> = BTreeMap::new();
    for (i, outlines) in cells.outlines.iter().enumerate() {
        let width = class(WIDEST_BORDER, BORDER_SHARE * thickness(outlines, frame));
        let fill = colours::factor_fill(factors.get(&(i as u32)).copied().unwrap_or(f64::NAN));
        let path = paths.entry((width, fill)).or_default();
        for outline in outlines {
            path.polyline(&place(&outline.points, &outline.corners, true, frame), true);
        }
    }
    for ((class, fill), path) in paths {
        let (ink, width) = (colours::CELL_BORDER, frame.quanta(width(WIDEST_BORDER, class)));
        let style = format!(r#"fill="{fill}" stroke="{ink}" stroke-width="{width:.1}" stroke-linejoin="round""#);
        let _ = writeln!(svg, r#"<path {style} d="{}"/>"#, path.text());
    }
}

/// A dot at each seed, smaller in thin cells.
pub(super) fn seeds(svg: &mut String, cells: &Cells, frame: &Frame) {
    let mut paths = vec![PathData::default(); CLASSES];
    for (outlines, seed) in cells.outlines.iter().zip(&cells.seeds) {
        if let (Some(seed), false) = (seed, outlines.is_empty()) {
            paths[class(WIDEST_DOT, DOT_SHARE * thickness(outlines, frame))].dot(frame.place(*seed));
        }
    }
    strokes(svg, &paths, WIDEST_DOT, colours::SEED, frame);
}

/// Canvas faces: those that witness Voronoi edges in grey, those that witness Voronoi vertices in red, over them.
pub(super) fn witnesses(svg: &mut String, [vertices, edges]: [&[[Point; 3]]; 2], frame: &Frame) {
    for (faces, [fill, ink]) in [(edges, colours::EDGE_WITNESS), (vertices, colours::VERTEX_WITNESS)] {
        let mut path = PathData::default();
        for face in faces {
            path.polyline(&face.map(|p| frame.place(p)), true);
        }
        let width = frame.quanta(0.35);
        let style = format!(r#"fill="{fill}" stroke="{ink}" stroke-width="{width:.1}" stroke-linejoin="round""#);
        let _ = writeln!(svg, r#"<path {style} d="{}"/>"#, path.text());
    }
}

/// Polylines over the cells, as wide as typical cells of this thickness (pixels) bear.
pub(super) fn geodesics(svg: &mut String, lines: &[Vec<Point>], thickness: f64, frame: &Frame) {
    polylines(svg, lines, ((0.12 * thickness).clamp(0.25, 1.3), colours::GEODESIC), frame);
}

/// Polylines under geodesics, fainter than they.
pub(super) fn grids(svg: &mut String, lines: &[Vec<Point>], thickness: f64, frame: &Frame) {
    polylines(svg, lines, ((0.05 * thickness).clamp(0.1, 0.6), colours::GRID), frame);
}

fn polylines(svg: &mut String, lines: &[Vec<Point>], (width, ink): (f64, &str), frame: &Frame) {
    let mut path = PathData::default();
    for line in lines {
        path.polyline(&place(line, &[], false, frame), false);
    }
    let width = frame.quanta(width);
    let style = format!(r#"fill="none" stroke="{ink}" stroke-width="{width:.1}""#);
    let _ = writeln!(svg, r#"<path {style} stroke-linejoin="round" stroke-linecap="round" d="{}"/>"#, path.text());
}

/// The border of the domain and its features.
pub(super) fn border(svg: &mut String, cells: &Cells, frame: &Frame) {
    let mut path = PathData::default();
    for line in &cells.border {
        path.polyline(&place(line, &[], true, frame), true);
    }
    for piece in &cells.features {
        path.polyline(&piece.map(|p| frame.place(p)), false);
    }
    let (ink, width) = (colours::BOUNDARY, frame.quanta(1.3));
    let style = format!(r#"fill="none" stroke="{ink}" stroke-width="{width:.1}""#);
    let _ = writeln!(svg, r#"<path {style} stroke-linejoin="round" stroke-linecap="round" d="{}"/>"#, path.text());
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
    let mut all: Vec<f64> = cells.outlines.iter().filter(|c| !c.is_empty()).map(|c| thickness(c, frame)).collect();
    all.sort_unstable_by(f64::total_cmp);
    [2, 50].map(|part| all.get(all.len() / part).copied().unwrap_or(1.0))
}

/// A little variation within a hue, the same for a seed at every run.
fn shade(i: usize) -> usize {
    (0.618_034 * i as f64 * Cell::SHADES as f64) as usize % Cell::SHADES
}

fn class(widest: f64, wanted: f64) -> usize {
    (2.0 * (widest / wanted).log2()).round().clamp(0.0, (CLASSES - 1) as f64) as usize
}

fn width(widest: f64, class: usize) -> f64 {
    widest * 0.5_f64.powf(0.5 * class as f64)
}

fn place(points: &[Point], corners: &[u32], is_closed: bool, frame: &Frame) -> Vec<[i64; 2]> {
    let placed: Vec<[i64; 2]> = points.iter().map(|&p| frame.place(p)).collect();
    simplify(&placed, corners, is_closed, frame.quanta(TOLERANCE))
}

fn strokes(svg: &mut String, paths: &[PathData], widest: f64, ink: &str, frame: &Frame) {
    let _ = writeln!(svg, r#"<g fill="none" stroke="{ink}" stroke-linecap="round">"#);
    for (class, path) in paths.iter().enumerate().filter(|(_, path)| !path.text().is_empty()) {
        let width = frame.quanta(width(widest, class));
        let _ = writeln!(svg, r#"<path stroke-width="{width:.1}" d="{}"/>"#, path.text());
    }
    svg.push_str("</g>\n");
}
