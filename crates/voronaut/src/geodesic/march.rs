//! Fast marching on a canvas by lengths alone, from any number of sources at once, and again after sources changed.
//!
//! A label is (distance, colour). The labels wanted are the one solution of
//!
//! ```text
//! label(x) = least of: the sources at x; label(y) + |xy| over neighbours y; crossings of faces (x, y, z), or, where
//!            the angle at x is wide, of the two faces (x, a, b) and (b, a, z) by one of a, b and z
//! ```
//!
//! where the two ends of the edge that is crossed have the same colour and every value is greater than those it comes from. By that last condition the
//! solution is unique: of two, the least label in which they differ would have the same origin in both. Hence the
//! labels do not depend on the order of work, and labels mended after a change are, bit for bit, those made anew.
//!
//! They are found, and mended, in one way, that of LPA* (Koenig, Likhachev and Furcy 2004; Ramalingam and Reps 1996): each
//! vertex has its label and the *due* one, the right-hand side above with the labels as they stand. Vertices where the two
//! differ are on the front and are settled in the order of the lesser of both. Where the due label is the lesser, the
//! vertex takes it and tells its neighbours; where it is the greater, the label is stale - what it came from has changed,
//! perhaps behind the front - and is withdrawn, with all that rests on it.

use super::front::Front;
use super::label::{Label, Sources, Support};
use super::patch::PatchSolver;
use super::update::{Crossing, Unfolding, Wave};
use super::{Geodesic, MarchCounters, Patches};
use crate::triangulation::{HalfEdge, Triangulation, VertexId};

/// Fast marching on a triangulation with waves of one shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Marching<'a> {
    canvas: &'a Triangulation,
    /// The shape of fronts within a face.
    wave: Wave,
}

impl<'a> Marching<'a> {
    /// With circular waves.
    pub(crate) fn on(canvas: &'a Triangulation) -> Self {
        Self { canvas, wave: Wave::default() }
    }

    /// With waves of another shape.
    #[must_use]
    pub(crate) fn with_wave(self, wave: Wave) -> Self {
        Self { wave, ..self }
    }
}

/// Labels of all vertices, with what is needed to mend them.
#[derive(Clone, Debug)]
pub struct Propagation {
    pub(super) labels: Vec<Label>,
    pub(super) due: Vec<Label>,
    pub(super) front: Front,
    pub(super) counters: MarchCounters,
}

impl Propagation {
    /// Labels that nothing will mend in part.
    pub(crate) fn of(labels: Vec<Label>, counters: MarchCounters) -> Self {
        Self { labels, due: Vec::new(), front: Front::default(), counters }
    }

    /// Makes labels that came at once ready to be mended in part: each is its due one.
    pub(super) fn mark_settled(&mut self) {
        if self.due.len() < self.labels.len() {
            self.due.clone_from(&self.labels);
            self.front = Front::new(self.labels.len());
        }
    }

    /// Takes labels made anew; the work for them is added.
    pub(super) fn replace(&mut self, anew: Self) {
        let before = std::mem::replace(self, anew).counters;
        self.counters += before;
    }

    /// Puts the vertex on the front if its label is not the due one, else takes it off.
    pub(super) fn enqueue(&mut self, v: VertexId) {
        let (label, due) = (&self.labels[v.index()], &self.due[v.index()]);
        if label == due {
            self.front.remove(v);
        } else {
            let key = if due.is_before(label) { due } else { label };
            self.front.set(v, key);
        }
    }

    fn new(vertices: usize) -> Self {
        Self {
            labels: vec![Label::FAR; vertices],
            due: vec![Label::FAR; vertices],
            front: Front::new(vertices),
            counters: MarchCounters::default(),
        }
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
}

impl Geodesic for Marching<'_> {
    fn propagate(&self, sources: &Sources) -> Propagation {
        let mut state = Propagation::new(self.canvas.vertex_slots());
        let starts: Vec<VertexId> = sources.vertices().collect();
        self.update(sources, &starts, &mut state);
        state
    }

    fn patches(&self) -> Box<dyn Patches + '_> {
        Box::new(PatchSolver::new(self.canvas))
    }

    fn update(&self, sources: &Sources, changed: &[VertexId], state: &mut Propagation) {
        let mut march = March { wave: self.wave, canvas: self.canvas, sources, state };
        for &v in changed {
            march.reconsider(v);
        }
        while let Some(v) = march.state.front.pop() {
            march.settle(v);
        }
    }
}

/// Unfolding is tried where the sum of the squares of the sides at a corner is less than this share of that of the base:
/// at right and obtuse angles, and a little below.
const WIDE: f64 = 1.05;

struct March<'a> {
    wave: Wave,
    canvas: &'a Triangulation,
    sources: &'a Sources,
    state: &'a mut Propagation,
}

