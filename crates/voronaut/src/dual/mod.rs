//! The Riemannian Delaunay triangulation of seeds in a planar domain, with straight edges: the mesh in the making.
//!
//! It starts as the constrained Delaunay triangulation of the domain's corners and changes by insertions, moves,
//! removals and flips, each of which keeps it embedded. Edges are flipped by the metric in-circle test
//! ([`flips`](self)); a flip that the metric wants and the plane forbids is *blocked*.

mod consult;
mod edit;
mod halve;
mod margin;
mod moving;
mod on_surface;
mod surface_flips;
mod patch;
mod state;
mod tried;

pub(crate) use consult::Consultation;
pub(crate) use consult::Disagreement;
pub use consult::Road;
use moving::Saved;
pub(crate) use moving::{Moving, sites};
pub(crate) use on_surface::SurfaceDual;

use crate::error::{Error, Result};
use crate::geodesic::{LocalMetric, Paths, chord_between, hermite, is_unit};
use crate::geometry::{Point, Readable, Tensor};
use crate::in_circle::Tests;
use crate::manifold::domain::Corners;
use crate::metric::Scaled;
use crate::parallel::prelude::*;
use crate::planar::{Location, Planar};
use crate::triangulation::{FaceId, HalfEdge, Lawson, Limit, VertexId};
use margin::{LEVELS, Margins};
use std::collections::HashSet;

/// What holds a vertex in its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It is this point of the domain's graph.
    Corner(u32),
    /// It lies on a segment of the domain's graph.
    Curve,
    /// It lies on one and stays where it is: on another segment of the pair is its partner.
    Held,
    /// Nothing: it may move and go.
    Free,
}

/// Margins closer to zero than this are ties: flipping them gains nothing and could go on for ever.
const TIE: f64 = 1e-9;

/// Inconsistent tests can make flips go round in a circle.
const LIMIT: Limit = Limit::OfSlot(6);

/// A flip may not leave a triangle whose quality is below this if both were better before: where lengths of straight
/// edges contradict each other, or geodesics bend away from them, it would leave slivers.
const POOR: f64 = 0.5;

/// How far up the levels a test may climb.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effort {
    /// To lengths from the expansions at the vertices: no evaluation of the field.
    Local = 1,
    /// To quadrature along the chords.
    Chord = 2,
    /// To the last level: geodesics.
    Full = 4,
}

/// Work counters; deterministic.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct DualCounters {
    /// In-circle tests settled at each level.
    pub tests: [u64; LEVELS],
    /// Flips done.
    pub flips: u64,
}

/// See the [module](self).
pub struct Dual<'a> {
    field: Scaled<'a>,
    planar: Planar,
    locals: Vec<LocalMetric>,
    kinds: Vec<Kind>,
    required: Vec<bool>,
    touched: Vec<FaceId>,
    lawson: Lawson,
    /// What is known of edges, until a seed moves, comes or goes.
    tests: Tests,
    /// Their margins by all levels, until then.
    margins: Margins,
    /// Edges that are not to be flipped, until then.
    held: HashSet<[VertexId; 2]>,
    paths: Paths,
    counters: DualCounters,
    fault: Option<(Point, Tensor)>,
    /// What moves that were taken back had led to.
    tried: Saved,
}

impl<'a> Dual<'a> {
    /// The triangulated corners of a domain. The field measures in units of the wanted edge length.
    ///
    /// # Errors
    /// The metric is not positive definite at a corner.
    pub(crate) fn new(corners: Corners, field: Scaled<'a>) -> Result<Self> {
        let planar = corners.planar.clone();
        let kinds = corners.sources.iter().map(|s| s.map_or(Kind::Free, Kind::Corner)).collect();
        let mut dual = Self {
            field,
            locals: vec![LocalMetric::default(); planar.positions.len()],
            planar,
            kinds,
            required: corners.segments.iter().map(|s| s.required).collect(),
            touched: Vec::new(),
            lawson: Lawson::default(),
            tests: Tests::default(),
            margins: Margins::default(),
            held: HashSet::new(),
            paths: Paths::default(),
            counters: DualCounters::default(),
            fault: None,
            tried: Saved::default(),
        };
        dual.measure_all();
        dual.verdict()?;
        dual.flip_all(Effort::Local);
        Ok(dual)
    }

