//! The filtered in-circle test of four seeds around an edge: each level costs more and errs less, and runs only where the one
//! before it cannot tell. What the levels are is for an [`InCircle`] to say; lengths and outcomes are kept.

use crate::geodesic::{Margin, PathLength, margin_from_lengths};
use crate::lists::{Table, distinct};
use crate::parallel::prelude::*;
use crate::triangulation::{HalfEdge, Triangulation};
use std::ops::Range;

/// Where the margin is known this well and still may be zero, four seeds count as being on a circle.
pub(crate) const RESOLUTION: f64 = 1e-9;
/// No test has more levels.
pub(crate) const LEVELS: usize = 7;

/// The four seeds around an edge a-b: c to the left, d to the right of a -> b.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quad {
    /// One end.
    pub a: u32,
    /// The other.
    pub b: u32,
    /// To its left.
    pub c: u32,
    /// To its right.
    pub d: u32,
}

impl Quad {
    /// Around an edge of a triangulation whose vertices are the seeds; `None` at its border.
    pub(crate) fn around(topology: &Triangulation, h: HalfEdge) -> Option<Self> {
        let [a, b, c, d] = topology.quad(h)?.map(|v| v.0);
        Some(Self { a, b, c, d })
    }

    /// The four seeds.
    pub(crate) fn seeds(&self) -> [u32; 4] {
        [self.a, self.b, self.c, self.d]
    }

    /// The pairs a-b, a-c, b-c, a-d, b-d.
    pub(crate) fn pairs(&self) -> [(u32, u32); 5] {
        let [a, b, c, d] = self.seeds();
        [(a, b), (a, c), (b, c), (a, d), (b, d)].map(|(i, j): (u32, u32)| (i.min(j), i.max(j)))
    }

    /// The five lengths, if they are known and of geodesics: ways around holes make no triangles that a test could use.
    pub(crate) fn lengths(&self, known: &Lengths) -> Option<[PathLength; 5]> {
        let length = |pair| known.get(&pair).filter(|known| !known.is_vetoed).map(|known| known.length);
        let found = self.pairs().map(length);
        let [Some(ab), Some(ac), Some(bc), Some(ad), Some(bd)] = found else { return None };
        Some([ab, ac, bc, ad, bd])
    }

    /// The margin by the lengths that are known.
    pub(crate) fn margin(&self, known: &Lengths) -> Margin {
        self.lengths(known).map_or(Margin::UNKNOWN, |lengths| margin_from_lengths(&lengths))
    }

    /// The same for the edge in both directions.
    pub(crate) fn key(&self) -> [u32; 4] {
        let [a, b, c, d] = self.seeds();
        if a < b { [a, b, c, d] } else { [b, a, d, c] }
    }
}

/// The best length known between two seeds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    /// The length.
    pub length: PathLength,
    /// The level at which it was found; higher levels look for a better one.
    pub level: usize,
    /// It is no geodesic's, but what a reference holds against it.
    pub is_vetoed: bool,
}

/// The best lengths known, by their ends, the smaller first.
pub(crate) type Lengths = Table<(u32, u32), Known>;

/// The outcome of a test, and the level that settled it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tested {
    /// The outcome.
    pub margin: Margin,
    /// The level.
    pub level: usize,
}

/// What knows seeds and the metric between them.
pub(crate) trait InCircle: Sync {
    /// Whether a level can add to what is known of an edge so far.
    fn may_tell(&self, quad: &Quad, level: usize, lengths: &Lengths, known: Option<Tested>) -> bool;

    /// Whether a level asks for the lengths that quadrilaterals lack.
    fn is_by_lengths(&self, level: usize) -> bool;

    /// The length between two seeds at such a level.
    fn solve(&self, i: u32, j: u32, level: usize) -> Option<Known>;

    /// The outcome of the test at a level.
    fn margin(&self, quad: &Quad, level: usize, lengths: &Lengths) -> Margin;

    /// Whether what a level found is to be kept in place of what is known.
    fn prefers(&self, found: Tested, known: Tested) -> bool {
        found.margin.error < known.margin.error
    }
}

/// Climbs some levels, as far as it must, without asking for lengths. Returns the best that is known then.
pub(crate) fn climb(
    by: &(impl InCircle + ?Sized),
    quad: &Quad,
    levels: Range<usize>,
    lengths: &Lengths,
    mut known: Option<Tested>,
) -> Option<Tested> {
    for level in levels {
        if is_settled(known) {
            break;
        }
        if by.may_tell(quad, level, lengths, known) {
            let found = Tested { margin: by.margin(quad, level, lengths), level };
            known = known.filter(|&known| !by.prefers(found, known)).or(Some(found));
        }
    }
    known
}

