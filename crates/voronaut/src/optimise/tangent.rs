//! Cells in the tangent planes at their seeds.

use super::cell::{Cell, Moments, to_frame};
use crate::dual::{Kind, Moving};
use crate::geometry::Vector;
use crate::parallel::prelude::*;
use crate::triangulation::{HalfEdge, VertexId};

/// The moments of every seed's cell, cut in the tangent plane at the seed: by bisectors with its neighbours, which are seen through
/// the second-order logarithm map, and by the domain's segments. Tangent vectors are in the orthonormal frame of
/// [`to_frame`]. In order of the vertices' ids; lengths at rough seeds must have been measured.
pub(super) fn tangent_moments(dual: &impl Moving) -> Vec<(VertexId, Moments)> {
    let seeds: Vec<VertexId> = dual.topology().vertices().collect();
    let of = |cell: &mut Cell, v: VertexId| (v, View::at(dual, v).moments(cell));
    seeds.into_par_iter().with_min_len(256).map_init(Cell::default, of).collect()
}

/// What the neighbourhood looks like in the tangent plane at a seed.
struct View<'a, M> {
    dual: &'a M,
    seed: VertexId,
    frame: [f64; 3],
}

impl<'a, M: Moving> View<'a, M> {
    fn at(dual: &'a M, seed: VertexId) -> Self {
        Self { dual, seed, frame: dual.local(seed).tensor.cholesky() }
    }

    fn moments(&self, cell: &mut Cell) -> Moments {
        let topology = self.dual.topology();
        if topology.is_border_vertex(self.seed) {
            return self.border_moments(cell);
        }
        cell.reset(topology.star(self.seed).map(|h| self.neighbour(h).norm()).fold(0.0, f64::max));
        self.cut(cell);
        cell.moments()
    }

    /// At the border the cell is a part of a disc: one or, at reflex corners, several convex ones.
    fn border_moments(&self, cell: &mut Cell) -> Moments {
        let topology = self.dual.topology();
        let spokes: Vec<Vector> = topology.star(self.seed).map(|h| self.neighbour(h)).collect();
        let Some(last) = topology.star(self.seed).last().map(|h| self.beyond(h)) else { return Moments::default() };
        let width = spokes.iter().map(|w| w.norm()).fold(last.norm(), f64::max);
        let is_convex = matches!(self.dual.kind(self.seed), Kind::Curve) || turn(&spokes, last) <= std::f64::consts::PI;
        let sectors: Vec<[Vector; 2]> = if is_convex {
            vec![[spokes[0], last]]
        } else {
            spokes.iter().copied().zip(spokes.iter().copied().skip(1).chain([last])).map(|(a, b)| [a, b]).collect()
        };
        let mut sum = Moments::default();
        for [from, to] in sectors {
            cell.reset(width);
            cell.keep_left_of(from);
            cell.keep_left_of(-to);
            cell.cut_by_bisector(last);
            self.cut(cell);
            sum = sum + cell.moments();
        }
        sum
    }

    /// Cuts by what lies around.
    fn cut(&self, cell: &mut Cell) {
        let topology = self.dual.topology();
        let is_rough = self.dual.local(self.seed).is_rough;
        for h in topology.star(self.seed) {
            cell.cut_by_bisector(self.neighbour(h));
            if topology.is_fixed(h.next()) {
                cell.cut_by_line(self.neighbour(h), self.beyond(h));
            } else if let Some(t) = topology.twin(h.next()).filter(|_| !is_rough) {
                // Not needed where every edge is Delaunay; where one is not, cells would overlap.
                cell.cut_by_bisector(self.image(topology.apex(t), 0.0));
            }
        }
    }

    /// The target of a half-edge from the seed.
    fn neighbour(&self, h: HalfEdge) -> Vector {
        let topology = self.dual.topology();
        self.image(topology.target(h), topology.length(h))
    }

    /// The apex of its face.
    fn beyond(&self, h: HalfEdge) -> Vector {
        let topology = self.dual.topology();
        self.image(topology.apex(h), topology.length(h.prev()))
    }

    fn image(&self, u: VertexId, length: f64) -> Vector {
        let local = self.dual.local(self.seed);
        let w = to_frame(self.frame, local.log(self.dual.offset(self.seed, u)));
        // No expansion gives lengths in a rough field; quadrature does.
        if local.is_rough { w * (length / w.norm()) } else { w }
    }
}

/// The angle from the first spoke to the last.
fn turn(spokes: &[Vector], last: Vector) -> f64 {
    let to = spokes.iter().copied().skip(1).chain([last]);
    spokes.iter().zip(to).map(|(a, b)| a.cross(b).atan2(a.dot(b))).sum()
}
