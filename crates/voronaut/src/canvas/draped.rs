//! A triangulation draped over a surface: every face lies in a triangle of the input or, on an equation's surface, has its
//! corners on it.

use super::CanvasCounters;
use super::buckets::Buckets;
use super::isotropic::isotropic_size;
use super::lengths::{self, Measured};
use crate::error::{Error, Result};
use crate::geodesic::bowed_between;
use crate::geometry::{Point3, TangentPlane, Tensor3};
use crate::lists::distinct;
use crate::manifold::surface::metric::{SurfaceMetric, check_tensor3};
use crate::manifold::{Chart, Manifold, Place};
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};
use std::collections::BTreeMap;

/// Tensors at the ends of an edge say the same of it, and of what is across it, if they differ by no more than this share.
const ALIKE: f64 = 0.02;
/// Where they differ by more than this the edge may bow.
const UNLIKE: f64 = 0.05;
/// The least share of a straight edge's length that its best bow has.
const NOT_RESOLVED: f64 = 0.5;
/// A seed this near (barycentric) to an edge of its face is on it, and one this near (as a share of the longest edge) to a
/// corner is there.
const ON_EDGE: f64 = 1e-9;

/// A face is flat but for rounding if its height is so small a part of its longest edge.
const FLAT: f64 = 1e-9;

/// A triangulation draped over a surface, with its metric. Faces are labelled with the number of the input's triangle that they lie in.
#[derive(Clone)]
pub struct Draped<'s> {
    pub(super) manifold: &'s Manifold,
    pub(super) metric: &'s dyn SurfaceMetric,
    pub(super) topology: Triangulation,
    places: Vec<Place>,
    tensors: Vec<Tensor3>,
}

/// The faces in each of the input's triangles.
pub(crate) type Homes = BTreeMap<FaceId, Vec<FaceId>>;

/// Which way along an edge is measured. Long edges may bow far away from what halves of them would see: while a triangulation is
/// refined they are straight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Along {
    Straight,
    Shortest,
}

/// By what edges are halved, the greatest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Size {
    /// Metric length.
    Metric,
    /// Euclidean length beside what the metric asks for in its finest direction.
    Isotropic,
}

impl<'s> Draped<'s> {
    /// The triangles of the input; edges are to be measured.
    ///
    /// # Errors
    /// [`Error::Metric`] where the metric is not positive definite at a vertex.
    pub(super) fn new(manifold: &'s Manifold, metric: &'s dyn SurfaceMetric) -> Result<Self> {
        let mut topology = manifold.topology().clone();
        for f in topology.faces().collect::<Vec<_>>() {
            topology.set_region(f, f.0.cast_signed());
        }
        let slots = topology.vertex_slots() as u32;
        let place = |v: u32| {
            let place = manifold.place_of(VertexId(v))?;
            // On an equation's surface its normal counts.
            Some(if manifold.equation().is_some() { manifold.lift(&place, place.position)? } else { place })
        };
        let unused = manifold.place(topology.faces().next().expect("a surface has triangles"), [1.0, 0.0, 0.0]);
        let places: Vec<Place> = (0..slots).into_par_iter().map(|v| place(v).unwrap_or(unused)).collect();
        let tensors: Vec<Tensor3> = places.par_iter().with_min_len(256).map(|place| metric.at(place)).collect();
        for v in topology.vertices() {
            check_tensor3(tensors[v.index()], || places[v.index()].position.to_string())?;
        }
        Ok(Self { manifold, metric, topology, places, tensors })
    }

    /// Halves the largest edge, again and again, until there are so many vertices. Edges are then to be measured.
    ///
    /// # Errors
    /// The metric is not positive definite at a new vertex.
    pub(super) fn refine(&mut self, size: Size, vertices: usize, counters: &mut CanvasCounters) -> Result<()> {
        if self.topology.vertex_count() >= vertices {
            return Ok(());
        }
        self.measure_all(Along::Straight);
        let mut queue: Buckets<[VertexId; 2]> = Buckets::default();
        let enqueue = |draped: &Self, queue: &mut Buckets<_>, h: HalfEdge| {
            queue.push(draped.size_of(h, size), draped.topology.ends(h));
        };
        for h in self.topology.edges().collect::<Vec<_>>() {
            enqueue(self, &mut queue, h);
        }
        while self.topology.vertex_count() < vertices {
            let Some([a, b]) = queue.pop() else { break };
            let Some(h) = self.topology.edge_between(a, b) else { continue };
            let Some(v) = self.halve(h)? else { continue };
            counters.splits += 1;
            for h in self.topology.spokes(v) {
                enqueue(self, &mut queue, h);
            }
        }
        Ok(())
    }

