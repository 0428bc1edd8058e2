//! What a propagation says of a vertex, and where it starts from.

use crate::triangulation::{HalfEdge, VertexId};
use std::cmp::Ordering;

/// The colour of a vertex that no source reaches.
pub(crate) const NO_COLOUR: u32 = u32::MAX;

/// Distance to the nearest source, the source's colour, and what the distance was computed from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Label {
    /// Metric distance; infinite where no source reaches.
    pub distance: f64,
    /// Colour of the source; `NO_COLOUR` where none reaches.
    pub colour: u32,
    pub(super) support: u32,
}

/// What a distance was computed from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Support {
    /// No source reaches the vertex.
    Nothing,
    /// A source beside the vertex, or one that distances lead straight from.
    Source,
    /// Both ends of the half-edge, opposite to the vertex in its face or (unfolded) in the face beyond.
    Edge(HalfEdge),
    /// The other end of this edge, along it.
    Vertex(HalfEdge),
    /// This neighbour, in a graph; of two the nearer to the source.
    Neighbour(VertexId),
}

const NOTHING: u32 = u32::MAX;
const SOURCE: u32 = u32::MAX - 1;
/// Kinds of support that name a half-edge or a vertex, in the last digit of its code: ids are below 2^32 / 3.
const KINDS: u32 = 3;

impl Label {
    /// The label of a vertex that no source reaches.
    pub(crate) const FAR: Label = Label { distance: f64::INFINITY, colour: NO_COLOUR, support: NOTHING };

    pub(super) fn new(distance: f64, colour: u32, support: Support) -> Self {
        let support = match support {
            Support::Nothing => NOTHING,
            Support::Source => SOURCE,
            Support::Edge(h) => KINDS * h.0,
            Support::Vertex(h) => KINDS * h.0 + 1,
            Support::Neighbour(v) => KINDS * v.0 + 2,
        };
        Self { distance, colour, support }
    }

    /// The label of a vertex that has its distance straight from a source.
    pub(crate) fn of_source(distance: f64, colour: u32) -> Self {
        Self::new(distance, colour, Support::Source)
    }

    /// What the distance was computed from.
    pub(crate) fn support(&self) -> Support {
        match self.support {
            NOTHING => Support::Nothing,
            SOURCE => Support::Source,
            code => match code % KINDS {
                0 => Support::Edge(HalfEdge(code / KINDS)),
                1 => Support::Vertex(HalfEdge(code / KINDS)),
                _ => Support::Neighbour(VertexId(code / KINDS)),
            },
        }
    }

    /// Nearer first; of equally near the smaller colour, of those the smaller support.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        let by_distance = self.distance.total_cmp(&other.distance);
        by_distance.then_with(|| (self.colour, self.support).cmp(&(other.colour, other.support)))
    }

    pub(super) fn is_before(&self, other: &Self) -> bool {
        self.order(other) == Ordering::Less
    }
}

/// Where distances start: at every vertex the sources beside it, each by its distance and colour.
#[derive(Clone, Debug)]
pub(crate) struct Sources(Vec<Vec<(f64, u32)>>);

impl Sources {
    /// No sources on a canvas with so many vertices.
    pub(crate) fn new(vertices: usize) -> Self {
        Self(vec![Vec::new(); vertices])
    }

    /// Adds a start at a vertex.
    pub(crate) fn add(&mut self, v: VertexId, distance: f64, colour: u32) {
        self.0[v.index()].push((distance, colour));
    }

    /// Removes all starts of a colour at a vertex.
    pub(crate) fn remove(&mut self, v: VertexId, colour: u32) {
        self.0[v.index()].retain(|start| start.1 != colour);
    }

    /// The starts at a vertex: distance and colour.
    pub(crate) fn at(&self, v: VertexId) -> &[(f64, u32)] {
        &self.0[v.index()]
    }

    /// The nearest start at a vertex.
    pub(super) fn nearest(&self, v: VertexId) -> Label {
        let labels = self.at(v).iter().map(|&(distance, colour)| Label::of_source(distance, colour));
        labels.fold(Label::FAR, |best, label| if label.is_before(&best) { label } else { best })
    }

    /// The vertices that have a start.
    pub(crate) fn vertices(&self) -> impl Iterator<Item = VertexId> + '_ {
        (0..self.0.len() as u32).map(VertexId).filter(|&v| !self.at(v).is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_come_and_go() {
        let mut sources = Sources::new(3);
        let v = VertexId(1);
        sources.add(v, 0.5, 7);
        sources.add(v, 0.25, 9);
        sources.add(v, 0.25, 8);
        assert_eq!((sources.nearest(v).colour, sources.vertices().count()), (8, 1));
        sources.remove(v, 8);
        sources.remove(v, 9);
        assert_eq!(sources.at(v), [(0.5, 7)]);
        sources.add(v, 0.1, 3);
        assert_eq!(sources.nearest(v).colour, 3);
        assert_eq!(sources.nearest(VertexId(0)), Label::FAR);
    }
}
