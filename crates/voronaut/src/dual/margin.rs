//! The filtered in-circle test: each level costs more and errs less, and runs only where the one before it cannot tell.

use super::Dual;
use crate::geodesic::{
    Angles, Fineness, Length, PathLength, bent_chord, bowed_chord, chord, frozen_margin, hermite, margin_from_lengths,
};
use crate::geometry::Tensor;
use crate::triangulation::{HalfEdge, VertexId};
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};

/// What is known of pairs of seeds, the smaller id first, until a seed moves, comes or goes.
#[derive(Debug, Default)]
pub(super) struct Known {
    /// Lengths of geodesics, and the level at which each was found; `None` where the field is no metric on the way.
    paths: HashMap<[VertexId; 2], (usize, Option<PathLength>)>,
    /// Margins with all levels, by the diagonals of quadrilaterals.
    margins: HashMap<[[VertexId; 2]; 2], Margin>,
    /// Edges that are not to be flipped.
    pub(super) held: HashSet<[VertexId; 2]>,
}

/// Number of levels: frozen tensor, expansions at the vertices, quadrature along the chords, geodesics with 4 and with 8
/// modes.
pub const LEVELS: usize = 5;
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
const KINKS: f64 = 0.005;
const OF_BOW: f64 = 0.25;
/// A bow that saves less than this share of the chord is small.
const STRAIGHT: f64 = 0.02;

/// How far up the levels a test may climb.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// To lengths from the expansions at the vertices: no evaluation of the field.
    Local = 1,
    /// To quadrature along the chords.
    Chord = 2,
    /// To the last level: geodesics.
    Full = 4,
}

/// The outcome of an in-circle test: the sine of the sum of the two angles that face the edge (see
/// [`crate::geodesic::Angles`]); negative where the edge should be flipped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// The sine.
    pub value: f64,
    /// Estimated error of `value`.
    pub error: f64,
    /// The level that settled it.
    pub level: usize,
}

impl Margin {
    /// Whether the sign is settled.
    pub fn is_certain(&self) -> bool {
        self.value.abs() > self.error
    }

    /// The one that errs less.
    fn or_better(self, other: Self) -> Self {
        if other.error < self.error { other } else { self }
    }
}

/// The four corners of the two faces at an edge a-b: c to the left, d to the right of a -> b.
pub(super) struct Quad {
    a: VertexId,
    b: VertexId,
    c: VertexId,
    d: VertexId,
}

impl Quad {
    /// The two diagonals, that of the edge first.
    pub(super) fn diagonals(&self) -> [[VertexId; 2]; 2] {
        [pair(self.a, self.b), pair(self.c, self.d)]
    }

    /// The five edges whose lengths make the test.
    fn sides(&self) -> [[VertexId; 2]; 5] {
        let Quad { a, b, c, d } = *self;
        [pair(a, b), pair(a, c), pair(b, c), pair(a, d), pair(b, d)]
    }
}

pub(super) fn pair(u: VertexId, v: VertexId) -> [VertexId; 2] {
    [u.min(v), u.max(v)]
}

