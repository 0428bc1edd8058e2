//! Distances by FM-LBR, on a grid over a canvas of the plane.

use super::seeds::Start;
use crate::canvas::{Border, Canvas};
use crate::geodesic::Lattice;
use crate::geometry::{Aabb, Point};
use crate::metric::MetricField;

/// By [`Lattice`] on as many nodes as the canvas has vertices; vertices in sight of a point have the length of the way there.
pub(super) fn distances(canvas: &Canvas, field: &dyn MetricField, from: &[Point], starts: &[Vec<Start>]) -> Vec<f64> {
    let positions = &canvas.embedded().positions;
    let Some(bounds) = Aabb::of(positions.iter().copied()) else { return Vec::new() };
    let extent = bounds.extent();
    // What of the box is outside the domain costs no nodes.
    let nodes = positions.len() as f64 * (extent.x * extent.y / canvas.embedded().area()).min(100.0);
    let border = Border::of(canvas);
    let is_inside = |points: &[Point]| canvas.locate_all(points).iter().map(Option::is_some).collect();
    let mut values = Lattice::new(bounds, nodes as usize, field, is_inside, &border).distances(from, positions);
    for start in starts.iter().flatten() {
        let value = &mut values[start.vertex.index()];
        *value = value.min(start.distance);
    }
    values
}
