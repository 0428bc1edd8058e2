//! Edges that leave a seed side by side, nearer to each other than they are accurate, told apart.
//!
//! Geodesics from one seed do not meet again as long as they are shortest. Where the metric is singular (the centre of a
//! swirl) they can run together for a good part of their length, with less between them than the error of a straightened
//! path, and their polylines cross. Then both take the way of the shorter one there, and the other a little to the side.

use super::{Found, GeodesicEdge};
use crate::geodesic::{Obstacles, Polyline};
use crate::geometry::{Orientation, Point, orientation, segment_intersection};
use crate::metric::MetricField;
use crate::quality::{Crossing, crossings};

/// How often all crossings are looked for and mended.
const ROUNDS: usize = 12;
/// How far to the side, as a share of the length of the way that is taken in common; less in later rounds.
const ASIDE: f64 = 2e-5;

/// Mends crossings of edges with a common seed; leaves the state with the fewest.
pub(super) fn untangle(field: &dyn MetricField, obstacles: &dyn Obstacles, edges: &mut Vec<GeodesicEdge>) {
    let mut trial = edges.clone();
    let mut fewest = usize::MAX;
    for round in 0..=ROUNDS {
        let found = crossings(&trial);
        let pairs = || found.chunk_by(|x, y| x.paths == y.paths);
        let count = pairs().count();
        if count < fewest {
            edges.clone_from(&trial);
            fewest = count;
        }
        if count == 0 || round == ROUNDS {
            return;
        }
        let mut changed = vec![false; trial.len()];
        for group in pairs() {
            let [i, j] = group[0].paths.map(|k| k as usize);
            if changed[i] || changed[j] {
                continue;
            }
            if let Some((k, edge)) = parted(field, &trial, group, ASIDE / (1 + round) as f64)
                && !edge.points.windows(2).any(|w| obstacles.bars(w[0], w[1]))
            {
                trial[k] = edge;
                changed[k] = true;
            }
        }
    }
}

/// Of two edges that cross, the one to be changed, by number, and how.
fn parted(
    field: &dyn MetricField,
    edges: &[GeodesicEdge],
    group: &[Crossing],
    aside: f64,
) -> Option<(usize, GeodesicEdge)> {
    let numbers = group[0].paths.map(|k| k as usize);
    let [e, f] = numbers.map(|k| &edges[k]);
    let seed = *e.ends.iter().find(|seed| f.ends.contains(seed))?;
    // Both from the seed on, and their last crossing.
    let [p, q] = [e, f].map(|edge| edge.from(seed));
    let last = |c: &&Crossing| if e.ends[0] == seed { c.segments[0] } else { u32::MAX - c.segments[0] };
    let segments = group.iter().max_by_key(last)?.segments;
    let i = turned(segments[0], e.ends[0] == seed, p.len());
    let j = turned(segments[1], f.ends[0] == seed, q.len());
    let at = segment_intersection(p[i], p[i + 1], q[j], q[j + 1]);
    let ways = [(&p, i), (&q, j)].map(|(path, k)| [&path[..=k], &[at]].concat());
    let [to_e, to_f] = [&ways[0], &ways[1]].map(|way| Polyline::length_of(field, way));
    let left_of_e = orientation(p[i], p[i + 1], q[j + 1]) == Orientation::Left;
    let (number, mut points, rest) = if to_e <= to_f {
        (1, beside(&ways[0], left_of_e, aside), &q[j + 1..])
    } else {
        (0, beside(&ways[1], !left_of_e, aside), &p[i + 1..])
    };
    points.extend(rest);
    points.dedup();
    let old = [e, f][number];
    let gain = (to_e - to_f).abs();
    let length = old.length - gain;
    if old.ends[0] != seed {
        points.reverse();
    }
    // It was no better known than that it could be so much shorter, and it may bend where it leaves the common way.
    let error = old.error.max(gain / length);
    Some((numbers[number], GeodesicEdge { ends: old.ends, points, length, error, found: Found::Parted }))
}

/// The number of a segment of a path of so many points, counted from its other end unless it is the right one.
fn turned(segment: u32, is_right: bool, points: usize) -> usize {
    if is_right { segment as usize } else { points - 2 - segment as usize }
}

/// A way moved to one side, more and more from its start to its end.
fn beside(way: &[Point], is_left: bool, share: f64) -> Vec<Point> {
    let sign = if is_left { share } else { -share };
    let mut walked = 0.0;
    let mut points = vec![way[0]];
    for k in 1..way.len() {
        walked += way[k - 1].distance(way[k]);
        let along = way[(k + 1).min(way.len() - 1)] - way[k - 1];
        let normal = along.perpendicular() * (1.0 / along.norm());
        if normal.x.is_finite() {
            points.push(way[k] + normal * (sign * walked));
        }
    }
    points
}
