//! Which cells relaxation works with.

use super::cell::{CellsOf, Moments, Tangent};
use super::on_canvas::{Colouring, OnCanvas};
use crate::diagram::Flat;
use crate::dual::Moving;
use crate::error::Result;
use crate::triangulation::VertexId;

/// The cells that relaxation works with, in the plane or on a surface.
pub(crate) enum Cells<'a, G = Flat<'a>> {
    /// Cut in the tangent plane at each seed, from what its neighbours are seen as through the second-order logarithm map.
    /// Fast; right where the metric changes little over an edge.
    Tangent,
    /// Those of the diagram on a canvas, with the distances there; directions by the second-order logarithm map.
    Canvas(OnCanvas<'a, G>),
    /// The same cells, and the report's centroid (RR-9103, equation 9): the Euclidean one with the metric's area as weight, on a surface in
    /// the tangent plane. For
    /// comparison: it is not the Riemannian one (erratum 14), and nothing holds the energy.
    Weighted(OnCanvas<'a, G>),
}

impl<'a, M: Moving, G: Colouring<'a, M>> CellsOf<M> for Cells<'a, G> {
    fn moments(&self, dual: &M) -> Result<Vec<(VertexId, Moments)>> {
        match self {
            Cells::Tangent => Tangent.moments(dual),
            Cells::Canvas(cells) => cells.moments(dual, |_, logarithm| logarithm),
            Cells::Weighted(cells) => cells.moments(dual, |difference, _| difference),
        }
    }

    fn lower_energy(&self) -> bool {
        !matches!(self, Cells::Weighted(_))
    }
}
