//! The worst triangles: a few seeds move to where the worst triangle around them is best.

use super::cells::from_frame;
use crate::dual::{Dual, Effort, Kind};
use crate::geometry::{Point, Vector};
use crate::triangulation::VertexId;

/// Triangles of a quality below this are worth a try, the worst first.
const POOR: f64 = 0.35;
/// Lengths of the moves that are tried (metric length), and directions of each.
const LENGTHS: [f64; 4] = [0.2, 0.1, 0.05, 0.02];
const DIRECTIONS: usize = 12;
/// A move must raise the least quality by this at least.
const GAIN: f64 = 1e-3;
/// Moves of one seed.
const MOVES: usize = 6;

/// Moves the free corners of at most so many poor triangles, each to where the least quality (in the mean tensor of a
/// triangle's corners) of the triangles around it is greatest, by trial. Returns how many seeds moved.
///
/// Relaxation equalises cells; this mends what it leaves at the few places where neighbours are five or seven, or
/// where the metric is rough. The energy rises a little.
pub fn mend_worst(dual: &mut Dual, most: usize) -> usize {
    let mut poor: Vec<(f64, [VertexId; 3])> = Vec::new();
    for face in dual.topology().faces() {
        let corners = dual.topology().corners(face);
        let quality = dual.shape(corners);
        if quality < POOR {
            poor.push((quality, corners));
        }
    }
    poor.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    poor.truncate(most);
    let free: Vec<VertexId> =
        poor.into_iter().flat_map(|(_, corners)| corners).filter(|&v| dual.kind(v) == Kind::Free).collect();
    let moved = free.into_iter().filter(|&v| mend(dual, v)).count();
    dual.take_touched();
    moved
}

/// Climbs from one trial to the next.
fn mend(dual: &mut Dual, v: VertexId) -> bool {
    let mut now = least_quality(dual, v, dual.position(v));
    let mut has_moved = false;
    for _ in 0..MOVES {
        let from = dual.position(v);
        let Some((to, _)) = best_trial(dual, v, from).filter(|&(_, quality)| quality > now + GAIN) else { break };
        if !dual.shift(v, to) {
            break;
        }
        dual.remeasure(v);
        let found = least_quality(dual, v, to);
        if found <= now {
            // The metric there is not what its expansion promised.
            dual.shift(v, from);
            dual.remeasure(v);
            break;
        }
        (now, has_moved) = (found, true);
    }
    if has_moved {
        dual.flip_around(v, Effort::Local);
    }
    has_moved
}

fn best_trial(dual: &Dual, v: VertexId, from: Point) -> Option<(Point, f64)> {
    let frame = dual.local(v).tensor.cholesky();
    let turn = |k: usize| (std::f64::consts::TAU * k as f64 / DIRECTIONS as f64).sin_cos();
    let trial = |length: f64, k: usize| {
        let (sine, cosine) = turn(k);
        from + from_frame(frame, Vector::new(length * cosine, length * sine))
    };
    let trials = LENGTHS.iter().flat_map(|&length| (0..DIRECTIONS).map(move |k| trial(length, k)));
    trials.map(|to| (to, least_quality(dual, v, to))).max_by(|a, b| a.1.total_cmp(&b.1))
}

/// The least quality of the triangles around a seed, were it at a point nearby.
fn least_quality(dual: &Dual, v: VertexId, at: Point) -> f64 {
    let topology = dual.topology();
    let qualities = topology.star(v).map(|h| dual.shape_from(v, at, [topology.target(h), topology.apex(h)]));
    qualities.fold(f64::INFINITY, f64::min)
}
