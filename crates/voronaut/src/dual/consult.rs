//! The two roads to one dual: lengths of geodesics, and the diagram on a canvas (RR-9103, section 6.4).
//!
//! Each finds what the other cannot: in-circle tests by length are exact where geodesics are short and the field is
//! smooth; the diagram knows about far seeds, wild fields and walls, to within the size of its canvas.

use super::margin::diagonals;
use super::patch::Patch;
use super::{Dual, Effort, Moving};
use crate::canvas::{self, Canvas, CanvasFigures};
use crate::diagram::{Care, Diagram, NerveTriangle, resolve};
use crate::error::{Result, named};
use crate::geodesic::{MarchCounters, Margin, Method};
use crate::lists::{in_order, ranked};
use crate::metric::MetricField;
use crate::parallel::prelude::*;
use crate::planar::Planar;
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use std::collections::HashSet;

/// Which road decides on the topology (`--dual`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Road {
    /// In-circle tests by lengths of geodesics.
    Geodesic,
    /// The nerve of the diagram on a canvas.
    Canvas,
    /// In-circle tests, and the nerve where their estimated error is too large to decide.
    #[default]
    Both,
}

named!(Road, "dual", [Geodesic = "geodesic", Canvas = "canvas", Both = "both"]);

impl Road {
    /// How many of so many seeds a diagram has at most.
    pub(crate) fn seeds_asked(self, seeds: usize) -> usize {
        match self {
            Road::Geodesic => 0,
            Road::Canvas => seeds,
            Road::Both => LEAST_SEEDS.max(seeds / SHARE).min(seeds),
        }
    }
}

/// A diagram is asked where the margin of a test is within its error and that error is larger than this, about the
/// error of a nerve's: nearer ties are beyond both.
const BEYOND_LENGTHS: f64 = 0.1;

/// With [`Road::Both`] the canvas covers at most so many seeds, or one of so many of the mesh's: a diagram of everything
/// takes far longer than the mesh. The least known edges come first.
const LEAST_SEEDS: usize = 1000;
const SHARE: usize = 20;

/// Where there is more than one unknown edge to so many seeds, the canvas has so many vertices at least.
const WILD: usize = 4;
const LEAST_VERTICES: usize = 15_000;

/// With [`Road::Canvas`] the canvas is refined so many times where it does not tell Voronoi vertices apart.
const ROUNDS: u32 = 3;

/// A nerve is not sure of a triangle whose place a fourth seed would win if squares of distances were off by this share:
/// distances on a canvas err by some thousandths.
const BEYOND_CANVAS: f64 = 0.01;

/// Several flips at once may not leave a triangle of a quality below this, poorer than all before.
const SLIVER: f64 = 0.1;

/// Whether lengths do not decide.
fn is_beyond(margin: Margin) -> bool {
    !margin.is_certain() && margin.error > BEYOND_LENGTHS
}

/// An edge on which the roads differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Disagreement {
    /// The ends of the edge by lengths of geodesics.
    pub edge: [VertexId; 2],
    /// The ends of the other diagonal, if the nerve has it.
    pub instead: Option<[VertexId; 2]>,
    /// The edge's margin by lengths.
    pub margin: Margin,
    /// Which road was followed.
    pub settled_by: Road,
}

/// What came of asking the diagram.
#[derive(Clone, Debug, Default)]
pub(crate) struct Consultation {
    /// Edges on which the two roads were compared.
    pub compared: usize,
    /// Those on which they differ.
    pub disagreements: Vec<Disagreement>,
    /// Edges of the nerve that were wanted and cannot be had as straight edges, each with a seed at both ends.
    pub impossible: Vec<[VertexId; 2]>,
    /// The canvas and its diagram, where they were needed.
    pub made: Option<Made>,
    /// Edges of the mesh of which neither road is sure, each with its margin by lengths.
    pub uncertain: Vec<([VertexId; 2], Margin)>,
}

/// A canvas and a diagram that were made, and what they cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Made {
    /// The canvas.
    pub canvas: CanvasFigures,
    /// Canvas vertices cut off from their cells.
    pub orphans: usize,
    /// The connected sets that they form.
    pub orphan_components: usize,
    /// Work of the solver.
    pub diagram: MarchCounters,
}

impl Made {
    /// Both together.
    fn with(mut self, more: Self) -> Self {
        self.canvas += more.canvas;
        self.orphans += more.orphans;
        self.orphan_components += more.orphan_components;
        self.diagram += more.diagram;
        self
    }
}

/// How diagrams are made that are asked.
struct Asking<'a> {
    field: &'a dyn MetricField,
    road: Road,
    canvas: canvas::Kind,
    method: Method,
}