    /// Makes places vertices; returns these. Places at one vertex have the same.
    ///
    /// # Errors
    /// As for [`Draped::refine`].
    pub(super) fn insert_all(&mut self, seeds: &[Place]) -> Result<Vec<VertexId>> {
        let mut at_home = self.homes();
        let mut found = Vec::with_capacity(seeds.len());
        for seed in seeds {
            let before = self.topology.face_slots() as u32;
            let on_border = self.insert_on_border(seed, &at_home)?;
            found.push(if let Some(v) = on_border {
                v
            } else {
                let (f, weights) = self.face_at(seed, &at_home)?;
                self.insert_in(f, weights, *seed)?
            });
            self.note_homes(before, &mut at_home);
        }
        Ok(found)
    }

    /// The faces in each of the input's triangles.
    pub(crate) fn homes(&self) -> Homes {
        let mut at_home = Homes::new();
        for f in self.topology.faces() {
            at_home.entry(self.home(f)).or_default().push(f);
        }
        at_home
    }

    /// The face that holds a place, and the weights of its corners.
    ///
    /// # Errors
    /// [`Error::Domain`] of a place off the surface.
    pub(crate) fn face_at(&self, seed: &Place, at_home: &Homes) -> Result<(FaceId, [f64; 3])> {
        let homes = self.homes_around(seed.face);
        let faces = homes.iter().flat_map(|home| at_home.get(home).map_or(&[][..], Vec::as_slice));
        let held = faces.map(|&f| (f, self.closest_on(f, seed.position)));
        let deepest = |weights: [f64; 3]| weights.into_iter().fold(f64::INFINITY, f64::min);
        let order =
            |x: &(f64, [f64; 3]), y: &(f64, [f64; 3])| x.0.total_cmp(&y.0).then(deepest(y.1).total_cmp(&deepest(x.1)));
        let found = held.min_by(|x, y| order(&x.1, &y.1)).map(|(f, (_, weights))| (f, weights));
        let off = || Error::domain("a seed off the surface", seed.position.to_string(), "move it onto the surface");
        found.ok_or_else(off)
    }

    /// The vertices of the face that holds a place and of those around its corners, with their metric distances from it along chords.
    ///
    /// # Errors
    /// [`Error::Domain`] of a place off the surface.
    pub(crate) fn around(&self, place: &Place, at_home: &Homes) -> Result<Vec<(VertexId, f64)>> {
        let (f, _) = self.face_at(place, at_home)?;
        let around = self.topology.corners(f).into_iter().flat_map(|v| self.topology.around(v));
        let near = distinct(around);
        let tensor = self.metric.at(place);
        let distance = |v: VertexId| self.between([place, self.place(v)], [tensor, self.tensor(v)]);
        Ok(near.into_iter().map(|v| (v, distance(v))).collect())
    }

    /// Puts faces that are new since there were so many with the others of their homes.
    fn note_homes(&self, before: u32, at_home: &mut Homes) {
        for new in (before..self.topology.face_slots() as u32).map(FaceId) {
            at_home.entry(self.home(new)).or_default().push(new);
        }
    }

    /// Makes a place at the border of an equation's surface a vertex there: it is on the equation, and so beside the edges that
    /// the border has here. `None` of any other place.
    fn insert_on_border(&mut self, seed: &Place, at_home: &Homes) -> Result<Option<VertexId>> {
        if self.manifold.equation().is_none() || !self.manifold.is_at_border(seed, 0.0) {
            return Ok(None);
        }
        let faces = at_home.get(&seed.face).into_iter().flatten();
        let borders = faces.flat_map(|f| f.half_edges()).filter(|&h| self.topology.twin(h).is_none());
        let distance = |h: HalfEdge| {
            let [a, b] = self.topology.ends(h).map(|v| self.position(v));
            let t = ((seed.position - a).dot(b - a) / (b - a).dot(b - a)).clamp(0.0, 1.0);
            (a.lerp(b, t).distance(seed.position), t)
        };
        let nearest = borders.map(|h| (h, distance(h))).min_by(|x, y| x.1.0.total_cmp(&y.1.0));
        let Some((h, (_, t))) = nearest else { return Ok(None) };
        let end = if t <= ON_EDGE { self.topology.origin(h) } else { self.topology.target(h) };
        if t <= ON_EDGE || t >= 1.0 - ON_EDGE {
            self.places[end.index()] = *seed;
            return Ok(Some(end));
        }
        let v = self.add(*seed)?;
        self.topology.split_edge(h, v);
        self.measure_around(v);
        Ok(Some(v))
    }

