//! The Riemannian Delaunay triangulation of any seeds: topology only, by in-circle tests with geodesic lengths.
//!
//! It starts from triangles that are nearly right (a diagram's nerve), makes them a triangulation, and flips edges until
//! every in-circle test agrees. A test climbs only as far as it must: one tensor, expansions at the seeds, geodesics of
//! growing degree, and at last the circumcentre itself. Nothing is embedded, so that nothing keeps an edge from being
//! flipped; how the triangulation is drawn is for others to say. It ends where the triangles it started from end.

mod flips;
mod in_field;
mod on_surface;
mod site;
mod sides;
mod start;

pub(crate) use in_field::InField;
pub(crate) use on_surface::OnSurface;
pub use start::Start;

use crate::geodesic::{Margin, PathLength};
use crate::geometry::{Point, Vector};
use crate::in_circle::{InCircle, LEVELS, Lengths, Quad, TestCounters, Tested, Tests};
use crate::lists::in_order;
use crate::metric::MetricField;
use crate::triangulation::{HalfEdge, Triangulation, VertexId, smallest_first};
use std::collections::HashSet;

/// What a triangulation of seeds knows of where they are: seeds of the plane in a metric field, or of a surface.
pub(crate) trait Judge: InCircle {
    /// Whether there is such a seed, and a metric there.
    fn is_seed(&self, i: u32) -> bool;
    /// The direction of a seed seen from another, in a frame there.
    fn direction(&self, from: u32, to: u32) -> Vector;
    /// The squared circumradius of a triangle, roughly, in the metric there; infinite where it is turned over.
    fn size(&self, triangle: [u32; 3]) -> f64;
    /// Whether a loop of seeds turns so that there are triangles missing within it.
    fn encloses(&self, outline: &[u32]) -> bool;
    /// The greatest error of a margin whose sign is followed although it is not certain.
    fn doubt(&self) -> f64;
}

/// Distances on a canvas, held against geodesics found from the metric alone, which may not be the shortest and know no
/// holes: of two seeds, their distance and an absolute bound on its error; `None` where it is not known.
pub(crate) type Reference<'a> = &'a (dyn Fn(u32, u32) -> Option<(f64, f64)> + Sync);

/// How far in-circle tests are followed.
#[derive(Clone, Copy)]
pub(crate) struct Trust<'a> {
    /// What geodesics are held against. Where they do not agree no test is made, and the start stays as it is.
    pub reference: Option<Reference<'a>>,
    /// The greatest error of a margin whose sign is followed although it is not certain. Above, the start stays as it is.
    pub doubt: f64,
}

impl Default for Trust<'_> {
    /// Tests only, whatever they are worth.
    fn default() -> Self {
        Self { reference: None, doubt: f64::INFINITY }
    }
}

/// What a triangulation has found, lengths and in-circle tests, for the next one of which few seeds have moved. It is of one field and one [`Trust`].
#[derive(Clone, Default)]
pub(crate) struct Memory {
    seeds: Vec<Point>,
    tests: Tests,
}

impl Memory {
    /// Forgets what depends on seeds that are not where they were.
    fn keep_for(&mut self, seeds: &[Point]) {
        let is_there = |i: u32| self.seeds.get(i as usize).is_some_and(|p| seeds.get(i as usize) == Some(p));
        self.tests.keep(is_there);
        self.tests.counters = TestCounters::default();
        self.seeds = seeds.to_vec();
    }
}

/// An edge of the triangulation with its in-circle test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Edge {
    /// The seeds at its ends.
    pub ends: [u32; 2],
    /// The seeds opposite to it: to its left, and to its right, if there is a triangle there.
    pub apexes: [Option<u32>; 2],
    /// The in-circle test; `None` of an edge with one triangle.
    pub margin: Option<Margin>,
    /// The level that settled it, below [`LEVELS`].
    pub level: usize,
}

impl Edge {
    /// Whether there was a test, and it could not tell.
    pub(crate) fn is_uncertain(&self) -> bool {
        self.margin.is_some_and(|margin| !margin.is_certain())
    }
}