    /// The embedded triangulation.
    pub(crate) fn planar(&self) -> &Planar {
        &self.planar
    }

    /// The metric field, in units of the wanted edge length.
    pub(crate) fn field(&self) -> &Scaled<'a> {
        &self.field
    }

    /// Multiplies the metric by another factor instead; seeds and edges stay.
    pub(crate) fn rescale(&mut self, factor: f64) {
        self.field.factor = factor;
        self.measure_all();
    }

    /// Number of vertices.
    pub(crate) fn vertex_count(&self) -> usize {
        self.planar.topology.vertex_count()
    }

    /// Position of a vertex.
    pub(crate) fn position(&self, v: VertexId) -> Point {
        self.planar.position(v)
    }

    /// The metric around every vertex, by id.
    pub(crate) fn locals(&self) -> &[LocalMetric] {
        &self.locals
    }

    /// Where a point is, as a vertex near it sees it: straight ahead, and with `confined` not beyond constraints.
    pub(crate) fn seen_from(&self, near: VertexId, p: Point, confined: bool) -> Option<Location> {
        Some(self.planar.walk(self.topology().start(near)?.face(), p, confined))
    }

    /// Whether the straight way from a vertex to a point stays in the domain.
    pub(crate) fn is_inside(&self, near: VertexId, p: Point) -> bool {
        !matches!(self.seen_from(near, p, false), None | Some(Location::Behind(_)))
    }

    /// Work counters since the beginning.
    pub(crate) fn counters(&self) -> &DualCounters {
        &self.counters
    }

    /// Metric length of an edge: estimated from its ends (`hermite`), or, where the metric is rough, by quadrature
    /// along the chord.
    pub(crate) fn edge_length(&self, h: HalfEdge) -> f64 {
        let [u, v] = self.topology().ends(h);
        let (p, q) = (self.position(u), self.position(v));
        if self.local(u).is_rough || self.local(v).is_rough {
            return chord_between(&self.field, [p, q], [u, v].map(|v| self.local(v).tensor), self.local(u).near);
        }
        hermite(p, self.local(u), q, self.local(v)).value
    }

    /// The share of unit lengths among the edges that a flip may remove.
    pub(crate) fn unit_share(&self) -> f64 {
        unit_share(&self.free_edges(), |h| self.edge_length(h))
    }

    /// The faces that changed since the last call, some of them perhaps several times or removed.
    pub(crate) fn take_touched(&mut self) -> Vec<FaceId> {
        std::mem::take(&mut self.touched)
    }

    /// The same, into this list.
    pub(crate) fn take_touched_into(&mut self, list: &mut Vec<FaceId>) {
        list.clear();
        std::mem::swap(list, &mut self.touched);
    }

    /// Whether the metric was found valid wherever it was evaluated so far.
    ///
    /// # Errors
    /// [`Error::Metric`] with the first place where it is not positive definite and finite.
    pub(crate) fn verdict(&self) -> Result<()> {
        let Some((p, t)) = self.fault else { return Ok(()) };
        let [xx, xy, yy] = [t.xx, t.xy, t.yy].map(Readable);
        let what = format!("the tensor {xx}, {xy}, {yy} is not finite and positive definite");
        Err(Error::metric(what, p.to_string(), "give a metric whose eigenvalues are positive in the whole domain"))
    }

    /// Numbers vertices and faces along a Hilbert curve; ids change. Passes over all seeds are then fast for any size.
    pub(crate) fn reorder(&mut self) {
        let (planar, old) = self.planar.reordered();
        self.locals = old.par_iter().with_min_len(1024).map(|&v| self.locals[v.index()]).collect();
        self.kinds = old.iter().map(|&v| self.kinds[v.index()]).collect();
        self.planar = planar;
        self.touched.clear();
        self.forget();
    }

    /// Forgets what is known of edges.
    fn forget(&mut self) {
        self.tests = Tests::default();
        self.margins = Margins::default();
        self.held.clear();
    }

    /// Evaluates the metric at every vertex, in parallel.
    pub(crate) fn measure_all(&mut self) {
        self.measure_each(|local, field, p| LocalMetric::at_near(field, p, local.near));
    }

    fn measure_each(&mut self, measure: impl Fn(&LocalMetric, &Scaled, Point) -> LocalMetric + Sync) {
        self.forget();
        let field = self.field;
        let (topology, positions) = (&self.planar.topology, &self.planar.positions);
        let seeds = self.locals.par_iter_mut().enumerate().with_min_len(256);
        let seeds = seeds.filter(|(v, _)| topology.is_vertex(VertexId(*v as u32)));
        let faults = seeds.filter_map(|(v, local)| {
            *local = measure(local, &field, positions[v]);
            (!local.tensor.is_positive_definite()).then_some(v)
        });
        for v in faults.collect::<Vec<usize>>() {
            self.locals[v] = self.vetted(self.planar.positions[v], self.locals[v]);
        }
    }

    /// Measures, in parallel, the edges at rough vertices by quadrature along the chord, and stores their lengths in
    /// the triangulation.
    pub(crate) fn measure_rough_edges(&mut self) {
        if !self.locals.par_iter().with_min_len(1024).any(|local| local.is_rough) {
            return;
        }
        let is_rough = |v: VertexId| self.local(v).is_rough;
        let topology = self.topology();
        let at_rough = |&h: &HalfEdge| topology.ends(h).into_iter().any(is_rough);
        let measured = |h: HalfEdge| {
            let [from, to] = topology.ends(h).map(|v| self.local(v));
            let chord = || chord_between(&self.field, self.planar.ends(h), [from.tensor, to.tensor], from.near);
            (h, self.recalled_length(topology.ends(h)).unwrap_or_else(chord))
        };
        let faces = (0..topology.face_slots() as u32).into_par_iter().with_min_len(64).map(FaceId);
        let edges = faces.flat_map_iter(|f| topology.edges_of(f).filter(at_rough).map(measured));
        let lengths: Vec<(HalfEdge, f64)> = edges.collect();
        for (h, length) in lengths {
            self.planar.topology.set_length(h, length);
        }
    }

    /// The metric around a vertex; where it is not valid that is noted, and the Euclidean metric serves instead.
    fn measure(&mut self, v: VertexId) -> LocalMetric {
        self.forget();
        // A neighbour tells where to look, of a vertex that is new itself.
        let beside = self.topology().star(v).map(|h| self.topology().target(h));
        let near = beside.map(|u| self.locals[u.index()].near).next().unwrap_or_default();
        let p = self.position(v);
        let local = LocalMetric::at_near(&self.field, p, near);
        self.vetted(p, local)
    }

    fn vetted(&mut self, p: Point, local: LocalMetric) -> LocalMetric {
        if local.tensor.is_positive_definite() {
            return local;
        }
        self.fault.get_or_insert((p, local.tensor));
        LocalMetric { tensor: Tensor::IDENTITY, ..LocalMetric::default() }
    }
}

/// The share of edges whose lengths are within a factor of sqrt(2) of one; 1 of none.
fn unit_share(edges: &[HalfEdge], length: impl Fn(HalfEdge) -> f64 + Sync) -> f64 {
    let unit = edges.par_iter().with_min_len(64).filter(|&&h| is_unit(length(h))).count();
    if edges.is_empty() { 1.0 } else { unit as f64 / edges.len() as f64 }
}
