//! Cells of the diagram on a canvas, of the plane or of a surface, with their moments.

use super::cell::Moments;
use crate::canvas::{Canvas, Draped};
use crate::diagram::{Care, Diagram, Flat, Frozen, Ground};
use crate::dual::{Dual, Moving, SurfaceDual};
use crate::error::Result;
use crate::geodesic::{LocalMetric, Method, Support};
use crate::geometry::{Point, Vector, to_frame};
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;
use std::marker::PhantomData;

/// A canvas on which the cells of a triangulation's seeds are coloured.
pub(crate) trait Colouring<'a, M>: Ground<'a> {
    /// The diagram of the seeds with these ids, whose colours are in their order.
    ///
    /// # Errors
    /// [`crate::Error::Domain`] of a seed outside the canvas's domain, or off its surface.
    fn coloured(&self, dual: &M, ids: &[VertexId]) -> Result<Diagram<'a, Self>>;

    /// Where a canvas vertex is, seen from a seed, in the seed's coordinates.
    fn seen_from(&self, dual: &M, seed: VertexId, x: VertexId) -> Vector;
}

impl<'a> Colouring<'a, Dual<'_>> for Flat<'a> {
    fn coloured(&self, dual: &Dual, ids: &[VertexId]) -> Result<Diagram<'a>> {
        let seeds: Vec<Point> = ids.iter().map(|&v| dual.position(v)).collect();
        Diagram::of_vertices(self.canvas, self.field, &seeds, Method::March, Care::Quick)
    }

    fn seen_from(&self, dual: &Dual, seed: VertexId, x: VertexId) -> Vector {
        self.place(x) - dual.position(seed)
    }
}

impl<'a> Colouring<'a, SurfaceDual<'_>> for &'a Canvas<Draped<'a>> {
    fn coloured(&self, dual: &SurfaceDual, ids: &[VertexId]) -> Result<Diagram<'a, Self>> {
        let places: Vec<_> = ids.iter().map(|v| dual.places()[v.index()]).collect();
        Diagram::of_places(self, &places)
    }

    fn seen_from(&self, dual: &SurfaceDual, seed: VertexId, x: VertexId) -> Vector {
        dual.seen_from(seed, self.draped().place(x))
    }
}

/// A canvas, and the metric area that each of its vertices stands for.
pub(crate) struct OnCanvas<'a, G = Flat<'a>> {
    ground: G,
    areas: Vec<f64>,
    frozen: Vec<Frozen>,
    canvas: PhantomData<&'a ()>,
}

