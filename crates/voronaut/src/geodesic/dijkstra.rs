//! Dijkstra's distances on a graph: shortest ways along its edges. The baseline: however fine the canvas, ways stay on edges,
//! and are too long by a share that depends on how many directions these have.

use super::label::{Label, Sources, Support};
use super::sweep::{self, Step, beyond};
use super::{Geodesic, Graph, Patches, Propagation};
use crate::triangulation::VertexId;

/// Shortest ways along the edges of a graph, of lengths [`Graph::length`] (Dijkstra 1959).
///
/// Labels are mended as in [`Marching`](super::Marching): by work on what has changed, with the result of making them anew.
#[derive(Clone, Debug)]
pub(crate) struct Dijkstra {
    graph: Graph,
}

impl Dijkstra {
    /// On a graph.
    pub(crate) fn on(graph: Graph) -> Self {
        Self { graph }
    }
}

impl Step for Dijkstra {
    fn carry(&self, graph: &Graph, labels: &[Label], from: VertexId, x: VertexId) -> Label {
        let label = labels[from.index()];
        let distance = beyond(label.distance + graph.length(from, x), label.distance);
        Label::new(distance, label.colour, Support::Neighbour(from))
    }
}

impl Geodesic for Dijkstra {
    fn propagate(&self, sources: &Sources) -> Propagation {
        sweep::propagate(self, &self.graph, sources)
    }

    fn update(&self, sources: &Sources, changed: &[VertexId], state: &mut Propagation) {
        let mut mending = Mending { dijkstra: self, sources, state };
        mending.state.mark_settled();
        for &v in changed {
            mending.reconsider(v);
        }
        while let Some(v) = mending.state.front.pop() {
            mending.settle(v);
        }
    }

    fn patches(&self) -> Box<dyn Patches + '_> {
        sweep::patches(self, &self.graph)
    }
}

/// LPA* (Koenig, Likhachev and Furcy 2004), as [`march`](super::march) has it.
struct Mending<'a> {
    dijkstra: &'a Dijkstra,
    sources: &'a Sources,
    state: &'a mut Propagation,
}

impl Mending<'_> {
    fn settle(&mut self, v: VertexId) {
        let (old, due) = (self.state.labels[v.index()], self.state.due[v.index()]);
        self.state.counters.settled += 1;
        if due.is_before(&old) {
            self.state.labels[v.index()] = due;
            self.reconsider_dependents(v);
            self.spread(v);
        } else {
            self.state.counters.withdrawn += 1;
            self.state.labels[v.index()] = Label::FAR;
            self.reconsider_dependents(v);
            self.state.enqueue(v);
        }
    }

    fn spread(&mut self, v: VertexId) {
        let graph = &self.dijkstra.graph;
        for &x in graph.neighbours(v) {
            self.state.counters.crossings += 1;
            let label = self.dijkstra.carry(graph, &self.state.labels, v, x);
            if label.is_before(&self.state.due[x.index()]) {
                self.state.due[x.index()] = label;
                self.state.enqueue(x);
            }
        }
    }

    fn reconsider_dependents(&mut self, v: VertexId) {
        for &x in self.dijkstra.graph.neighbours(v) {
            if self.state.due[x.index()].support() == Support::Neighbour(v) {
                self.reconsider(x);
            }
        }
    }

    /// Computes the due label anew from all neighbours that have one.
    fn reconsider(&mut self, x: VertexId) {
        let graph = &self.dijkstra.graph;
        let has_label = |v: &&VertexId| self.state.labels[v.index()].support() != Support::Nothing;
        let carried =
            graph.neighbours(x).iter().filter(has_label).map(|&v| self.dijkstra.carry(graph, &self.state.labels, v, x));
        let best =
            carried.fold(self.sources.nearest(x), |best, label| if label.is_before(&best) { label } else { best });
        self.state.counters.reconsidered += 1;
        self.state.due[x.index()] = best;
        self.state.enqueue(x);
    }
}