/// Whether no other level has to be asked.
pub(crate) fn is_settled(known: Option<Tested>) -> bool {
    known.is_some_and(|known| known.margin.is_certain() || known.margin.error < RESOLUTION)
}

/// What was done. Deterministic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TestCounters {
    /// Tests settled at each level.
    pub tests: [u64; LEVELS],
    /// Lengths solved for.
    pub paths: u64,
    /// Lengths that a reference did not agree with.
    pub vetoed: u64,
}

/// An outcome, the level that settled it, and the last one that it may be from: small, for a mesh has one for every edge.
#[derive(Clone, Copy, Debug)]
struct Outcome {
    margin: Margin,
    level: u8,
    last: u8,
}

impl Outcome {
    fn new(tested: Tested, last: usize) -> Self {
        Self { margin: tested.margin, level: tested.level as u8, last: last as u8 }
    }

    fn tested(&self) -> Tested {
        Tested { margin: self.margin, level: usize::from(self.level) }
    }
}

/// Lengths and outcomes that are known. They are of one [`InCircle`].
#[derive(Clone, Debug, Default)]
pub(crate) struct Tests {
    /// Lengths, by their ends.
    pub lengths: Lengths,
    outcomes: Table<[u32; 4], Outcome>,
    /// What was done for them.
    pub counters: TestCounters,
}

impl Tests {
    /// The outcome for an edge, with all levels up to and including `last`; `None` where it was not tested.
    pub(crate) fn known(&self, quad: &Quad, last: usize) -> Option<Tested> {
        self.outcomes.get(&quad.key()).filter(|outcome| usize::from(outcome.last) >= last).map(Outcome::tested)
    }

    /// Forgets what depends on other seeds than these.
    pub(crate) fn keep(&mut self, is_there: impl Fn(u32) -> bool) {
        self.lengths.retain(|&(i, j), _| is_there(i) && is_there(j));
        self.outcomes.retain(|quad, _| quad.iter().all(|&i| is_there(i)));
    }

    /// Tests edges with all levels up to and including `last`: in parallel, level by level, so that lengths are solved for in
    /// parallel, too, each once.
    pub(crate) fn test(&mut self, by: &impl InCircle, quads: &[Quad], last: usize) -> Vec<Option<Tested>> {
        let mut found: Vec<Option<Tested>> = quads.iter().map(|quad| self.known(quad, last)).collect();
        let new: Vec<usize> = (0..quads.len()).filter(|&i| found[i].is_none()).collect();
        let (mut open, mut level) = (new.clone(), 0);
        while level <= last && !open.is_empty() {
            if by.is_by_lengths(level) {
                let may_tell = |&&i: &&usize| by.may_tell(&quads[i], level, &self.lengths, found[i]);
                let asked: Vec<Quad> = open.iter().filter(may_tell).map(|&i| quads[i]).collect();
                self.solve_for(by, &asked, level);
            }
            // Levels that ask for no lengths follow one another without waiting.
            let next = (level + 1..=last).find(|&next| by.is_by_lengths(next)).unwrap_or(last + 1);
            let lengths = &self.lengths;
            let test = |&i: &usize| climb(by, &quads[i], level..next, lengths, found[i]);
            let outcomes: Vec<Option<Tested>> = open.par_iter().with_min_len(16).map(test).collect();
            for (&i, outcome) in open.iter().zip(outcomes) {
                found[i] = outcome;
            }
            open.retain(|&i| !is_settled(found[i]));
            level = next;
        }
        self.outcomes.reserve(new.len());
        for i in new {
            if let Some(tested) = found[i] {
                self.counters.tests[tested.level] += 1;
                self.outcomes.insert(quads[i].key(), Outcome::new(tested, last));
            }
        }
        found
    }

    /// Solves, in parallel, for the lengths that quadrilaterals lack at a level.
    fn solve_for(&mut self, by: &impl InCircle, quads: &[Quad], level: usize) {
        let is_lacking =
            |pair: &(u32, u32)| self.lengths.get(pair).is_none_or(|known| known.level < level && !known.is_vetoed);
        let pairs = distinct(quads.iter().flat_map(Quad::pairs).filter(is_lacking));
        let solved: Vec<Option<Known>> =
            pairs.par_iter().with_min_len(8).map(|&(i, j)| by.solve(i, j, level)).collect();
        self.counters.paths += pairs.len() as u64;
        for (pair, known) in pairs.into_iter().zip(solved) {
            if let Some(known) = known {
                self.counters.vetoed += u64::from(known.is_vetoed);
                self.lengths.insert(pair, known);
            }
        }
    }
}
