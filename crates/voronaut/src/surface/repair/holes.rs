//! Small holes that look like damage.

use super::fans::Sewn;
use super::fill::{Rim, fill};
use super::glue::NONE;
use super::mended::Damage;
use super::work::{Classes, Work};
use crate::geometry::{Aabb3, Point3};
use crate::mesh::{Network, Side, borders, edges_of, sides, sides_at, unordered};
use std::collections::{HashMap, HashSet};

/// A hole with more edges than this is no small one.
const EDGES: usize = 12;
/// Its bounding box has at most this share of the diagonal of its component's.
const EXTENT: f64 = 0.5;

/// Closes small holes, if damage is to be repaired, and else counts them.
///
/// A border of at most twelve edges is a small hole if it is at most half as large as its component and can be filled so that
/// the surface goes on over it ([`fill`]). All others are borders that were meant.
pub(super) fn close(work: &mut Work, sewn: &mut Sewn) {
    let all = sides(sewn.triangles.iter().copied());
    let borders: Vec<Side> = borders(&all).collect();
    if borders.is_empty() {
        return;
    }
    let position = |v: u32| match (v as usize).checked_sub(work.mesh.points.len()) {
        Some(i) => sewn.added[i].0,
        None => work.position(v),
    };
    let sizes = component_sizes(work, sewn, &position);
    let mut chords: HashSet<[u32; 2]> = HashSet::new();
    let (mut patches, mut places) = (Vec::new(), Vec::new());
    let vertices = work.mesh.points.len() + sewn.added.len();
    for rim in loops(vertices, &borders).into_iter().filter(|rim| (3..=EDGES).contains(&rim.len())) {
        let corners: Vec<Point3> = rim.iter().map(|side| position(side.0)).collect();
        let size = Aabb3::of(corners.iter().copied()).map_or(0.0, |bounds| bounds.diagonal());
        if size > EXTENT * sizes[rim[0].1 as usize] {
            continue;
        }
        let vertices: Vec<u32> = rim.iter().map(|side| side.0).collect();
        let apexes = rim.iter().enumerate().map(|(i, side)| {
            let ends = [side.0, vertices[(i + 1) % vertices.len()]];
            sewn.triangles[side.1 as usize].into_iter().find(|v| !ends.contains(v)).map_or(corners[i], position)
        });
        let is_edge = |ends: [u32; 2]| !sides_at(&all, ends).is_empty() || chords.contains(&ends);
        let rim_of = Rim { vertices: &vertices, corners: &corners, apexes: &apexes.collect::<Vec<_>>() };
        let Some(patch) = fill(&rim_of, is_edge) else { continue };
        chords.extend(patch.iter().copied().flat_map(edges_of).map(unordered));
        let number = sewn.numbers[rim[0].1 as usize].into_iter().find(|&v| v != NONE).unwrap_or(0);
        places.push(format!("{} edges at {}", rim.len(), work.vertex(number)));
        patches.push((patch, rim[0].1));
    }
    let kind = if work.options.repair { Damage::Closed } else { Damage::Open };
    places.into_iter().for_each(|place| work.mended.add(kind, place));
    for (patch, beside) in patches.into_iter().filter(|_| work.options.repair) {
        for triangle in patch {
            sewn.triangles.push(triangle);
            sewn.numbers.push([NONE; 3]);
            sewn.sources.push(sewn.sources[beside as usize]);
        }
    }
}

/// For each triangle the diagonal of its component's bounding box.
fn component_sizes(work: &Work, sewn: &Sewn, position: &impl Fn(u32) -> Point3) -> Vec<f64> {
    let mut parts = Classes::new(work.mesh.points.len() + sewn.added.len());
    for &[a, b, c] in &sewn.triangles {
        parts.join(a, b);
        parts.join(b, c);
    }
    parts.flatten();
    let mut bounds: HashMap<u32, Aabb3> = HashMap::new();
    for &v in sewn.triangles.as_flattened() {
        let p = position(v);
        let found = bounds.entry(parts.of(v)).or_insert(Aabb3 { min: p, max: p });
        *found = Aabb3::of([found.min, found.max, p]).unwrap_or(*found);
    }
    sewn.triangles.iter().map(|t| bounds[&parts.of(t[0])].diagonal()).collect()
}

/// The closed curves of the border: vertices in order, each with the triangle beside the edge to the next.
fn loops(vertices: usize, borders: &[Side]) -> Vec<Vec<(u32, u32)>> {
    let network = Network::new(vertices, borders.iter().map(|side| side.ends));
    let curve = |(mut v, edges): (u32, Vec<u32>)| {
        let step = |i| {
            let from = v;
            v = network.across(v, i);
            (from, borders[i as usize].triangle)
        };
        edges.into_iter().map(step).collect()
    };
    network.chains(|_| false).into_iter().map(curve).collect()
}
