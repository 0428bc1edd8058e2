//! The Riemannian Delaunay triangulation of seeds on a surface, with straight edges in space: the mesh in the making.
//!
//! It starts as the dual of a diagram and changes by moves and flips, each of which keeps it a triangulation of the surface
//! without doubled edges, and lets no triangle turn away from the surface's normals. What the metric is around a seed, and where its neighbours are, is
//! told in a chart there (RR-9103, section 12).

use super::state::{Measured, State};
use super::tried::{Landing, Tried};
use super::{Kind, Moving, unit_share};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geodesic::{LocalMetric, STILL};
use crate::geometry::{Point, Point3, Seen, TangentPlane, Tensor, Tensor3, Vector, Vector3};
use crate::manifold::surface::metric::SurfaceMetric;
use crate::manifold::{Chart, Manifold, Place};
use crate::metric::Scaled;
use crate::parallel::prelude::*;
use crate::progress::Sketch;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};

/// The least cosine between a triangle's normal and those of the surface at its corners.
pub(super) const UPRIGHT: f64 = 0.3;
/// Triangles with this cosine or less are folded over, or flat.
pub(super) const FOLDED: f64 = 1e-6;
/// A triangle is flat if its height is so small a part of an edge.
const FLAT: f64 = 1e-9;
/// Slopes of the surface over a chord that tell its length; steeper ones count as this.
const STEEP: f64 = 0.8;
/// By a factor nearer to one than this, expansions of the metric hold for the unit after it as well.
const ALIKE: f64 = 1.5;

/// The Riemannian Delaunay triangulation of seeds on a surface, with straight edges in space: the mesh in the making.
pub(crate) struct SurfaceDual<'a> {
    pub(super) manifold: &'a Manifold,
    pub(super) metric: &'a dyn SurfaceMetric,
    pub(super) factor: f64,
    pub(super) state: State,
    pub(super) flips: u64,
    pub(super) tried: Tried,
}

impl<'a> SurfaceDual<'a> {
    /// A triangulation of seeds at places of a surface, all of them in triangles that turn counter-clockwise around the
    /// surface's normals. Those at the border stay where they are, and so many of the first.
    ///
    /// # Errors
    /// [`Error::Metric`] where the metric is not positive definite at a seed.
    pub(crate) fn new(
        manifold: &'a Manifold,
        metric: &'a dyn SurfaceMetric,
        factor: f64,
        places: Vec<Place>,
        staying: usize,
        topology: Triangulation,
    ) -> Result<Self> {
        let seen = |place: &Place| (TangentPlane::new(manifold.normal(place)), manifold.facing(place));
        let (planes, facing) = places.par_iter().with_min_len(256).map(seen).unzip();
        let stays = |v: u32| (v as usize) < staying || topology.is_border_vertex(VertexId(v));
        let kind = |v: u32| if stays(v) { Kind::Corner(v) } else { Kind::Free };
        let kinds = (0..places.len() as u32).map(kind).collect();
        let (locals, measured) = (vec![LocalMetric::default(); places.len()], vec![Measured::default(); places.len()]);
        let mut dual = Self {
            manifold,
            metric,
            factor,
            state: State { topology, places, planes, facing, locals, measured, kinds },
            flips: 0,
            tried: Tried::default(),
        };
        dual.measure_all()?;
        Ok(dual)
    }

    /// The triangles by their seeds.
    pub(crate) fn triangles(&self) -> Vec<[u32; 3]> {
        self.topology().faces().map(|f| self.topology().corners(f).map(|v| v.0)).collect()
    }

    /// Where the seeds are.
    pub(crate) fn places(&self) -> &[Place] {
        &self.state.places
    }

