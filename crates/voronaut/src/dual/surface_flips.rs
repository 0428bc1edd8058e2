//! Flips of the mesh in the making on a surface: by its own lengths, by a test of the caller's, and away from folds. Lengths are
//! from the expansions at both ends; where the metric is rough, by Simpson's rule.

use super::margin::KINKS;
use super::on_surface::{FOLDED, SurfaceDual, UPRIGHT};
use super::{LIMIT, Moving, POOR, TIE};
use crate::geodesic::{Length, Margin, hermite_between, margin_of_estimates};
use crate::geometry::NEEDLE;
use crate::in_circle::Quad;
use crate::parallel::prelude::*;
use crate::triangulation::{Flipping, HalfEdge, Lawson, Rounds, Triangulation, VertexId, flip_from, flip_in_rounds};

/// Rounds of flips that unfold or round off, at most.
const ROUNDS: usize = 64;

impl SurfaceDual<'_> {
    /// Flips every edge that the metric wants flipped and the surface allows. Returns the number of flips.
    pub(crate) fn flip_all(&mut self) -> u64 {
        self.measure();
        let margins = self.margins().into_iter();
        let edges = margins.filter(|(_, margin)| margin.value < -TIE).map(|(h, _)| h).collect();
        self.flip_by(edges, Self::margin)
    }

    /// The margins of all edges that may flip; each edge is measured once, for it is a side of five quads.
    fn margins(&self) -> Vec<(HalfEdge, Margin)> {
        let topology = self.topology();
        let measured = |slot: u32| {
            let h = HalfEdge(slot);
            let is_edge = topology.is_face(h.face()) && topology.canonical(h) == h;
            if is_edge { self.estimate(topology.ends(h)) } else { Length { value: f64::NAN, error: f64::INFINITY } }
        };
        let slots = (0..3 * topology.face_slots() as u32).into_par_iter().with_min_len(64);
        let lengths: Vec<Length> = slots.map(measured).collect();
        let free = topology.edges_with(|h| !topology.is_fixed(h)).into_par_iter().with_min_len(256);
        free.map(|h| (h, self.margin_by(h, |side| lengths[topology.canonical(side).index()]))).collect()
    }

    /// Flips an edge, if that leaves a triangulation; says whether it did.
    pub(crate) fn flip_edge(&mut self, h: HalfEdge) -> bool {
        let may_flip = self.topology().can_flip(h);
        if may_flip {
            self.state.topology.flip(h);
            self.flips += 1;
        }
        may_flip
    }

    /// Flips around a seed and onwards.
    pub(super) fn flip_around(&mut self, v: VertexId) {
        let star: Vec<HalfEdge> = self.topology().star(v).flat_map(|h| [h, h.next()]).collect();
        self.flip_by(star, Self::margin);
    }

    /// Flips by a test of the caller's: every edge with a certainly negative margin whose flip the surface allows. Returns the
    /// number of flips.
    pub(crate) fn settle_by(&mut self, test: impl Fn(&Quad) -> Margin) -> u64 {
        let edges = self.topology().edges_with(|_| true);
        self.flip_by(edges, |dual, h| dual.certain(h, &test))
    }

    /// How many edges a test wants flipped.
    pub(crate) fn disagreeing(&self, test: impl Fn(&Quad) -> Margin) -> usize {
        let wants = |&h: &HalfEdge| !self.topology().is_fixed(h) && self.certain(h, &test).value < -TIE;
        self.topology().edges().filter(wants).count()
    }

    /// How many edges their own lengths want flipped and the surface forbids, and the smallest margin of the others; 1 of none.
    pub(crate) fn unsettled(&self) -> (usize, f64) {
        let known = self.margins().into_iter().map(|(_, margin)| margin);
        let known = known.filter(|margin| margin.error.is_finite()).map(|margin| margin.value);
        let (blocked, settled): (Vec<f64>, Vec<f64>) = known.partition(|&margin| margin < -TIE);
        (blocked.len(), settled.into_iter().fold(1.0, f64::min))
    }

    /// Flips edges and what follows from them as long as a test gives a negative margin and the surface allows it.
    fn flip_by(&mut self, edges: Vec<HalfEdge>, margin: impl Fn(&Self, HalfEdge) -> Margin) -> u64 {
        let mut lawson = Lawson::default();
        lawson.queue(edges);
        lawson.pass(&mut By { dual: self, margin }, LIMIT).len() as u64
    }

    /// Whether a flip leaves a triangulation without doubled edges whose triangles stand upright on the surface, and makes
    /// none that is poor in the metric and poorer than both of before.
    fn allows_flip(&self, h: HalfEdge) -> bool {
        let Some(Flip { now, then }) = self.flip_of(h) else { return false };
        let [before, after] = [now, then].map(|pair| self.leaning(pair));
        if before.upright <= FOLDED {
            return after.is_better_than(&before);
        }
        if after.upright < UPRIGHT && after.upright < before.upright {
            return false;
        }
        let [before, after] = [now, then].map(|pair| pair.map(|t| self.shape(t)).into_iter().fold(1.0, f64::min));
        after > POOR || after > before
    }

    /// The triangles of an edge, and those after its flip, if it can be flipped.
    fn flip_of(&self, h: HalfEdge) -> Option<Flip> {
        let [a, b, c, d] = self.topology().quad(h).filter(|_| self.topology().can_flip(h))?;
        Some(Flip { now: [[a, b, c], [b, a, d]], then: [[d, b, c], [c, a, d]] })
    }

    fn leaning(&self, triangles: [[VertexId; 3]; 2]) -> Leaning {
        let mut found = Leaning { area: 0.0, upright: 1.0 };
        for t in triangles {
            let [a, b, c] = t.map(|v| self.position(v));
            let upright = self.upright(t);
            found.area += (b - a).cross(c - a).norm() * (UPRIGHT - upright).max(0.0);
            found.upright = found.upright.min(upright);
        }
        found
    }

    /// Flips edges of triangles that are folded over, whatever the metric says, as long as less of their area leans over.
    /// Returns the number of flips.
    pub(crate) fn unfold(&mut self) -> u64 {
        flip_in_rounds(&mut Improving { dual: self, by: Self::unfolding }, ROUNDS)
    }

    /// Flips edges of triangles that are nearly flat, as those of a mesh are measured, whatever lengths say, as long as the worse of
    /// the two gets better; of these edges, and what follows from them. Returns the number of flips.
    pub(crate) fn round_off(&mut self, edges: Vec<HalfEdge>) -> u64 {
        flip_from(&mut Improving { dual: self, by: Self::rounding }, edges, ROUNDS)
    }

    /// The quality of the worse triangle of an edge, where it is poor and better after a flip.
    fn rounding(&self, h: HalfEdge) -> Option<f64> {
        let quad = self.topology().quad(h)?;
        let Flip { now, then } = self.flip_of(h)?;
        let sites = quad.map(|v| self.site(v));
        let site = |v: VertexId| sites[quad.iter().position(|&w| w == v).unwrap_or(0)];
        let worse = |pair: [[VertexId; 3]; 2]| {
            pair.map(|corners| self.quality(corners.map(site))).into_iter().fold(1.0, f64::min)
        };
        let before = worse(now);
        let may_flip = || self.leaning(then).upright >= self.leaning(now).upright.min(UPRIGHT);
        (before < NEEDLE && worse(then) > before && may_flip()).then_some(before)
    }

    /// By how much more area leans over after a flip, of an edge of a triangle that is folded over; `None` where it is no better.
    fn unfolding(&self, h: HalfEdge) -> Option<f64> {
        let Flip { now, then } = self.flip_of(h)?;
        let [before, after] = [now, then].map(|pair| self.leaning(pair));
        (before.upright <= FOLDED && after.is_better_than(&before)).then_some(after.area - before.area)
    }

    /// The margin of an edge by a test of the caller's, if its sign is certain.
    fn certain(&self, h: HalfEdge, test: impl Fn(&Quad) -> Margin) -> Margin {
        let margin = Quad::around(self.topology(), h).map(|quad| test(&quad));
        margin.filter(Margin::is_certain).unwrap_or(Margin::UNKNOWN)
    }

    /// Metric length of the geodesic between two seeds.
    pub(super) fn estimate(&self, ends: [VertexId; 2]) -> Length {
        let [u, v] = ends;
        if !self.is_rough(ends) {
            let locals = ends.map(|w| &self.state.locals[w.index()]);
            return hermite_between(locals, self.offsets(ends));
        }
        let topology = self.topology();
        let measured = topology.edge_between(u, v).map(|h| topology.length(h));
        let value = measured.filter(|length| !length.is_nan()).unwrap_or_else(|| self.chord_length(ends));
        Length { value, error: KINKS }
    }

    pub(super) fn chord_length(&self, ends: [VertexId; 2]) -> f64 {
        let [p, q] = ends.map(|w| &self.state.places[w.index()]);
        let tensors = ends.map(|w| self.state.measured[w.index()].tensor);
        let [m, n] = ends.map(|w| self.state.planes[w.index()].normal);
        let (half, up) = (p.position.lerp(q.position, 0.5), (m + n).unit());
        // Straight above is found sooner than the closest point.
        let above = up.and_then(|up| self.manifold.lift_along(p, half, up, UPRIGHT));
        let middle = above.or_else(|| self.manifold.lift(p, half));
        let middle = middle.map_or(tensors, |place| [self.metric.at(&place); 2]);
        self.manifold.chord([p, q], tensors).simpson(middle) * self.factor.sqrt()
    }

    pub(super) fn is_rough(&self, ends: [VertexId; 2]) -> bool {
        ends.iter().any(|v| self.state.locals[v.index()].is_rough)
    }

    /// Keeps the length of an edge that takes long to measure, where it is not known.
    pub(super) fn measure_edge(&mut self, h: HalfEdge) {
        let ends = self.topology().ends(h);
        if self.topology().length(h).is_nan() && self.is_rough(ends) {
            let length = self.chord_length(ends);
            self.state.topology.set_length(h, length);
        }
    }

    /// The in-circle test of an edge; [`Margin::UNKNOWN`] of one with a single face, and where lengths make no triangles.
    pub(super) fn margin(&self, h: HalfEdge) -> Margin {
        self.margin_by(h, |side| self.estimate(self.topology().ends(side)))
    }

    fn margin_by(&self, h: HalfEdge, length: impl Fn(HalfEdge) -> Length) -> Margin {
        let Some(t) = self.topology().twin(h) else { return Margin::UNKNOWN };
        margin_of_estimates([h, h.prev(), h.next(), t.next(), t.prev()].map(length))
    }
}