impl Dual<'_> {
    /// The margin of an edge with two faces.
    pub fn margin(&mut self, h: HalfEdge, effort: Effort) -> Margin {
        if effort == Effort::Full {
            return self.full_margin(self.quad(h));
        }
        let margin = self.cheap_margin(&self.quad(h), effort);
        self.counters.tests[margin.level] += 1;
        margin
    }

    fn full_margin(&mut self, quad: Quad) -> Margin {
        if let Some(&margin) = self.known.margins.get(&quad.diagonals()) {
            return margin;
        }
        self.measure_quads(&[quad])[0]
    }

    /// Computes the margins of all edges with all levels, in parallel.
    pub(super) fn measure_margins(&mut self) {
        let quads: Vec<Quad> = self.free_edges().map(|h| self.quad(h)).collect();
        self.measure_quads(&quads);
    }

    /// Margins with all levels, level by level, so that the geodesics of each are solved for in parallel. They are kept.
    fn measure_quads(&mut self, quads: &[Quad]) -> Vec<Margin> {
        let cheap = |quad: &Quad| self.cheap_margin(quad, Effort::Full);
        let mut margins: Vec<Margin> = quads.par_iter().with_min_len(64).map(cheap).collect();
        for level in FIRST_PATH..LEVELS {
            let open: Vec<usize> = (0..quads.len()).filter(|&i| !margins[i].is_certain()).collect();
            self.solve_for(open.iter().flat_map(|&i| quads[i].sides()).collect(), level);
            for i in open {
                margins[i] = self.by_paths(&quads[i], level).map_or(margins[i], |found| margins[i].or_better(found));
            }
        }
        for (quad, margin) in quads.iter().zip(&margins) {
            self.counters.tests[margin.level] += 1;
            self.known.margins.insert(quad.diagonals(), *margin);
        }
        margins
    }

    fn solve_for(&mut self, mut sides: Vec<[VertexId; 2]>, level: usize) {
        sides.retain(|side| self.known.paths.get(side).is_none_or(|known| known.0 < level));
        sides.sort_unstable();
        sides.dedup();
        let solve = |&side: &[VertexId; 2]| self.solve(side, level);
        let solved: Vec<(usize, Option<PathLength>)> = sides.par_iter().with_min_len(8).map(solve).collect();
        self.known.paths.extend(sides.into_iter().zip(solved));
    }

    /// The geodesic between two seeds. Where the field has kinks, one bow says as much as polynomials, and finer ones do
    /// not help; they are tried only where the bow is large.
    fn solve(&self, [u, v]: [VertexId; 2], level: usize) -> (usize, Option<PathLength>) {
        let [p, q] = [u, v].map(|v| self.position(v));
        let mut bowed = None;
        if level == FIRST_PATH && (self.local(u).is_rough || self.local(v).is_rough) {
            let (value, straight) = (bowed_chord(&self.field, p, q), chord(&self.field, p, q));
            let saving = straight / value - 1.0;
            bowed = Some(PathLength { value, error: KINKS + OF_BOW * saving, curvature: [0.0; 2] });
            if saving < STRAIGHT {
                return (LEVELS, bowed);
            }
        }
        let path = self.paths.length(&self.field, p, q, PATHS[level - FIRST_PATH]);
        match (path, bowed) {
            (Some(path), Some(bowed)) if path.error > bowed.error => (LEVELS, Some(bowed)),
            (None, Some(bowed)) => (LEVELS, Some(bowed)),
            (path, _) => (level, path),
        }
    }

    /// The margin from the geodesics that are known; `None` where one is not, or none can be found, or they make no
    /// triangles.
    fn by_paths(&self, quad: &Quad, level: usize) -> Option<Margin> {
        let [ab, ac, bc, ad, bd] = quad.sides().map(|side| self.known.paths.get(&side).and_then(|known| known.1));
        let found = margin_from_lengths(&[ab?, ac?, bc?, ad?, bd?]);
        let (value, error) = (found.value, found.error);
        error.is_finite().then_some(Margin { value, error, level })
    }

    pub(super) fn quad(&self, h: HalfEdge) -> Quad {
        let [a, b, c, d] = self.topology().quad(h).expect("an edge with two faces");
        Quad { a, b, c, d }
    }

    /// All levels but the last.
    fn cheap_margin(&self, quad: &Quad, effort: Effort) -> Margin {
        let (mut margin, is_long) = self.frozen(quad);
        if effort == Effort::Full && margin.error > FROZEN {
            margin.error = UNKNOWN;
        }
        let expands = !is_long && ![quad.a, quad.b, quad.c, quad.d].iter().any(|&v| self.local(v).is_rough);
        if !expands && effort == Effort::Local {
            return Margin { error: 0.0, ..margin };
        }
        for level in if expands { 1 } else { 2 }..=(effort as usize).min(FIRST_PATH - 1) {
            if margin.is_certain() {
                break;
            }
            match self.by_lengths(quad, level) {
                Some(better) => margin = better,
                // Lengths that make no triangles: this level cannot tell. While seeds still move it is left at that.
                None => margin.error = if effort == Effort::Local { 0.0 } else { UNKNOWN },
            }
        }
        margin
    }

    /// Level 0, the mean tensor of the four corners, its error from how much the corners' tensors differ; and whether
    /// the quadrilateral is [`LONG`].
    fn frozen(&self, quad: &Quad) -> (Margin, bool) {
        let [a, b, c, d] = [quad.a, quad.b, quad.c, quad.d].map(|v| self.position(v));
        let tensors = [quad.a, quad.b, quad.c, quad.d].map(|v| self.local(v).tensor);
        let mean = tensors.iter().fold(Tensor::default(), |sum, &t| sum + t) * 0.25;
        let value = frozen_margin(mean, [a - c, b - c], [b - d, a - d]);
        let spread = |v| {
            let reference = mean.dot(v, v);
            tensors.iter().map(|t| (t.dot(v, v) / reference - 1.0).abs()).fold(0.0, f64::max)
        };
        let is_long = mean.length(b - a).min(mean.length(d - c)) > LONG;
        (Margin { value, error: spread(b - a).max(spread(d - c)), level: 0 }, is_long)
    }

    /// The margin from five lengths; `None` where they make no triangles, and the level before has to do.
    fn by_lengths(&self, quad: &Quad, level: usize) -> Option<Margin> {
        let length = |u: VertexId, v: VertexId| self.length_between(u, v, level);
        let Quad { a, b, c, d } = *quad;
        let (ab, ac, bc, ad, bd) = (length(a, b), length(a, c), length(b, c), length(a, d), length(b, d));
        let relative = [ab, ac, bc, ad, bd].iter().map(|l| l.error).fold(0.0, f64::max);
        let angles = Angles::from_lengths(ab.value, [ac.value, bc.value], [ad.value, bd.value]);
        (!angles.is_flat()).then(|| Margin { value: angles.margin(), error: angles.error(relative), level })
    }

    fn length_between(&self, u: VertexId, v: VertexId, level: usize) -> Length {
        let (p, q) = (self.position(u), self.position(v));
        if level == 1 {
            hermite(p, self.local(u), q, self.local(v))
        } else {
            bent_chord(&self.field, p, self.local(u), q, self.local(v))
        }
    }
}
