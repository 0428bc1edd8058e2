//! Seeds that change places: those that crowd go and others come where edges are too long, at a given number of vertices.

use crate::dual::{Dual, Effort, Kind, Moving};
use crate::error::Result;
use crate::lists::ranked;
use crate::parallel::prelude::*;
use crate::planar::Location;
use crate::progress::Silent;
use crate::sampling::{Fill, insert_spaced, refine};
use crate::triangulation::VertexId;

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
    let edges = dual.topology().edges_with(|_| true);
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
