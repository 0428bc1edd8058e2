//! What a step that was taken back has found out about places, which the next try of the same step leads most seeds to again.

use super::moving::KEPT;
use super::state::State;
use crate::geometry::{Vector, Vector3};
use crate::manifold::Place;
use crate::triangulation::VertexId;

/// The last moves of all seeds at once, and the state that those taken back had led to. The way to a place, the metric there and the length of an edge between two
/// hang on where seeds were and on the metric's factor alone, so that they need not be found again
/// (an edge that was measured from its other end may be longer or shorter by rounding).
#[derive(Default)]
pub(super) struct Tried {
    /// Of seeds that went all the way, by id, from where and by what.
    moves: Vec<Option<Move>>,
    /// The same of the moves that were taken back.
    then: Vec<Option<Move>>,
    state: State,
}

#[derive(Clone, Copy, PartialEq)]
struct Move {
    from: Place,
    by: Vector,
}

impl Tried {
    /// Nothing is known.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    /// Where a move has led before.
    pub(super) fn landing(&self, v: VertexId, from: &Place, by: Vector) -> Option<Landing> {
        let known = self.then.get(v.index()).copied().flatten();
        known.filter(|then| *then == Move { from: *from, by }).map(|_| {
            let normal = self.state.facing[v.index()];
            Landing { place: self.state.places[v.index()], normal }
        })
    }

    /// Notes moves, of seeds that went all the way, before these are done.
    pub(super) fn note(&mut self, state: &State, moves: impl Iterator<Item = (VertexId, Vector)>) {
        self.moves.clear();
        if state.places.len() > KEPT {
            return;
        }
        self.moves.resize(state.places.len(), None);
        for (v, by) in moves {
            self.moves[v.index()] = Some(Move { from: state.places[v.index()], by });
        }
    }

    /// Keeps a state that is taken back, if it is not too large; what is left in its place is of no use.
    pub(super) fn keep(&mut self, state: &mut State) {
        if state.places.len() > KEPT {
            return;
        }
        std::mem::swap(&mut self.state, state);
        std::mem::swap(&mut self.then, &mut self.moves);
        self.moves.clear();
    }

    /// Fills in what is known of seeds that have come to the same places, and of edges between these whose lengths are not known.
    pub(super) fn recall(&self, state: &mut State) {
        if self.then.len() != state.places.len() {
            return;
        }
        let is_there = |v: VertexId| {
            let is_same = self.moves.get(v.index()) == self.then.get(v.index());
            is_same && self.state.places[v.index()] == state.places[v.index()]
        };
        let there: Vec<bool> = (0..self.then.len() as u32).map(|v| is_there(VertexId(v))).collect();
        for (i, _) in there.iter().enumerate().filter(|(_, is_there)| **is_there) {
            (state.locals[i], state.measured[i]) = (self.state.locals[i], self.state.measured[i]);
        }
        let then = &self.state.topology;
        state.topology.change_lengths(|ends, length| {
            if !length.is_nan() || ends.iter().any(|v| !there[v.index()]) {
                return length;
            }
            then.edge_between(ends[0], ends[1]).map_or(length, |h| then.length(h))
        });
    }
}

/// Where a seed comes to lie, and the surface's normal there.
#[derive(Clone, Copy)]
pub(super) struct Landing {
    pub(super) place: Place,
    pub(super) normal: Vector3,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::{Moving, SurfaceDual};
    use crate::manifold::Manifold;
    use crate::manifold::surface::metric::Sizes;
    use crate::manifold::surface::sphere;

    #[test]
    fn the_next_try_finds_what_it_would_find_alone_to_the_last_bit() {
        let manifold = Manifold::new(sphere(1.0, 0.4).unwrap(), None);
        let size = |i: usize| if i.is_multiple_of(3) { 0.25 } else { 0.6 };
        let metric =
            Sizes::Isotropic((0..manifold.positions().len()).map(size).collect()).field(manifold.surface()).unwrap();
        let made = || {
            let topology = manifold.topology().clone();
            let places = topology.vertices().map(|v| manifold.place_of(v).unwrap()).collect();
            let mut dual = SurfaceDual::new(&manifold, &metric, 1.0, places, 0, topology).unwrap();
            dual.flip_all();
            dual
        };
        let step = |dual: &mut SurfaceDual, moves: &[(VertexId, Vector)]| {
            dual.shift_together(moves);
            dual.settle_moves().unwrap();
        };
        let (mut alone, mut second) = (made(), made());
        assert!(alone.topology().vertices().any(|v| alone.local(v).is_rough), "lengths take chords");
        let way = |v: VertexId| Vector::new(f64::from(v.0).cos(), f64::from(v.0).sin()) * 0.08;
        let all: Vec<(VertexId, Vector)> = second.topology().vertices().map(|v| (v, way(v))).collect();
        let some: Vec<(VertexId, Vector)> = all.iter().copied().filter(|(v, _)| v.0 % 4 > 0).collect();
        let before = second.save();
        step(&mut second, &all);
        second.take_back(&before);
        let is_known =
            |&&(v, by): &&(VertexId, Vector)| second.tried.landing(v, &second.places()[v.index()], by).is_some();
        assert!(2 * some.iter().filter(is_known).count() > some.len());
        step(&mut alone, &some);
        step(&mut second, &some);
        assert!(alone.places() == second.places() && alone.triangles() == second.triangles());
        assert!(alone.topology().vertices().all(|v| alone.local(v) == second.local(v)));
        let length = |dual: &SurfaceDual, h| dual.topology().length(h).to_bits();
        assert!(alone.topology().edges().all(|h| length(&alone, h) == length(&second, h)));
    }
}
