//! The interior by farthest points (RR-9103, section 13): seeds one at a time at the canvas vertex that is farthest, in
//! geodesic distance, from all seeds so far.

use super::interior::{Fill, SPACING};
use super::queue::Entry;
use crate::diagram::{Diagram, Ground};
use crate::dual::{Dual, Moving};
use crate::error::Result;
use crate::geometry::{Point, holds};
use crate::metric::MetricField;
use crate::planar::Location;
use crate::progress::Progress;
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use std::collections::binary_heap::PeekMut;
use std::collections::{BTreeSet, BinaryHeap};

/// The canvas vertices of a diagram by their distance from the seeds, farthest first, while seeds are inserted.
///
/// Insertions only shorten distances. So a heap of distances as they once were will do: where the first entry's distance
/// is still the vertex's, no other vertex is farther; where it is not, it goes back with the present one. (Computed
/// distances may also grow, by part of their error, where a new border keeps fronts from crossing a face. The vertex
/// taken is the farthest but for that.)
pub struct Farthest {
    heap: BinaryHeap<Entry<VertexId>>,
}

impl Farthest {
    /// The vertices that may become seeds, as `accept` says.
    pub(crate) fn new<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>, accept: impl Fn(VertexId) -> bool) -> Self {
        let vertices = (0..diagram.vertex_count() as u32).map(VertexId).filter(|&v| accept(v));
        Self { heap: vertices.map(|of| Entry { value: diagram.distance(of), of }).collect() }
    }

    /// Takes out the farthest vertex, with its distance; `None` where none is left that is no seed itself. Between
    /// [`Farthest::new`] and this seeds may have been inserted into the diagram, not removed.
    pub(crate) fn pop<'a, G: Ground<'a>>(&mut self, diagram: &Diagram<'a, G>) -> Option<(VertexId, f64)> {
        loop {
            let mut first = self.heap.peek_mut()?;
            let now = diagram.distance(first.of);
            if now < first.value {
                first.value = now;
            } else {
                let Entry { of, .. } = PeekMut::pop(first);
                return (now > 0.0).then_some((of, now));
            }
        }
    }
}

/// Inserts seeds into a diagram, each at the canvas vertex that is farthest from all seeds and that `insert` accepts (it says whether it
/// did), until there are so many, or none is left that is farther than `least`. `may_hold` says which vertices may be seeds.
///
/// # Errors
/// Only that of being told to stop.
pub(crate) fn fill_farthest<'a, G: Ground<'a>>(
    diagram: &mut Diagram<'a, G>,
    count: usize,
    least: f64,
    may_hold: impl Fn(VertexId) -> bool,
    progress: &dyn Progress,
    mut insert: impl FnMut(&mut Diagram<'a, G>, VertexId),
) -> Result<()> {
    let mut farthest = Farthest::new(diagram, may_hold);
    let mut reported = diagram.colours();
    while diagram.colours() < count {
        let Some((v, _)) = farthest.pop(diagram).filter(|&(_, distance)| distance >= least) else { break };
        insert(diagram, v);
        if diagram.colours() >= reported + 256 {
            progress.advance((diagram.colours() - reported) as u64)?;
            reported = diagram.colours();
        }
    }
    Ok(())
}

/// Inserts seeds into a dual whose vertices are, in order of their ids, the seeds of the diagram, and into that diagram:
/// each at the canvas vertex inside the domain, on no segment, that is farthest from all seeds. Ends when the dual has
/// as many vertices as asked for, when there is no such vertex, or, with [`Fill::AtMost`], when all are nearer than the
/// least spacing of seeds. The dual's field is the diagram's times the dual's factor.
///
/// A vertex at which the plane allows no seed (rounding) is passed over. Returns the number of seeds.
pub(crate) fn refine_farthest(
    dual: &mut Dual,
    diagram: &mut Diagram,
    fill: Fill,
    progress: &dyn Progress,
) -> Result<usize> {
    let canvas = diagram.canvas();
    let topology = &canvas.embedded().topology;
    let is_free = |v: VertexId| topology.star(v).all(|h| !topology.is_fixed(h) && !topology.is_fixed(h.prev()));
    let mut seeds: Vec<VertexId> = dual.topology().vertices().collect();
    let least = if matches!(fill, Fill::AtMost(_)) { SPACING / dual.field().factor.sqrt() } else { 0.0 };
    let before = dual.vertex_count();
    fill_farthest(diagram, fill.count(), least, is_free, progress, |diagram, v| {
        let near = diagram.colour(v).map_or(seeds[0], |colour| seeds[colour as usize]);
        if let Some(seed) = insert(dual, near, canvas.position(v)) {
            diagram.insert_at_vertex(v);
            seeds.push(seed);
        }
    })?;
    dual.take_touched();
    Ok(dual.vertex_count() - before)
}

/// Puts a free seed where it can be had.
fn insert(dual: &mut Dual, near: VertexId, p: Point) -> Option<VertexId> {
    match locate(dual, near, p)? {
        Location::Face(f) => dual.insert_in_face(f, p),
        Location::Edge(h) if !dual.topology().is_fixed(h) => dual.insert_on_edge(h, p),
        _ => None,
    }
}

/// Straight from a vertex that is near in the metric; where a hole bars the way, around it.
fn locate(dual: &Dual, near: VertexId, p: Point) -> Option<Location> {
    let from = dual.topology().start(near)?.face();
    match dual.planar().walk(from, p, false) {
        Location::Behind(_) => search(dual, from, p).map(|face| dual.planar().walk(face, p, false)),
        found => Some(found),
    }
}

/// The face that holds a point, from face to neighbour, nearest first.
fn search(dual: &Dual, from: FaceId, p: Point) -> Option<FaceId> {
    let tensor = dual.field().at(p);
    let entry = |of: FaceId| {
        let lengths = dual.planar().triangle(of).map(|q| tensor.length(q - p));
        Entry { value: -lengths.into_iter().fold(f64::INFINITY, f64::min), of }
    };
    let mut seen = BTreeSet::from([from]);
    let mut heap = BinaryHeap::from([entry(from)]);
    while let Some(Entry { of: face, .. }) = heap.pop() {
        if holds(dual.planar().triangle(face), p) {
            return Some(face);
        }
        let beyond = face.half_edges().into_iter().filter_map(|h| dual.topology().twin(h)).map(HalfEdge::face);
        heap.extend(beyond.filter(|&f| seen.insert(f)).map(entry));
    }
    None
}
