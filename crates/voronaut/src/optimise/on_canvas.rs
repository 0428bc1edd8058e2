//! Cells of the diagram on a canvas.

use super::cell::Moments;
use super::cells::to_frame;
use crate::canvas::Canvas;
use crate::diagram::Diagram;
use crate::dual::Dual;
use crate::error::Result;
use crate::geodesic::LocalMetric;
use crate::geometry::{Point, Vector};
use crate::triangulation::VertexId;

/// A canvas, and the metric area that each of its vertices stands for.
pub struct OnCanvas<'a> {
    canvas: &'a Canvas,
    areas: Vec<f64>,
}

impl<'a> OnCanvas<'a> {
    /// Each vertex stands for a third of its faces, flat with their metric lengths.
    pub fn new(canvas: &'a Canvas) -> Self {
        let topology = canvas.topology();
        let mut areas = vec![0.0; canvas.vertex_count()];
        for face in topology.faces() {
            let [a, b, c] = face.half_edges().map(|h| topology.length(h));
            let product = (a + b + c) * (b + c - a).max(0.0) * (c + a - b).max(0.0) * (a + b - c).max(0.0);
            topology.corners(face).iter().for_each(|v| areas[v.index()] += 0.25 * product.sqrt() / 3.0);
        }
        Self { canvas, areas }
    }

    /// The moments of every seed's cell, with the canvas's distances; `tangent` gives the tangent vector at a seed that leads
    /// to a point at a distance.
    ///
    /// # Errors
    /// [`crate::Error::Domain`] of a seed outside the canvas's domain.
    pub(super) fn moments(
        &self,
        dual: &Dual,
        tangent: impl Fn(&LocalMetric, Vector, f64) -> Vector,
    ) -> Result<Vec<(VertexId, Moments)>> {
        let ids: Vec<VertexId> = dual.topology().vertices().collect();
        let seeds: Vec<Point> = ids.iter().map(|&v| dual.position(v)).collect();
        let factor = dual.field().factor;
        let diagram = Diagram::roughly_of_vertices(self.canvas, dual.field().field, &seeds)?;
        let mut moments = vec![Moments::default(); ids.len()];
        for x in (0..self.canvas.vertex_count() as u32).map(VertexId) {
            let Some(colour) = diagram.colour(x).map(|colour| colour as usize) else { continue };
            let (mass, distance) = (self.areas[x.index()] * factor, diagram.distance(x) * factor.sqrt());
            let local = dual.local(ids[colour]);
            let w = tangent(local, self.canvas.position(x) - seeds[colour], distance);
            let first = to_frame(local.tensor.cholesky(), w) * mass;
            moments[colour] = moments[colour] + Moments { mass, first, second: mass * distance * distance };
        }
        Ok(ids.into_iter().zip(moments).collect())
    }

    /// The logarithm: its direction from the second-order expansion at the seed, its length from the canvas.
    pub(super) fn logarithm(local: &LocalMetric, difference: Vector, distance: f64) -> Vector {
        let w = local.log(difference);
        let length = local.tensor.length(w);
        if length > 0.0 { w * (distance / length) } else { Vector::default() }
    }

    /// The difference of positions.
    pub(super) fn difference(_: &LocalMetric, difference: Vector, _: f64) -> Vector {
        difference
    }
}
