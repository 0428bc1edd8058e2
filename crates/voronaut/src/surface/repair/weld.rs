//! Which vertices are at one place.

use super::mended::Damage;
use super::work::Work;
use crate::error::{Error, Result};
use crate::geometry::{BoxTree, widened};
use crate::surface::orient::sides;
use std::collections::HashMap;

/// Vertices on borders this close, as a share of the diagonal, are at one place.
const NEAR: f64 = 1e-9;
/// And not farther than this share of the shortest edge at either: what is small is not a point because something else is large.
const OF_EDGE: f64 = 1e-2;
/// Near vertices that are looked at, at most.
const NEIGHBOURS: usize = 8;

/// Drops triangles with coordinates that are not finite, if damage is to be repaired.
///
/// # Errors
/// [`Error::Domain`] with the vertex, if it is not.
pub(super) fn drop_not_finite(work: &mut Work) -> Result<()> {
    let is_finite = |v: u32| work.mesh.position(v).is_finite();
    let marked: Vec<bool> = work.triangles.iter().map(|t| !t.iter().all(|&v| is_finite(v))).collect();
    let Some(first) = marked.iter().position(|&marked| marked) else { return Ok(()) };
    if !work.options.repair {
        let at = work.triangles[first].into_iter().find(|&v| !is_finite(v)).unwrap_or_default();
        let help = "correct the vertex, or run again with `repair`: its triangles are dropped then";
        return Err(Error::domain("a coordinate is not finite", work.vertex(at), help));
    }
    for t in (0..marked.len()).filter(|&t| marked[t]) {
        work.note_triangle(Damage::NotFinite, t);
    }
    work.drop_marked(&marked);
    Ok(())
}

/// Finds vertices at one place: with the same coordinates; and on borders, which soups are made of, nearly so.
///
/// Nothing is joined by that yet: sides of triangles will be, where they are at the same places and a surface comes out.
pub(super) fn find_places(work: &mut Work) {
    let mut first: HashMap<[u64; 3], u32> = HashMap::new();
    let mut used = work.triangles.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    for v in used {
        // Adding zero makes -0 equal to 0 in its bits, too.
        let key = work.mesh.points[v as usize].map(|x| (x + 0.0).to_bits());
        let at = *first.entry(key).or_insert(v);
        work.places.join(at, v);
    }
    work.places.flatten();
    join_near(work);
    work.places.flatten();
}

/// Joins places on borders that are next to each other.
fn join_near(work: &mut Work) {
    let mut reach: HashMap<u32, f64> = HashMap::new();
    let by_places: Vec<[u32; 3]> = (0..work.triangles.len()).map(|t| work.places_of(t)).collect();
    let all = sides(&by_places);
    for group in all.chunk_by(|s, t| s.ends == t.ends).filter(|group| group.len() == 1) {
        for end in group[0].ends {
            reach.insert(end, NEAR * work.diagonal);
        }
    }
    for side in all.iter().filter(|side| side.ends[0] != side.ends[1]) {
        let length = work.position(side.ends[0]).distance(work.position(side.ends[1]));
        for end in side.ends {
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
