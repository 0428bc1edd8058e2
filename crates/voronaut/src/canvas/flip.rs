//! Flips to the intrinsic Delaunay triangulation, by lengths alone (Bobenko and Springborn 2007; Fisher et al. 2007); and of an
//! embedded triangulation by one tensor for each quadrilateral, the mean of its corners'.

use crate::elementary::Elementary;
use crate::geodesic::{Angles, frozen_margin, layout};
use crate::geometry::Tensor;
use crate::planar::Planar;
use crate::triangulation::{Flipping, HalfEdge, Lawson, Limit, Triangulation, VertexId};

/// Margins (sine of the sum of opposite angles) above minus this are ties: flipping them gains nothing.
const TIE: f64 = 1e-9;
/// Flips of one slot at most. With exact lengths flips end by themselves, after less than one per vertex; lengths of flat
/// triangles contradict each other, and flips then go round.
const FLIPS_PER_SLOT: u8 = 20;

/// Flips every edge whose two opposite angles sum to more than pi, until none is left. Constraints do not hold edges
/// back: distances pass through features. Returns the number of flips.
pub(super) fn to_intrinsic_delaunay(topology: &mut Triangulation) -> u64 {
    let mut lawson = Lawson::default();
    lawson.queue(topology.edges());
    lawson.pass(&mut Intrinsic { topology, diagonal: f64::NAN }, Limit::OfSlot(FLIPS_PER_SLOT)).len() as u64
}

struct Intrinsic<'a> {
    topology: &'a mut Triangulation,
    /// The length of what comes of the edge that was looked at last.
    diagonal: f64,
}

impl Flipping for Intrinsic<'_> {
    fn topology(&mut self) -> &mut Triangulation {
        self.topology
    }

    /// Rounding may let two vertices of a needle fall together: then not.
    fn wants_flip(&mut self, h: HalfEdge) -> bool {
        let Some(t) = self.topology.twin(h).filter(|t| t.face() != h.face()) else { return false };
        let quad = Quad::around(self.topology, h, t);
        if quad.margin() >= -TIE {
            return false;
        }
        self.diagonal = quad.other_diagonal();
        self.diagonal > 0.0 && self.diagonal.is_finite()
    }

    fn flip(&mut self, h: HalfEdge) {
        self.topology.clear_constraint(h);
        self.topology.flip(h);
        self.topology.set_length(h, self.diagonal);
    }
}

/// The lengths of an edge a-b and of the outer edges of its faces a b c and b a d.
struct Quad {
    ab: f64,
    ac: f64,
    bc: f64,
    ad: f64,
    bd: f64,
}

impl Quad {
    fn around(topology: &Triangulation, h: HalfEdge, t: HalfEdge) -> Self {
        let length = |e: HalfEdge| topology.length(e);
        Self { ab: length(h), bc: length(h.next()), ac: length(h.prev()), ad: length(t.next()), bd: length(t.prev()) }
    }

    fn margin(&self) -> f64 {
        Angles::from_lengths(self.ab, [self.ac, self.bc], [self.ad, self.bd]).margin()
    }

    /// The length from c to d in the quadrilateral laid out flat, a at the origin and b on the x axis.
    fn other_diagonal(&self) -> f64 {
        let (cx, cy) = layout(self.ab, self.ac, self.bc);
        let (dx, dy) = layout(self.ab, self.ad, self.bd);
        (cx - dx).hypotenuse(cy + dy)
    }
}

/// The test must be violated by more than this (sine of the angles' sum) for a flip: tests of neighbouring quadrilaterals with
/// different tensors contradict each other near zero.
const CLEARLY: f64 = 1e-2;
/// Flips after one insertion at most; measured was a little more than one in the mean.
pub(super) const FROZEN_LIMIT: Limit = Limit::OfAll(64);

/// A triangulation that flips by the tensors at its vertices.
pub(super) struct Frozen<'a> {
    pub(super) planar: &'a mut Planar,
    /// One per vertex slot.
    pub(super) tensors: &'a [Tensor],
    /// Only edges opposite to this vertex follow.
    pub(super) around: Option<VertexId>,
}

impl Flipping for Frozen<'_> {
    fn topology(&mut self) -> &mut Triangulation {
        &mut self.planar.topology
    }

    fn wants_flip(&mut self, h: HalfEdge) -> bool {
        let Some(quad) = self.planar.topology.quad(h).filter(|_| !self.planar.topology.is_fixed(h)) else {
            return false;
        };
        let mean = quad.iter().fold(Tensor::default(), |sum, v| sum + self.tensors[v.index()]) * 0.25;
        let [a, b, c, d] = quad.map(|v| self.planar.position(v));
        frozen_margin(mean, [a - c, b - c], [b - d, a - d]) <= -CLEARLY && self.planar.is_convex(h)
    }

    fn flip(&mut self, h: HalfEdge) {
        self.planar.topology.flip(h);
    }

    fn follows(&self, h: HalfEdge) -> bool {
        self.around.is_none_or(|v| self.planar.topology.apex(h) == v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_lozenge_gets_its_short_diagonal() {
        let mut t = Triangulation::from_triangles(4, &[[0, 1, 2], [1, 0, 3]], &[0, 0]);
        for h in t.edges().collect::<Vec<_>>() {
            t.set_length(h, 1.0);
        }
        t.set_length(HalfEdge(0), 3.0_f64.sqrt());
        assert_eq!(to_intrinsic_delaunay(&mut t), 1);
        t.check().unwrap();
        assert!((t.length(HalfEdge(0)) - 1.0).abs() < 1e-15);
        assert_eq!(to_intrinsic_delaunay(&mut t), 0);
    }

    #[test]
    fn diagonals_of_a_quadrilateral_are_measured() {
        // a = (0, 0), b = (4, 0), c = (1, 2), d = (3, -1).
        let [ac, bc, ad, bd] = [5.0_f64, 13.0, 10.0, 2.0].map(f64::sqrt);
        assert!((Quad { ab: 4.0, ac, bc, ad, bd }.other_diagonal() - 13.0_f64.sqrt()).abs() < 1e-14);
    }
}