    /// The input's triangles in which a place of one of them may be: on an equation's surface those around it, too.
    fn homes_around(&self, home: FaceId) -> Vec<FaceId> {
        if self.manifold.equation().is_none() {
            return vec![home];
        }
        let own = self.manifold.topology();
        distinct(own.corners(home).into_iter().flat_map(|v| own.star(v)).map(HalfEdge::face))
    }

    /// The distance of a point to a face, with the weights of the closest one; on a plane face that holds it zero but for
    /// rounding, which must not decide.
    fn closest_on(&self, f: FaceId, p: Point3) -> (f64, [f64; 3]) {
        let corners = self.topology.corners(f).map(|v| self.position(v));
        let weights = crate::manifold::surface::closest_weights(corners, p);
        let distance = Point3::weighted(corners, weights).distance(p);
        (if distance < 1e-13 * self.manifold.diagonal() { 0.0 } else { distance }, weights)
    }

    fn insert_in(&mut self, f: FaceId, weights: [f64; 3], seed: Place) -> Result<VertexId> {
        let near_zero = weights.map(|w| w <= ON_EDGE);
        let [ab, bc, ca] = f.half_edges();
        let corners = self.topology.corners(f);
        let rounding = ON_EDGE * Point3::longest_side(corners.map(|v| self.position(v)));
        if let Some(v) = corners.into_iter().find(|&v| self.position(v).distance(seed.position) <= rounding) {
            self.places[v.index()].position = seed.position;
            return Ok(v);
        }
        let v = self.add(seed)?;
        match near_zero {
            [true, ..] => drop(self.topology.split_edge(bc, v)),
            [_, true, _] => drop(self.topology.split_edge(ca, v)),
            [.., true] => drop(self.topology.split_edge(ab, v)),
            _ => self.topology.split_face(f, v),
        }
        self.measure_around(v);
        Ok(v)
    }

    /// A new vertex at a place.
    fn add(&mut self, place: Place) -> Result<VertexId> {
        let tensor = self.metric.at(&place);
        check_tensor3(tensor, || place.position.to_string())?;
        let v = self.topology.add_vertex();
        self.places.resize(v.index() + 1, place);
        self.tensors.resize(v.index() + 1, tensor);
        (self.places[v.index()], self.tensors[v.index()]) = (place, tensor);
        Ok(v)
    }

    /// The middle of an edge, on the surface.
    fn middle(&self, h: HalfEdge) -> Option<Place> {
        let [a, b] = self.topology.ends(h);
        let p = self.position(a).lerp(self.position(b), 0.5);
        match self.manifold.equation() {
            Some(_) => self.manifold.lift(&self.places[a.index()], p),
            None => Some(Place { position: p, ..self.manifold.closest_on(self.home(h.face()), p) }),
        }
    }

    fn size_of(&self, h: HalfEdge, size: Size) -> f64 {
        match size {
            Size::Metric => self.topology.length(h),
            Size::Isotropic => {
                let [a, b] = self.topology.ends(h);
                let finest = |v: VertexId| isotropic_size(self.plane(v).restrict(self.tensors[v.index()]));
                self.position(a).distance(self.position(b)) / finest(a).min(finest(b))
            }
        }
    }

    fn measure_all(&mut self, along: Along) {
        let edges: Vec<HalfEdge> = self.topology.edges().collect();
        let lengths: Vec<f64> = edges.par_iter().with_min_len(256).map(|&h| self.length_of(h, along)).collect();
        edges.into_iter().zip(lengths).for_each(|(h, length)| self.topology.set_length(h, length));
    }

    fn measure_around(&mut self, v: VertexId) {
        let spokes: Vec<HalfEdge> = self.topology.spokes(v).collect();
        for h in spokes {
            let length = self.length_of(h, Along::Straight);
            self.topology.set_length(h, length);
        }
    }

