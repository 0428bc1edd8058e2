//! Seeds that change places: those that crowd go and others come where edges are too long, at a given number of vertices; and a few
//! move to where the worst triangle around them is best.

use crate::dual::{Dual, Effort, Kind, Moving, sites};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geometry::{NEEDLE, Vector, from_frame};
use crate::lists::{least_ranked, ranked};
use crate::parallel::prelude::*;
use crate::planar::Location;
use crate::progress::Silent;
use crate::sampling::{Fill, insert_spaced, refine};
use crate::triangulation::{HalfEdge, VertexId};
use std::collections::BTreeMap;

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
const LENGTHS: [f64; 4] = [0.2, 0.1, 0.05, SHORTEST];
const SHORTEST: f64 = 0.02;
const WAYS: usize = 12;
/// A move must raise the least quality by this at least.
const GAIN: f64 = 1e-3;
/// Edges whose metric length has a logarithm of at most this size are well within the unit range.
const UNIT: f64 = 0.3;
/// Below this quality lengths do not count beside an edge that must stay whole and is too long: every way off it may make others worse.
const POOR: f64 = 2.0 * NEEDLE;
/// Moves of one seed.
const MOVES: usize = 6;

/// Moves corners of poor triangles, each to where the least quality of the triangles around it is greatest, by trial; quality as it is
/// measured of a mesh, in the log-Euclidean mean of the tensors at the corners.
///
/// Relaxation equalises cells, of which a triangle beside the tip of a cape knows little. The energy may rise a little. The metric's factor
/// stays from one call to the next.
pub(crate) struct Mending<M: Moving> {
    /// Of seeds that no trial was better for: where they and their neighbours were.
    in_vain: BTreeMap<(VertexId, Lengths), Ring<M::Site>>,
}

/// A seed's place, and the triangles around it by their other corners.
#[derive(PartialEq)]
struct Ring<S> {
    centre: S,
    links: Vec<[S; 2]>,
}

impl<M: Moving> Default for Mending<M> {
    fn default() -> Self {
        Self { in_vain: BTreeMap::new() }
    }
}

impl<M: Moving> Mending<M> {
    /// Moves the free corners of the poorest triangles, at most so many. Returns how many seeds moved.
    pub(crate) fn worst(&mut self, dual: &mut M, most: usize) -> usize {
        let poorest = least_ranked(by_quality(dual), most).into_iter().map(|(_, corners)| corners);
        let poorest: Vec<[VertexId; 3]> = poorest.collect();
        self.corners(dual, poorest, Lengths::Kept)
    }

    /// The same of all triangles that are needles, or nearly, whatever lengths become: what the mesh is measured by asks for the metric at the closest
    /// places, and may find less.
    pub(crate) fn needles(&mut self, dual: &mut M) -> usize {
        let poor = ranked(by_quality(dual).into_iter().filter(|(quality, _)| *quality < POOR));
        let poor: Vec<[VertexId; 3]> = poor.into_iter().map(|(_, corners)| corners).collect();
        self.corners(dual, poor, Lengths::AfterNeedles)
    }

    fn corners(&mut self, dual: &mut M, triangles: Vec<[VertexId; 3]>, lengths: Lengths) -> usize {
        let corners = triangles.into_iter().flatten();
        let free: Vec<VertexId> = corners.filter(|&v| dual.kind(v) == Kind::Free).collect();
        free.into_iter().filter(|&v| self.corner(dual, v, lengths)).count()
    }

    /// Says whether the seed moved.
    fn corner(&mut self, dual: &mut M, v: VertexId, lengths: Lengths) -> bool {
        let topology = dual.topology();
        let link = |h: HalfEdge| [dual.ready(dual.site(topology.target(h))), dual.site(topology.apex(h))];
        let ring = Ring { centre: dual.ready(dual.site(v)), links: topology.star(v).map(link).collect() };
        if self.in_vain.get(&(v, lengths)) == Some(&ring) {
            return false;
        }
        let has_moved = mend(dual, v, &ring, lengths);
        if !has_moved {
            self.in_vain.insert((v, lengths), ring);
        }
        has_moved
    }
}

