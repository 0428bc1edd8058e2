//! Lawson's flips (Lawson 1977): edges that a test wants flipped are, and the edges around them are looked at again. One edge
//! after the other ([`Lawson`]), or in rounds of flips that share no triangle, so that tests can run in parallel ([`Rounds`]).

use super::{HalfEdge, Triangulation};

/// A triangulation whose edges are flipped one after the other.
pub(crate) trait Flipping {
    /// What flips change.
    fn topology(&mut self) -> &mut Triangulation;

    /// Whether a test wants an edge flipped, and nothing forbids it.
    fn wants_flip(&mut self, h: HalfEdge) -> bool;

    /// Flips an edge, which was wanted, and does what goes with it.
    fn flip(&mut self, h: HalfEdge) {
        self.topology().flip(h);
    }

    /// Whether an edge around a flip is to be looked at again.
    fn follows(&self, _h: HalfEdge) -> bool {
        true
    }
}

/// What ends flips whose tests contradict each other, as inexact ones may: they must not go round for ever.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// Tests are exact: flips end by themselves.
    None,
    /// So many flips of one slot (a half-edge or its twin) in one pass: the rest of the mesh has its flips all the same.
    OfSlot(u8),
    /// So many flips in one pass.
    OfAll(usize),
}

/// Room for a pass of flips, used again by the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lawson {
    stack: Vec<HalfEdge>,
    flipped: Vec<HalfEdge>,
    /// How often the slots in `counted` were flipped.
    flips_of_slot: Vec<u8>,
    counted: Vec<usize>,
}

impl Lawson {
    /// Puts edges on the stack of those to look at.
    pub(crate) fn queue(&mut self, edges: impl IntoIterator<Item = HalfEdge>) {
        self.stack.extend(edges);
    }

    /// Flips edges of the stack, and what follows from them, the last one first, until none is left or the limit is reached.
    /// Returns the edges that were flipped, in order.
    pub(crate) fn pass(&mut self, mesh: &mut impl Flipping, limit: Limit) -> &[HalfEdge] {
        self.flipped.clear();
        self.counted.drain(..).for_each(|slot| self.flips_of_slot[slot] = 0);
        while let Some(h) = self.stack.pop() {
            if !mesh.wants_flip(h) || !self.may_flip(mesh.topology(), h, limit) {
                continue;
            }
            mesh.flip(h);
            self.flipped.push(h);
            if limit == Limit::OfAll(self.flipped.len()) {
                self.stack.clear();
                break;
            }
            let t = mesh.topology().twin(h).expect("flipped edges have two faces");
            self.stack.extend([h.next(), h.prev(), t.next(), t.prev()].into_iter().filter(|&e| mesh.follows(e)));
        }
        &self.flipped
    }

    /// Counts a flip of a slot, unless that has had them all.
    fn may_flip(&mut self, topology: &Triangulation, h: HalfEdge, limit: Limit) -> bool {
        let Limit::OfSlot(most) = limit else { return true };
        let slot = topology.canonical(h).index();
        self.flips_of_slot.resize(3 * topology.face_slots(), 0);
        let is_allowed = self.flips_of_slot[slot] < most;
        if is_allowed {
            self.flips_of_slot[slot] += 1;
            self.counted.push(slot);
        }
        is_allowed
    }
}

/// A triangulation whose edges are flipped in rounds.
pub(crate) trait Rounds {
    /// What flips change.
    fn topology(&self) -> &Triangulation;

    /// The edges, of those given, that are to be flipped: the one with the least number first.
    fn wanted(&mut self, edges: &[HalfEdge]) -> Vec<(f64, HalfEdge)>;

    /// Flips an edge that is wanted, unless flips before it forbid that; says whether it did.
    fn flip(&mut self, h: HalfEdge) -> bool;
}

/// Flips edges, and what follows from them, in rounds, so many at most, until no edge is wanted. Returns the number of flips.
pub(crate) fn flip_in_rounds(mesh: &mut impl Rounds, rounds: usize) -> u64 {
    let edges = mesh.topology().edges_with(|_| true);
    flip_from(mesh, edges, rounds)
}

/// The same of some edges, and what follows from them.
pub(crate) fn flip_from(mesh: &mut impl Rounds, mut edges: Vec<HalfEdge>, rounds: usize) -> u64 {
    let mut flips = 0;
    for _ in 0..rounds {
        let mut wanted = mesh.wanted(&edges);
        wanted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        edges.clear();
        let mut is_changed = vec![false; mesh.topology().face_slots()];
        for (_, h) in wanted {
            // Where a flip has changed one of its triangles, its slot may hold another edge by now; whichever that is, the next round
            // looks at it.
            let Some(t) = mesh.topology().twin(h) else { continue };
            if is_changed[h.face().index()] || is_changed[t.face().index()] || !mesh.flip(h) {
                continue;
            }
            flips += 1;
            for face in [h.face(), t.face()] {
                is_changed[face.index()] = true;
                edges.extend(face.half_edges());
            }
        }
        for h in &mut edges {
            *h = mesh.topology().canonical(*h);
        }
        edges.sort_unstable();
        edges.dedup();
        if edges.is_empty() {
            break;
        }
    }
    flips
}