    /// The surface.
    pub(crate) fn manifold(&self) -> &'a Manifold {
        self.manifold
    }

    /// Its metric, not scaled.
    pub(crate) fn metric(&self) -> &'a dyn SurfaceMetric {
        self.metric
    }

    /// Multiplies the metric by another factor instead.
    ///
    /// # Errors
    /// As for [`SurfaceDual::new`].
    pub(crate) fn rescale(&mut self, factor: f64) -> Result<()> {
        let ratio = factor / self.factor;
        self.factor = factor;
        self.tried.forget();
        if !(1.0 / ALIKE..=ALIKE).contains(&ratio) {
            self.state.topology.change_lengths(|_, _| f64::NAN);
            return self.measure_all();
        }
        self.state.locals.par_iter_mut().with_min_len(1024).for_each(|local| *local = local.times(ratio));
        self.state.topology.stretch(ratio.sqrt());
        Ok(())
    }

    fn measure_all(&mut self) -> Result<()> {
        self.measure_each(|_, _| true, |_, field, tensor| LocalMetric::at_known(field, Point::default(), tensor))
    }

    pub(super) fn position(&self, v: VertexId) -> Point3 {
        self.state.places[v.index()].position
    }

    /// Evaluates the metric at seeds that are due, by the metric there and how far in the tangent plane they have moved.
    fn measure_each(
        &mut self,
        is_due: impl Fn(&LocalMetric, Vector) -> bool + Sync,
        measure: impl Fn(&LocalMetric, &Scaled, Tensor) -> LocalMetric + Sync,
    ) -> Result<()> {
        let (manifold, metric, factor) = (self.manifold, self.metric, self.factor);
        let State { places, planes, locals, measured, .. } = &mut self.state;
        let seeds = locals.par_iter_mut().zip(measured).zip(places.as_slice()).zip(planes.as_slice());
        seeds.with_min_len(64).for_each(|(((local, measured), at), plane)| {
            if is_due(local, plane.flatten(at.position - measured.at)) {
                let (chart, tensor) = (Chart::in_plane(manifold, metric, *at, *plane), metric.at(at));
                *local = measure(local, &Scaled { field: &chart, factor }, chart.seen(at, tensor) * factor);
                *measured = Measured { at: at.position, tensor };
            }
        });
        match self.state.locals.iter().position(|local| !local.tensor.is_positive_definite()) {
            None => Ok(()),
            Some(i) => {
                let what = "the tensor there is not finite and positive definite";
                let help = "give a metric whose eigenvalues are positive on the whole surface";
                Err(Error::metric(what, self.state.places[i].position.to_string(), help))
            }
        }
    }

    /// Where a place is, seen from a seed.
    pub(crate) fn seen_from(&self, seed: VertexId, place: &Place) -> Vector {
        self.seen(seed, place.position, self.manifold.normal(place))
    }

    /// In the direction of the projection, as long as the way along the surface.
    fn seen(&self, from: VertexId, to: Point3, normal: Vector3) -> Vector {
        let (e, plane) = (to - self.position(from), &self.state.planes[from.index()]);
        ahead(plane.flatten(e), length_over(e, [plane.normal, normal]))
    }

    /// Where two seeds are, each seen from the other; of the second the opposite.
    pub(super) fn offsets(&self, ends: [VertexId; 2]) -> [Vector; 2] {
        let [from, to] = ends.map(|v| self.position(v));
        let (e, planes) = (to - from, ends.map(|v| &self.state.planes[v.index()]));
        let length = length_over(e, planes.map(|plane| plane.normal));
        planes.map(|plane| ahead(plane.flatten(e), length))
    }

    /// Where a seed comes to lie that is moved by a vector of its tangent plane.
    pub(crate) fn place_after(&self, v: VertexId, by: Vector) -> Option<Place> {
        let (at, plane) = (self.state.places[v.index()], self.state.planes[v.index()]);
        self.manifold.lift(&at, at.position + plane.lift(by))
    }

    /// Moves a seed to a place near it, or as near to that as straight up from its tangent plane leads, and flips around it, unless a triangle would
    /// turn over; says whether it did.
    pub(crate) fn relocate(&mut self, v: VertexId, to: &Place) -> bool {
        let by = self.state.planes[v.index()].flatten(to.position - self.position(v));
        let is_done = self.shift_by(v, by);
        if is_done {
            self.settle_move(v);
        }
        is_done
    }

    /// Whether a triangle faces away from the mean of the surface's normals at its corners.
    pub(crate) fn is_folded(&self, f: FaceId) -> bool {
        let corners = self.topology().corners(f);
        let [a, b, c] = corners.map(|v| self.position(v));
        let mean = corners.iter().fold(Vector3::default(), |sum, v| sum + self.state.planes[v.index()].normal);
        (b - a).cross(c - a).dot(mean) < 0.0
    }

    /// The least cosine between the normal of a triangle and those of the surface at its corners.
    pub(crate) fn upright(&self, corners: [VertexId; 3]) -> f64 {
        let normals = corners.map(|v| self.state.facing[v.index()]);
        upright(corners.map(|v| self.position(v)), normals)
    }

    /// Quality of a triangle by its lengths: 1 of an equilateral one.
    pub(crate) fn shape(&self, [a, b, c]: [VertexId; 3]) -> f64 {
        let [x, y, z] = [[a, b], [b, c], [c, a]].map(|ends| self.estimate(ends).value);
        let square = (x + y + z) * (x + y - z) * (x - y + z) * (y + z - x);
        3.0_f64.sqrt() * square.max(0.0).sqrt() / (x * x + y * y + z * z)
    }

    /// Edges that are free to be as long as the metric wants: not between seeds that stay. All, if there are none.
    fn free_edges(&self) -> Vec<HalfEdge> {
        let topology = self.topology();
        let edges = topology.edges_with(|h| topology.ends(h).iter().any(|&v| self.kind(v) == Kind::Free));
        if edges.is_empty() { topology.edges_with(|_| true) } else { edges }
    }

    /// The geometric mean of the lengths of edges that are free, but for those between seeds that have come to one place.
    pub(crate) fn mean_length(&self) -> f64 {
        let edges = self.free_edges();
        let log = |&h: &HalfEdge| self.estimate(self.topology().ends(h)).value.logarithm();
        let mut logs: Vec<f64> = edges.par_iter().with_min_len(64).map(log).collect();
        logs.retain(|log| log.is_finite());
        (logs.iter().sum::<f64>() / logs.len().max(1) as f64).exponential()
    }

    /// The share of unit lengths among the edges that are free.
    pub(crate) fn unit_share(&self) -> f64 {
        unit_share(&self.free_edges(), |h| self.estimate(self.topology().ends(h)).value)
    }

    /// Where a move leads a seed, unless the surface turns away.
    fn landing(&self, v: VertexId, by: Vector) -> Option<Landing> {
        let place = self.place_after(v, by)?;
        let normal = self.manifold.normal(&place);
        (normal.dot(self.state.planes[v.index()].normal) >= UPRIGHT).then_some(Landing { place, normal })
    }

    /// Moves a seed there, unless a triangle would turn over; says whether it did.
    fn land(&mut self, v: VertexId, Landing { place, normal }: Landing) -> bool {
        let topology = self.topology();
        let stands = |h: HalfEdge| {
            let [a, b] = [topology.target(h), topology.apex(h)];
            let normals = [normal, self.state.facing[a.index()], self.state.facing[b.index()]];
            let after = upright([place.position, self.position(a), self.position(b)], normals);
            after >= UPRIGHT || after >= self.upright([v, a, b])
        };
        if !topology.star(v).all(stands) {
            return false;
        }
        self.state.places[v.index()] = place;
        self.state.planes[v.index()] = self.state.planes[v.index()].turned(normal);
        self.state.facing[v.index()] = normal;
        let around: Vec<HalfEdge> = self.topology().star(v).flat_map(|h| [h, h.prev()]).collect();
        for h in around {
            self.state.topology.set_length(h, f64::NAN);
        }
        true
    }

    /// Whether a triangle would turn over if its corners that move came to land there.
    fn would_turn(&self, f: FaceId, landings: &[Option<Landing>], moving: &[bool]) -> bool {
        let corners = self.topology().corners(f);
        let landing = |v: VertexId| landings[v.index()].filter(|_| moving[v.index()]);
        let then = corners.map(|v| {
            landing(v).map_or((self.position(v), self.state.facing[v.index()]), |to| (to.place.position, to.normal))
        });
        let after = upright(then.map(|(at, _)| at), then.map(|(_, normal)| normal));
        after < UPRIGHT && after < self.upright(corners)
    }

    /// Lengths after seeds have moved: they change as straight edges do, where the metric at both ends holds still, and are to be measured elsewhere.
    fn carry_lengths(&mut self, landings: &[Option<Landing>], moving: &[bool]) {
        let State { topology, places, planes, locals, measured, .. } = &mut self.state;
        let landing = |v: VertexId| landings[v.index()].filter(|_| moving[v.index()]).map(|to| to.place.position);
        let is_due = |v: VertexId| {
            let by = |to: Point3| planes[v.index()].flatten(to - measured[v.index()].at);
            landing(v).is_some_and(|to| locals[v.index()].tensor.length(by(to)) >= STILL)
        };
        topology.change_lengths(|ends, length| {
            if length.is_nan() || !ends.iter().any(|v| moving[v.index()]) {
                return length;
            }
            if ends.into_iter().any(is_due) {
                return f64::NAN;
            }
            let [m, n] = ends.map(|v| measured[v.index()].tensor);
            let [p, q] = ends.map(|v| places[v.index()].position);
            let [to_p, to_q] = ends.map(|v| landing(v).unwrap_or(places[v.index()].position));
            length * ((m + n).length(to_q - to_p) / (m + n).length(q - p))
        });
    }

    /// A place with the metric there, scaled.
    fn site_of(&self, place: Place) -> SurfaceSite {
        let normal = self.manifold().normal(&place);
        let tensor = self.metric().at(&place) * self.factor();
        SurfaceSite { tensor, log: None, place: Place { normal, ..place } }
    }
}