/// What a diagram tells of a part of the mesh.
struct Answer {
    /// The sides of the nerve's triangles.
    sides: Vec<[VertexId; 2]>,
    /// Those of triangles of which the nerve is not sure.
    unsure: Vec<[VertexId; 2]>,
    made: Made,
}

impl Asking<'_> {
    /// Of a part whose vertices are these of the mesh, on a canvas of so many vertices.
    fn answer(&self, planar: Planar, ids: &[VertexId], vertices: usize) -> Result<Answer> {
        let seeds = planar.positions.clone();
        let mut canvas = Canvas::from_planar(self.canvas, planar, self.field, vertices)?;
        if self.road == Road::Canvas {
            canvas = resolve(canvas, self.field, &seeds, ROUNDS)?.canvas;
        }
        let diagram = Diagram::of_vertices(&canvas, self.field, &seeds, self.method, Care::Full)?;
        let nerve = diagram.sharp_nerve();
        let ends = |side: [u32; 2]| in_order(side.map(|i| ids[i as usize]));
        let is_unsure = |t: &NerveTriangle| t.fourth.is_some_and(|(_, gap)| gap < BEYOND_CANVAS);
        let orphans = diagram.orphan_components();
        let made = Made {
            canvas: canvas.figures(),
            orphans: orphans.iter().map(Vec::len).sum(),
            orphan_components: orphans.len(),
            diagram: *diagram.counters(),
        };
        let (sides, unsure) = (nerve.sides(|_| true).map(ends), nerve.sides(is_unsure).map(ends));
        Ok(Answer { sides: sides.collect(), unsure: unsure.collect(), made })
    }
}

