//! What the in-circle test of the mesh in the making climbs: a frozen tensor, expansions at the vertices, quadrature along the
//! chords, geodesics with 4 and with 8 modes.

use super::{Dual, Effort, Moving, TIE};
use crate::geodesic::{
    Fineness, Length, Margin, PathLength, bent_chord, bowed_chord, chord, frozen_margin, hermite, margin_of_estimates,
};
use crate::geometry::Tensor;
use crate::in_circle::{InCircle, Known, Lengths, Quad, Tested, climb, is_settled};
use crate::lists::in_order;
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use std::ops::Range;

/// Number of levels.
pub(super) const LEVELS: usize = 5;
/// The first level of geodesics, and how fine they are from there on.
const FIRST_PATH: usize = 3;
const PATHS: [Fineness; 2] = [Fineness::COARSEST, Fineness::MIDDLE];

/// Local expansions say nothing of quadrilaterals whose shorter diagonal is longer than this (metric length), nor of
/// those at a rough vertex. With [`Effort::Local`] the frozen tensor settles them: such edges are on their way to be
/// split, and while seeds still move the dearer levels are not worth their price.
const LONG: f64 = 3.0;

/// How much the corners' tensors may differ, at most, for one to stand for all in the last pass.
const FROZEN: f64 = 0.3;
/// The error of a margin of which nothing is known.
const UNKNOWN: f64 = 1.0;

/// Relative error of a bowed chord: of its quadrature across kinks, and as a share of what the bow saves.
pub(super) const KINKS: f64 = 0.005;
const OF_BOW: f64 = 0.25;
/// A bow that saves less than this share of the chord is small.
const STRAIGHT: f64 = 0.02;

/// Slots of faces whose edges are tested one after the other.
const PART: usize = 256;
/// Edges whose margins are looked up at once: enough for all cores, and next to no memory.
const LOOKED_UP: usize = 1 << 16;

