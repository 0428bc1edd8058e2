//! A part of the mesh around some of its edges, as a triangulation of its own.

use super::{Dual, Moving};
use crate::planar::Planar;
use crate::triangulation::{FaceId, HalfEdge, VertexId};

/// Rings of seeds around the edges' quadrilaterals, whose own seeds then have whole cells: of 321 edges of five meshes (a hard shock, swirl, a Hessian
/// among them) the nerve has or lacks all but one as with four rings on a canvas four times as fine; with two rings all but two.
const RINGS: usize = 1;

/// All triangles around a set of seeds.
pub(super) struct Patch {
    /// The triangles, with the mesh's ids; those elsewhere are gone.
    pub(super) planar: Planar,
    /// Seeds whose cells do not reach the patch's own border, by id.
    pub(super) is_inner: Vec<bool>,
}

impl Dual<'_> {
    /// The patch around edges.
    pub(super) fn patch_around(&self, edges: &[HalfEdge]) -> Patch {
        let is_inner = self.inner(edges);
        let planar = self.part(is_inner.clone(), RINGS);
        debug_assert_eq!(planar.topology.vertex_count(), self.patch_size(edges), "the patch is as large as foreseen");
        Patch { planar, is_inner }
    }

    /// The seeds of edges' quadrilaterals.
    fn inner(&self, edges: &[HalfEdge]) -> Vec<bool> {
        let topology = self.topology();
        let mut inside = vec![false; topology.vertex_slots()];
        for v in edges.iter().filter_map(|&h| topology.quad(h)).flatten() {
            inside[v.index()] = true;
        }
        inside
    }

    /// The number of seeds of the patch around edges.
    fn patch_size(&self, edges: &[HalfEdge]) -> usize {
        let mut reached = self.within(self.inner(edges), RINGS);
        self.grow(&mut reached);
        reached.into_iter().filter(|is| *is).count()
    }

    /// The triangles within some rings of neighbours around seeds, with the mesh's ids.
    pub(crate) fn part_around(&self, seeds: &[VertexId], rings: usize) -> Planar {
        let mut inside = vec![false; self.topology().vertex_slots()];
        for v in seeds {
            inside[v.index()] = true;
        }
        self.part(inside, rings)
    }

    /// The triangles at these vertices and within some rings around them.
    fn part(&self, inside: Vec<bool>, rings: usize) -> Planar {
        let inside = self.within(inside, rings);
        let mut planar = self.planar().clone();
        planar.topology.retain_faces(|f| self.is_in(f, &inside));
        planar
    }

    /// These vertices and those within some rings around them, and others whose faces would form several fans.
    fn within(&self, mut inside: Vec<bool>, rings: usize) -> Vec<bool> {
        (0..rings).for_each(|_| self.grow(&mut inside));
        while self.close_fans(&mut inside) {}
        inside
    }

    /// The patch around as many edges, from the first on, as keep it within so many seeds; around one edge at least.
    pub(super) fn patch_within(&self, edges: &[HalfEdge], seeds: usize) -> Patch {
        let fits = |count: usize| self.patch_size(&edges[..count]) <= seeds;
        if fits(edges.len()) {
            return self.patch_around(edges);
        }
        let (mut low, mut high) = (1, edges.len());
        while high - low > 1 {
            let middle = low.midpoint(high);
            if fits(middle) { low = middle } else { high = middle }
        }
        self.patch_around(&edges[..low])
    }

    /// Adds all neighbours.
    fn grow(&self, inside: &mut [bool]) {
        let topology = self.topology();
        let before: Vec<VertexId> = topology.vertices().filter(|v| inside[v.index()]).collect();
        for v in before.into_iter().flat_map(|v| topology.around(v)) {
            inside[v.index()] = true;
        }
    }

    /// A face belongs to the patch if one of its corners is inside.
    fn is_in(&self, f: FaceId, inside: &[bool]) -> bool {
        self.topology().corners(f).iter().any(|v| inside[v.index()])
    }

    /// Takes in the vertices whose faces would form several fans. Says whether there were any.
    fn close_fans(&self, inside: &mut [bool]) -> bool {
        let topology = self.topology();
        let starts_fan = |h: &HalfEdge| {
            let before = topology.twin(*h).map(HalfEdge::face);
            self.is_in(h.face(), inside) && !before.is_some_and(|f| self.is_in(f, inside))
        };
        let pinched: Vec<VertexId> = topology
            .vertices()
            .filter(|v| !inside[v.index()] && topology.star(*v).filter(starts_fan).count() > 1)
            .collect();
        for v in &pinched {
            inside[v.index()] = true;
        }
        !pinched.is_empty()
    }
}
