//! Cells of the diagram on a canvas.

use super::cell::{Moments, to_frame};
use crate::canvas::Canvas;
use crate::diagram::Diagram;
use crate::dual::Dual;
use crate::error::Result;
use crate::geodesic::{LocalMetric, Support};
use crate::geometry::{Point, Tensor, Vector};
use crate::metric::MetricField;
use crate::triangulation::VertexId;
use rayon::prelude::*;

/// A canvas, and the metric area that each of its vertices stands for.
pub struct OnCanvas<'a> {
    canvas: &'a Canvas,
    areas: Vec<f64>,
    tensors: Vec<Tensor>,
}

impl<'a> OnCanvas<'a> {
    /// Each vertex stands for a third of its faces, flat with their metric lengths.
    pub(crate) fn new(canvas: &'a Canvas, field: &dyn MetricField) -> Self {
        let topology = canvas.topology();
        let mut areas = vec![0.0; canvas.vertex_count()];
        for face in topology.faces() {
            let [a, b, c] = face.half_edges().map(|h| topology.length(h));
            let product = (a + b + c) * (b + c - a).max(0.0) * (c + a - b).max(0.0) * (a + b - c).max(0.0);
            topology.corners(face).iter().for_each(|v| areas[v.index()] += 0.25 * product.sqrt() / 3.0);
        }
        let vertices = (0..canvas.vertex_count() as u32).into_par_iter().map(VertexId);
        let tensors = vertices.map(|v| field.at(canvas.position(v))).collect();
        Self { canvas, areas, tensors }
    }

    /// The moments of every seed's cell, with the canvas's distances; `tangent` gives the tangent vector at a seed that leads
    /// to a point at a distance.
    ///
    /// # Errors
    /// [`crate::Error::Domain`] of a seed outside the canvas's domain.
    pub(super) fn moments(
        &self,
        dual: &Dual,
        tangent: impl Fn(&LocalMetric, Vector, Vector) -> Vector,
    ) -> Result<Vec<(VertexId, Moments)>> {
        let ids: Vec<VertexId> = dual.topology().vertices().collect();
        let seeds: Vec<Point> = ids.iter().map(|&v| dual.position(v)).collect();
        let factor = dual.field().factor;
        let diagram = Diagram::roughly_of_vertices(self.canvas, dual.field().field, &seeds)?;
        let directions = self.directions(&diagram, |colour| dual.local(ids[colour as usize]));
        let mut moments = vec![Moments::default(); ids.len()];
        for x in (0..self.canvas.vertex_count() as u32).map(VertexId) {
            let Some(colour) = diagram.colour(x).map(|colour| colour as usize) else { continue };
            let (mass, distance) = (self.areas[x.index()] * factor, diagram.distance(x) * factor.sqrt());
            let local = dual.local(ids[colour]);
            let w = tangent(local, self.canvas.position(x) - seeds[colour], directions[x.index()] * distance);
            let first = to_frame(local.tensor.cholesky(), w) * mass;
            moments[colour] = moments[colour] + Moments { mass, first, second: mass * distance * distance };
        }
        Ok(ids.into_iter().zip(moments).collect())
    }

    /// The logarithm.
    pub(super) fn logarithm(_: &LocalMetric, _: Vector, logarithm: Vector) -> Vector {
        logarithm
    }

    /// The difference of positions.
    pub(super) fn difference(_: &LocalMetric, difference: Vector, _: Vector) -> Vector {
        difference
    }

    /// In which direction the geodesic to each vertex leaves its seed: a unit vector at the seed, handed on from the
    /// vertices that its distance came from. Beside the seed, by the second-order logarithm map.
    fn directions<'l>(&self, diagram: &Diagram, local: impl Fn(u32) -> &'l LocalMetric) -> Vec<Vector> {
        let mut order: Vec<VertexId> = (0..self.canvas.vertex_count() as u32).map(VertexId).collect();
        order.sort_by(|&a, &b| diagram.distance(a).total_cmp(&diagram.distance(b)));
        let mut directions = vec![Vector::default(); self.canvas.vertex_count()];
        for x in order {
            let Some(colour) = diagram.colour(x) else { break };
            let local = local(colour);
            let handed: Vector = match diagram.label(x).support() {
                Support::Nothing | Support::Source => Vector::default(),
                Support::Vertex(_) | Support::Neighbour(_) => {
                    diagram.parent(x).map_or(Vector::default(), |p| directions[p.index()])
                }
                Support::Edge(h) => {
                    let topology = self.canvas.topology();
                    let [a, b] = [topology.origin(h), topology.target(h)];
                    let [at_a, at_b] = [a, b].map(|end| self.detour(diagram, x, end));
                    match [a, b].map(|end| diagram.colour(end) == Some(colour)) {
                        [true, true] => directions[a.index()] * at_b + directions[b.index()] * at_a,
                        [true, false] => directions[a.index()],
                        [false, true] => directions[b.index()],
                        [false, false] => Vector::default(),
                    }
                }
            };
            let seed = diagram.seed(colour).unwrap_or_default();
            let w = if handed == Vector::default() { local.log(self.canvas.position(x) - seed) } else { handed };
            let length = local.tensor.length(w);
            directions[x.index()] = if length > 0.0 { w * (1.0 / length) } else { Vector::default() };
        }
        directions
    }

    /// The square root of what the way to x through one end of its support is longer than the geodesic: about proportional to
    /// how far from that end the geodesic crosses the support.
    fn detour(&self, diagram: &Diagram, x: VertexId, end: VertexId) -> f64 {
        let step = self.canvas.position(x) - self.canvas.position(end);
        let tensor = (self.tensors[x.index()] + self.tensors[end.index()]) * 0.5;
        (diagram.distance(end) + tensor.length(step) - diagram.distance(x)).max(0.0).sqrt()
    }
}