impl Dual<'_> {
    /// The margin of an edge with two faces.
    pub(crate) fn margin(&mut self, h: HalfEdge, effort: Effort) -> Margin {
        let quad = self.quad(h);
        if effort == Effort::Full {
            let h = self.topology().canonical(h);
            return self.margins.get(h, &quad).unwrap_or_else(|| {
                let margin = self.test(&[quad])[0].margin;
                self.margins.put(h, &quad, margin);
                margin
            });
        }
        let Tested { margin, level } = self.climbed(&quad, effort);
        self.counters.tests[level] += 1;
        margin
    }

    fn climbed(&self, quad: &Quad, effort: Effort) -> Tested {
        let by = ByEffort { dual: self, effort };
        let tested = climb(&by, quad, 0..effort as usize + 1, &self.tests.lengths, None);
        let mut tested = tested.expect("the first level tells of every edge");
        if effort == Effort::Local && tested.level == 0 {
            tested.margin.error = 0.0;
        }
        tested
    }

    /// The edges whose margins, with less than full effort, want them flipped; in parallel.
    pub(super) fn wanted(&mut self, effort: Effort) -> Vec<HalfEdge> {
        let slots = self.topology().face_slots();
        let part = |k: usize| self.wanted_at(k * PART..slots.min((k + 1) * PART), effort);
        let found: Vec<_> = (0..slots.div_ceil(PART)).into_par_iter().map(part).collect();
        let mut wanted = Vec::new();
        for (edges, tests) in found {
            wanted.extend(edges);
            self.counters.tests.iter_mut().zip(tests).for_each(|(sum, count)| *sum += count);
        }
        wanted
    }

    /// Those of face slots, and how many tests each level settled.
    fn wanted_at(&self, faces: Range<usize>, effort: Effort) -> (Vec<HalfEdge>, [u64; LEVELS]) {
        let topology = self.topology();
        let is_free = |h: &HalfEdge| !topology.is_fixed(*h) && !self.is_held(*h);
        let mut tests = [0; LEVELS];
        let mut is_wanted = |h: &HalfEdge| {
            let Tested { margin, level } = self.climbed(&self.quad(*h), effort);
            tests[level] += 1;
            margin.value < -TIE
        };
        let edges = faces.flat_map(|f| topology.edges_of(FaceId(f as u32))).filter(is_free);
        (edges.filter(|h| is_wanted(h)).collect(), tests)
    }

    /// Computes the margins of all edges with all levels, in parallel.
    pub(super) fn measure_margins(&mut self) {
        let edges = self.free_edges();
        let by = ByEffort { dual: self, effort: Effort::Full };
        let cheap = |&h: &HalfEdge| {
            let quad = self.quad(h);
            let is_new = self.margins.get(h, &quad).is_none();
            is_new.then(|| (h, quad, climb(&by, &quad, 0..FIRST_PATH, &self.tests.lengths, None)))
        };
        let climbed: Vec<(HalfEdge, Quad, Option<Tested>)> =
            edges.par_iter().with_min_len(256).filter_map(cheap).collect();
        let (mut open, mut dear) = (Vec::new(), Vec::new());
        self.margins.make_room(3 * self.topology().face_slots());
        for (h, quad, tested) in climbed {
            if let Some(Tested { margin, level }) = tested.filter(|_| is_settled(tested)) {
                self.counters.tests[level] += 1;
                self.margins.put(h, &quad, margin);
            } else {
                open.push(h);
                dear.push(quad);
            }
        }
        let found = self.test(&dear);
        for ((h, quad), tested) in open.into_iter().zip(&dear).zip(found) {
            self.margins.put(h, quad, tested.margin);
        }
    }

    /// The edges whose margins by all levels want them flipped.
    pub(super) fn wanted_fully(&mut self) -> Vec<HalfEdge> {
        let edges = self.free_edges();
        let mut wanted = Vec::new();
        self.each_margin(&edges, Effort::Full, |h, margin| wanted.extend((margin.value < -TIE).then_some(h)));
        wanted
    }

    /// Goes through the margins of edges: what is known of them is looked up in parallel, and what is not is tested one after the other with full
    /// effort, in parallel with less.
    pub(super) fn each_margin(&mut self, edges: &[HalfEdge], effort: Effort, mut then: impl FnMut(HalfEdge, Margin)) {
        for edges in edges.chunks(LOOKED_UP) {
            if effort == Effort::Full {
                let known = |&h: &HalfEdge| self.margins.get(self.topology().canonical(h), &self.quad(h));
                let known: Vec<Option<Margin>> = edges.par_iter().with_min_len(1024).map(known).collect();
                for (&h, known) in edges.iter().zip(known) {
                    then(h, known.unwrap_or_else(|| self.margin(h, effort)));
                }
                continue;
            }
            let climbed = |&h: &HalfEdge| self.climbed(&self.quad(h), effort);
            let climbed: Vec<Tested> = edges.par_iter().with_min_len(256).map(climbed).collect();
            for (&h, Tested { margin, level }) in edges.iter().zip(climbed) {
                self.counters.tests[level] += 1;
                then(h, margin);
            }
        }
    }

    fn test(&mut self, quads: &[Quad]) -> Vec<Tested> {
        let mut tests = std::mem::take(&mut self.tests);
        let found = tests.test(&ByEffort { dual: self, effort: Effort::Full }, quads, LEVELS - 1);
        for (sum, count) in self.counters.tests.iter_mut().zip(std::mem::take(&mut tests.counters).tests) {
            *sum += count;
        }
        self.tests = tests;
        found.into_iter().map(|tested| tested.expect("the first level tells of every edge")).collect()
    }

    pub(super) fn quad(&self, h: HalfEdge) -> Quad {
        Quad::around(self.topology(), h).expect("an edge with two faces")
    }
}

/// Margins by all levels, by the canonical half-edge of each edge, with the quadrilaterals that they are of: flips leave others.
#[derive(Default)]
pub(super) struct Margins(Vec<([u32; 4], Margin)>);

impl Margins {
    fn get(&self, h: HalfEdge, quad: &Quad) -> Option<Margin> {
        self.0.get(h.index()).filter(|(key, _)| *key == quad.key()).map(|&(_, margin)| margin)
    }

    fn make_room(&mut self, slots: usize) {
        if self.0.len() < slots {
            self.0.reserve_exact(slots - self.0.len());
            self.0.resize(slots, ([u32::MAX; 4], Margin::UNKNOWN));
        }
    }

    fn put(&mut self, h: HalfEdge, quad: &Quad, margin: Margin) {
        self.make_room(h.index() + 1);
        self.0[h.index()] = (quad.key(), margin);
    }
}

/// The two diagonals of a quadrilateral, that of the edge first, each with its smaller end first.
pub(super) fn diagonals(&Quad { a, b, c, d }: &Quad) -> [[VertexId; 2]; 2] {
    [[a, b], [c, d]].map(|ends| in_order(ends.map(VertexId)))
}

/// A dual, tested with some effort.
struct ByEffort<'a, 'b> {
    dual: &'a Dual<'b>,
    effort: Effort,
}