impl<'a, G: Ground<'a>> OnCanvas<'a, G> {
    /// Each vertex stands for a third of its faces, flat with their metric lengths.
    pub(crate) fn new(ground: G) -> Self {
        let topology = ground.topology();
        let mut areas = vec![0.0; topology.vertex_slots()];
        for face in topology.faces() {
            let [a, b, c] = face.half_edges().map(|h| topology.length(h));
            let product = (a + b + c) * (b + c - a).max(0.0) * (c + a - b).max(0.0) * (a + b - c).max(0.0);
            topology.corners(face).iter().for_each(|v| areas[v.index()] += 0.25 * product.sqrt() / 3.0);
        }
        let vertices = (0..topology.vertex_slots() as u32).into_par_iter().map(VertexId);
        let frozen = vertices.map(|v| ground.frozen(ground.place(v))).collect();
        Self { ground, areas, frozen, canvas: PhantomData }
    }

    /// The moments of every seed's cell, with the canvas's distances; `tangent` chooses the vector from a seed to a point: their
    /// difference, or the logarithm.
    ///
    /// # Errors
    /// [`crate::Error::Domain`] of a seed outside the canvas's domain.
    pub(super) fn moments<M: Moving>(
        &self,
        dual: &M,
        tangent: impl Fn(Vector, Vector) -> Vector,
    ) -> Result<Vec<(VertexId, Moments)>>
    where
        G: Colouring<'a, M>,
    {
        let ids: Vec<VertexId> = dual.topology().vertices().collect();
        let diagram = self.ground.coloured(dual, &ids)?;
        let seen = |colour: u32, x: VertexId| self.ground.seen_from(dual, ids[colour as usize], x);
        let local = |colour: u32| dual.local(ids[colour as usize]);
        let directions = self.directions(&diagram, seen, local);
        let factor = dual.factor();
        let mut moments = vec![Moments::default(); ids.len()];
        for x in diagram.vertices() {
            let Some(colour) = diagram.colour(x) else { continue };
            let (mass, distance) = (self.areas[x.index()] * factor, diagram.distance(x) * factor.sqrt());
            let w = tangent(seen(colour, x), directions[x.index()] * distance);
            let first = to_frame(local(colour).tensor.cholesky(), w) * mass;
            let own = &mut moments[colour as usize];
            *own = *own + Moments { mass, first, second: mass * distance * distance };
        }
        Ok(ids.into_iter().zip(moments).collect())
    }

    /// In which direction the geodesic to each vertex leaves its seed: a unit vector at the seed, handed on from the
    /// vertices that its distance came from. Beside the seed, by the second-order logarithm map.
    fn directions<'l>(
        &self,
        diagram: &Diagram<'a, G>,
        seen: impl Fn(u32, VertexId) -> Vector,
        local: impl Fn(u32) -> &'l LocalMetric,
    ) -> Vec<Vector> {
        let mut order: Vec<VertexId> = diagram.vertices().collect();
        order.sort_by(|&a, &b| diagram.distance(a).total_cmp(&diagram.distance(b)));
        let mut directions = vec![Vector::default(); diagram.vertex_count()];
        for x in order {
            let Some(colour) = diagram.colour(x) else { break };
            let handed: Vector = match diagram.label(x).support() {
                Support::Nothing | Support::Source => Vector::default(),
                Support::Vertex(_) | Support::Neighbour(_) => {
                    diagram.parent(x).map_or(Vector::default(), |p| directions[p.index()])
                }
                Support::Edge(h) => {
                    let [a, b] = self.ground.topology().ends(h);
                    let [at_a, at_b] = [a, b].map(|end| self.detour(diagram, x, end));
                    match [a, b].map(|end| diagram.colour(end) == Some(colour)) {
                        [true, true] => directions[a.index()] * at_b + directions[b.index()] * at_a,
                        [true, false] => directions[a.index()],
                        [false, true] => directions[b.index()],
                        [false, false] => Vector::default(),
                    }
                }
            };
            let local = local(colour);
            let w = if handed == Vector::default() { local.log(seen(colour, x)) } else { handed };
            let length = local.tensor.length(w);
            directions[x.index()] = if length > 0.0 { w * (1.0 / length) } else { Vector::default() };
        }
        directions
    }

    /// The square root of what the way to x through one end of its support is longer than the geodesic: about proportional to
    /// how far from that end the geodesic crosses the support.
    fn detour(&self, diagram: &Diagram<'a, G>, x: VertexId, end: VertexId) -> f64 {
        let [from, to] = [end, x].map(|v| &self.frozen[v.index()]);
        let step = to.at - from.at;
        // In the mean of the tensors at both ends.
        let length = (0.5 * (from.length(step).powi(2) + to.length(step).powi(2))).sqrt();
        (diagram.distance(end) + length - diagram.distance(x)).max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::Kind;
    use crate::geometry::{Point3, Tensor3};
    use crate::manifold::Manifold;
    use crate::manifold::surface::sphere;
    use crate::optimise::cell::{CellsOf, Tangent};

    /// On a sphere in an anisotropic metric: the cells cover it, and are those of tangent planes but for what these do not see.
    #[test]
    fn cells_on_a_sphere_are_those_of_tangent_planes() {
        let metric = |p: Point3| Tensor3::from_disk([4.0 + p.y, 0.0, 2.0, 0.0, 0.5 * p.x, 3.0]);
        let manifold = Manifold::new(sphere(1.0, 0.25).unwrap(), None);
        let fine = Manifold::new(sphere(1.0, 0.015).unwrap(), None);
        let surface = manifold.surface();
        let places: Vec<_> =
            surface.topology().vertices().map(|v| fine.closest(surface.position(v)).unwrap()).collect();
        let mut dual = SurfaceDual::new(&fine, &metric, 20.0, places, 0, surface.topology().clone()).unwrap();
        dual.settle_moves().unwrap();
        dual.measure();
        let (canvas, _) = Canvas::on_surface(Kind::Intrinsic, &fine, &metric, 0, &[]).unwrap();
        assert!(canvas.vertex_count() > 200 * dual.places().len());
        let found = OnCanvas::new(&canvas).moments(&dual, |_, logarithm| logarithm).unwrap();
        let expected = Tangent.moments(&dual).unwrap();
        let mass = |all: &[(VertexId, Moments)]| all.iter().map(|(_, moments)| moments.mass).sum::<f64>();
        let whole = 20.0 * crate::manifold::surface::metric::area_of_surface(&fine, &metric, 0).unwrap();
        assert!((mass(&found) / whole - 1.0).abs() < 0.02, "{} {whole}", mass(&found));
        // Borders of cells are where canvas vertices are.
        let (mut of_mass, mut of_first, seeds) = (0.0, 0.0, found.len() as f64);
        for ((_, found), (_, expected)) in found.iter().zip(&expected) {
            of_mass += (found.mass / expected.mass - 1.0).abs();
            of_first += (found.first - expected.first).norm() / expected.mass.powf(1.5);
        }
        assert!(of_mass < 0.03 * seeds && of_first < 0.03 * seeds, "{of_mass} {of_first} of {seeds}");
    }
}
