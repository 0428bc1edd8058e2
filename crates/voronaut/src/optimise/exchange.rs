//! Seeds that change places: those that crowd go and others come where edges are too long, at a given number of vertices; and a few
//! move to where the worst triangle around them is best.

use crate::dual::{Dual, Effort, Kind, Moving, sites};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geometry::{NEEDLE, Vector, from_frame};
use crate::lists::ranked;
use crate::parallel::prelude::*;
use crate::planar::Location;
use crate::progress::Silent;
use crate::sampling::{Fill, insert_spaced, refine};
use crate::triangulation::{HalfEdge, VertexId};

/// Edges shorter than this in the metric (just below the unit range) mark seeds that crowd.
const SHORT: f64 = 0.66;

/// Removes free seeds at edges that are too short, shortest first and no two of them neighbours, at most `most`; then
/// inserts where circumradii are largest until there are as many vertices as `fill` says again. Returns how many seeds
/// were removed.
pub(crate) fn exchange(dual: &mut Dual, fill: Fill, most: usize) -> Result<usize> {
    let removed = remove_crowded(dual, most, SHORT);
    let excess = dual.vertex_count().saturating_sub(fill.count());
    let removed = removed + if excess > 0 { remove_crowded(dual, excess, f64::INFINITY) } else { 0 };
    refine(dual, fill, &Silent)?;
    Ok(removed)
}

fn remove_crowded(dual: &mut Dual, most: usize, shorter_than: f64) -> usize {
    let edges: Vec<HalfEdge> = dual.topology().edges().collect();
    let edges = edges.par_iter().with_min_len(1024).map(|&h| (dual.edge_length(h), dual.topology().ends(h)));
    let is_free = |ends: &[VertexId; 2]| ends.iter().any(|&v| dual.kind(v) == Kind::Free);
    let short = edges.filter(|(length, ends)| *length < shorter_than && is_free(ends));
    let short = ranked(short.collect::<Vec<_>>());
    let mut spoken_for = vec![false; dual.topology().vertex_slots()];
    let mut removed = 0;
    for (_, ends) in short {
        if removed == most {
            break;
        }
        let crowded = ends.into_iter().filter(|&v| dual.kind(v) == Kind::Free && !spoken_for[v.index()]);
        let Some(v) = crowded.min_by(|&u, &v| nearest_two(dual, u).total_cmp(&nearest_two(dual, v))) else { continue };
        let link: Vec<VertexId> = dual.topology().star(v).map(|h| dual.topology().target(h)).collect();
        if dual.remove(v) {
            removed += 1;
            link.into_iter().chain(ends).for_each(|u| spoken_for[u.index()] = true);
        }
    }
    removed
}

/// The sum of a seed's two shortest edges: the smaller, the more it crowds.
fn nearest_two(dual: &Dual, v: VertexId) -> f64 {
    let mut lengths: Vec<f64> = dual.topology().star(v).map(|h| dual.edge_length(h)).collect();
    lengths.sort_by(f64::total_cmp);
    lengths.iter().take(2).sum()
}

/// Puts a seed at the middle of each edge whose flip the metric certainly wants and the plane forbids, worst first and
/// at most `most` of them. Returns how many.
pub(crate) fn meet_blocked_flips(dual: &mut Dual, most: usize) -> usize {
    let mut blocked = dual.blocked_flips(Effort::Local);
    blocked.retain(|(_, margin)| margin.is_certain());
    let worst_first = ranked(blocked.into_iter().map(|(h, margin)| (margin.value, h)));
    let edges: Vec<[VertexId; 2]> = worst_first.into_iter().map(|(_, h)| dual.topology().ends(h)).collect();
    let mut met = 0;
    for [a, b] in edges {
        if met == most {
            break;
        }
        let Some(h) = dual.topology().find(a, b) else { continue };
        let middle = dual.position(a).midpoint(dual.position(b));
        met += usize::from(insert_spaced(dual, Location::Edge(h), middle));
    }
    met
}

/// Lengths of the moves that are tried (metric length), and directions of each.
const LENGTHS: [f64; 4] = [0.2, 0.1, 0.05, 0.02];
const DIRECTIONS: usize = 12;
/// A move must raise the least quality by this at least.
const GAIN: f64 = 1e-3;
/// Edges whose metric length has a logarithm of at most this size are well within the unit range.
const UNIT: f64 = 0.3;
/// Below this quality lengths do not count beside an edge that must stay whole and is too long: every way off it may make others worse.
const POOR: f64 = 2.0 * NEEDLE;
/// Moves of one seed.
const MOVES: usize = 6;

/// Moves the free corners of the poorest triangles, at most so many, each to where the least quality of the triangles around it is
/// greatest, by trial; quality as it is measured of a mesh, in the log-Euclidean mean of the tensors at the corners. Returns
/// how many seeds moved.
///
/// Relaxation equalises cells, of which a triangle beside the tip of a cape knows little. The energy may rise a little.
pub(crate) fn mend_worst(dual: &mut impl Moving, most: usize) -> usize {
    let poorest: Vec<[VertexId; 3]> = by_quality(dual).into_iter().take(most).map(|(_, corners)| corners).collect();
    mend_corners(dual, poorest, Lengths::Kept)
}

