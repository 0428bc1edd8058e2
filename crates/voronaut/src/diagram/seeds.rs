//! From a seed to the canvas vertices around it, with exact local distances.

use super::Flat;
use crate::canvas::Canvas;
use crate::error::{Error, Result};
use crate::geodesic::bowed_chord;
use crate::geometry::{Orientation, Point, orientation};
use crate::lists::distinct;
use crate::parallel::prelude::*;
use crate::planar::{Location, Planar};
use crate::triangulation::{HalfEdge, VertexId};
use std::collections::BTreeMap;

/// A canvas vertex in sight of a seed, and the metric length of the geodesic between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    pub(super) vertex: VertexId,
    pub(super) distance: f64,
}

/// How many faces away from the one that holds it a seed looks for vertices: fronts are most curved, and poorest, where
/// they start.
const SIGHT: u32 = 3;

/// What starts may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Care {
    /// All vertices in sight, each by the length of its geodesic.
    Full,
    /// Beyond the face of the seed by straight lines and Simpson's rule, two evaluations each: poorer where the metric varies much,
    /// for a tenth of the evaluations; good enough to find where seeds are far.
    Quick,
}

/// The starts of many seeds, as for [`starts_in`]. Where the domain touches itself in a point and seeds are the vertices of a
/// mesh of it, as many seeds in the point as there are fans have a fan each, in order.
///
/// # Errors
/// A seed, by number, is outside the domain.
pub(super) fn starts_of_all(ground: Flat, seeds: &[Point], are_vertices: bool, care: Care) -> Result<Vec<Vec<Start>>> {
    let mut found: Vec<Vec<Location>> = Vec::with_capacity(seeds.len());
    for (i, location) in ground.canvas.locate_all(seeds).into_iter().enumerate() {
        let location = location.ok_or_else(|| outside(format!("seed {} {}", i + 1, seeds[i])))?;
        found.push(places(ground.canvas, location));
    }
    if are_vertices {
        share_fans(&mut found);
    }
    let measured = |(&seed, places): (&Point, &Vec<Location>)| starts_in(ground, seed, places, care);
    Ok(seeds.par_iter().zip(&found).with_min_len(64).map(measured).collect())
}

/// All fans of a place.
pub(super) fn places(canvas: &Canvas, location: Location) -> Vec<Location> {
    match location {
        Location::Vertex(v) => canvas.copies(v).into_iter().map(Location::Vertex).collect(),
        other => vec![other],
    }
}

fn share_fans(found: &mut [Vec<Location>]) {
    let mut seeds_at: BTreeMap<VertexId, Vec<usize>> = BTreeMap::new();
    for (i, places) in found.iter().enumerate() {
        if let [Location::Vertex(first), _, ..] = places[..] {
            seeds_at.entry(first).or_default().push(i);
        }
    }
    for seeds in seeds_at.into_values() {
        if seeds.len() == found[seeds[0]].len() {
            for (k, i) in seeds.into_iter().enumerate() {
                found[i] = vec![found[i][k]];
            }
        }
    }
}

/// The starts of a seed in places: every vertex of the embedded face that holds it, and those in sight across its edges.
/// Where the domain touches itself in a point, a seed there starts in all fans.
pub(super) fn starts_in(ground: Flat, seed: Point, places: &[Location], care: Care) -> Vec<Start> {
    places.iter().flat_map(|&location| starts_at(ground, seed, location, care)).collect()
}

fn starts_at(Flat { canvas, field }: Flat, seed: Point, location: Location, care: Care) -> Vec<Start> {
    let planar = canvas.embedded();
    let (rim, near) = around(planar, location);
    let mut far = Vec::new();
    for h in rim {
        let [right, left] = planar.ends(h);
        look(planar, seed, h, [right, left], SIGHT, &mut far);
    }
    let (near, mut far) = (distinct(near), distinct(far));
    far.retain(|v| near.binary_search(v).is_err());
    let geodesic = |vertex: VertexId| Start { vertex, distance: bowed_chord(field, seed, planar.position(vertex)) };
    if care == Care::Full {
        return near.into_iter().chain(far).map(geodesic).collect();
    }
    let tensor = field.at(seed);
    let straight = |vertex: VertexId| {
        let q = planar.position(vertex);
        let [middle, end] = [seed.midpoint(q), q].map(|p| field.at(p).length(q - seed));
        Start { vertex, distance: (tensor.length(q - seed) + 4.0 * middle + end) / 6.0 }
    };
    near.into_iter().map(geodesic).chain(far.into_iter().map(straight)).collect()
}

/// The edges around the faces that hold a place, and the vertices of these faces.
fn around(planar: &Planar, location: Location) -> (Vec<HalfEdge>, Vec<VertexId>) {
    let topology = &planar.topology;
    let rim: Vec<HalfEdge> = match location {
        Location::Vertex(v) => topology.star(v).map(HalfEdge::next).collect(),
        Location::Face(f) => f.half_edges().to_vec(),
        Location::Edge(h) | Location::Behind(h) => {
            let sides = topology.sides(h);
            sides.flat_map(|side| [side.next(), side.prev()]).collect()
        }
    };
    let mut near: Vec<VertexId> = rim.iter().flat_map(|&h| topology.ends(h)).collect();
    if let Location::Vertex(v) = location {
        near.push(v);
    }
    (rim, near)
}

/// Collects the vertices that the seed sees across an edge, between two directions, within so many faces.
fn look(planar: &Planar, seed: Point, h: HalfEdge, [right, left]: [Point; 2], faces: u32, seen: &mut Vec<VertexId>) {
    let Some(t) = planar.topology.twin(h).filter(|_| faces > 0) else { return };
    let w = planar.topology.apex(t);
    let p = planar.position(w);
    let is_right = orientation(seed, right, p) == Orientation::Right;
    let is_left = orientation(seed, left, p) == Orientation::Left;
    if !is_right && !is_left {
        seen.push(w);
    }
    if !is_right {
        look(planar, seed, t.next(), [right, if is_left { left } else { p }], faces - 1, seen);
    }
    if !is_left {
        look(planar, seed, t.prev(), [if is_right { right } else { p }, left], faces - 1, seen);
    }
}

pub(super) fn outside(place: String) -> Error {
    Error::domain("a seed outside the domain", place, "remove it, or move it into the domain")
}
