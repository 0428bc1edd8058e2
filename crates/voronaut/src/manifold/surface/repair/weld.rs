//! Which vertices are at one place.

use super::work::Work;
use crate::geometry::{BoxTree, widened};
use crate::lists::distinct;
use crate::mesh::coincident;
use std::collections::HashMap;

/// Vertices on borders this close, as a share of the diagonal, are at one place.
const NEAR: f64 = 1e-9;
/// And not farther than this share of the shortest edge at either: what is small is not a point because something else is large.
const OF_EDGE: f64 = 1e-2;
/// Near vertices that are looked at, at most.
const NEIGHBOURS: usize = 8;

/// Finds vertices at one place: with the same coordinates; and on borders, which soups are made of, nearly so.
///
/// Nothing is joined by that yet: sides of triangles will be, where they are at the same places and a surface comes out.
pub(super) fn find_places(work: &mut Work) {
    let used = distinct(work.triangles.as_flattened().iter().copied());
    for [first, v] in coincident(used.into_iter().map(|v| (v, work.mesh.position(v)))) {
        work.places.join(first, v);
    }
    work.places.flatten();
    join_near(work);
    work.places.flatten();
}

/// Joins places on borders that are next to each other.
fn join_near(work: &mut Work) {
    let mut reach: HashMap<u32, f64> = HashMap::new();
    let edges = work.edges();
    let on_borders = edges.boundary().flat_map(|side| side.ends);
    reach.extend(on_borders.map(|end| (end, NEAR * work.diagonal)));
    for [v, w] in edges.ends().filter(|[v, w]| v != w) {
        let length = work.position(v).distance(work.position(w));
        for end in [v, w] {
            if let Some(reach) = reach.get_mut(&end) {
                *reach = reach.min(OF_EDGE * length);
            }
        }
    }
    let mut places: Vec<u32> = reach.keys().copied().collect();
    places.sort_unstable();
    let at = |v: u32| [work.position(v).to_array(); 2];
    let tree = BoxTree::new(places.iter().map(|&v| (at(v), v)));
    let mut pairs = Vec::new();
    for v in places {
        let distance = |other: u32| work.position(other).distance(work.position(v));
        let near = tree.meeting(widened(at(v), reach[&v])).copied().filter(|&other| distance(other) <= reach[&v]);
        // By number of results capped, not of those looked at: within the reach there are hardly ever two.
        let found = near.take(NEIGHBOURS).filter(|&other| other < v && distance(other) <= reach[&other]);
        pairs.extend(found.map(|other| [other, v]));
    }
    for [v, w] in pairs {
        work.places.join(v, w);
    }
}
