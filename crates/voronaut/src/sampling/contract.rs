//! A triangulation of seeds by contraction: every cell of a diagram becomes its seed.

use crate::diagram::SurfaceDiagram;
use crate::triangulation::{HalfEdge, Triangulation, VertexId};

/// The triangulation of a surface that is left when the canvas is contracted, vertex by vertex, onto the seeds of a diagram: where
/// cells are discs that meet as they should about their dual, and a triangulation without doubled edges, with the surface's
/// topology and its border from seed to seed, wherever there is one. Contraction goes over edges that meet the link condition
/// (Dey et al. 1999) only.
///
/// The triangles are of colours. Returned, too, are the canvas vertices that could not be contracted, which seeds are too few
/// for: they have to be seeds.
pub(super) fn contracted(diagram: &SurfaceDiagram) -> (Vec<[u32; 3]>, Vec<VertexId>) {
    let mut topology = diagram.canvas().draped().topology().clone();
    let mut seed_at: Vec<Option<u32>> = vec![None; topology.vertex_slots()];
    for colour in 0..diagram.colours() as u32 {
        if let Some(v) = diagram.seed(colour) {
            seed_at[v.index()] = Some(colour);
        }
    }
    let mut left: Vec<VertexId> = topology.vertices().filter(|v| seed_at[v.index()].is_none()).collect();
    left.sort_by(|&v, &w| diagram.distance(v).total_cmp(&diagram.distance(w)).then(v.cmp(&w)));
    // First each cell onto its seed, then whatever can be done.
    for strangers in [false, true] {
        loop {
            let before = left.len();
            left.retain(|&v| !contract(&mut topology, diagram, &seed_at, v, strangers));
            if left.len() == before || left.is_empty() {
                break;
            }
        }
    }
    let colour = |v: VertexId| seed_at[v.index()];
    let corners = topology.faces().filter_map(|f| {
        let [a, b, c] = topology.corners(f).map(colour);
        Some([a?, b?, c?])
    });
    (corners.collect(), left)
}

/// Contracts a vertex onto the best neighbour that there is: of its own colour, or of any if `strangers` will do.
fn contract(
    topology: &mut Triangulation,
    diagram: &SurfaceDiagram,
    seed_at: &[Option<u32>],
    v: VertexId,
    strangers: bool,
) -> bool {
    let own = diagram.colour(v);
    let is_border = topology.is_border_vertex(v);
    // A half-edge, and whether the vertex is its origin.
    let outward = topology.star(v).filter(|&h| !is_border || topology.twin(h).is_none()).map(|h| (h, true));
    let last = topology.star(v).last().map(HalfEdge::prev).filter(|_| is_border).map(|h| (h, false));
    let other = |topology: &Triangulation, (h, is_outward): (HalfEdge, bool)| {
        if is_outward { topology.target(h) } else { topology.origin(h) }
    };
    let mut ways: Vec<(HalfEdge, bool)> = outward.chain(last).collect();
    ways.retain(|&way| {
        let u = other(topology, way);
        (strangers || diagram.colour(u) == own) && topology.can_collapse(way.0)
    });
    let rank = |way: &(HalfEdge, bool)| {
        let u = other(topology, *way);
        (diagram.colour(u) != own, seed_at[u.index()].is_none(), diagram.distance(u))
    };
    let best = ways.into_iter().min_by(|x, y| {
        let (x, y) = (rank(x), rank(y));
        (x.0, x.1).cmp(&(y.0, y.1)).then(x.2.total_cmp(&y.2))
    });
    match best {
        Some((h, true)) => topology.collapse(h),
        Some((h, false)) => topology.collapse_back(h),
        None => return false,
    }
    true
}