/// The same of all triangles that are needles, or nearly, whatever lengths become: what the mesh is measured by asks for the metric at the closest places, and
/// may find less.
pub(crate) fn mend_needles(dual: &mut impl Moving) -> usize {
    let poor = by_quality(dual).into_iter().take_while(|(quality, _)| *quality < POOR).map(|(_, corners)| corners);
    let poor: Vec<[VertexId; 3]> = poor.collect();
    mend_corners(dual, poor, Lengths::AfterNeedles)
}

/// The triangles by their quality, the poorest first.
fn by_quality(dual: &impl Moving) -> Vec<(f64, [VertexId; 3])> {
    let sites = sites(dual);
    let corners: Vec<_> = dual.topology().faces().map(|face| dual.topology().corners(face)).collect();
    let measured = corners.par_iter().with_min_len(1024).map(|&corners| {
        let quality = dual.quality(corners.map(|v| sites[v.index()]));
        (quality, corners)
    });
    ranked(measured.collect::<Vec<_>>())
}

fn mend_corners(dual: &mut impl Moving, triangles: Vec<[VertexId; 3]>, lengths: Lengths) -> usize {
    let corners = triangles.into_iter().flatten();
    let free: Vec<VertexId> = corners.filter(|&v| dual.kind(v) == Kind::Free).collect();
    free.into_iter().filter(|&v| mend(dual, v, lengths)).count()
}

/// What counts where a triangle is a needle.
#[derive(Clone, Copy, PartialEq)]
enum Lengths {
    /// That no edge leaves the unit range.
    Kept,
    /// That it is none any more.
    AfterNeedles,
}

/// Climbs from one trial to the next. No edge may leave the unit range for it, or get farther out, unless needles come first, or
/// the quality is poor beside an edge that must stay whole and is too long.
fn mend<M: Moving>(dual: &mut M, v: VertexId, lengths: Lengths) -> bool {
    let topology = dual.topology();
    let ring: Vec<[M::Site; 2]> =
        topology.star(v).map(|h| [topology.target(h), topology.apex(h)].map(|u| dual.site(u))).collect();
    let is_long = |h: HalfEdge| {
        let ends = topology.ends(h).map(|u| dual.site(u));
        topology.is_fixed(h) && dual.straight_length(ends).logarithm() > UNIT
    };
    let is_beside = topology.star(v).any(|h| is_long(h.next()));
    let misfit = |dual: &M, site: M::Site, u: M::Site| dual.straight_length([site, u]).logarithm().abs();
    let worst_edge = |dual: &M, site: M::Site| ring.iter().map(|&[u, _]| misfit(dual, site, u)).fold(0.0, f64::max);
    let usual = worst_edge(dual, dual.site(v)).max(UNIT);
    // The least quality around, where that is at least so much: most trials are told by their first triangles.
    let least = |dual: &M, site: M::Site, floor: f64| {
        ring.iter().map(|&[a, b]| dual.quality([site, a, b])).try_fold(f64::INFINITY, |least, quality| {
            let least = least.min(quality);
            (least >= floor).then_some(least)
        })
    };
    let mut now = least(dual, dual.site(v), f64::NEG_INFINITY).unwrap_or(f64::NEG_INFINITY);
    let mut has_moved = false;
    for _ in 0..MOVES {
        let allowed = if (lengths == Lengths::AfterNeedles && now < NEEDLE) || (is_beside && now < POOR) {
            f64::INFINITY
        } else {
            usual
        };
        let tried: Vec<Vector> = trials(dual.local(v).tensor.cholesky()).collect();
        let gained = |&by: &Vector| {
            let site = dual.site_after(v, by)?;
            least(dual, site, now + GAIN).filter(|_| worst_edge(dual, site) <= allowed)
        };
        let gains: Vec<Option<f64>> = tried.par_iter().map(gained).collect();
        let better = ranked(gains.into_iter().enumerate().filter_map(|(i, gain)| Some((-gain?, i))));
        let Some((loss, _)) = better.into_iter().find(|&(_, i)| dual.shift_by(v, tried[i])) else { break };
        (now, has_moved) = (-loss, true);
    }
    if has_moved {
        dual.settle_move(v);
    }
    has_moved
}

fn trials(frame: [f64; 3]) -> impl Iterator<Item = Vector> {
    LENGTHS.into_iter().flat_map(move |length| {
        (0..DIRECTIONS).map(move |k| {
            let (sine, cosine) = (std::f64::consts::TAU * k as f64 / DIRECTIONS as f64).sine_and_cosine();
            from_frame(frame, Vector::new(length * cosine, length * sine))
        })
    })
}
