//! The filtered in-circle test: each level costs more and errs less, and runs only where the one before cannot tell.

use super::{Known, Rdt, Tested};
use crate::geodesic::{
    Fineness, Margin, PathLength, circumradius, frozen_margin, hermite, margin_by_power, margin_from_lengths,
};
use crate::geometry::Tensor;
use crate::triangulation::HalfEdge;
use rayon::prelude::*;

/// Number of levels: one tensor for the quadrilateral; lengths from the expansions at the seeds; geodesics with 4, 8 and
/// 16 modes; the circumcentre with geodesics of 8 and of 16 modes.
pub const LEVELS: usize = 7;
const FROZEN: usize = 0;
const EXPANSIONS: usize = 1;
const FIRST_PATH: usize = 2;
const LAST_PATH: usize = 4;
const CIRCUMCENTRE: usize = 5;

/// Where the margin is known this well and still may be zero, four seeds count as being on a circle.
pub(super) const RESOLUTION: f64 = 1e-9;
/// Where curvature times the square of the length exceeds this, the circles of both triangles are looked at.
const MUCH_CURVED: f64 = 0.1;
/// Edges longer than so many times the spacing of the seeds at their ends are not told by one tensor, nor by expansions;
/// circles with such a radius are not solved for.
const LONG: f64 = 3.0;
/// What a length found with one tensor errs by, as a share of how much the tensors at its ends differ.
const OF_SPREAD: f64 = 0.5;
/// The error of a length from expansions, times this; and a share that it always has.
const OF_EXPANSION: (f64, f64) = (1.0, 5e-4);

/// The four seeds around an edge a-b: c to the left, d to the right of a -> b.
#[derive(Clone, Copy)]
pub(super) struct Quad {
    pub(super) a: u32,
    pub(super) b: u32,
    pub(super) c: u32,
    pub(super) d: u32,
}

impl Quad {
    /// The pairs a-b, a-c, b-c, a-d, b-d.
    fn pairs(&self) -> [(u32, u32); 5] {
        let Quad { a, b, c, d } = *self;
        [(a, b), (a, c), (b, c), (a, d), (b, d)].map(|(i, j): (u32, u32)| (i.min(j), i.max(j)))
    }
}

