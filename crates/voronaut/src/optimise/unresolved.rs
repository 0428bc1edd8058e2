//! Circles that geodesics do not find, by the diagram on a small canvas around them.

use crate::canvas::Canvas;
use crate::dual::{Dual, Kind};
use crate::geometry::Point;
use crate::net::{Net, measure_on_canvas};
use crate::triangulation::VertexId;

/// Rings of triangles of the mesh around the seeds of such a triangle.
const RINGS: usize = 2;
/// Canvas vertices per seed, and at least.
const PER_SEED: usize = 200;
const LEAST: usize = 2000;

/// Measures on a canvas what a net has no circles of. A triangle with a seed on the border whose cells do not meet in the
/// domain is no simplex there; another stays unknown.
pub(super) fn learn(dual: &Dual, positions: &[Point], net: &mut Net) {
    if net.unknown.is_empty() {
        return;
    }
    let seeds: Vec<VertexId> = net.unknown.iter().flatten().map(|&i| VertexId(i)).collect();
    let part = dual.part_around(&seeds, RINGS);
    let near: Vec<(u32, Point)> = part.topology.vertices().map(|v| (v.0, positions[v.index()])).collect();
    let size = (PER_SEED * near.len()).max(LEAST);
    let Ok(canvas) = Canvas::intrinsic_from(part, dual.scaled_field(), size) else { return };
    // Seeds may be tried outside the part: then nothing is learnt.
    let Ok(found) = measure_on_canvas(&canvas, dual.scaled_field(), &near, &net.unknown) else { return };
    let is_at_border = |corners: &[u32; 3]| corners.iter().any(|&i| dual.kind(VertexId(i)) != Kind::Free);
    let lacking = net.unknown.iter().zip(&found).filter(|(_, ball)| ball.is_none()).map(|(corners, _)| *corners);
    let outside: Vec<[u32; 3]> = lacking.filter(is_at_border).collect();
    let balls: Vec<_> = found.into_iter().flatten().collect();
    net.learn(&balls, &outside);
}