impl Dual<'_> {
    /// Asks the diagram, by a method, for the topology where the road says so, on a canvas of a kind with so many vertices per
    /// seed, around the edges concerned only, of each connected part by itself. Edges by lengths are to be settled before ([`Dual::flip_all`] with
    /// [`Effort::Full`]).
    ///
    /// # Errors
    /// The metric is not positive definite somewhere around these edges; the method does not drive diagrams.
    pub(crate) fn consult_diagram(
        &mut self,
        road: Road,
        canvas: canvas::Kind,
        per_seed: u32,
        method: Method,
    ) -> Result<Consultation> {
        let asked = self.edges_to_ask(road);
        if asked.is_empty() {
            let uncertain = self.uncertain_edges(&HashSet::new());
            return Ok(Consultation { uncertain, ..Consultation::default() });
        }
        let most = road.seeds_asked(self.vertex_count());
        let Patch { planar, is_inner } = match road {
            Road::Both => self.patch_within(&asked, most),
            Road::Canvas | Road::Geodesic => self.patch_around(&asked),
        };
        // Where much is unknown the cells are wide.
        let seeds = planar.topology.vertex_count();
        let least = if WILD * asked.len() > seeds { LEAST_VERTICES } else { 0 };
        let field = self.field;
        let asking = Asking { field: &field, road, canvas, method };
        let answer = |(planar, ids): (Planar, Vec<VertexId>)| {
            let vertices = (ids.len() * per_seed as usize).max(least * ids.len() / seeds);
            asking.answer(planar, &ids, vertices)
        };
        let answers: Vec<Result<Answer>> = planar.pieces().into_par_iter().map(answer).collect();
        let answers = answers.into_iter().collect::<Result<Vec<Answer>>>()?;
        let is_within = |side: &[VertexId; 2]| side.iter().all(|v| is_inner[v.index()]);
        let wanted: HashSet<[VertexId; 2]> =
            answers.iter().flat_map(|answer| &answer.sides).copied().filter(is_within).collect();
        let unsure = answers.iter().flat_map(|answer| &answer.unsure).copied().collect();
        let mut found = self.compare(road, &wanted, &is_inner);
        found.made = answers.into_iter().map(|answer| answer.made).reduce(Made::with);
        found.impossible = self.adopt(road, wanted);
        found.uncertain = self.uncertain_edges(&unsure);
        Ok(found)
    }

    /// The edges of which lengths are not sure, and that are not held, or held and the nerve is not sure of them.
    fn uncertain_edges(&mut self, unsure: &HashSet<[VertexId; 2]>) -> Vec<([VertexId; 2], Margin)> {
        let topology = self.topology();
        let ends = |h: HalfEdge| diagonals(&self.quad(h))[0];
        let edges = topology.edges_with(|h| !topology.is_fixed(h) && (!self.is_held(h) || unsure.contains(&ends(h))));
        let mut uncertain = Vec::new();
        self.each_margin(&edges, Effort::Full, |h, margin| {
            uncertain.extend((!margin.is_certain()).then_some((h, margin)));
        });
        uncertain.into_iter().map(|(h, margin)| (diagonals(&self.quad(h))[0], margin)).collect()
    }

    fn edges_to_ask(&mut self, road: Road) -> Vec<HalfEdge> {
        let free = self.free_edges();
        match road {
            Road::Geodesic => Vec::new(),
            Road::Canvas => free,
            Road::Both => self.beyond_lengths(&free),
        }
    }

    /// The edges that lengths do not decide, those that they know least about first.
    fn beyond_lengths(&mut self, edges: &[HalfEdge]) -> Vec<HalfEdge> {
        let certainty = |margin: Margin| margin.value.abs() / margin.error;
        let mut beyond = Vec::new();
        self.each_margin(edges, Effort::Full, |h, margin| {
            beyond.extend(is_beyond(margin).then(|| (certainty(margin), h)));
        });
        ranked(beyond).into_iter().map(|(_, h)| h).collect()
    }

    fn is_beyond_lengths(&mut self, h: HalfEdge) -> bool {
        is_beyond(self.margin(h, Effort::Full))
    }

    /// Holds the edges of the mesh against those of the nerve.
    fn compare(&mut self, road: Road, wanted: &HashSet<[VertexId; 2]>, is_inner: &[bool]) -> Consultation {
        let mut found = Consultation::default();
        for h in self.free_edges() {
            let [edge, other] = diagonals(&self.quad(h));
            if !edge.iter().chain(&other).all(|v| is_inner[v.index()]) {
                continue;
            }
            found.compared += 1;
            if !wanted.contains(&edge) {
                let margin = self.margin(h, Effort::Full);
                let by_canvas = road == Road::Canvas || self.is_beyond_lengths(h);
                let settled_by = if by_canvas { Road::Canvas } else { Road::Geodesic };
                let instead = Some(other).filter(|other| wanted.contains(other));
                found.disagreements.push(Disagreement { edge, instead, margin, settled_by });
            }
        }
        found
    }

    /// Makes edges of the nerve edges of the mesh, as far as the plane allows and the road leads, and holds them; the
    /// others then follow by lengths. Returns those that cannot be had.
    fn adopt(&mut self, road: Road, wanted: HashSet<[VertexId; 2]>) -> Vec<[VertexId; 2]> {
        let is_missing = |&[u, v]: &[VertexId; 2]| self.topology().find(u, v).is_none();
        let mut missing: Vec<[VertexId; 2]> = wanted.iter().copied().filter(is_missing).collect();
        missing.sort_unstable();
        self.held = wanted;
        let mut before = usize::MAX;
        while missing.len() < before {
            before = missing.len();
            missing.retain(|&ends| !self.join(road, ends));
        }
        self.flip_all(Effort::Full);
        missing
            .retain(|&ends| self.crossed_by(ends).iter().any(|&h| road == Road::Canvas || self.is_beyond_lengths(h)));
        missing
    }

    /// Joins two seeds by flips of edges that are neither held nor fixed, and that the road leaves to the diagram.
    fn join(&mut self, road: Road, [u, v]: [VertexId; 2]) -> bool {
        let crossed = self.crossed_by([u, v]);
        let may_go = |dual: &mut Self, h: HalfEdge| {
            !dual.planar.topology.is_fixed(h) && !dual.is_held(h) && (road == Road::Canvas || dual.is_beyond_lengths(h))
        };
        if crossed.is_empty() || !crossed.iter().all(|&h| may_go(self, h)) {
            return false;
        }
        if let [only] = crossed[..] {
            return self.allows_flip(only) && self.planar.connect(u, v).is_some();
        }
        let before = self.planar.clone();
        let faces: Vec<FaceId> = crossed.iter().flat_map(|&h| self.topology().sides(h)).map(HalfEdge::face).collect();
        let poorest =
            |dual: &Self| faces.iter().map(|&f| dual.shape(dual.topology().corners(f))).fold(f64::INFINITY, f64::min);
        let was = poorest(self);
        let is_joined = self.planar.connect(u, v).is_some();
        // Flips keep the ids of faces.
        let is = poorest(self);
        if is_joined && is < SLIVER && is < was {
            self.planar = before;
            return false;
        }
        is_joined
    }

    /// The edges between two seeds that are not joined; none where the line between them leaves the domain.
    fn crossed_by(&self, [u, v]: [VertexId; 2]) -> Vec<HalfEdge> {
        self.planar.edges_between(u, v).unwrap_or_default()
    }
}
