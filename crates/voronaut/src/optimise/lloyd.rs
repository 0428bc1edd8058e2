//! Riemannian Lloyd relaxation: every free seed moves to the centroid of its cell in its tangent plane.

use super::cell::{Cell, centroid};
use crate::dual::{Dual, Effort, Kind};
use crate::error::Result;
use crate::geometry::Vector;
use crate::progress::Progress;
use crate::triangulation::{HalfEdge, VertexId};
use rayon::prelude::*;

/// A seed whose move would turn a triangle over tries this many times with half of the move.
const HALVINGS: u32 = 4;

/// How a relaxation went.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Relaxed {
    /// Root mean square of the moves (metric units), one entry per step.
    pub moves: Vec<f64>,
    /// Flips done.
    pub flips: u64,
    /// Moves cut short or left out, to keep the triangulation embedded.
    pub held: u64,
}

/// Moves all free seeds `steps` times. Neighbours are seen through the second-order logarithm map, cells are cut there
/// by bisectors and by the boundary, and seeds move by the second-order exponential map (DESIGN.md, "Lloyd"). After
/// each step edges are flipped; the triangulation stays embedded throughout. The result does not depend on the number
/// of threads.
///
/// # Errors
/// The metric is found invalid at a seed.
pub fn relax(dual: &mut Dual, steps: usize, progress: &dyn Progress) -> Result<Relaxed> {
    let mut relaxed = Relaxed::default();
    for _ in 0..steps {
        dual.measure_rough_edges();
        let moves = targets(dual);
        let mut sum = 0.0;
        for &(v, step) in &moves {
            sum += dual.local(v).tensor.dot(step, step);
            relaxed.held += u64::from(!shift(dual, v, step));
        }
        dual.measure_all();
        dual.verdict()?;
        relaxed.flips += dual.flip_all(Effort::Local);
        dual.take_touched();
        relaxed.moves.push((sum / moves.len().max(1) as f64).sqrt());
        progress.done(1);
    }
    Ok(relaxed)
}

/// Where each free seed wants to go, as a difference of positions.
fn targets(dual: &Dual) -> Vec<(VertexId, Vector)> {
    let free: Vec<VertexId> = dual.topology().vertices().filter(|&v| dual.kind(v) == Kind::Free).collect();
    free.par_iter()
        .with_min_len(256)
        .map_init(Cell::default, |cell, &v| (v, dual.local(v).exp(to_centroid(dual, v, cell))))
        .collect()
}

/// The tangent vector from a seed to the centroid of its cell.
fn to_centroid(dual: &Dual, v: VertexId, cell: &mut Cell) -> Vector {
    let (p, local, topology) = (dual.position(v), dual.local(v), dual.topology());
    let [a, b, c] = local.tensor.cholesky();
    let image = |u: VertexId, length: f64| {
        let w = local.log(dual.position(u) - p);
        let w = Vector::new(a * w.x + b * w.y, c * w.y);
        // No expansion gives lengths in a rough field; quadrature does.
        if local.is_rough { w * (length / w.norm()) } else { w }
    };
    let neighbour = |h: HalfEdge| image(topology.target(h), topology.length(h));
    cell.reset(topology.star(v).map(|h| neighbour(h).norm()).fold(0.0, f64::max));
    for h in topology.star(v) {
        cell.cut_by_bisector(neighbour(h));
        if topology.is_fixed(h.next()) {
            cell.cut_by_line(neighbour(h), image(topology.apex(h), topology.length(h.prev())));
        }
    }
    let centre = centroid(cell.corners());
    let y = centre.y / c;
    Vector::new((centre.x - b * y) / a, y)
}

/// Moves a seed, or as far as the embedding allows; says whether it went all the way.
fn shift(dual: &mut Dual, v: VertexId, step: Vector) -> bool {
    let from = dual.position(v);
    let mut share = 1.0;
    for _ in 0..=HALVINGS {
        if dual.shift(v, from + step * share) {
            return share >= 1.0;
        }
        share *= 0.5;
    }
    false
}