/// A mesh whose edges are flipped where a number says so, the least first.
struct Improving<'a, 'b, F> {
    dual: &'a mut SurfaceDual<'b>,
    by: F,
}

impl<'b, F: Fn(&SurfaceDual<'b>, HalfEdge) -> Option<f64> + Sync> Rounds for Improving<'_, 'b, F> {
    fn topology(&self) -> &Triangulation {
        self.dual.topology()
    }

    fn wanted(&mut self, edges: &[HalfEdge]) -> Vec<(f64, HalfEdge)> {
        let (dual, by) = (&*self.dual, &self.by);
        edges.par_iter().with_min_len(64).filter_map(|&h| Some((by(dual, h)?, h))).collect()
    }

    fn flip(&mut self, h: HalfEdge) -> bool {
        // Another flip of the round may have joined the same two seeds.
        self.dual.flip_edge(h)
    }
}

/// A mesh that flips by some margins.
struct By<'a, 'b, F> {
    dual: &'a mut SurfaceDual<'b>,
    margin: F,
}

impl<'b, F: Fn(&SurfaceDual<'b>, HalfEdge) -> Margin> Flipping for By<'_, 'b, F> {
    fn topology(&mut self) -> &mut Triangulation {
        &mut self.dual.state.topology
    }

    fn wants_flip(&mut self, h: HalfEdge) -> bool {
        !self.dual.topology().is_fixed(h) && (self.margin)(self.dual, h).value < -TIE && self.dual.allows_flip(h)
    }