/// The triangles by their quality.
fn by_quality(dual: &impl Moving) -> Vec<(f64, [VertexId; 3])> {
    let sites = sites(dual);
    let corners: Vec<_> = dual.topology().faces().map(|face| dual.topology().corners(face)).collect();
    let measured = |&corners: &[VertexId; 3]| {
        let quality = dual.quality(corners.map(|v| sites[v.index()]));
        (quality, corners)
    };
    corners.par_iter().with_min_len(1024).map(measured).collect()
}

/// What counts where a triangle is a needle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Lengths {
    /// That no edge leaves the unit range.
    Kept,
    /// That it is none any more.
    AfterNeedles,
}

/// Climbs from one trial to the next. No edge may leave the unit range for it, or get farther out, unless needles come first, or
/// the quality is poor beside an edge that must stay whole and is too long.
fn mend<M: Moving>(dual: &mut M, v: VertexId, ring: &Ring<M::Site>, lengths: Lengths) -> bool {
    let topology = dual.topology();
    let is_long = |h: HalfEdge| {
        let ends = topology.ends(h).map(|u| dual.site(u));
        topology.is_fixed(h) && dual.straight_length(ends).logarithm() > UNIT
    };
    let is_beside = topology.star(v).any(|h| is_long(h.next()));
    let misfit = |dual: &M, site: M::Site, u: M::Site| dual.straight_length([site, u]).logarithm().abs();
    let usual = ring.links.iter().map(|&[u, _]| misfit(dual, ring.centre, u)).fold(UNIT, f64::max);
    let mut has_moved = false;
    for _ in 0..MOVES {
        // The poorest triangle first: it tells of most trials that they are no better.
        let here = dual.site(v);
        let by_quality = ranked(ring.links.iter().zip(0..).map(|(&[a, b], i)| (dual.quality([here, a, b]), i)));
        let now = by_quality.first().map_or(f64::NEG_INFINITY, |&(quality, _)| quality);
        let links: Vec<[M::Site; 2]> = by_quality.into_iter().map(|(_, i): (f64, usize)| ring.links[i]).collect();
        // The least quality around, where that is at least so much.
        let least = |site: M::Site, floor: f64| {
            links.iter().map(|&[a, b]| dual.quality([site, a, b])).try_fold(f64::INFINITY, |least, quality| {
                let least = least.min(quality);
                (least >= floor).then_some(least)
            })
        };
        let allowed = if (lengths == Lengths::AfterNeedles && now < NEEDLE) || (is_beside && now < POOR) {
            f64::INFINITY
        } else {
            usual
        };
        // Where the metric is even, quality is nowhere less on the way to a place where it is greater: triangles of at least some quality have their
        // corners in convex sets.
        let rises =
            |by: &Vector| now < 0.0 || dual.site_after(v, *by * SHORTEST).is_some_and(|at| least(at, now).is_some());
        let ways = ways(dual.local(v).tensor.cholesky());
        let rising: Vec<Vector> = ways.into_par_iter().with_min_len(WAYS / 4).filter(rises).collect();
        let tried: Vec<Vector> = LENGTHS.iter().flat_map(|&length| rising.iter().map(move |&by| by * length)).collect();
        let gained = |&by: &Vector| {
            let site = dual.site_after(v, by)?;
            let quality = least(site, now + GAIN)?;
            let site = dual.ready(site);
            links.iter().all(|&[u, _]| misfit(dual, site, u) <= allowed).then_some(quality)
        };
        let gains: Vec<Option<f64>> = tried.par_iter().with_min_len(WAYS / 2).map(gained).collect();
        let better = ranked(gains.into_iter().enumerate().filter_map(|(i, gain)| Some((-gain?, i))));
        if !better.into_iter().any(|(_, i)| dual.shift_by(v, tried[i])) {
            break;
        }
        has_moved = true;
    }
    if has_moved {
        dual.settle_move(v);
    }
    has_moved
}

/// Unit vectors all around.
fn ways(frame: [f64; 3]) -> Vec<Vector> {
    let way = |k: usize| {
        let (sine, cosine) = (std::f64::consts::TAU * k as f64 / WAYS as f64).sine_and_cosine();
        from_frame(frame, Vector::new(cosine, sine))
    };
    (0..WAYS).map(way).collect()
}