impl InCircle for ByEffort<'_, '_> {
    /// Expansions tell nothing of long quadrilaterals, nor at rough vertices.
    fn may_tell(&self, quad: &Quad, level: usize, _lengths: &Lengths, _known: Option<Tested>) -> bool {
        let is_rough = |i: u32| self.dual.local(VertexId(i)).is_rough;
        level != 1 || !self.is_long(quad) && !quad.seeds().into_iter().any(is_rough)
    }

    fn is_by_lengths(&self, level: usize) -> bool {
        level >= FIRST_PATH
    }

    /// The geodesic between two seeds. Where the field is rough, a bow that is small says as much as coarse polynomials; finer ones say more where
    /// there is no kink.
    fn solve(&self, i: u32, j: u32, level: usize) -> Option<Known> {
        let dual = self.dual;
        let [p, q] = [i, j].map(|i| dual.position(VertexId(i)));
        let known = |length| Some(Known { length, level, is_vetoed: false });
        let mut bowed = None;
        if [i, j].iter().any(|&i| dual.local(VertexId(i)).is_rough) {
            let (value, straight) = (bowed_chord(&dual.field, p, q), chord(&dual.field, p, q));
            let saving = straight / value - 1.0;
            let length = PathLength { value, error: KINKS + OF_BOW * saving, curvature: [0.0; 2] };
            if level == FIRST_PATH && saving < STRAIGHT {
                return known(length);
            }
            bowed = Some(length);
        }
        let fineness = PATHS[level - FIRST_PATH];
        let path = match bowed {
            Some(_) => dual.paths.length_without_kinks(&dual.field, p, q, fineness),
            None => dual.paths.length(&dual.field, p, q, fineness),
        };
        match (path, bowed) {
            (Some(path), Some(bowed)) if path.error > bowed.error => known(bowed),
            (None, Some(bowed)) => known(bowed),
            (path, _) => known(path?),
        }
    }

    /// Lengths that make no triangles do not tell. While seeds still move it is left at that.
    fn margin(&self, quad: &Quad, level: usize, lengths: &Lengths) -> Margin {
        match level {
            0 => self.frozen(quad),
            FIRST_PATH.. => quad.margin(lengths),
            _ => {
                let found = self.by_lengths(quad, level);
                let unknown = if self.effort == Effort::Local { 0.0 } else { UNKNOWN };
                if found.error.is_finite() { found } else { Margin { error: unknown, ..self.frozen(quad) } }
            }
        }
    }

    /// Below geodesics a level stands in place of the one before it.
    fn prefers(&self, found: Tested, known: Tested) -> bool {
        found.level < FIRST_PATH || found.margin.error < known.margin.error
    }
}

impl ByEffort<'_, '_> {
    fn tensors(&self, quad: &Quad) -> ([Tensor; 4], Tensor) {
        let tensors = quad.seeds().map(|i| self.dual.local(VertexId(i)).tensor);
        (tensors, tensors.iter().fold(Tensor::default(), |sum, &t| sum + t) * 0.25)
    }

    /// Whether the quadrilateral is [`LONG`].
    fn is_long(&self, quad: &Quad) -> bool {
        let [a, b, c, d] = quad.seeds().map(|i| self.dual.position(VertexId(i)));
        let (_, mean) = self.tensors(quad);
        mean.length(b - a).min(mean.length(d - c)) > LONG
    }

    /// The mean tensor of the four corners, its error from how much the corners' tensors differ.
    fn frozen(&self, quad: &Quad) -> Margin {
        let [a, b, c, d] = quad.seeds().map(|i| self.dual.position(VertexId(i)));
        let (tensors, mean) = self.tensors(quad);
        let value = frozen_margin(mean, [a - c, b - c], [b - d, a - d]);
        let spread = |v| {
            let reference = mean.dot(v, v);
            tensors.iter().map(|t| (t.dot(v, v) - reference).abs()).fold(0.0, f64::max) / reference
        };
        let error = spread(b - a).max(spread(d - c));
        Margin { value, error: if self.effort == Effort::Full && error > FROZEN { UNKNOWN } else { error } }
    }

    fn by_lengths(&self, &Quad { a, b, c, d }: &Quad, level: usize) -> Margin {
        let pairs = [(a, b), (a, c), (b, c), (a, d), (b, d)];
        margin_of_estimates(pairs.map(|(i, j)| self.length_between(i, j, level)))
    }

    fn length_between(&self, i: u32, j: u32, level: usize) -> Length {
        let [u, v] = [i, j].map(VertexId);
        let (p, q) = (self.dual.position(u), self.dual.position(v));
        if level == 1 {
            hermite(p, self.dual.local(u), q, self.dual.local(v))
        } else {
            bent_chord(&self.dual.field, p, self.dual.local(u), q, self.dual.local(v))
        }
    }
}
