//! Seeds of the plane in a metric field.

use super::site::{self, Site};
use super::{Judge, Trust};
use crate::geodesic::{
    Fineness, Margin, PathLength, Paths, circumradius, frozen_margin, hermite, margin_by_power, margin_from_lengths,
};
use crate::geometry::{Point, Tensor, Vector};
use crate::in_circle::{InCircle, Known, Lengths, Quad, Tested};
use crate::metric::MetricField;
use crate::parallel::prelude::*;

const FROZEN: usize = 0;
const EXPANSIONS: usize = 1;
const FIRST_PATH: usize = 2;
const LAST_PATH: usize = 4;
const CIRCUMCENTRE: usize = 5;

/// Where curvature times the square of the length exceeds this, the circles of both triangles are looked at.
const MUCH_CURVED: f64 = 0.1;
/// Edges longer than so many times the spacing of the seeds at their ends are not told by one tensor, nor by expansions;
/// circles with such a radius are not solved for.
const LONG: f64 = 3.0;
/// What a length found with one tensor errs by, as a share of how much the tensors at its ends differ.
const OF_SPREAD: f64 = 0.5;
/// The error of a length from expansions, times this; and a share that it always has.
const OF_EXPANSION: (f64, f64) = (1.0, 5e-4);

/// Seeds of the plane in a metric field, with what levels of tests need of them.
pub(crate) struct InField<'a> {
    field: &'a dyn MetricField,
    trust: Trust<'a>,
    paths: Paths,
    sites: Vec<Site>,
}

impl<'a> InField<'a> {
    /// Seeds with the tensors there.
    pub(super) fn new(field: &'a dyn MetricField, seeds: &[Point], trust: Trust<'a>) -> Self {
        let sites = seeds.par_iter().with_min_len(256).map(|&at| Site::new(field, at)).collect();
        Self { field, trust, paths: Paths::default(), sites }
    }

    /// Takes derivatives and curvature at the scale of the cells, which triangles tell.
    pub(super) fn expand(&mut self, triangles: &[[u32; 3]]) {
        let spacings = site::spacings(&self.sites, triangles);
        let field = self.field;
        self.sites
            .par_iter_mut()
            .zip(&spacings)
            .with_min_len(64)
            .for_each(|(site, &spacing)| site.expand(field, spacing));
    }
}

impl Judge for InField<'_> {
    fn is_seed(&self, i: u32) -> bool {
        self.sites.get(i as usize).is_some_and(|s| s.local.tensor.is_positive_definite())
    }

    fn direction(&self, from: u32, to: u32) -> Vector {
        self.sites[to as usize].at - self.sites[from as usize].at
    }

    fn size(&self, triangle: [u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| &self.sites[i as usize]);
        let tensor = (a.local.tensor + b.local.tensor + c.local.tensor) * (1.0 / 3.0);
        let (u, v) = (b.at - a.at, c.at - a.at);
        let doubled = tensor.determinant().max(0.0).sqrt() * u.cross(v);
        let product = tensor.dot(u, u) * tensor.dot(v, v) * tensor.dot(v - u, v - u);
        if doubled > 0.0 { product / (4.0 * doubled * doubled) } else { f64::INFINITY }
    }

    fn encloses(&self, outline: &[u32]) -> bool {
        let arm = |i: usize| self.direction(outline[0], outline[i % outline.len()]);
        (1..outline.len()).map(|i| arm(i).cross(arm(i + 1))).sum::<f64>() > 0.0
    }

    fn doubt(&self) -> f64 {
        self.trust.doubt
    }
}

impl InCircle for InField<'_> {
    fn is_by_lengths(&self, level: usize) -> bool {
        (FIRST_PATH..=LAST_PATH).contains(&level)
    }

    /// Finer lengths cannot add where curvature is what they leave open, nor a circle with finer spokes where none was found.
    fn may_tell(&self, quad: &Quad, level: usize, lengths: &Lengths, known: Option<Tested>) -> bool {
        match level {
            FROZEN..=FIRST_PATH | CIRCUMCENTRE => true,
            ..=LAST_PATH => quad.lengths(lengths).is_none_or(|lengths| {
                let exact = margin_from_lengths(&lengths.map(|length| PathLength { error: 0.0, ..length }));
                exact.error < 0.5 * margin_from_lengths(&lengths).error
            }),
            _ => known.is_some_and(|known| known.level == CIRCUMCENTRE),
        }
    }

    fn margin(&self, quad: &Quad, level: usize, lengths: &Lengths) -> Margin {
        match level {
            FROZEN => self.frozen(quad),
            EXPANSIONS => self.by_expansions(quad),
            FIRST_PATH..=LAST_PATH => quad.margin(lengths),
            _ => self.by_power(quad, level, lengths),
        }
    }

    fn solve(&self, i: u32, j: u32, level: usize) -> Option<Known> {
        let [p, q] = [i, j].map(|k| &self.sites[k as usize]);
        let fineness = [Fineness::COARSEST, Fineness::MIDDLE, Fineness::FINEST][level - FIRST_PATH];
        let found = self.paths.length(self.field, p.at, q.at, fineness);
        let agreed = found.filter(|l| self.agrees(i, j, l.value, l.error));
        let vetoed = || {
            let (distance, error) = self.trust.reference.and_then(|reference| reference(i, j))?;
            let length = PathLength { value: distance, error: error / distance, curvature: [0.0; 2] };
            Some(Known { length, level, is_vetoed: true })
        };
        agreed.map(|length| Known { length, level, is_vetoed: false }).or_else(vetoed)
    }
}