/// What was done. Deterministic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RdtCounters {
    /// Triangles of the start left out because others claimed one of their sides, or their corners were not three seeds.
    pub dropped: u64,
    /// Triangles put into small holes of the start.
    pub filled: u64,
    /// Vertices that had to be made two because their triangles were not one fan.
    pub split: u64,
    /// Seeds without a triangle.
    pub isolated: u64,
    /// In-circle tests settled at each level.
    pub tests: [u64; LEVELS],
    /// Geodesics solved for.
    pub paths: u64,
    /// Geodesics that the reference did not agree with.
    pub vetoed: u64,
    /// Flips.
    pub flips: u64,
    /// Edges left although a test wants them flipped: the other diagonal is an edge already.
    pub blocked: u64,
    /// Edges left although a test wants them flipped: they were flipped too often, so that tests contradict each other.
    pub circling: u64,
}

/// See the [module](self).
pub(crate) struct Rdt<J> {
    judge: J,
    topology: Triangulation,
    seed_of: Vec<u32>,
    memory: Memory,
    flips_of_slot: Vec<u8>,
    started_with: Vec<[u32; 2]>,
    dropped: Vec<[u32; 3]>,
    counters: RdtCounters,
}

impl<'a> Rdt<InField<'a>> {
    /// The triangulation of seeds, which are known by their numbers, from a start.
    ///
    /// The field may measure in any unit, and seeds may be denser here than there: the scale of a cell is taken from the
    /// start's edges. A seed where the field is no metric is left out.
    pub(crate) fn new(field: &'a dyn MetricField, seeds: &[Point], start: &Start, trust: Trust<'a>) -> Self {
        Self::again(field, seeds, start, trust, Memory::default())
    }

    /// [`Rdt::new`] of seeds of which most are where they were when the memory was written (`Rdt::into_memory`): what depends
    /// on no seed that has moved is not tested again.
    pub(crate) fn again(
        field: &'a dyn MetricField,
        seeds: &[Point],
        start: &Start,
        trust: Trust<'a>,
        mut memory: Memory,
    ) -> Self {
        memory.keep_for(seeds);
        let mut judge = InField::new(field, seeds, trust);
        let filled = start.triangulated(&judge);
        judge.expand(&filled.0);
        Self::settled(judge, seeds.len(), start, filled, memory)
    }
}

impl<J: Judge> Rdt<J> {
    /// The triangulation of the seeds, so many, that a judge knows, from a start.
    pub(crate) fn judged(judge: J, seeds: usize, start: &Start) -> Self {
        let filled = start.triangulated(&judge);
        Self::settled(judge, seeds, start, filled, Memory::default())
    }

    /// The triangulation of the seeds, so many, that a judge knows, from one that may have doubled edges: vertices are seeds,
    /// those behind them copies of the seeds in the list.
    pub(crate) fn from_glued(judge: J, seeds: usize, topology: Triangulation, copies: &[u32]) -> Self {
        let seed_of = (0..seeds as u32).chain(copies.iter().copied()).collect();
        Self::of_topology(judge, seeds, topology, seed_of, Memory::default())
    }

    fn settled(
        judge: J,
        seeds: usize,
        start: &Start,
        (triangles, filled): (Vec<[u32; 3]>, RdtCounters),
        memory: Memory,
    ) -> Self {
        let mut topology = Triangulation::from_triangles(seeds, &triangles, &vec![0; triangles.len()]);
        let seed_of = split(&mut topology, seeds);
        let mut rdt = Self::of_topology(judge, seeds, topology, seed_of, memory);
        rdt.dropped = missing(&start.triangles, &triangles);
        rdt.counters = RdtCounters { dropped: filled.dropped, filled: filled.filled, ..rdt.counters };
        rdt
    }

    fn of_topology(judge: J, seeds: usize, topology: Triangulation, seed_of: Vec<u32>, memory: Memory) -> Self {
        let mut used = vec![false; seeds];
        topology.vertices().for_each(|v| used[seed_of[v.index()] as usize] = true);
        let isolated = used.iter().filter(|used| !**used).count() as u64;
        let counters = RdtCounters { split: (seed_of.len() - seeds) as u64, isolated, ..RdtCounters::default() };
        let slots = 3 * topology.face_slots();
        let mut rdt = Self {
            judge,
            topology,
            seed_of,
            memory,
            flips_of_slot: vec![0; slots],
            started_with: Vec::new(),
            dropped: Vec::new(),
            counters,
        };
        rdt.started_with = rdt.pairs();
        rdt.settle();
        rdt
    }

    /// The triangles, counter-clockwise, by the numbers of their seeds.
    pub(crate) fn triangles(&self) -> Vec<[u32; 3]> {
        self.topology.faces().map(|f| self.topology.corners(f).map(|v| self.seed(v))).collect()
    }

