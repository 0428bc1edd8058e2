//! The shortest way between two vertices along edges (Dijkstra 1959), on one part of a triangulation.

use crate::triangulation::{HalfEdge, Triangulation, VertexId};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

/// A distance that orders a heap. Distances are finite and not negative, so that their bits are in their order.
fn key(distance: f64) -> Reverse<u64> {
    Reverse(distance.to_bits())
}

/// The edges of the shortest way along edges from one vertex to another, in order, by metric length; `None` where there is
/// none. It searches no farther than the other vertex is.
pub(super) fn edge_path(topology: &Triangulation, from: VertexId, to: VertexId) -> Option<Vec<HalfEdge>> {
    // Searched from the end, so that the half-edges back to it come in order.
    let mut best: HashMap<VertexId, (f64, Option<HalfEdge>)> = HashMap::from([(to, (0.0, None))]);
    let mut heap = BinaryHeap::from([(key(0.0), to)]);
    while let Some((Reverse(bits), v)) = heap.pop() {
        let distance = f64::from_bits(bits);
        if v == from {
            break;
        }
        if best[&v].0 < distance {
            continue;
        }
        for h in topology.star(v) {
            // The two sides of the star's faces at v: at the border only one of them is a spoke of the star.
            for (towards_v, u, length) in [
                (topology.twin(h), topology.target(h), topology.length(h)),
                (Some(h.prev()), topology.apex(h), topology.length(h.prev())),
            ] {
                let reached = distance + length;
                if best.get(&u).is_none_or(|known| reached < known.0) {
                    // At the border the way is known by its other side.
                    best.insert(u, (reached, Some(towards_v.unwrap_or(h))));
                    heap.push((key(reached), u));
                }
            }
        }
    }
    let mut path = Vec::new();
    let mut v = from;
    while v != to {
        let h = best.get(&v)?.1?;
        path.push(h);
        v = if topology.origin(h) == v { topology.target(h) } else { topology.origin(h) };
    }
    Some(path)
}