/// The length of a surface over a chord, by its normals at both ends and the cubic that they make.
fn length_over(e: Vector3, normals: [Vector3; 2]) -> f64 {
    let length = e.norm();
    let [a, b] = normals.map(|normal| {
        let sine = -normal.dot(e) / length;
        (sine / (1.0 - sine * sine).max(f64::MIN_POSITIVE).sqrt()).clamp(-STEEP, STEEP)
    });
    length * (1.0 + (2.0 * (a * a + b * b) - a * b) / 30.0)
}

/// In the direction of a vector, so long.
fn ahead(flat: Vector, length: f64) -> Vector {
    let norm = flat.norm();
    if norm > 0.0 { flat * (length / norm) } else { Vector::default() }
}

/// The least cosine of a triangle's normal with others; 0 of a triangle that is flat but for rounding.
fn upright([a, b, c]: [Point3; 3], normals: [Vector3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    if normal.norm() <= FLAT * (b - a).norm().max((c - a).norm()).powi(2) {
        return 0.0;
    }
    let normal = normal.unit().unwrap_or_default();
    normals.iter().map(|n| n.dot(normal)).fold(1.0, f64::min)
}

/// A place of a surface, the tensor there and, where that was asked for, its logarithm.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct SurfaceSite {
    place: Place,
    tensor: Tensor3,
    log: Option<Tensor3>,
}

