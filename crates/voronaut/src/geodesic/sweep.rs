//! One sweep of fronts over a graph, from any number of sources at once: what the methods on graphs share.
//!
//! (RR-9103, section 6.3.) The vertex with the least distance is settled and offers labels to its neighbours. How a
//! distance gets from one to the other is the method's [`Step`]; whether settled vertices may be corrected is, too.

use super::front::Front;
use super::label::{Label, Sources, Support};
use super::mending::{Propagation, Rule};
use super::{Geodesic, Graph, MarchCounters, Patches};
use crate::triangulation::VertexId;

/// How a method carries distances over an edge of the graph that it travels on.
pub(super) trait Step: Sync + Sized {
    /// What it travels on.
    fn graph(&self) -> &Graph;

    /// The share of its distance by which a settled vertex must improve to be settled once more; `None`: it never is.
    fn correction(&self) -> Option<f64> {
        None
    }

    /// The label that x has from the label of its neighbour `from`, which has one: greater than those it rests on.
    fn carry(&self, labels: &[Label], from: VertexId, x: VertexId) -> Label;

    /// As [`Geodesic::update`]: by making labels anew, for as a rule they depend on the order of work.
    fn mend(&self, sources: &Sources, _changed: &[VertexId], state: &mut Propagation) {
        state.replace(self.propagate(sources));
    }
}

impl<S: Step> Geodesic for S {
    fn propagate(&self, sources: &Sources) -> Propagation {
        let mut sweep = Sweep::new(self, Status::Open);
        for v in sources.vertices() {
            sweep.start(v, sources.nearest(v));
        }
        sweep.run();
        Propagation::of(sweep.labels, sweep.counters)
    }

    fn update(&self, sources: &Sources, changed: &[VertexId], state: &mut Propagation) {
        self.mend(sources, changed, state);
    }

    fn patches(&self) -> Box<dyn Patches + '_> {
        Box::new(Sweep::new(self, Status::Outside))
    }
}

/// Shortest ways along the edges of a graph, of lengths [`Graph::length`] (Dijkstra 1959). The baseline: however fine the
/// canvas, ways stay on edges, and are too long by a share that depends on how many directions these have.
///
/// Labels are mended as in [`Marching`](super::Marching): by work on what has changed, with the result of making them anew.
#[derive(Clone, Debug)]
pub(crate) struct Dijkstra(pub Graph);

impl Step for Dijkstra {
    fn graph(&self) -> &Graph {
        &self.0
    }

    fn carry(&self, labels: &[Label], from: VertexId, x: VertexId) -> Label {
        let label = labels[from.index()];
        let distance = beyond(label.distance + self.0.length(from, x), label.distance);
        Label::new(distance, label.colour, Support::Neighbour(from))
    }

    fn mend(&self, sources: &Sources, changed: &[VertexId], state: &mut Propagation) {
        state.mend(self, sources, changed);
    }
}

impl Rule for Dijkstra {
    fn spread(&self, labels: &[Label], v: VertexId, mut offer: impl FnMut(VertexId, Label)) -> u64 {
        let neighbours = self.0.neighbours(v);
        for &x in neighbours {
            offer(x, self.carry(labels, v, x));
        }
        neighbours.len() as u64
    }

    fn gather(&self, labels: &[Label], x: VertexId, mut offer: impl FnMut(Label)) -> u64 {
        let has_label = |v: &VertexId| labels[v.index()].support() != Support::Nothing;
        self.near(x).filter(has_label).for_each(|v| offer(self.carry(labels, v, x)));
        0
    }

    fn near(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        self.0.neighbours(v).iter().copied()
    }

    fn rests_on(&self, due: &Label, v: VertexId) -> bool {
        due.support() == Support::Neighbour(v)
    }
}

/// Labels in the making.
struct Sweep<'a, S> {
    step: &'a S,
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
    fn new(step: &'a S, status: Status) -> Self {
        let n = step.graph().vertex_count();
        let counters = MarchCounters::default();
        let (labels, status) = (vec![Label::FAR; n], vec![status; n]);
        Self { step, labels, status, front: Front::new(n), counters }
    }

    fn start(&mut self, v: VertexId, label: Label) {
        if self.status[v.index()] == Status::Open && label.is_before(&self.labels[v.index()]) {
            self.labels[v.index()] = label;
            self.front.set(v, &label);
        }
    }

    fn run(&mut self) {
        let graph = self.step.graph();
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
        let label = self.step.carry(&self.labels, v, x);
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
