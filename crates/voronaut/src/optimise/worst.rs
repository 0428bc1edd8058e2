//! The worst triangles: a few seeds move to where the worst triangle around them is best.

use super::cells::from_frame;
use crate::dual::{Dual, Effort, Kind};
use crate::geometry::{Point, Tensor, Vector, signed_area};
use crate::metric::MetricField;
use crate::triangulation::VertexId;

/// Lengths of the moves that are tried (metric length), and directions of each.
const LENGTHS: [f64; 4] = [0.2, 0.1, 0.05, 0.02];
const DIRECTIONS: usize = 12;
/// A move must raise the least quality by this at least.
const GAIN: f64 = 1e-3;
/// Edges whose metric length has a logarithm of at most this size are well within the unit range.
const UNIT: f64 = 0.3;
/// Moves of one seed.
const MOVES: usize = 6;

/// Moves the free corners of the poorest triangles, at most so many, each to where the least quality of the triangles around it is
/// greatest, by trial; quality as it is measured of a mesh, in the log-Euclidean mean of the tensors at the corners. Returns
/// how many seeds moved.
///
/// Relaxation equalises cells, of which a triangle beside the tip of a cape knows little. The energy may rise a little.
pub fn mend_worst(dual: &mut Dual, most: usize) -> usize {
    let mut found: Vec<(f64, [VertexId; 3])> = Vec::new();
    for face in dual.topology().faces() {
        let corners = dual.topology().corners(face);
        let [a, b, c] = corners.map(|v| Site::of(dual, v));
        found.push((quality(a, b, c), corners));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    found.truncate(most);
    let corners = found.into_iter().flat_map(|(_, corners)| corners);
    let free: Vec<VertexId> = corners.filter(|&v| dual.kind(v) == Kind::Free).collect();
    let moved = free.into_iter().filter(|&v| mend(dual, v)).count();
    dual.take_touched();
    moved
}

/// A point and the logarithm of the tensor there.
#[derive(Clone, Copy)]
struct Site {
    at: Point,
    log: Tensor,
}

impl Site {
    fn of(dual: &Dual, v: VertexId) -> Self {
        Self::at(dual, dual.position(v))
    }

    fn at(dual: &Dual, at: Point) -> Self {
        Self { at, log: dual.field().at(at).log() }
    }
}

fn quality(a: Site, b: Site, c: Site) -> f64 {
    let tensor = ((a.log + b.log + c.log) * (1.0 / 3.0)).exp();
    let squares: f64 = [b.at - a.at, c.at - b.at, a.at - c.at].iter().map(|&e| tensor.dot(e, e)).sum();
    2.0 * 3.0_f64.sqrt() * signed_area(a.at, b.at, c.at) * tensor.determinant().max(0.0).sqrt() / squares
}

/// How far the metric length of a straight edge is from one: the size of its logarithm.
fn misfit(a: Site, b: Site) -> f64 {
    ((a.log + b.log) * 0.5).exp().length(b.at - a.at).ln().abs()
}

/// Climbs from one trial to the next. No edge may leave the unit range for it, or get farther out.
fn mend(dual: &mut Dual, v: VertexId) -> bool {
    let topology = dual.topology();
    let ring: Vec<[Site; 2]> =
        topology.star(v).map(|h| [topology.target(h), topology.apex(h)].map(|u| Site::of(dual, u))).collect();
    let worst_edge = |site: Site| ring.iter().flatten().map(|&u| misfit(site, u)).fold(0.0, f64::max);
    let allowed = worst_edge(Site::of(dual, v)).max(UNIT);
    let least = |at: Point, dual: &Dual| {
        let site = Site::at(dual, at);
        let least = ring.iter().map(|&[a, b]| quality(site, a, b)).fold(f64::INFINITY, f64::min);
        if worst_edge(site) > allowed { f64::NEG_INFINITY } else { least }
    };
    let frame = dual.local(v).tensor.cholesky();
    let mut now = least(dual.position(v), dual);
    let mut has_moved = false;
    for _ in 0..MOVES {
        let from = dual.position(v);
        let trials = trials(from, frame).map(|to| (to, least(to, dual)));
        let Some((to, best)) = trials.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        if best < now + GAIN || !dual.shift(v, to) {
            break;
        }
        (now, has_moved) = (best, true);
    }
    if has_moved {
        dual.remeasure(v);
        dual.flip_around(v, Effort::Local);
    }
    has_moved
}

fn trials(from: Point, frame: [f64; 3]) -> impl Iterator<Item = Point> {
    LENGTHS.into_iter().flat_map(move |length| {
        (0..DIRECTIONS).map(move |k| {
            let (sine, cosine) = (std::f64::consts::TAU * k as f64 / DIRECTIONS as f64).sin_cos();
            from + from_frame(frame, Vector::new(length * cosine, length * sine))
        })
    })
}