impl SurfaceSite {
    fn log(&self) -> Tensor3 {
        self.log.unwrap_or_else(|| self.tensor.log())
    }
}

impl Moving for SurfaceDual<'_> {
    type Saved = State;
    type Site = SurfaceSite;

    fn sketch(&self) -> Sketch {
        (self.places().iter().map(|place| place.position.to_array()).collect(), self.triangles())
    }

    fn topology(&self) -> &Triangulation {
        &self.state.topology
    }

    fn local(&self, v: VertexId) -> &LocalMetric {
        &self.state.locals[v.index()]
    }

    fn kind(&self, v: VertexId) -> Kind {
        self.state.kinds[v.index()]
    }

    fn offset(&self, from: VertexId, to: VertexId) -> Vector {
        self.seen(from, self.position(to), self.state.planes[to.index()].normal)
    }

    fn factor(&self) -> f64 {
        self.factor
    }

    fn shift_by(&mut self, v: VertexId, by: Vector) -> bool {
        self.landing(v, by).is_some_and(|landing| self.land(v, landing))
    }

    fn shift_together(&mut self, moves: &[(VertexId, Vector)]) -> Vec<bool> {
        let landing = |v: VertexId, by| {
            let known = self.tried.landing(v, &self.state.places[v.index()], by);
            known.or_else(|| self.landing(v, by))
        };
        let found = moves.par_iter().with_min_len(64).map(|&(v, by)| landing(v, by));
        let mut landings = vec![None; self.state.places.len()];
        moves.iter().zip(found.collect::<Vec<_>>()).for_each(|(&(v, _), found)| landings[v.index()] = found);
        let moving = landings.iter().map(Option::is_some).collect();
        let moving = self.topology().movable_together(moving, |f, moving| self.would_turn(f, &landings, moving));
        self.carry_lengths(&landings, &moving);
        self.tried.note(&self.state, moves.iter().copied().filter(|(v, _)| moving[v.index()]));
        let State { places, planes, facing, .. } = &mut self.state;
        let seeds = places.par_iter_mut().zip(planes).zip(facing).zip(&landings).zip(&moving).with_min_len(256);
        seeds.for_each(|((((place, plane), facing), landing), &moves)| {
            if let Some(landing) = landing.filter(|_| moves) {
                (*place, *plane, *facing) = (landing.place, plane.turned(landing.normal), landing.normal);
            }
        });
        moves.iter().map(|(v, _)| moving[v.index()]).collect()
    }

    /// Lengths of edges that a rough metric makes slow to measure, where they are not known.
    fn measure(&mut self) {
        let topology = self.topology();
        let edges = topology.edges_with(|h| topology.length(h).is_nan() && self.is_rough(topology.ends(h)));
        let length = |&h: &HalfEdge| self.chord_length(topology.ends(h));
        let lengths: Vec<f64> = edges.par_iter().with_min_len(64).map(length).collect();
        for (h, length) in edges.into_iter().zip(lengths) {
            self.state.topology.set_length(h, length);
        }
    }

    fn settle_moves(&mut self) -> Result<u64> {
        self.tried.recall(&mut self.state);
        let is_due = |local: &LocalMetric, by: Vector| local.tensor.length(by) >= STILL;
        self.measure_each(is_due, |local, field, tensor| local.moved_to(field, Point::default(), tensor))?;
        Ok(self.flip_all())
    }

    fn save(&self) -> State {
        let mut saved = State::default();
        self.save_over(&mut saved);
        saved
    }

    fn save_over(&self, saved: &mut State) {
        saved.copy_from(&self.state);
    }

    fn take_back(&mut self, saved: &State) {
        self.tried.keep(&mut self.state);
        self.state.copy_from(saved);
    }

    fn moved_since(&self, saved: &State, v: VertexId) -> Vector {
        self.state.planes[v.index()].flatten(self.position(v) - saved.places[v.index()].position)
    }

    fn site(&self, v: VertexId) -> SurfaceSite {
        self.site_of(self.places()[v.index()])
    }

    fn site_after(&self, v: VertexId, by: Vector) -> Option<SurfaceSite> {
        Some(self.site_of(self.place_after(v, by)?))
    }

    /// Negative where the triangle is turned over against the surface's normal at a corner.
    fn quality(&self, corners: [SurfaceSite; 3]) -> f64 {
        let at @ [a, b, c] = corners.map(|site| site.place.position);
        let seen = corners.map(|site| Seen { tensor: site.tensor, normal: site.place.normal });
        let quality = Seen::flattened(at, seen).map_or(0.0, |(metric, corners)| metric.shape(corners));
        let normal = (b - a).cross(c - a);
        let is_upright = corners.iter().all(|site| site.place.normal.dot(normal) > 0.0);
        if is_upright { quality } else { -quality }
    }

    fn straight_length(&self, [a, b]: [SurfaceSite; 2]) -> f64 {
        ((a.log() + b.log()) * 0.5).exp().length(b.place.position - a.place.position)
    }

    fn ready(&self, site: SurfaceSite) -> SurfaceSite {
        SurfaceSite { log: Some(site.log()), ..site }
    }

    fn settle_move(&mut self, v: VertexId) {
        let (at, plane) = (self.state.places[v.index()], self.state.planes[v.index()]);
        let (chart, tensor) = (Chart::in_plane(self.manifold, self.metric, at, plane), self.metric.at(&at));
        let (field, there) = (Scaled { field: &chart, factor: self.factor }, chart.seen(&at, tensor) * self.factor);
        let local = self.state.locals[v.index()].moved_to(&field, Point::default(), there);
        if local.tensor.is_positive_definite() {
            self.state.locals[v.index()] = local;
            self.state.measured[v.index()] = Measured { at: at.position, tensor };
        }
        let star: Vec<HalfEdge> = self.topology().star(v).flat_map(|h| [h, h.prev()]).collect();
        for h in star {
            self.measure_edge(h);
        }
        self.flip_around(v);
    }
}