impl Rdt<'_> {
    /// The quadrilateral around an edge with two triangles.
    pub(super) fn quad(&self, h: HalfEdge) -> Option<Quad> {
        let t = self.topology.twin(h)?;
        let [a, b, c, d] =
            [self.topology.origin(h), self.topology.target(h), self.topology.apex(h), self.topology.apex(t)]
                .map(|v| self.seed(v));
        Some(Quad { a, b, c, d })
    }

    /// Tests edges, in parallel, level by level, up to and including `last`; stores and returns the outcomes.
    pub(super) fn test(&mut self, edges: &[HalfEdge], last: usize) {
        let mut pending: Vec<(HalfEdge, Quad)> = edges.iter().filter_map(|&h| Some((h, self.quad(h)?))).collect();
        pending.retain(|(h, quad)| {
            let known = self.memory.test(quad);
            self.tested[h.index()] = known.or(self.tested[h.index()]);
            known.is_none()
        });
        for level in FROZEN..=last {
            let (tested, passed): (Vec<_>, Vec<_>) =
                pending.into_iter().partition(|(h, quad)| self.may_tell(*h, quad, level));
            if (FIRST_PATH..=LAST_PATH).contains(&level) {
                self.solve_for(&tested, level);
            }
            let outcomes: Vec<Margin> =
                tested.par_iter().with_min_len(16).map(|(_, quad)| self.margin(quad, level)).collect();
            pending = passed;
            for ((h, quad), margin) in tested.into_iter().zip(outcomes) {
                if !self.settles(h, margin, level) {
                    pending.push((h, quad));
                }
            }
        }
        for (h, _) in pending {
            self.counters.tests[self.tested[h.index()].map_or(0, |t| t.level)] += 1;
        }
    }

    /// Whether a level can add to what is known of an edge: finer lengths cannot where curvature is what they leave open, nor
    /// a circle with finer spokes where none was found.
    fn may_tell(&self, h: HalfEdge, quad: &Quad, level: usize) -> bool {
        match level {
            FROZEN..=FIRST_PATH | CIRCUMCENTRE => true,
            ..=LAST_PATH => self.lengths_of(quad).is_none_or(|lengths| {
                let exact = margin_from_lengths(&lengths.map(|length| PathLength { error: 0.0, ..length }));
                exact.error < 0.5 * margin_from_lengths(&lengths).error
            }),
            _ => self.tested[h.index()].is_some_and(|t| t.level == CIRCUMCENTRE),
        }
    }

    /// Keeps the outcome of a level unless the one before was better; says whether that is all that is to be known.
    fn settles(&mut self, h: HalfEdge, margin: Margin, level: usize) -> bool {
        self.keep(h, margin, level);
        let is_settled = margin.is_certain() || margin.error < RESOLUTION;
        self.counters.tests[level] += u64::from(is_settled);
        is_settled
    }

    /// Keeps the outcome of a level unless the one before was better.
    fn keep(&mut self, h: HalfEdge, margin: Margin, level: usize) {
        let known = &mut self.tested[h.index()];
        if level == FROZEN || known.is_none_or(|k| margin.error < k.margin.error) {
            *known = Some(Tested { margin, level });
        }
    }

    fn margin(&self, quad: &Quad, level: usize) -> Margin {
        match level {
            FROZEN => self.frozen(quad),
            EXPANSIONS => self.by_expansions(quad),
            FIRST_PATH..=LAST_PATH => self.by_paths(quad),
            _ => self.by_power(quad, level),
        }
    }

    /// One tensor for all, the mean of the four; the error from what the tensors at the ends say of each edge.
    fn frozen(&self, quad: &Quad) -> Margin {
        let sites = [quad.a, quad.b, quad.c, quad.d].map(|i| &self.sites[i as usize]);
        let [a, b, c, d] = sites.map(|s| s.at);
        let mean = sites.iter().fold(Tensor::default(), |sum, s| sum + s.local.tensor) * 0.25;
        let (left, right) = ((b - a).cross(c - a), (a - b).cross(d - b));
        if sites.iter().any(|s| s.local.is_rough) || !(left > 0.0 && right > 0.0) || !mean.is_positive_definite() {
            return Margin { value: frozen_margin(mean, [a - c, b - c], [b - d, a - d]), error: f64::INFINITY };
        }
        let error_of = |i: u32, j: u32| {
            let [p, q] = [i, j].map(|k| &self.sites[k as usize]);
            let e = q.at - p.at;
            let [here, there, all] = [p.local.tensor, q.local.tensor, mean].map(|t| t.length(e));
            // What the field does between two seeds whose tensors agree, its slopes there tell.
            let [g, h] = [p, q].map(|s| s.local.tensor.length(s.local.christoffel(e)) / all);
            let slopes = (g + h) / 12.0 + (g * g + h * h) / 24.0;
            ((0.5 * (here + there) / all - 1.0).abs() + OF_SPREAD * (here - there).abs() / all + slopes, all)
        };
        let mut plain = [PathLength { value: 0.0, error: 0.0, curvature: [0.0; 2] }; 5];
        let bent = sites.iter().map(|s| s.curvature.abs()).fold(0.0, f64::max);
        for (length, (i, j)) in plain.iter_mut().zip(quad.pairs()) {
            let (error, value) = error_of(i, j);
            *length = PathLength { value, error, curvature: [-bent, bent] };
        }
        let is_told = |(l, (i, j)): (&PathLength, (u32, u32))| {
            l.value < self.longest((i, j)) && self.agrees(i, j, [1.0 - l.error, 1.0 + l.error].map(|x| l.value * x))
        };
        let margin = margin_from_lengths(&plain);
        let error = if plain.iter().zip(quad.pairs()).all(is_told) { margin.error } else { f64::INFINITY };
        Margin { value: margin.value, error }
    }

    fn by_expansions(&self, quad: &Quad) -> Margin {
        let mut lengths = [PathLength { value: 0.0, error: 0.0, curvature: [0.0; 2] }; 5];
        let curvatures = || [quad.a, quad.b, quad.c, quad.d].into_iter().map(|i| self.sites[i as usize].curvature);
        let (least, most) =
            (curvatures().fold(f64::INFINITY, f64::min), curvatures().fold(f64::NEG_INFINITY, f64::max));
        let doubt = 0.5 * (most - least);
        for (length, (i, j)) in lengths.iter_mut().zip(quad.pairs()) {
            let Some(found) = self.expanded(i, j) else { return Margin::UNKNOWN };
            *length = PathLength { curvature: [least - doubt, most + doubt], ..found };
        }
        margin_from_lengths(&lengths)
    }

    /// A length from the expansions at its ends; `None` where they do not tell.
    fn expanded(&self, i: u32, j: u32) -> Option<PathLength> {
        let [p, q] = [i, j].map(|k| &self.sites[k as usize]);
        let found = hermite(p.at, &p.local, q.at, &q.local);
        let error = OF_EXPANSION.0 * found.error + OF_EXPANSION.1;
        let is_told = !p.local.is_rough
            && !q.local.is_rough
            && found.value < self.longest((i, j))
            && self.agrees(i, j, [1.0 - error, 1.0 + error].map(|x| found.value * x));
        is_told.then_some(PathLength { value: found.value, error, curvature: [0.0; 2] })
    }

    fn longest(&self, (i, j): (u32, u32)) -> f64 {
        LONG * self.sites[i as usize].spacing.max(self.sites[j as usize].spacing)
    }

    /// Whether the reference allows a length between these bounds: it is neither the longer of two ways nor one that
    /// leaves the domain.
    fn agrees(&self, i: u32, j: u32, [least, most]: [f64; 2]) -> bool {
        let known = self.trust.reference.and_then(|reference| reference(i, j));
        known.is_none_or(|(distance, error)| least <= distance + error && most >= distance - error)
    }

    fn by_paths(&self, quad: &Quad) -> Margin {
        self.lengths_of(quad).map_or(Margin::UNKNOWN, |lengths| margin_from_lengths(&lengths))
    }

    /// The five lengths, if they are known and of geodesics: ways around holes make no triangles that a test could use.
    fn lengths_of(&self, quad: &Quad) -> Option<[PathLength; 5]> {
        let length = |pair| self.lengths.get(&pair).filter(|known| !known.is_vetoed).map(|known| known.length);
        let known = quad.pairs().map(length);
        let [Some(ab), Some(ac), Some(bc), Some(ad), Some(bd)] = known else { return None };
        Some([ab, ac, bc, ad, bd])
    }

    fn by_power(&self, quad: &Quad, level: usize) -> Margin {
        let known = quad.pairs().map(|pair| self.lengths.get(&pair));
        let [Some(ab), Some(ac), Some(bc), Some(ad), Some(bd)] = known else { return Margin::UNKNOWN };
        let known = [ab, ac, bc, ad, bd];
        let [ab, ac, bc, ad, bd] = known.map(|k| k.length.value);
        let mut sides = [
            ([quad.a, quad.b, quad.c, quad.d], [ab, ac, bc, ad, bd]),
            ([quad.b, quad.a, quad.d, quad.c], [ab, bd, ad, bc, ac]),
        ];
        // The triangle whose outer edges are the longer is the larger.
        if ac * bc < ad * bd {
            sides.swap(0, 1);
        }
        let [first, second] = sides;
        let is_small = circumradius(first.1[0], first.1[1], first.1[2]) < self.longest((quad.a, quad.b));
        if !is_small || known.iter().any(|k| k.is_vetoed) {
            return Margin::UNKNOWN;
        }
        let fineness = if level == CIRCUMCENTRE { Fineness::MIDDLE } else { Fineness::FINEST };
        let by_circle = |(corners, lengths): ([u32; 4], [f64; 5])| {
            let corners = corners.map(|i| self.sites[i as usize].at);
            margin_by_power(&self.paths, self.field, corners, lengths, fineness)
        };
        let margin = by_circle(first);
        // With the other triangle's circle the value differs by about this share of it.
        let bends = known.iter().flat_map(|k| k.length.curvature).map(f64::abs).filter(|k| k.is_finite());
        let share = bends.fold(0.0, f64::max) * ab * ab;
        let other = if share > MUCH_CURVED && margin.error.is_finite() { by_circle(second) } else { Margin::UNKNOWN };
        if other.error.is_finite() {
            let [value, half] = [0.5 * (margin.value + other.value), 0.51 * (margin.value - other.value).abs()];
            return Margin { value, error: half + margin.error.max(other.error) };
        }
        Margin { error: margin.error + share * margin.value.abs(), ..margin }
    }

    /// Solves, in parallel, for the lengths that quadrilaterals lack at a level.
    fn solve_for(&mut self, pending: &[(HalfEdge, Quad)], level: usize) {
        let is_lacking =
            |pair: &(u32, u32)| self.lengths.get(pair).is_none_or(|known| known.level < level && !known.is_vetoed);
        let mut pairs: Vec<(u32, u32)> = pending.iter().flat_map(|(_, quad)| quad.pairs()).filter(is_lacking).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let solved: Vec<Option<Known>> =
            pairs.par_iter().with_min_len(16).map(|&(i, j)| self.solve(i, j, level)).collect();
        self.counters.paths += pairs.len() as u64;
        for (pair, known) in pairs.into_iter().zip(solved) {
            if let Some(known) = known {
                self.counters.vetoed += u64::from(known.is_vetoed);
                self.lengths.insert(pair, known);
            }
        }
    }

    fn solve(&self, i: u32, j: u32, level: usize) -> Option<Known> {
        let [p, q] = [i, j].map(|k| &self.sites[k as usize]);
        let fineness = [Fineness::COARSEST, Fineness::MIDDLE, Fineness::FINEST][level - FIRST_PATH];
        let found = self.paths.length(self.field, p.at, q.at, fineness);
        let agreed = found.filter(|l| self.agrees(i, j, [1.0 - l.error, 1.0 + l.error].map(|x| l.value * x)));
        let vetoed = || {
            let (distance, error) = self.trust.reference.and_then(|reference| reference(i, j))?;
            let length = PathLength { value: distance, error: error / distance, curvature: [0.0; 2] };
            Some(Known { length, level, is_vetoed: true })
        };
        agreed.map(|length| Known { length, level, is_vetoed: false }).or_else(vetoed)
    }
}
