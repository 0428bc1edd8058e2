//! Short-term vector Dijkstra: the last few edges of a way count as one straight piece.

use super::Graph;
use super::label::{Label, Support};
use super::sweep::{Step, beyond};
use crate::geometry::{Tensor, Vector};
use crate::triangulation::VertexId;

/// Short-term vector Dijkstra (Campen 2013), the method of RR-9103.
///
/// From the vertex a that a front has reached to its neighbour x the distance is the least over the last predecessors of
/// a, as many as the window has: the predecessor's distance, and the length of the straight line from there to x,
/// measured by the metric along the way's edges, each projected on that line. The window being fixed, the relative error does
/// not vanish on fine canvases. It is not the same in other coordinates either: the projection is Euclidean.
///
/// On a surface the window ends where that turns away: there are no straight lines around a bend.
///
/// The least may be less than the distance at a. As every other method, this one says then that x is not nearer than a.
/// Labels are mended by making them anew: they depend on the order of work.
#[derive(Clone, Debug)]
pub(crate) struct Stvd {
    graph: Graph,
    /// The symmetric square roots F of the tensors: F' F = M.
    roots: Vec<Tensor>,
    window: usize,
}

impl Stvd {
    /// On a graph, with a window of so many edges, at least one; with one it is Dijkstra's method with another rule for the
    /// lengths of edges.
    pub(crate) fn on(graph: Graph, window: usize) -> Self {
        let roots = graph.vertices().map(|v| graph.tensor(v).map_eigenvalues(f64::sqrt)).collect();
        Self { graph, roots, window: window.max(1) }
    }
}

/// Windows up to this have room for their edges from the beginning.
const USUAL: usize = 64;

/// The length of a way's edges, each with its tensor's root and projected on the line along the unit vector u; not negative.
fn projected(edges: &[(Vector, Tensor)], u: Vector) -> f64 {
    let lengths = edges.iter().map(|&(edge, root)| edge.dot(u) * root.apply(u).norm());
    lengths.sum::<f64>().max(0.0)
}

impl Step for Stvd {
    fn graph(&self) -> &Graph {
        &self.graph
    }

    fn carry(&self, labels: &[Label], from: VertexId, x: VertexId) -> Label {
        let graph = &self.graph;
        let sight = graph.sight();
        let label = labels[from.index()];
        let mut edges: Vec<(Vector, Tensor)> = Vec::with_capacity(self.window.min(USUAL));
        let is_bent = !sight.is_flat(x, from);
        let mut best = if is_bent { label.distance + graph.length(from, x) } else { f64::INFINITY };
        let (mut near, mut next) = (x, Some(from));
        while let Some(a) = next.filter(|&a| edges.len() < self.window && sight.is_flat(x, a)) {
            let root = [near, a].map(|v| sight.turned(x, v, self.roots[v.index()]));
            let root = (root[0] + root[1]) * 0.5;
            edges.push((sight.line(x, a, near), root));
            let line = sight.line(x, a, x);
            let length = line.norm();
            if length > 0.0 {
                best = best.min(labels[a.index()].distance + projected(&edges, line * (1.0 / length)));
            }
            near = a;
            next = match labels[a.index()].support() {
                Support::Neighbour(before) => Some(before),
                _ => None,
            };
        }
        Label::new(beyond(best, label.distance), label.colour, Support::Neighbour(from))
    }
}
