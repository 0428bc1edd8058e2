//! What every mesh must be, whatever was asked: compared with the drawing, not with the mesher's own idea of it.

use super::domains::Drawn;
use std::collections::{BTreeMap, HashSet};
use voronaut::geometry::Point;
use voronaut::manifold::domain::{Domain, Pslg, Segment};
use voronaut::mesh::Mesh;
use voronaut::quality;

/// Everything that is wrong with the mesh of a drawing; empty if nothing is.
pub(crate) fn faults(drawn: &Drawn, domain: &Domain, mesh: &Mesh) -> Vec<String> {
    let mut faults = Vec::new();
    if let Err(error) = quality::check(mesh) {
        faults.push(error.to_string());
    }
    faults.extend(missing_corners(domain, mesh));
    faults.extend(segments_not_covered(drawn, mesh));
    faults.extend(wrong_area(drawn, mesh));
    faults
}

fn missing_corners(domain: &Domain, mesh: &Mesh) -> Option<String> {
    let vertices: HashSet<[u64; 2]> = mesh.points.iter().map(|&[x, y, _]| [x.to_bits(), y.to_bits()]).collect();
    let missing = |p: &&Point| !vertices.contains(&[p.x.to_bits(), p.y.to_bits()]);
    let corners = &domain.pslg().points;
    corners.iter().find(missing).map(|p| format!("the corner {p} is no vertex"))
}

/// Per label: every labelled edge lies on a segment with that label, and together they are as long as the segments.
/// Labels are mostly one per segment, which makes this exact.
fn segments_not_covered(drawn: &Drawn, mesh: &Mesh) -> Option<String> {
    let points = &drawn.pslg.points;
    let reach = reach(&drawn.pslg);
    let mut of_label: BTreeMap<i32, (Vec<[Point; 2]>, f64)> = BTreeMap::new();
    for Segment { ends, label, .. } in &drawn.pslg.segments {
        let [a, b] = ends.map(|v| points[v as usize]);
        let entry = of_label.entry(*label).or_default();
        entry.0.push([a, b]);
        entry.1 += (b - a).norm();
    }
    let mut left: BTreeMap<i32, f64> = of_label.iter().map(|(&label, entry)| (label, entry.1)).collect();
    for (edge, label) in mesh.edges.iter().zip(&mesh.edge_labels) {
        let [p, q] = edge.map(|v| mesh.point(v));
        // An edge may pass a vertex in the middle of a straight run.
        let lies_on_segments = |segments: &[[Point; 2]]| {
            let tolerance = 8.0 * f64::EPSILON * reach;
            [p, q, p.lerp(q, 0.5)].iter().all(|&x| segments.iter().any(|&s| distance(s, x) <= tolerance))
        };
        let Some((segments, _)) = of_label.get(label) else { return Some(format!("label {label} is new")) };
        if !lies_on_segments(segments) {
            return Some(format!("the edge {p} - {q} with label {label} lies on no segment"));
        }
        *left.get_mut(label).expect("known") -= (q - p).norm();
    }
    let uncovered = |&(label, left): &(&i32, &f64)| {
        let (segments, length) = &of_label[label];
        left.abs() > 1e-9 * length + 1e-14 * reach * (segments.len() + mesh.edges.len()) as f64
    };
    left.iter().find(uncovered).map(|(label, left)| format!("{left:e} of the segments with label {label} are missing"))
}

fn distance([a, b]: [Point; 2], p: Point) -> f64 {
    let d = b - a;
    let t = ((p - a).dot(d) / d.dot(d)).clamp(0.0, 1.0);
    p.distance(a.lerp(b, t))
}

fn wrong_area(drawn: &Drawn, mesh: &Mesh) -> Option<String> {
    let triangle = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|v| mesh.point(v));
        0.5 * (b - a).cross(c - a)
    };
    let found: f64 = mesh.triangles.iter().map(triangle).sum();
    let (area, rounding) = (drawn.area, rounding(&drawn.pslg));
    let wrong = (found - area).abs() > 1e-9 * area + rounding;
    wrong.then(|| format!("the area is {found:e}, not {area:e}"))
}

/// How much area rounding can add: vertices on the segments are off by the spacing of floating-point numbers there.
fn rounding(pslg: &Pslg) -> f64 {
    let ends = |s: &Segment| s.ends.map(|v| pslg.points[v as usize]);
    let perimeter: f64 = pslg.segments.iter().map(ends).map(|[a, b]| (b - a).norm()).sum();
    2.0 * f64::EPSILON * reach(pslg) * perimeter
}

fn reach(pslg: &Pslg) -> f64 {
    pslg.points.iter().fold(0.0, |m, p| m.max(p.x.abs()).max(p.y.abs()))
}
