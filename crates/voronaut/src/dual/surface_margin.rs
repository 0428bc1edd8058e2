//! What the in-circle test of a surface mesh in the making knows: lengths from the expansions at both ends; where the metric is
//! rough, by Simpson's rule.

use super::Moving;
use super::margin::KINKS;
use super::on_surface::SurfaceDual;
use crate::geodesic::{Length, Margin, hermite_between, margin_of_estimates};
use crate::in_circle::{InCircle, Known, Lengths, Quad, Tested, climb};
use crate::triangulation::{HalfEdge, VertexId};

impl SurfaceDual<'_> {
    /// Metric length of the geodesic between two seeds.
    pub(crate) fn length_between(&self, u: VertexId, v: VertexId) -> f64 {
        self.estimate([u, v]).value
    }

    fn estimate(&self, ends: [VertexId; 2]) -> Length {
        let [u, v] = ends;
        if !self.is_rough(ends) {
            let locals = ends.map(|w| &self.state.locals[w.index()]);
            return hermite_between(locals, [self.offset(u, v), -self.offset(v, u)]);
        }
        let topology = self.topology();
        let measured = topology.find(u, v).or_else(|| topology.find(v, u)).map(|h| topology.length(h));
        let value = measured.filter(|length| !length.is_nan()).unwrap_or_else(|| self.chord_length(ends));
        Length { value, error: KINKS }
    }

    pub(super) fn chord_length(&self, ends: [VertexId; 2]) -> f64 {
        let [p, q] = ends.map(|w| &self.state.places[w.index()]);
        let tensors = ends.map(|w| self.state.measured[w.index()].tensor);
        let middle = self.input.lift(p, p.position.lerp(q.position, 0.5));
        let middle = middle.map_or(tensors, |place| [self.metric.at(&place); 2]);
        self.input.chord([p, q], tensors).simpson(middle) * self.factor.sqrt()
    }

    pub(super) fn is_rough(&self, ends: [VertexId; 2]) -> bool {
        ends.iter().any(|v| self.state.locals[v.index()].is_rough)
    }

    pub(super) fn ends(&self, h: HalfEdge) -> [VertexId; 2] {
        [self.topology().origin(h), self.topology().target(h)]
    }

    /// Keeps the length of an edge that takes long to measure.
    pub(super) fn measure_edge(&mut self, h: HalfEdge) {
        let ends = self.ends(h);
        if self.is_rough(ends) {
            let length = self.chord_length(ends);
            self.state.topology.set_length(h, length);
        }
    }

    /// The in-circle test of an edge; [`Margin::UNKNOWN`] of one with a single face, and where lengths make no triangles.
    pub(super) fn margin(&self, h: HalfEdge) -> Margin {
        let tested = self.seeds_around(h).and_then(|quad| climb(self, &quad, 0..1, &Lengths::new(), None));
        tested.map_or(Margin::UNKNOWN, |tested| tested.margin)
    }
}

impl InCircle for SurfaceDual<'_> {
    fn may_tell(&self, _quad: &Quad, level: usize, _lengths: &Lengths, _known: Option<Tested>) -> bool {
        level == 0
    }

    fn is_by_lengths(&self, _level: usize) -> bool {
        false
    }

    fn solve(&self, _i: u32, _j: u32, _level: usize) -> Option<Known> {
        None
    }

    fn margin(&self, &Quad { a, b, c, d }: &Quad, _level: usize, _lengths: &Lengths) -> Margin {
        let [a, b, c, d] = [a, b, c, d].map(VertexId);
        margin_of_estimates([[a, b], [c, a], [b, c], [a, d], [d, b]].map(|ends| self.estimate(ends)))
    }
}
