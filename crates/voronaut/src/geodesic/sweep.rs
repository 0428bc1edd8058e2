//! One sweep of fronts over a graph, from any number of sources at once: what the methods on graphs share.
//!
//! (RR-9103, section 6.3.) The vertex with the least distance is settled and offers labels to its neighbours. How a
//! distance gets from one to the other is the method's [`Step`]; whether settled vertices may be corrected is, too.

use super::front::Front;
use super::label::{Label, Sources};
use super::{Graph, MarchCounters, Patches, Propagation};
use crate::triangulation::VertexId;

/// How a method carries distances over an edge of a graph.
pub(super) trait Step: Sync {
    /// The share of its distance by which a settled vertex must improve to be settled once more; `None`: it never is.
    fn correction(&self) -> Option<f64> {
        None
    }

    /// The label that x has from the label of its neighbour `from`, which has one: greater than those it rests on.
    fn carry(&self, graph: &Graph, labels: &[Label], from: VertexId, x: VertexId) -> Label;
}

/// Labels in the making.
pub(super) struct Sweep<'a, S> {
    step: &'a S,
    graph: &'a Graph,
    labels: Vec<Label>,
    status: Vec<Status>,
    front: Front,
    counters: MarchCounters,
}

/// In the words of the report, with vertices that a sweep does not enter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Status {
    Outside,
    Open,
    Known,
}

impl<'a, S: Step> Sweep<'a, S> {
    fn new(step: &'a S, graph: &'a Graph, status: Status) -> Self {
        let n = graph.vertex_count();
        let counters = MarchCounters::default();
        let (labels, status) = (vec![Label::FAR; n], vec![status; n]);
        Self { step, graph, labels, status, front: Front::new(n), counters }
    }

    fn start(&mut self, v: VertexId, label: Label) {
        if self.status[v.index()] == Status::Open && label.is_before(&self.labels[v.index()]) {
            self.labels[v.index()] = label;
            self.front.set(v, &label);
        }
    }

    fn run(&mut self) {
        let graph = self.graph;
        while let Some(v) = self.front.pop() {
            self.status[v.index()] = Status::Known;
            self.counters.settled += 1;
            for &x in graph.neighbours(v) {
                self.offer(v, x);
            }
        }
    }

    fn offer(&mut self, v: VertexId, x: VertexId) {
        let status = self.status[x.index()];
        let correction = self.step.correction();
        if status == Status::Outside || (status == Status::Known && correction.is_none()) {
            return;
        }
        self.counters.crossings += 1;
        let old = self.labels[x.index()];
        let label = self.step.carry(self.graph, &self.labels, v, x);
        let least = old.distance * (1.0 - correction.unwrap_or(0.0));
        let is_better = if status == Status::Known { label.distance < least } else { label.is_before(&old) };
        if is_better {
            if status == Status::Known {
                self.counters.withdrawn += 1;
                self.status[x.index()] = Status::Open;
            }
            self.labels[x.index()] = label;
            self.front.set(x, &label);
        }
    }
}

/// The labels of all vertices.
pub(super) fn propagate(step: &impl Step, graph: &Graph, sources: &Sources) -> Propagation {
    let mut sweep = Sweep::new(step, graph, Status::Open);
    for v in sources.vertices() {
        sweep.start(v, sources.nearest(v));
    }
    sweep.run();
    Propagation::of(sweep.labels, sweep.counters)
}

/// Sweeps over one part of the graph after the other.
pub(super) fn patches<'a>(step: &'a impl Step, graph: &'a Graph) -> Box<dyn Patches + 'a> {
    Box::new(Sweep::new(step, graph, Status::Outside))
}

impl<S: Step> Patches for Sweep<'_, S> {
    fn distances(&mut self, patch: &[VertexId], starts: &[(VertexId, f64)]) -> Vec<f64> {
        for v in patch {
            self.status[v.index()] = Status::Open;
        }
        for &(v, distance) in starts {
            self.start(v, Label::of_source(distance, 0));
        }
        self.run();
        let found = patch.iter().map(|v| self.labels[v.index()].distance).collect();
        for v in patch {
            self.status[v.index()] = Status::Outside;
            self.labels[v.index()] = Label::FAR;
        }
        found
    }
}

/// A distance that is greater than the one it comes from, where rounding would make them equal: no way ends on its way.
pub(super) fn beyond(distance: f64, from: f64) -> f64 {
    distance.max(from.next_up())
}