    fn flip(&mut self, h: HalfEdge) {
        self.dual.state.topology.flip(h);
        self.dual.flips += 1;
        self.dual.measure_edge(h);
    }
}

/// Two triangles before and after a flip.
struct Flip {
    now: [[VertexId; 3]; 2],
    then: [[VertexId; 3]; 2],
}

/// How far two triangles are from standing upright.
struct Leaning {
    /// Their areas, each weighted by how far it leans over; 0 of upright ones. In a plane this is twice what is covered too often,
    /// and flips that make it less lead to a triangulation that is embedded.
    area: f64,
    /// The least cosine between their normals and those of the surface; 0 of triangles without area.
    upright: f64,
}

impl Leaning {
    fn is_better_than(&self, other: &Self) -> bool {
        let rounding = 1e-9 * other.area;
        self.area < other.area - rounding || (self.area <= other.area + rounding && self.upright > other.upright)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point3, Tensor3};
    use crate::manifold::Manifold;
    use crate::manifold::surface::metric::Constant;
    use crate::mesh::Mesh;

    #[test]
    fn what_is_nearly_flat_is_rounded_off() {
        let corners = vec![[-3.0, -3.0, 0.0], [3.0, -3.0, 0.0], [3.0, 3.0, 0.0], [-3.0, 3.0, 0.0]];
        let sheet = Mesh { points: corners, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
        let (manifold, metric) = (Manifold::of(&sheet).unwrap(), Constant(Tensor3::IDENTITY));
        // The third is above the middle of the edge between the first two by next to nothing.
        let seeds = [(-1.0, 0.0), (1.0, 0.0), (0.0, 1e-6), (0.0, 2.0), (0.0, -2.0)];
        let places = seeds.map(|(x, y)| manifold.closest(Point3::new(x, y, 0.0)).unwrap()).to_vec();
        let triangles = [[0, 1, 2], [0, 2, 3], [2, 1, 3], [0, 4, 1]];
        let topology = Triangulation::from_triangles(5, &triangles, &[0; 4]);
        let mut dual = SurfaceDual::new(&manifold, &metric, 1.0, places, 0, topology).unwrap();
        let mut round_off = || dual.round_off(dual.topology().edges().collect());
        assert_eq!((round_off(), round_off()), (1, 0));
        let least = dual.triangles().into_iter().map(|t| dual.quality(t.map(|v| dual.site(VertexId(v)))));
        assert!(least.fold(1.0, f64::min) > 0.5);
    }

    #[test]
    fn flips_of_one_round_do_not_join_two_seeds_twice() {
        let points: Vec<[f64; 3]> =
            [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]].map(|p| p.map(f64::from)).to_vec();
        let triangles = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        let octahedron = Mesh { points, triangles, ..Mesh::default() };
        let manifold = Manifold::of(&octahedron).unwrap();
        let topology = manifold.topology().clone();
        let places = topology.vertices().map(|v| manifold.place_of(v).unwrap()).collect();
        let metric = Constant(Tensor3::IDENTITY);
        let mut dual = SurfaceDual::new(&manifold, &metric, 1.0, places, 0, topology).unwrap();
        // Each edge of the square 0 2 1 3 flips to an edge from 4 to 5.
        let by = |dual: &SurfaceDual, h: HalfEdge| {
            let flip = dual.flip_of(h)?;
            flip.then.iter().all(|t| [4, 5].iter().all(|&v| t.contains(&VertexId(v)))).then_some(0.0)
        };
        assert_eq!(flip_in_rounds(&mut Improving { dual: &mut dual, by }, 1), 1);
    }
}