    /// The triangles of the start that it could not hold beside the others, smallest seed first.
    pub(crate) fn dropped(&self) -> &[[u32; 3]] {
        &self.dropped
    }

    /// The topology; its vertices are numbered like the seeds, but for copies where [`RdtCounters::split`] is not zero.
    /// Edges whose length was needed carry it.
    pub(crate) fn topology(&self) -> &Triangulation {
        &self.topology
    }

    /// The seed of a vertex of the topology.
    pub(crate) fn seed(&self, v: VertexId) -> u32 {
        self.seed_of[v.index()]
    }

    /// All edges with their margins.
    pub(crate) fn edges(&self) -> Vec<Edge> {
        self.topology.edges().map(|h| self.edge(h)).collect()
    }

    /// The edges that the start did not have: where the start and the in-circle tests disagree.
    pub(crate) fn disagreements(&self) -> Vec<Edge> {
        let is_new = |e: &Edge| self.started_with.binary_search(&in_order(e.ends)).is_err();
        self.edges().into_iter().filter(is_new).collect()
    }

    /// The in-circle test of any four seeds around an edge by the lengths known, or found for it.
    pub(crate) fn margin_of(&self, quad: &Quad) -> Margin {
        let level = (0..LEVELS).rev().find(|&level| self.judge.is_by_lengths(level)).unwrap_or(0);
        let known = |&(i, j): &(u32, u32)| {
            let found = self.memory.tests.lengths.get(&(i, j)).copied().or_else(|| self.judge.solve(i, j, level));
            found.map(|found| ((i, j), found))
        };
        let lengths: Lengths = quad.pairs().iter().filter_map(known).collect();
        self.judge.margin(quad, level, &lengths)
    }

    /// What was done.
    pub(crate) fn counters(&self) -> &RdtCounters {
        &self.counters
    }

    /// The best length known between two seeds; `None` where no test needed one.
    pub(crate) fn length(&self, i: u32, j: u32) -> Option<PathLength> {
        self.memory.tests.lengths.get(&(i.min(j), i.max(j))).map(|known| known.length)
    }

    /// What was found, for [`Rdt::again`].
    pub(crate) fn into_memory(self) -> Memory {
        self.memory
    }

    /// The quadrilateral around an edge with two triangles.
    fn quad(&self, h: HalfEdge) -> Option<Quad> {
        let [a, b, c, d] = self.topology.quad(h)?.map(|v| self.seed(v));
        Some(Quad { a, b, c, d })
    }

    /// What is known of an edge, with all levels up to and including `last`.
    fn tested(&self, h: HalfEdge, last: usize) -> Option<Tested> {
        self.memory.tests.known(&self.quad(h)?, last)
    }

    fn edge(&self, h: HalfEdge) -> Edge {
        let topology = &self.topology;
        let tested = self.tested(h, LEVELS - 1);
        Edge {
            ends: topology.ends(h).map(|v| self.seed(v)),
            apexes: [Some(h), topology.twin(h)].map(|side| side.map(|e| self.seed(topology.apex(e)))),
            margin: tested.map(|t| t.margin),
            level: tested.map_or(0, |t| t.level),
        }
    }

    /// The ends of all edges, the smaller first, sorted.
    fn pairs(&self) -> Vec<[u32; 2]> {
        let topology = &self.topology;
        let ends = |h| in_order(topology.ends(h).map(|v| self.seed(v)));
        let mut pairs: Vec<[u32; 2]> = topology.edges().map(ends).collect();
        pairs.sort_unstable();
        pairs
    }
}

/// Gives every fan of triangles a vertex of its own; returns the seed of every vertex.
fn split(topology: &mut Triangulation, seeds: usize) -> Vec<u32> {
    let mut seed_of: Vec<u32> = (0..seeds as u32).collect();
    for (copy, of) in topology.split_pinched_vertices() {
        let seed = seed_of[of.index()];
        seed_of.resize(seed_of.len().max(copy.index() + 1), seed);
        seed_of[copy.index()] = seed;
    }
    seed_of
}

/// The triangles of the first list that the second lacks, wherever they begin.
fn missing(wanted: &[[u32; 3]], found: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let found: HashSet<[u32; 3]> = found.iter().map(|&t| smallest_first(t)).collect();
    wanted.iter().map(|&t| smallest_first(t)).filter(|t| !found.contains(t)).collect()
}
