//! What methods that know no triangles travel on: vertices with a tensor each, and who is whose neighbour.

use crate::geometry::{Point, Tensor, Vector};
use crate::lists::distinct;
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;
use std::fmt;
use std::sync::Arc;

/// How the vertices of a graph see each other. Each has a frame of its own: that of the plane, or one of its tangent plane.
pub(crate) trait Sight: Send + Sync {
    /// The straight line from one vertex to another, in the frame of the first of the three.
    fn line(&self, seen_from: VertexId, from: VertexId, to: VertexId) -> Vector;
    /// A tensor in the frame of the second vertex, turned to that of the first.
    fn turned(&self, seen_from: VertexId, at: VertexId, tensor: Tensor) -> Tensor;
    /// Whether what lies between two vertices is nearly flat, so that a straight line between them means something.
    fn is_flat(&self, _from: VertexId, _to: VertexId) -> bool {
        true
    }
}

/// Vertices of the plane, at these positions.
struct InPlane(Vec<Point>);

impl Sight for InPlane {
    fn line(&self, _seen_from: VertexId, from: VertexId, to: VertexId) -> Vector {
        self.0[to.index()] - self.0[from.index()]
    }

    fn turned(&self, _seen_from: VertexId, _at: VertexId, tensor: Tensor) -> Tensor {
        tensor
    }
}

/// An immutable graph over the vertices of a canvas, of whichever kind. Neighbours are reciprocal and in order.
#[derive(Clone)]
pub struct Graph {
    sight: Arc<dyn Sight>,
    tensors: Vec<Tensor>,
    /// The neighbours of v are those from `first[v]` to `first[v + 1]`.
    first: Vec<u32>,
    neighbours: Vec<VertexId>,
    /// Metric lengths of the edges to them.
    lengths: Vec<f64>,
}

impl Graph {
    /// A graph of vertices of the plane at these (Euclidean) positions with the metric there, in the units of the metric field.
    ///
    /// As for `Graph::seen_by`; positions are as many as tensors.
    pub(crate) fn new(
        positions: Vec<Point>,
        tensors: Vec<Tensor>,
        pairs: impl IntoIterator<Item = [VertexId; 2]>,
    ) -> Self {
        assert!(positions.len() == tensors.len(), "an entry for each vertex");
        Self::seen_by(Arc::new(InPlane(positions)), tensors, pairs)
    }

    /// A graph of vertices that see each other so, with the metric in the frame of each. Neighbours are named
    /// in pairs, in any order, if more than once; a vertex is never its own. Edges have their lengths by the trapezium rule: the mean
    /// of what the tensors at their ends say of a straight line.
    ///
    /// There is a tensor for each vertex.
    pub(crate) fn seen_by(
        sight: Arc<dyn Sight>,
        tensors: Vec<Tensor>,
        pairs: impl IntoIterator<Item = [VertexId; 2]>,
    ) -> Self {
        let named = pairs.into_iter().map(|[a, b]| (a.0, b.0)).filter(|(v, u)| v != u);
        let pairs = distinct(named.flat_map(|(v, u)| [(v, u), (u, v)]));
        let first = |v: usize| pairs.partition_point(|pair| (pair.0 as usize) < v) as u32;
        let first = (0..=tensors.len()).map(first).collect();
        let straight = |&(v, u): &(u32, u32)| {
            let ends = [VertexId(v), VertexId(u)];
            let said_by = |end: VertexId| tensors[end.index()].length(sight.line(end, ends[0], ends[1]));
            0.5 * (said_by(ends[0]) + said_by(ends[1]))
        };
        let lengths = pairs.iter().map(straight).collect();
        let neighbours = pairs.into_iter().map(|(_, u)| VertexId(u)).collect();
        Self { sight, tensors, first, neighbours, lengths }
    }

    /// The same graph with other lengths of its edges (metric, positive, the same in both directions).
    #[must_use]
    pub(crate) fn with_lengths(mut self, length: impl Fn(VertexId, VertexId) -> f64 + Sync) -> Self {
        let of_vertex = |v: VertexId| self.neighbours(v).iter().map(move |&u| (v, u));
        let vertices = (0..self.tensors.len() as u32).into_par_iter().with_min_len(1024).map(VertexId);
        self.lengths = vertices.flat_map_iter(of_vertex).map(|(v, u)| length(v, u)).collect();
        self
    }

    /// Number of vertices.
    pub(crate) fn vertex_count(&self) -> usize {
        self.tensors.len()
    }

    /// All vertices, in order.
    pub(crate) fn vertices(&self) -> impl Iterator<Item = VertexId> {
        (0..self.tensors.len() as u32).map(VertexId)
    }

    /// How its vertices see each other.
    pub(crate) fn sight(&self) -> &dyn Sight {
        self.sight.as_ref()
    }

    /// The metric at a vertex, in its frame.
    pub(crate) fn tensor(&self, v: VertexId) -> Tensor {
        self.tensors[v.index()]
    }

    /// The neighbours of a vertex, by their numbers.
    pub(crate) fn neighbours(&self, v: VertexId) -> &[VertexId] {
        &self.neighbours[self.first[v.index()] as usize..self.first[v.index() + 1] as usize]
    }

    /// Number of pairs of neighbours.
    pub(crate) fn edge_count(&self) -> usize {
        self.neighbours.len() / 2
    }

    /// Metric length of the edge between two vertices; infinite if they are not neighbours.
    pub(crate) fn length(&self, a: VertexId, b: VertexId) -> f64 {
        let place = self.neighbours(a).binary_search(&b);
        place.map_or(f64::INFINITY, |i| self.lengths[self.first[a.index()] as usize + i])
    }
}

impl fmt::Debug for Graph {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Graph").field("vertices", &self.vertex_count()).field("edges", &self.edge_count()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_reciprocal_and_named_once() {
        let positions = [(0.0, 0.0), (2.0, 0.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y)).to_vec();
        let tensors = vec![Tensor::IDENTITY, Tensor::new(9.0, 0.0, 1.0), Tensor::IDENTITY];
        let graph = Graph::new(positions, tensors, [[0, 1], [0, 1], [0, 0], [2, 0]].map(|pair| pair.map(VertexId)));
        assert_eq!(graph.neighbours(VertexId(0)), [VertexId(1), VertexId(2)]);
        assert_eq!(graph.neighbours(VertexId(1)), [VertexId(0)]);
        assert_eq!((graph.vertex_count(), graph.edge_count()), (3, 2));
        assert!((graph.length(VertexId(0), VertexId(1)) - 4.0).abs() < 1e-15);
        assert!(graph.length(VertexId(1), VertexId(2)).is_infinite());
        let other = graph.clone().with_lengths(|a, b| f64::from(a.0 + b.0));
        assert!([1, 2].iter().all(|&v| (other.length(VertexId(v), VertexId(0)) - f64::from(v)).abs() < 1e-15));
        assert!(graph.vertices().all(|v| graph.neighbours(v).iter().all(|&u| graph.neighbours(u).contains(&v))));
    }
}
