//! A triangulation of seeds by contraction: every cell of a diagram becomes its seed.

use crate::diagram::SurfaceDiagram;
use crate::geometry::Vector3;
use crate::parallel::prelude::*;
use crate::triangulation::{HalfEdge, Triangulation, VertexId};

/// The least cosine between a triangle's normal and those of the surface at its corners.
const UPRIGHT: f64 = 0.2;

/// The triangulation of a surface that is left when the canvas is contracted, vertex by vertex, onto the seeds of a diagram: where
/// cells are discs that meet as they should about their dual, and a triangulation without doubled edges, with the surface's
/// topology and its border from seed to seed, wherever there is one. Contraction goes over edges that meet the link condition
/// (Dey et al. 1999) only, and lets no triangle turn away from the surface as long as there is another way.
///
/// The triangles are of colours. Returned, too, are the canvas vertices that could not be contracted, which seeds are too few
/// for: they have to be seeds.
pub(super) fn contracted(diagram: &SurfaceDiagram) -> (Vec<[u32; 3]>, Vec<VertexId>) {
    let mut contraction = Contraction::new(diagram);
    let topology = &contraction.topology;
    let mut left: Vec<VertexId> = topology.vertices().filter(|v| contraction.seed_at[v.index()].is_none()).collect();
    left.sort_by(|&v, &w| diagram.distance(v).total_cmp(&diagram.distance(w)).then(v.cmp(&w)));
    for manner in [Manner::OwnCell, Manner::Upright, Manner::AfterFlips, Manner::Anyhow] {
        loop {
            let before = left.len();
            left.retain(|&v| !contraction.contract(v, manner));
            if left.len() == before || left.is_empty() {
                break;
            }
        }
    }
    let topology = &contraction.topology;
    let corners = topology.faces().filter_map(|f| {
        let [a, b, c] = topology.corners(f).map(|v| contraction.seed_at[v.index()]);
        Some([a?, b?, c?])
    });
    (corners.collect(), left)
}

/// What a vertex may be contracted onto, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Manner {
    /// A neighbour of its own colour; triangles stay upright.
    OwnCell,
    /// Any neighbour; triangles stay upright.
    Upright,
    /// The same, after flips have taken edges from it, where triangles stay upright by these.
    AfterFlips,
    /// Any neighbour.
    Anyhow,
}

struct Contraction<'a, 'd> {
    diagram: &'a SurfaceDiagram<'d>,
    topology: Triangulation,
    normals: Vec<Vector3>,
    seed_at: Vec<Option<u32>>,
}

/// An edge of a vertex, and its other end.
#[derive(Clone, Copy)]
struct Way {
    h: HalfEdge,
    to: VertexId,
}

impl<'a, 'd> Contraction<'a, 'd> {
    fn new(diagram: &'a SurfaceDiagram<'d>) -> Self {
        let draped = diagram.canvas().draped();
        let topology = draped.topology().clone();
        let mut seed_at: Vec<Option<u32>> = vec![None; topology.vertex_slots()];
        for colour in 0..diagram.colours() as u32 {
            if let Some(v) = diagram.seed(colour) {
                seed_at[v.index()] = Some(colour);
            }
        }
        let slots = (0..topology.vertex_slots() as u32).into_par_iter().with_min_len(256);
        let normals = slots.map(|v| draped.plane(VertexId(v)).normal).collect();
        Self { diagram, topology, normals, seed_at }
    }

    fn contract(&mut self, v: VertexId, manner: Manner) -> bool {
        if manner == Manner::AfterFlips {
            self.take_edges(v);
        }
        let own = self.diagram.colour(v);
        let rank = |way: &Way| {
            (self.diagram.colour(way.to) != own, self.seed_at[way.to.index()].is_none(), self.diagram.distance(way.to))
        };
        let allowed = self.ways(v).into_iter().filter(|way| {
            (manner > Manner::OwnCell || self.diagram.colour(way.to) == own)
                && self.topology.can_collapse(way.h)
                && (manner == Manner::Anyhow || self.stays_upright(v, way.to))
        });
        let best = allowed.min_by(|x, y| {
            let (x, y) = (rank(x), rank(y));
            (x.0, x.1).cmp(&(y.0, y.1)).then(x.2.total_cmp(&y.2))
        });
        let Some(way) = best else { return false };
        if self.topology.origin(way.h) == v {
            self.topology.collapse(way.h);
        } else {
            self.topology.collapse_back(way.h);
        }
        true
    }

    /// The edges that a vertex may go along: of the border only its edges.
    fn ways(&self, v: VertexId) -> Vec<Way> {
        let t = &self.topology;
        let is_border = t.is_border_vertex(v);
        let out = t.star(v).filter(|&h| !is_border || t.twin(h).is_none()).map(|h| Way { h, to: t.target(h) });
        let last = t.star(v).last().map(HalfEdge::prev).filter(|_| is_border).map(|h| Way { h, to: t.origin(h) });
        out.chain(last).collect()
    }

    /// Whether the triangles around a vertex stand upright when another vertex takes its place.
    fn stays_upright(&self, v: VertexId, to: VertexId) -> bool {
        let t = &self.topology;
        t.star(v).all(|h| {
            let [a, b] = [t.target(h), t.apex(h)];
            a == to || b == to || self.is_upright([to, a, b])
        })
    }

    fn is_upright(&self, corners: [VertexId; 3]) -> bool {
        let draped = self.diagram.canvas().draped();
        let [a, b, c] = corners.map(|v| draped.position(v));
        let normal = (b - a).cross(c - a).unit().unwrap_or_default();
        corners.iter().all(|v| self.normals[v.index()].dot(normal) > UPRIGHT)
    }

    /// Flips edges of an inner vertex away as long as the new triangles stand upright.
    fn take_edges(&mut self, v: VertexId) {
        while let Some(h) = self.topology.star(v).find(|&h| self.can_flip(h)) {
            self.topology.flip(h);
        }
    }

    fn can_flip(&self, h: HalfEdge) -> bool {
        let Some([a, b, c, d]) = self.topology.quad(h).filter(|_| self.topology.can_flip(h)) else { return false };
        self.is_upright([d, b, c]) && self.is_upright([c, a, d])
    }
}
