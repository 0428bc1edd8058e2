//! Where the moments of the cells come from.

use super::cell::Moments;
use super::on_canvas::OnCanvas;
use super::tangent::tangent_moments;
use crate::dual::{Dual, Moving};
use crate::error::Result;
use crate::triangulation::VertexId;

/// The cells that relaxation works with.
pub enum Cells<'a> {
    /// Cut in the tangent plane at each seed, from what its neighbours are seen as through the second-order logarithm map.
    /// Fast; right where the metric changes little over an edge.
    Tangent,
    /// Those of the diagram on a canvas, with the distances there; directions by the second-order logarithm map.
    Canvas(OnCanvas<'a>),
    /// The same cells, and the report's centroid (RR-9103, equation 9): the Euclidean one with the metric's area as weight. For
    /// comparison: it is not the Riemannian one (erratum 14), and nothing holds the energy.
    Weighted(OnCanvas<'a>),
}

/// Where the moments of the cells of a triangulation's seeds come from.
pub(crate) trait CellsOf<M> {
    /// The moments of every seed's cell about the seed, in order of the vertices' ids; tangent vectors are in the
    /// orthonormal frame of the Cholesky factor of the tensor there.
    ///
    /// # Errors
    /// [`crate::Error::Domain`] if cells are of a canvas that is not of the dual's domain.
    fn moments(&self, dual: &M) -> Result<Vec<(VertexId, Moments)>>;

    /// Whether steps that raise the energy are taken back.
    fn lower_energy(&self) -> bool;
}

/// The cells of [`Cells::Tangent`], on surfaces, too.
pub(crate) struct Tangent;

impl<M: Moving> CellsOf<M> for Tangent {
    fn moments(&self, dual: &M) -> Result<Vec<(VertexId, Moments)>> {
        Ok(tangent_moments(dual))
    }

    fn lower_energy(&self) -> bool {
        true
    }
}

impl CellsOf<Dual<'_>> for Cells<'_> {
    fn moments(&self, dual: &Dual) -> Result<Vec<(VertexId, Moments)>> {
        match self {
            Cells::Tangent => Ok(tangent_moments(dual)),
            Cells::Canvas(cells) => cells.moments(dual, OnCanvas::logarithm),
            Cells::Weighted(cells) => cells.moments(dual, OnCanvas::difference),
        }
    }

    fn lower_energy(&self) -> bool {
        !matches!(self, Cells::Weighted(_))
    }
}
