//! The worst triangles: a few seeds move to where the worst triangle around them is best.

use super::cell::from_frame;
use crate::dual::{Kind, Mending};
use crate::geometry::Vector;
use crate::triangulation::{HalfEdge, VertexId};

/// Lengths of the moves that are tried (metric length), and directions of each.
const LENGTHS: [f64; 4] = [0.2, 0.1, 0.05, 0.02];
const DIRECTIONS: usize = 12;
/// A move must raise the least quality by this at least.
const GAIN: f64 = 1e-3;
/// Edges whose metric length has a logarithm of at most this size are well within the unit range.
const UNIT: f64 = 0.3;
/// Below this quality lengths do not count beside an edge that must stay whole and is too long: every way off it may make others worse.
const POOR: f64 = 0.1;
/// Moves of one seed.
const MOVES: usize = 6;

/// Moves the free corners of the poorest triangles, at most so many, each to where the least quality of the triangles around it is
/// greatest, by trial; quality as it is measured of a mesh, in the log-Euclidean mean of the tensors at the corners. Returns
/// how many seeds moved.
///
/// Relaxation equalises cells, of which a triangle beside the tip of a cape knows little. The energy may rise a little.
pub(crate) fn mend_worst(dual: &mut impl Mending, most: usize) -> usize {
    let mut found: Vec<(f64, [VertexId; 3])> = Vec::new();
    for face in dual.topology().faces() {
        let corners = dual.topology().corners(face);
        found.push((dual.quality(corners.map(|v| dual.site(v))), corners));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    found.truncate(most);
    let corners = found.into_iter().flat_map(|(_, corners)| corners);
    let free: Vec<VertexId> = corners.filter(|&v| dual.kind(v) == Kind::Free).collect();
    free.into_iter().filter(|&v| mend(dual, v)).count()
}

/// Climbs from one trial to the next. No edge may leave the unit range for it, or get farther out, unless the quality is poor beside
/// an edge that must stay whole and is too long.
fn mend<M: Mending>(dual: &mut M, v: VertexId) -> bool {
    let topology = dual.topology();
    let ring: Vec<[M::Site; 2]> =
        topology.star(v).map(|h| [topology.target(h), topology.apex(h)].map(|u| dual.site(u))).collect();
    let is_long = |h: HalfEdge| {
        let ends = [topology.origin(h), topology.target(h)].map(|u| dual.site(u));
        topology.is_fixed(h) && dual.straight_length(ends).ln() > UNIT
    };
    let is_beside = topology.star(v).any(|h| is_long(h.next()));
    let misfit = |dual: &M, a, b| dual.straight_length([a, b]).ln().abs();
    let worst_edge =
        |dual: &M, site: M::Site| ring.iter().flatten().map(|&u| misfit(dual, site, u)).fold(0.0, f64::max);
    let usual = worst_edge(dual, dual.site(v)).max(UNIT);
    let least = |dual: &M, site: M::Site, allowed: f64| {
        let least = ring.iter().map(|&[a, b]| dual.quality([site, a, b])).fold(f64::INFINITY, f64::min);
        if worst_edge(dual, site) > allowed { f64::NEG_INFINITY } else { least }
    };
    let mut now = least(dual, dual.site(v), f64::INFINITY);
    let mut has_moved = false;
    for _ in 0..MOVES {
        let allowed = if is_beside && now < POOR { f64::INFINITY } else { usual };
        let frame = dual.local(v).tensor.cholesky();
        let trials = trials(frame).filter_map(|by| Some((by, least(dual, dual.site_after(v, by)?, allowed))));
        let Some((by, best)) = trials.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        if best < now + GAIN || !dual.shift_by(v, by) {
            break;
        }
        (now, has_moved) = (best, true);
    }
    if has_moved {
        dual.settle_move(v);
    }
    has_moved
}

fn trials(frame: [f64; 3]) -> impl Iterator<Item = Vector> {
    LENGTHS.into_iter().flat_map(move |length| {
        (0..DIRECTIONS).map(move |k| {
            let (sine, cosine) = (std::f64::consts::TAU * k as f64 / DIRECTIONS as f64).sin_cos();
            from_frame(frame, Vector::new(length * cosine, length * sine))
        })
    })
}
