//! From a seed to the canvas vertices around it, with exact local distances.

use crate::canvas::Canvas;
use crate::error::{Error, Result};
use crate::geodesic::chord;
use crate::geometry::Point;
use crate::metric::MetricField;
use crate::planar::{Location, hilbert_order};
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use rayon::prelude::*;

/// A canvas vertex and the metric length of the straight segment to it from a seed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Start {
    pub(super) vertex: VertexId,
    pub(super) distance: f64,
}

/// The starts of a seed: every vertex of the embedded face that holds it; of both faces where it lies on an edge, of all
/// around a vertex where it lies on one.
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
    let topology = &canvas.embedded().topology;
    let mut vertices: Vec<VertexId> = match location {
        Location::Vertex(v) => topology.star(v).flat_map(|h| [v, topology.target(h), topology.apex(h)]).collect(),
        Location::Face(f) => topology.corners(f).into(),
        Location::Edge(h) | Location::Behind(h) => {
            let faces = [Some(h), topology.twin(h)].into_iter().flatten().map(HalfEdge::face);
            faces.flat_map(|f| topology.corners(f)).collect()
        }
    };
    vertices.sort_unstable();
    vertices.dedup();
    let start = |vertex: VertexId| Start { vertex, distance: chord(field, seed, canvas.position(vertex)) };
    vertices.into_iter().map(start).collect()
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