impl March<'_> {
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
            self.state.enqueue(v);
        }
    }

    /// Offers what follows from a vertex's new label to its neighbours.
    fn spread(&mut self, v: VertexId) {
        let canvas = self.canvas;
        for h in canvas.star(v) {
            let left = h.prev();
            self.state.counters.crossings += 2;
            self.offer(canvas.target(h), self.along(h, v));
            self.offer(canvas.target(h), self.across(left));
            self.offer(canvas.origin(left), self.across(h));
            if canvas.twin(left).is_none() {
                self.offer(canvas.origin(left), self.along(left, v));
            }
            let [opposite, left, right] = [h.next(), left, h].map(|e| canvas.twin(e).filter(|&g| self.is_wide(g)));
            if let Some(g) = opposite {
                self.offer(canvas.apex(g), self.over(g, h));
                self.offer(canvas.apex(g), self.over(g, h.prev()));
            }
            if let Some(g) = left {
                self.offer(canvas.apex(g), self.over(g, h));
            }
            if let Some(g) = right {
                self.offer(canvas.apex(g), self.over(g, h.prev()));
            }
        }
    }

    fn offer(&mut self, v: VertexId, label: Label) {
        if label.is_before(&self.state.due[v.index()]) && !self.is_circular(&label, v) {
            self.state.due[v.index()] = label;
            self.state.enqueue(v);
        }
    }

    /// Reconsiders the neighbours whose due label comes from the label of v.
    fn reconsider_dependents(&mut self, v: VertexId) {
        let canvas = self.canvas;
        for h in canvas.star(v) {
            let last = canvas.twin(h.prev()).is_none().then(|| canvas.apex(h));
            let beyond = canvas.twin(h.next()).map(|g| canvas.apex(g));
            for y in [Some(canvas.target(h)), last, beyond].into_iter().flatten() {
                if y != v && self.rests_on(y, v) {
                    self.reconsider(y);
                }
            }
        }
    }

    /// Whether the due label of y comes from the label of v.
    fn rests_on(&self, y: VertexId, v: VertexId) -> bool {
        match self.state.due[y.index()].support() {
            Support::Nothing | Support::Source | Support::Neighbour(_) => false,
            Support::Edge(h) | Support::Vertex(h) => self.canvas.origin(h) == v || self.canvas.target(h) == v,
        }
    }

    /// Whether a label of a vertex comes from that vertex: edges that flips have made may lead around a hole and back. A
    /// label must not rest on itself, not even while it is stale.
    fn is_circular(&self, label: &Label, v: VertexId) -> bool {
        let ends = |h: HalfEdge| [self.canvas.origin(h), self.canvas.target(h)];
        match label.support() {
            Support::Nothing | Support::Source | Support::Neighbour(_) => false,
            Support::Edge(h) => ends(h).contains(&v),
            Support::Vertex(h) => ends(h) == [v, v],
        }
    }

    /// Computes the due label anew from everything around the vertex.
    fn reconsider(&mut self, v: VertexId) {
        let canvas = self.canvas;
        let mut best = self.sources.nearest(v);
        let mut consider = |label: Label| {
            if label.is_before(&best) && !self.is_circular(&label, v) {
                best = label;
            }
        };
        let mut crossings = 0;
        for h in canvas.star(v) {
            crossings += 1;
            consider(self.along(h, canvas.target(h)));
            consider(self.across(h.next()));
            if let Some(t) = canvas.twin(h.next()).filter(|_| self.is_wide(h.next())) {
                consider(self.over(h.next(), t.next()));
                consider(self.over(h.next(), t.prev()));
            }
            if canvas.twin(h.prev()).is_none() {
                consider(self.along(h.prev(), canvas.apex(h)));
            }
        }
        self.state.counters.reconsidered += 1;
        self.state.counters.crossings += crossings;
        self.state.due[v.index()] = best;
        self.state.enqueue(v);
    }

    /// The label that reaches one end of an edge from the other, `from`, along it.
    fn along(&self, h: HalfEdge, from: VertexId) -> Label {
        let label = self.state.labels[from.index()];
        if label.support() == Support::Nothing {
            return Label::FAR;
        }
        // Where the edge is too short beside the distance, the next number serves: a path has no end on the way.
        let distance = (label.distance + self.canvas.length(h)).max(label.distance.next_up());
        let side = self.canvas.twin(h).map_or(h, |t| t.min(h));
        Label::new(distance, label.colour, Support::Vertex(side))
    }

    /// The label that reaches the apex of a half-edge's face across the half-edge.
    fn across(&self, h: HalfEdge) -> Label {
        let canvas = self.canvas;
        let (start, end) = (self.label_at(canvas.origin(h)), self.label_at(canvas.target(h)));
        if start.colour != end.colour || start.support() == Support::Nothing {
            return Label::FAR;
        }
        let crossing = Crossing {
            base: canvas.length(h),
            from_start: canvas.length(h.prev()),
            from_end: canvas.length(h.next()),
            at_start: start.distance,
            at_end: end.distance,
        };
        let distance = crossing.distance(self.wave);
        distance.map_or(Label::FAR, |distance| Label::new(distance, start.colour, Support::Edge(h)))
    }

    /// Whether the angle at the apex of a half-edge's face is too wide for fronts that come straight at the half-edge.
    fn is_wide(&self, h: HalfEdge) -> bool {
        let [l, a, b] = [h, h.next(), h.prev()].map(|e| self.canvas.length(e));
        a * a + b * b < WIDE * l * l
    }

    /// The label that reaches the apex of the face of g from an edge of the face beyond g, across that edge and g.
    fn over(&self, g: HalfEdge, edge: HalfEdge) -> Label {
        let canvas = self.canvas;
        let (start, end) = (self.label_at(canvas.origin(edge)), self.label_at(canvas.target(edge)));
        let Some(t) = canvas.twin(g).filter(|_| start.colour == end.colour && start.support() != Support::Nothing)
        else {
            return Label::FAR;
        };
        let unfolding = Unfolding {
            base: canvas.length(g),
            from_start: canvas.length(g.prev()),
            from_end: canvas.length(g.next()),
            beyond_start: canvas.length(t.next()),
            beyond_end: canvas.length(t.prev()),
        };
        // t.next() leaves the start of g for the far apex, t.prev() leaves the far apex for the end of g.
        let distance = if edge == t.next() {
            unfolding.over_start_edge(self.wave, start.distance, end.distance)
        } else {
            unfolding.mirrored().over_start_edge(self.wave, end.distance, start.distance)
        };
        distance.map_or(Label::FAR, |distance| Label::new(distance, start.colour, Support::Edge(edge)))
    }

    fn label_at(&self, v: VertexId) -> Label {
        self.state.labels[v.index()]
    }
}