impl InField<'_> {
    /// One tensor for all, the mean of the four; the error from what the tensors at the ends say of each edge.
    fn frozen(&self, quad: &Quad) -> Margin {
        let sites = quad.seeds().map(|i| &self.sites[i as usize]);
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
        let bent = sites.iter().map(|s| s.curvature.abs()).fold(0.0, f64::max);
        let plain = quad.pairs().map(|(i, j)| {
            let (error, value) = error_of(i, j);
            PathLength { value, error, curvature: [-bent, bent] }
        });
        let is_told = |(l, (i, j)): (&PathLength, (u32, u32))| {
            l.value < self.longest((i, j)) && self.agrees(i, j, l.value, l.error)
        };
        let margin = margin_from_lengths(&plain);
        let error = if plain.iter().zip(quad.pairs()).all(is_told) { margin.error } else { f64::INFINITY };
        Margin { value: margin.value, error }
    }

    fn by_expansions(&self, quad: &Quad) -> Margin {
        let curvatures = || quad.seeds().into_iter().map(|i| self.sites[i as usize].curvature);
        let (least, most) =
            (curvatures().fold(f64::INFINITY, f64::min), curvatures().fold(f64::NEG_INFINITY, f64::max));
        let doubt = 0.5 * (most - least);
        let [Some(ab), Some(ac), Some(bc), Some(ad), Some(bd)] = quad.pairs().map(|(i, j)| self.expanded(i, j)) else {
            return Margin::UNKNOWN;
        };
        let curvature = [least - doubt, most + doubt];
        margin_from_lengths(&[ab, ac, bc, ad, bd].map(|length| PathLength { curvature, ..length }))
    }

    /// A length from the expansions at its ends; `None` where they do not tell.
    fn expanded(&self, i: u32, j: u32) -> Option<PathLength> {
        let [p, q] = [i, j].map(|k| &self.sites[k as usize]);
        let found = hermite(p.at, &p.local, q.at, &q.local);
        let error = OF_EXPANSION.0 * found.error + OF_EXPANSION.1;
        let is_told = !p.local.is_rough
            && !q.local.is_rough
            && found.value < self.longest((i, j))
            && self.agrees(i, j, found.value, error);
        is_told.then_some(PathLength { value: found.value, error, curvature: [0.0; 2] })
    }

    fn longest(&self, (i, j): (u32, u32)) -> f64 {
        LONG * self.sites[i as usize].spacing.max(self.sites[j as usize].spacing)
    }

    /// Whether the reference allows a length with this relative error: it is neither the longer of two ways nor one that
    /// leaves the domain.
    fn agrees(&self, i: u32, j: u32, length: f64, error: f64) -> bool {
        let [least, most] = [1.0 - error, 1.0 + error].map(|x| length * x);
        let known = self.trust.reference.and_then(|reference| reference(i, j));
        known.is_none_or(|(distance, error)| least <= distance + error && most >= distance - error)
    }

    fn by_power(&self, quad: &Quad, level: usize, lengths: &Lengths) -> Margin {
        let Some(known) = quad.lengths(lengths) else { return Margin::UNKNOWN };
        let [ab, ac, bc, ad, bd] = known.map(|k| k.value);
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
        if !is_small {
            return Margin::UNKNOWN;
        }
        let fineness = if level == CIRCUMCENTRE { Fineness::MIDDLE } else { Fineness::FINEST };
        let by_circle = |(corners, lengths): ([u32; 4], [f64; 5])| {
            let corners = corners.map(|i| self.sites[i as usize].at);
            margin_by_power(&self.paths, self.field, corners, lengths, fineness)
        };
        let margin = by_circle(first);
        // With the other triangle's circle the value differs by about this share of it.
        let bends = known.iter().flat_map(|k| k.curvature).map(f64::abs).filter(|k| k.is_finite());
        let share = bends.fold(0.0, f64::max) * ab * ab;
        let other = if share > MUCH_CURVED && margin.error.is_finite() { by_circle(second) } else { Margin::UNKNOWN };
        if other.error.is_finite() {
            let [value, half] = [0.5 * (margin.value + other.value), 0.51 * (margin.value - other.value).abs()];
            return Margin { value, error: half + margin.error.max(other.error) };
        }
        Margin { error: margin.error + share * margin.value.abs(), ..margin }
    }
}
