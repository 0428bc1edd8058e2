//! Vertices inside the edges of triangles that do not have them.

use super::mended::Damage;
use super::work::Work;
use crate::error::{Error, Result};
use crate::geometry::Point3;
use crate::mesh::{EdgeSide, Network};

/// A vertex is on an edge if it is off by no more than this share of its distance from the nearer end ...
const OFF: f64 = 1e-6;
/// ... or this share of the diagonal, which is what single precision leaves ...
const SINGLE: f64 = 1e-7;
/// ... but never by more than this share of that distance.
const OFF_AT_MOST: f64 = 1e-2;
/// Nearer to an end, as a share of the edge, a vertex is not inside the edge but beside its end.
const END: f64 = 1e-4;
/// Edges that are cut from both sides take turns.
const ROUNDS: usize = 16;
/// Where more borders meet in a place, nothing is looked for.
const BORDERS: usize = 64;

/// Cuts triangles where the border beside one of their edges has vertices inside it.
///
/// A border that merely touches an edge is none of these: from an end of the edge, another border must run along it.
///
/// # Errors
/// [`Error::Domain`] with triangle and vertex, unless damage is to be repaired.
pub(super) fn close(work: &mut Work) -> Result<bool> {
    for round in 0..ROUNDS {
        let found = find(work);
        let Some(first) = found.first() else { return Ok(round > 0) };
        if !work.options.repair {
            let number = work.number(first.triangle);
            let what = format!("a T-junction: a vertex inside an edge of triangle {number}, which does not have it");
            let help = "split the triangle there, or run again with `repair`";
            return Err(Error::domain(what, work.vertex(first.inside[0]), help));
        }
        let mut is_touched = vec![false; work.triangles.len()];
        for Junction { triangle, side, inside } in found {
            if std::mem::replace(&mut is_touched[triangle], true) {
                continue;
            }
            for &v in &inside {
                work.mended.add(Damage::TJunction, work.vertex(v));
            }
            work.cut(triangle, side, &inside);
        }
    }
    Ok(true)
}

struct Junction {
    triangle: usize,
    /// The side from this corner to the next.
    side: usize,
    /// Vertices on it, in its direction.
    inside: Vec<u32>,
}

fn find(work: &Work) -> Vec<Junction> {
    let borders: Vec<EdgeSide> = work.edges().boundary().collect();
    let network = Network::new(work.mesh.points.len(), borders.iter().map(|side| side.ends));
    let mut found = Vec::new();
    for side in borders {
        let [p, q] = side.ends;
        let mut inside = along(work, &network, [p, q]);
        if inside.is_empty() {
            inside = along(work, &network, [q, p]);
            inside.reverse();
        }
        if inside.is_empty() {
            continue;
        }
        if !side.forward {
            inside.reverse();
        }
        found.push(Junction { triangle: side.triangle(), side: side.half_edge as usize % 3, inside });
    }
    found.sort_by_key(|junction| junction.triangle);
    found
}

/// The vertices of the border that runs from the first end along an edge.
fn along(work: &Work, network: &Network, [from, to]: [u32; 2]) -> Vec<u32> {
    let (a, b) = (work.position(from), work.position(to));
    let tolerance = SINGLE * work.diagonal;
    let (mut at, mut reached, mut inside) = (from, 0.0, Vec::new());
    while inside.len() < BORDERS {
        let next = || network.at(at).iter().map(|&i| network.across(at, i));
        if next().len() >= BORDERS || (at != from && next().any(|v| v == to)) {
            break;
        }
        let steps = next().filter_map(|v| Some((part_of(a, b, work.position(v), tolerance)?, v)));
        let Some((t, v)) = steps.filter(|step| step.0 > reached).min_by(|x, y| x.0.total_cmp(&y.0)) else { break };
        inside.push(v);
        (at, reached) = (v, t);
    }
    inside
}

/// How far along an edge a point is that is on it, between its ends.
fn part_of(a: Point3, b: Point3, p: Point3, tolerance: f64) -> Option<f64> {
    let along = b - a;
    let length = along.norm();
    let t = (p - a).dot(along) / along.dot(along);
    let from_end = t.min(1.0 - t) * length;
    let most = (OFF * from_end).max(tolerance).min(OFF_AT_MOST * from_end);
    (from_end > END * length && a.lerp(b, t).distance(p) <= most).then_some(t)
}