    /// The metric length of an edge along the surface: by Simpson's rule, on an equation's surface along the cubic that its
    /// tangent planes at the ends make (which is of fourth order); if it may bow, where the metric differs much along the edge,
    /// that of the best bow in the chart at the middle.
    fn length_of(&self, h: HalfEdge, along: Along) -> f64 {
        let ends = self.topology.ends(h);
        let [p, q] = ends.map(|v| &self.places[v.index()]);
        let tensors = ends.map(|v| self.tensors[v.index()]);
        let chord = self.manifold.chord([p, q], tensors);
        if chord.spread < ALIKE {
            return chord.simpson([tensors[0], tensors[1]]);
        }
        let Some(place) = self.middle(h) else { return f64::NAN };
        let tensor = self.metric.at(&place);
        let simpson = chord.simpson([tensor, tensor]);
        if chord.spread < UNLIKE || along == Along::Straight {
            return simpson;
        }
        let chart = Chart::new(self.manifold, self.metric, place, chord.up.unit().unwrap_or(place.normal));
        let [flat_p, flat_q] = [p, q].map(|end| chart.flatten(end.position));
        let bowed = bowed_between(&chart, [flat_p, flat_q], [p, q].map(|end| chart.tensor(end)));
        // A way that is much shorter than the edge leaves its surroundings: the metric is not resolved there.
        if bowed.is_finite() { bowed.clamp(NOT_RESOLVED * simpson, simpson) } else { simpson }
    }

    /// The metric length between two near places along the surface, by Simpson's rule.
    pub(super) fn between(&self, places: [&Place; 2], tensors: [Tensor3; 2]) -> f64 {
        if places[0].position == places[1].position {
            return 0.0;
        }
        self.manifold.chord(places, tensors).simpson(tensors)
    }

    /// The tangent plane at a vertex, of a surface of triangles that of the mean normal.
    pub(crate) fn plane(&self, v: VertexId) -> TangentPlane {
        TangentPlane::new(self.manifold.normal(&self.places[v.index()]))
    }

    /// The surface.
    pub fn manifold(&self) -> &'s Manifold {
        self.manifold
    }

    /// Its metric.
    pub(crate) fn metric(&self) -> &'s dyn SurfaceMetric {
        self.metric
    }

    /// Vertices and faces.
    pub fn topology(&self) -> &Triangulation {
        &self.topology
    }

    /// The input's triangle that a face lies in.
    pub(crate) fn home(&self, f: FaceId) -> FaceId {
        FaceId(self.topology.region(f).cast_unsigned())
    }

    /// Where a vertex is.
    pub(crate) fn place(&self, v: VertexId) -> &Place {
        &self.places[v.index()]
    }

    /// Where a vertex is in space.
    pub fn position(&self, v: VertexId) -> Point3 {
        self.places[v.index()].position
    }

    /// The metric at a vertex.
    pub(crate) fn tensor(&self, v: VertexId) -> Tensor3 {
        self.tensors[v.index()]
    }

    /// The same in another order of vertices; all slots are used.
    pub(super) fn renumbered(&self, order: &[VertexId]) -> Self {
        Self {
            topology: self.topology.renumbered(order),
            places: order.iter().map(|v| self.places[v.index()]).collect(),
            tensors: order.iter().map(|v| self.tensors[v.index()]).collect(),
            ..*self
        }
    }
}

impl Measured for Draped<'_> {
    fn topology_mut(&mut self) -> &mut Triangulation {
        &mut self.topology
    }

    fn topology(&self) -> &Triangulation {
        &self.topology
    }

    fn halve(&mut self, h: HalfEdge) -> Result<Option<VertexId>> {
        let Some(place) = self.middle(h) else { return Ok(None) };
        let faces = self.topology.sides(h).map(HalfEdge::face);
        if faces.flat_map(|f| self.topology.corners(f)).any(|v| self.position(v) == place.position) {
            return Ok(None);
        }
        let v = self.add(place)?;
        self.topology.split_edge(h, v);
        self.measure_around(v);
        Ok(Some(v))
    }

    fn is_beside_flat(&self, h: HalfEdge) -> bool {
        let is_flat = |f: FaceId| {
            let [a, b, c] = self.topology.corners(f).map(|v| self.position(v));
            let longest = Point3::longest_side([a, b, c]);
            (b - a).cross(c - a).norm() <= FLAT * longest * longest
        };
        self.topology.sides(h).any(|side| is_flat(side.face()))
    }

    fn place_of(&self, h: HalfEdge) -> String {
        let [p, q] = self.topology.ends(h).map(|v| self.position(v));
        format!("{p} - {q}")
    }
}

impl Draped<'_> {
    /// Measures all edges, and makes the lengths of every face those of a triangle.
    ///
    /// # Errors
    /// A length is not finite, or the metric is not positive definite at a new vertex.
    pub(super) fn settle_lengths(&mut self, counters: &mut CanvasCounters) -> Result<()> {
        self.measure_all(Along::Shortest);
        for h in self.topology.edges().collect::<Vec<_>>() {
            lengths::check(self, h)?;
        }
        lengths::make_triangles(self, counters)
    }
}

impl std::fmt::Debug for Draped<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Draped").field("vertices", &self.places.len()).finish_non_exhaustive()
    }
}
