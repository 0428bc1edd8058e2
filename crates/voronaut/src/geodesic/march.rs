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
//! labels do not depend on the order of work, and labels mended after a change ([`Propagation::mend`]) are, bit for bit, those made anew.

use super::label::{Label, Sources, Support};
use super::mending::{Propagation, Rule};
use super::patch::PatchSolver;
use super::update::{Crossing, Unfolding, Wave};
use super::{Geodesic, MarchCounters, Patches};
use crate::triangulation::{HalfEdge, Triangulation, VertexId};

/// Fast marching on a triangulation with waves of one shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Marching<'a> {
    /// What they march on.
    pub canvas: &'a Triangulation,
    /// The shape of fronts within a face.
    pub wave: Wave,
}

impl<'a> Marching<'a> {
    /// With circular waves.
    pub(crate) fn on(canvas: &'a Triangulation) -> Self {
        Self { canvas, wave: Wave::default() }
    }
}

impl Geodesic for Marching<'_> {
    fn propagate(&self, sources: &Sources) -> Propagation {
        let mut state = Propagation::of(vec![Label::FAR; self.canvas.vertex_slots()], MarchCounters::default());
        let starts: Vec<VertexId> = sources.vertices().collect();
        state.mend(self, sources, &starts);
        state
    }

    fn patches(&self) -> Box<dyn Patches + '_> {
        Box::new(PatchSolver::new(self.canvas))
    }

    fn update(&self, sources: &Sources, changed: &[VertexId], state: &mut Propagation) {
        state.mend(self, sources, changed);
    }
}

/// Unfolding is tried where the sum of the squares of the sides at a corner is less than this share of that of the base:
/// at right and obtuse angles, and a little below.
const WIDE: f64 = 1.05;

impl Rule for Marching<'_> {
    fn spread(&self, labels: &[Label], v: VertexId, mut offer: impl FnMut(VertexId, Label)) -> u64 {
        let canvas = self.canvas;
        let mut crossings = 0;
        for h in canvas.star(v) {
            let left = h.prev();
            crossings += 2;
            offer(canvas.target(h), self.along(labels, h, v));
            offer(canvas.target(h), self.across(labels, left));
            offer(canvas.origin(left), self.across(labels, h));
            if canvas.twin(left).is_none() {
                offer(canvas.origin(left), self.along(labels, left, v));
            }
            let [opposite, left, right] = [h.next(), left, h].map(|e| canvas.twin(e).filter(|&g| self.is_wide(g)));
            if let Some(g) = opposite {
                offer(canvas.apex(g), self.over(labels, g, h));
                offer(canvas.apex(g), self.over(labels, g, h.prev()));
            }
            if let Some(g) = left {
                offer(canvas.apex(g), self.over(labels, g, h));
            }
            if let Some(g) = right {
                offer(canvas.apex(g), self.over(labels, g, h.prev()));
            }
        }
        crossings
    }

    fn gather(&self, labels: &[Label], x: VertexId, mut offer: impl FnMut(Label)) -> u64 {
        let canvas = self.canvas;
        let mut crossings = 0;
        for h in canvas.star(x) {
            crossings += 1;
            offer(self.along(labels, h, canvas.target(h)));
            offer(self.across(labels, h.next()));
            if let Some(t) = canvas.twin(h.next()).filter(|_| self.is_wide(h.next())) {
                offer(self.over(labels, h.next(), t.next()));
                offer(self.over(labels, h.next(), t.prev()));
            }
            if canvas.twin(h.prev()).is_none() {
                offer(self.along(labels, h.prev(), canvas.apex(h)));
            }
        }
        crossings
    }

    fn near(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        let canvas = self.canvas;
        let near = canvas.star(v).flat_map(move |h| {
            let last = canvas.twin(h.prev()).is_none().then(|| canvas.apex(h));
            let beyond = canvas.twin(h.next()).map(|g| canvas.apex(g));
            [Some(canvas.target(h)), last, beyond].into_iter().flatten()
        });
        near.filter(move |&y| y != v)
    }

    fn rests_on(&self, due: &Label, v: VertexId) -> bool {
        match due.support() {
            Support::Nothing | Support::Source | Support::Neighbour(_) => false,
            Support::Edge(h) | Support::Vertex(h) => self.canvas.ends(h).contains(&v),
        }
    }

    /// Edges that flips have made may lead around a hole and back.
    fn is_circular(&self, label: &Label, v: VertexId) -> bool {
        match label.support() {
            Support::Vertex(h) => self.canvas.ends(h) == [v, v],
            _ => self.rests_on(label, v),
        }
    }
}

impl Marching<'_> {
    /// The label that reaches one end of an edge from the other, `from`, along it.
    fn along(&self, labels: &[Label], h: HalfEdge, from: VertexId) -> Label {
        let label = labels[from.index()];
        if label.support() == Support::Nothing {
            return Label::FAR;
        }
        // Where the edge is too short beside the distance, the next number serves: a path has no end on the way.
        let distance = (label.distance + self.canvas.length(h)).max(label.distance.next_up());
        Label::new(distance, label.colour, Support::Vertex(self.canvas.canonical(h)))
    }

    /// The label that reaches the apex of a half-edge's face across the half-edge.
    fn across(&self, labels: &[Label], h: HalfEdge) -> Label {
        self.by_edge(labels, h, |at| Crossing::of(self.canvas, h, at).distance(self.wave))
    }

    /// The label that comes from both ends of an edge, by a distance from theirs.
    fn by_edge(&self, labels: &[Label], edge: HalfEdge, distance: impl FnOnce([f64; 2]) -> Option<f64>) -> Label {
        let [start, end] = self.canvas.ends(edge).map(|v| labels[v.index()]);
        if start.colour != end.colour || start.support() == Support::Nothing {
            return Label::FAR;
        }
        let found = distance([start.distance, end.distance]);
        found.map_or(Label::FAR, |distance| Label::new(distance, start.colour, Support::Edge(edge)))
    }

    /// Whether the angle at the apex of a half-edge's face is too wide for fronts that come straight at the half-edge.
    fn is_wide(&self, h: HalfEdge) -> bool {
        let [l, a, b] = [h, h.next(), h.prev()].map(|e| self.canvas.length(e));
        a * a + b * b < WIDE * l * l
    }

    /// The label that reaches the apex of the face of g from an edge of the face beyond g, across that edge and g.
    fn over(&self, labels: &[Label], g: HalfEdge, edge: HalfEdge) -> Label {
        let Some(t) = self.canvas.twin(g) else { return Label::FAR };
        self.by_edge(labels, edge, |[at_start, at_end]| {
            let [base, from_start, from_end, beyond_start, beyond_end] =
                [g, g.prev(), g.next(), t.next(), t.prev()].map(|e| self.canvas.length(e));
            let unfolding = Unfolding { base, from_start, from_end, beyond_start, beyond_end };
            // t.next() leaves the start of g for the far apex, t.prev() leaves the far apex for the end of g.
            if edge == t.next() {
                unfolding.over_start_edge(self.wave, at_start, at_end)
            } else {
                unfolding.mirrored().over_start_edge(self.wave, at_end, at_start)
            }
        })
    }
}
