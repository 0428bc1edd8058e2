//! Edges of a dual as geodesics: of the ways that are found, the shortest that stays in the domain.

use super::untangle::untangle;
use super::{Found, GeodesicEdge};
use crate::canvas::Border;
use crate::diagram::Diagram;
use crate::geodesic::{Curve, Fineness, Obstacles, Paths, Polyline};
use crate::geometry::Point;
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
        let is_free = points.windows(2).all(|w| !self.border.bars(w[0], w[1]));
        is_free.then_some(points)
    }

    /// A polyline without points that are not needed to stay this near to it, in metric length.
    fn thinned(&self, points: Vec<Point>, sagitta: f64) -> Vec<Point> {
        let mut kept = vec![points[0]];
        self.keep(&points, sagitta, &mut kept);
        let is_free = kept.windows(2).all(|w| !self.border.bars(w[0], w[1]));
        if is_free { kept } else { points }
    }

    /// Appends what is needed of a polyline but its first point (Ramer 1972; Douglas and Peucker 1973).
    fn keep(&self, points: &[Point], sagitta: f64, kept: &mut Vec<Point>) {
        let [p, q] = [points[0], points[points.len() - 1]];
        let away = |&m: &Point| {
            let (chord, d) = (q - p, m - p);
            let t = (d.dot(chord) / chord.dot(chord)).clamp(0.0, 1.0);
            self.field.at(m).length(if t.is_finite() { d - chord * t } else { d })
        };
        let inner = points.iter().enumerate().skip(1).take(points.len().saturating_sub(2));
        let far = inner.map(|(i, m)| (i, away(m))).max_by(|x, y| x.1.total_cmp(&y.1));
        match far.filter(|far| far.1 > sagitta) {
            Some((i, _)) => {
                self.keep(&points[..=i], sagitta, kept);
                self.keep(&points[i..], sagitta, kept);
            }
            None => kept.push(q),
        }
    }
}
