//! Edges of a dual as geodesics: of the ways that are found, the shortest that stays in the domain.

use super::untangle::untangle;
use super::{Found, GeodesicEdge};
use crate::canvas::Border;
use crate::diagram::Diagram;
use crate::geodesic::{Curve, Fineness, Obstacles, Paths, Polyline};
use crate::geometry::{Point, kept_within};
use crate::metric::MetricField;
use crate::parallel::prelude::*;

/// Sagittas of drawn curves, as a share of their lengths.
const SAGITTA: f64 = 5e-4;
/// Polynomials whose length is known no better than this (relative) do not serve.
const VAGUE: f64 = 1e-4;
/// Those that are known this well need no more modes.
const CLEAR: f64 = 1e-7;
/// Relative error of the length of a straightened path; ten times more was seen at a singular point.
const OF_TRACED: f64 = 2e-4;

/// The geodesics between pairs of seeds. A pair for which there is no way at all has the straight segment, with an infinite
/// error.
pub(super) fn of(diagram: &Diagram, field: &dyn MetricField, pairs: &[[u32; 2]]) -> Vec<GeodesicEdge> {
    let traced = diagram.paths().geodesics(pairs);
    let finder = Finder { field, border: Border::of(diagram.canvas()), paths: Paths::default() };
    let find = |(&pair, traced): (&[u32; 2], Option<Polyline>)| {
        let [p, q] = pair.map(|i| diagram.seed(i).unwrap_or_default());
        finder.edge(pair, [p, q], traced)
    };
    let mut edges = pairs.par_iter().zip(traced).map(find).collect();
    untangle(field, &finder.border, &mut edges);
    edges
}

struct Finder<'a> {
    field: &'a dyn MetricField,
    border: Border<'a>,
    paths: Paths,
}

impl Finder<'_> {
    fn edge(&self, ends: [u32; 2], [p, q]: [Point; 2], traced: Option<Polyline>) -> GeodesicEdge {
        let limit = traced.as_ref().map_or(f64::INFINITY, |path| path.length * (1.0 + VAGUE));
        let from = |near: Option<&[Point]>| {
            let [coarse, fine] = [Fineness::MIDDLE, Fineness::FINEST];
            let first = self.paths.curve(self.field, [p, q], near, coarse).filter(|c| c.length().error < CLEAR);
            let curve = first.or_else(|| self.paths.curve(self.field, [p, q], near, fine))?;
            self.drawn(&curve, limit).map(|points| (points, curve.length()))
        };
        let near = traced.as_ref().map(|path| path.points.as_slice());
        if let Some((points, length)) = from(None).or_else(|| from(Some(near?))) {
            return GeodesicEdge { ends, points, length: length.value, error: length.error, found: Found::Smooth };
        }
        let error = if traced.is_some() { OF_TRACED } else { f64::INFINITY };
        let path = traced.unwrap_or_else(|| {
            let points = vec![p, q];
            Polyline { length: Polyline::length_of(self.field, &points), points }
        });
        let points = self.thinned(path.points, SAGITTA * path.length);
        GeodesicEdge { ends, points, length: path.length, error, found: Found::Traced }
    }

    /// A curve as a polyline, if it is known well, not longer than the limit, and in the domain.
    fn drawn(&self, curve: &Curve, limit: f64) -> Option<Vec<Point>> {
        let length = curve.length();
        if length.error > VAGUE || length.value > limit {
            return None;
        }
        let points = curve.polyline(self.field, SAGITTA);
        self.is_free(&points).then_some(points)
    }

    /// A polyline without points that are not needed to stay this near to it, in metric length.
    fn thinned(&self, points: Vec<Point>, sagitta: f64) -> Vec<Point> {
        let away = |[i, j]: [usize; 2], k: usize| {
            let (chord, d) = (points[j] - points[i], points[k] - points[i]);
            let t = (d.dot(chord) / chord.dot(chord)).clamp(0.0, 1.0);
            self.field.at(points[k]).length(if t.is_finite() { d - chord * t } else { d })
        };
        let kept = kept_within([0, points.len() - 1], |[i, j]| {
            let far = (i + 1..j).map(|k| (k, away([i, j], k))).max_by(|x, y| x.1.total_cmp(&y.1));
            far.filter(|far| far.1 > sagitta).map(|far| far.0)
        });
        let kept: Vec<Point> = [0].into_iter().chain(kept).map(|k| points[k]).collect();
        if self.is_free(&kept) { kept } else { points }
    }

    fn is_free(&self, points: &[Point]) -> bool {
        points.windows(2).all(|w| !self.border.bars(w[0], w[1]))
    }
}
