//! From a seed to the canvas vertices around it, with exact local distances.

use crate::canvas::Canvas;
use crate::error::{Error, Result};
use crate::geodesic::bowed_chord;
use crate::geometry::{Orientation, Point, orientation};
use crate::metric::MetricField;
use crate::planar::{Location, Planar, hilbert_order};
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use rayon::prelude::*;

/// A canvas vertex in sight of a seed, and the metric length of the geodesic between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Start {
    pub(super) vertex: VertexId,
    pub(super) distance: f64,
}

/// How many faces away from the one that holds it a seed looks for vertices: fronts are most curved, and poorest, where
/// they start.
const SIGHT: u32 = 3;

/// The starts of a seed: every vertex of the embedded face that holds it, and those in sight across its edges.
///
/// # Errors
/// The seed is outside the domain.
pub(super) fn starts(canvas: &Canvas, field: &dyn MetricField, seed: Point) -> Result<Vec<Start>> {
    let location = canvas.locate(seed).ok_or_else(|| outside(seed))?;
    Ok(starts_at(canvas, field, seed, location))
}

/// [`starts`] of many seeds: located one after the other along a curve, measured in parallel.
///
/// # Errors
/// A seed, by number, is outside the domain.
pub(super) fn starts_of_all(canvas: &Canvas, field: &dyn MetricField, seeds: &[Point]) -> Result<Vec<Vec<Start>>> {
    if let Some(i) = seeds.iter().position(|p| !p.is_finite()) {
        return Err(numbered(i, seeds[i]));
    }
    let mut locations: Vec<Option<Location>> = vec![None; seeds.len()];
    let mut near: Option<FaceId> = None;
    for i in hilbert_order(seeds).into_iter().map(|i| i as usize) {
        let found = near.map_or_else(|| canvas.locate(seeds[i]), |f| canvas.locate_from(f, seeds[i]));
        near = found.and_then(|location| face_of(canvas, location)).or(near);
        locations[i] = found;
    }
    if let Some(i) = locations.iter().position(Option::is_none) {
        return Err(numbered(i, seeds[i]));
    }
    let measured = |(&seed, &location): (&Point, &Option<Location>)| {
        location.map_or_else(Vec::new, |location| starts_at(canvas, field, seed, location))
    };
    Ok(seeds.par_iter().zip(&locations).with_min_len(64).map(measured).collect())
}

/// [`starts`] of a seed at a canvas vertex.
pub(super) fn starts_at_vertex(canvas: &Canvas, field: &dyn MetricField, v: VertexId) -> Vec<Start> {
    starts_at(canvas, field, canvas.position(v), Location::Vertex(v))
}

fn starts_at(canvas: &Canvas, field: &dyn MetricField, seed: Point, location: Location) -> Vec<Start> {
    let planar = canvas.embedded();
    let topology = &planar.topology;
    let edges_of = |f: FaceId| f.half_edges().into_iter();
    let rim: Vec<HalfEdge> = match location {
        Location::Vertex(v) => topology.star(v).map(HalfEdge::next).collect(),
        Location::Face(f) => edges_of(f).collect(),
        Location::Edge(h) | Location::Behind(h) => {
            let sides = [Some(h), topology.twin(h)].into_iter().flatten();
            sides.flat_map(|side| [side.next(), side.prev()]).collect()
        }
    };
    let mut vertices: Vec<VertexId> = rim.iter().flat_map(|&h| [topology.origin(h), topology.target(h)]).collect();
    if let Location::Vertex(v) = location {
        vertices.push(v);
    }
    for h in rim {
        let [right, left] = planar.ends(h);
        look(planar, seed, h, [right, left], SIGHT, &mut vertices);
    }
    vertices.sort_unstable();
    vertices.dedup();
    let start = |vertex: VertexId| Start { vertex, distance: bowed_chord(field, seed, planar.position(vertex)) };
    vertices.into_iter().map(start).collect()
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

fn face_of(canvas: &Canvas, location: Location) -> Option<FaceId> {
    match location {
        Location::Face(f) => Some(f),
        Location::Edge(h) | Location::Behind(h) => Some(h.face()),
        Location::Vertex(v) => canvas.embedded().topology.start(v).map(HalfEdge::face),
    }
}

fn outside(seed: Point) -> Error {
    Error::domain("a seed outside the domain", seed.to_string(), "remove it, or move it into the domain")
}

fn numbered(i: usize, seed: Point) -> Error {
    let place = format!("seed {} {seed}", i + 1);
    Error::domain("a seed outside the domain", place, "remove it, or move it into the domain")
}
