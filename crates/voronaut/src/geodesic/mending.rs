//! Labels found, and mended after a change, in one way: that of LPA* (Koenig, Likhachev and Furcy 2004; Ramalingam and Reps
//! 1996).
//!
//! Each vertex has its label and the *due* one, what the method's [`Rule`] makes of the labels as they stand. Vertices where
//! the two differ are on the front and are settled in the order of the lesser of both. Where the due label is the lesser, the
//! vertex takes it and tells its neighbours; where it is the greater, the label is stale - what it came from has changed,
//! perhaps behind the front - and is withdrawn, with all that rests on it.

use super::MarchCounters;
use super::front::Front;
use super::label::{Label, Sources, Support};
use crate::triangulation::VertexId;

/// How the labels of vertices follow from those around them: each is greater than those it comes from.
pub(super) trait Rule {
    /// Offers what follows from the label of a vertex, to whom it does; returns the number of crossings tried.
    fn spread(&self, labels: &[Label], v: VertexId, offer: impl FnMut(VertexId, Label)) -> u64;

    /// Offers all that follows for a vertex from the labels around it; returns the number of crossings tried.
    fn gather(&self, labels: &[Label], x: VertexId, offer: impl FnMut(Label)) -> u64;

    /// The vertices whose due label may come from the label of a vertex, in order.
    fn near(&self, v: VertexId) -> impl Iterator<Item = VertexId>;

    /// Whether a due label comes from the label of a vertex.
    fn rests_on(&self, due: &Label, v: VertexId) -> bool;

    /// Whether a label of a vertex comes from that vertex. A label must not rest on itself, not even while it is stale.
    fn is_circular(&self, _label: &Label, _v: VertexId) -> bool {
        false
    }
}

/// Labels of all vertices, with what is needed to mend them.
#[derive(Clone, Debug)]
pub struct Propagation {
    labels: Vec<Label>,
    due: Vec<Label>,
    front: Front,
    counters: MarchCounters,
}

impl Propagation {
    /// Labels that came at once.
    pub(crate) fn of(labels: Vec<Label>, counters: MarchCounters) -> Self {
        Self { labels, due: Vec::new(), front: Front::default(), counters }
    }

    /// Takes labels made anew; the work for them is added.
    pub(super) fn replace(&mut self, anew: Self) {
        let before = std::mem::replace(self, anew).counters;
        self.counters += before;
    }

    /// The label of a vertex.
    pub(crate) fn label(&self, v: VertexId) -> &Label {
        &self.labels[v.index()]
    }

    /// All labels, by vertex.
    pub(crate) fn labels(&self) -> &[Label] {
        &self.labels
    }

    /// Work since the beginning.
    pub(crate) fn counters(&self) -> &MarchCounters {
        &self.counters
    }

    /// Mends the labels after the sources at the vertices `changed` have changed.
    pub(super) fn mend(&mut self, rule: &impl Rule, sources: &Sources, changed: &[VertexId]) {
        if self.due.len() < self.labels.len() {
            // Of labels that came at once each is its due one.
            self.due.clone_from(&self.labels);
            self.front = Front::new(self.labels.len());
        }
        let mut mending = Mending { rule, sources, state: self };
        for &v in changed {
            mending.reconsider(v);
        }
        while let Some(v) = mending.state.front.pop() {
            mending.settle(v);
        }
    }
}

struct Mending<'a, R> {
    rule: &'a R,
    sources: &'a Sources,
    state: &'a mut Propagation,
}

impl<R: Rule> Mending<'_, R> {
    /// Takes the due label of the vertex with the least key, or withdraws its stale one.
    fn settle(&mut self, v: VertexId) {
        let (old, due) = (self.state.labels[v.index()], self.state.due[v.index()]);
        self.state.counters.settled += 1;
        if due.is_before(&old) {
            self.state.labels[v.index()] = due;
            if old.support() != Support::Nothing {
                self.reconsider_dependents(v);
            }
            self.spread(v);
        } else {
            self.state.counters.withdrawn += 1;
            self.state.labels[v.index()] = Label::FAR;
            self.reconsider_dependents(v);
            self.state.front.put(v, &Label::FAR, &self.state.due[v.index()]);
        }
    }

    fn spread(&mut self, v: VertexId) {
        let Propagation { labels, due, front, counters } = &mut *self.state;
        counters.crossings += self.rule.spread(labels, v, |x, label| {
            if label.is_before(&due[x.index()]) && !self.rule.is_circular(&label, x) {
                due[x.index()] = label;
                front.put(x, &labels[x.index()], &label);
            }
        });
    }

    fn reconsider_dependents(&mut self, v: VertexId) {
        for x in self.rule.near(v) {
            if self.rule.rests_on(&self.state.due[x.index()], v) {
                self.reconsider(x);
            }
        }
    }

    /// Computes the due label anew from everything around the vertex.
    fn reconsider(&mut self, x: VertexId) {
        let Propagation { labels, due, front, counters } = &mut *self.state;
        let mut best = self.sources.nearest(x);
        counters.crossings += self.rule.gather(labels, x, |label| {
            if label.is_before(&best) && !self.rule.is_circular(&label, x) {
                best = label;
            }
        });
        counters.reconsidered += 1;
        due[x.index()] = best;
        front.put(x, &labels[x.index()], &best);
    }
}
