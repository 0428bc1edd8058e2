//! Seeds on the features of a surface: at stops, and along curves at even metric length.

use crate::geometry::Point3;
use crate::lists::in_order;
use crate::parallel::prelude::*;
use crate::surface::metric::SurfaceMetric;
use crate::surface::{Curve, CurveEdge, Input, Mark, Place};
use crate::triangulation::VertexId;
use std::collections::BTreeMap;

/// The length of an edge of a curve is known when halving it changes it by no more than this share,
const PRECISE: f64 = 1e-3;
/// or it was halved so often; it is so often at least.
const HALVINGS: u32 = 10;
const LEAST_HALVINGS: u32 = 2;
/// Seeds of a closed curve, and edges of a curve from a stop to itself, at least.
const LEAST_OF_LOOP: usize = 3;

/// A density of seeds on a curve: all of its vertices.
pub(crate) const ALL_VERTICES: usize = usize::MAX;

/// A surface's feature curves with their metric lengths. Where the metric differs on the two sides of a crease, that counts in
/// which it is longer.
pub(crate) struct MeasuredCurves<'a> {
    input: &'a Input,
    curves: Vec<MeasuredCurve>,
}

struct MeasuredCurve {
    pieces: Vec<Piece>,
    /// The length of each side in the metric there; 0 of a side that is none.
    sides: [f64; 2],
}

/// A piece of a curve along which the metric hardly changes.
#[derive(Clone, Copy, Debug)]
struct Piece {
    edge: usize,
    /// Where on the edge it begins and ends.
    range: [f64; 2],
    /// The metric length of the curve before it, and to its end.
    behind: [f64; 2],
}

/// A seed on a feature.
#[derive(Clone, Debug)]
pub(crate) struct FeatureSeed {
    /// Where it is on each side of the feature: one place per patch there, or several where a patch meets itself. All have one
    /// position.
    pub places: Vec<Place>,
    /// The vertex of the input that it is, if it is one that has to be kept.
    pub stop: Option<VertexId>,
}

/// Seeds on all features, and the edges between them.
#[derive(Clone, Debug, Default)]
pub(crate) struct FeatureSeeds {
    /// The seeds.
    pub seeds: Vec<FeatureSeed>,
    /// The edges that the mesh shall have, by their seeds, and what they are.
    pub edges: Vec<FeatureEdge>,
    /// Single edges inside a patch, which cannot be cut open: their ends are seeds, and nothing else is done for them.
    pub loose: usize,
}

/// An edge that the mesh shall have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FeatureEdge {
    /// Its seeds.
    pub ends: [u32; 2],
    /// What it is.
    pub mark: Mark,
    /// The number of its curve.
    pub curve: usize,
}

impl FeatureSeeds {
    /// All places, those of each seed one after the other, and for each the seed that it belongs to.
    pub(crate) fn flattened(&self) -> (Vec<Place>, Vec<u32>) {
        let each = (0..).zip(&self.seeds).flat_map(|(i, seed)| seed.places.iter().map(move |place| (*place, i)));
        each.unzip()
    }
}

impl<'a> MeasuredCurves<'a> {
    /// Measures the curves of a surface's seams.
    pub(crate) fn new(input: &'a Input, metric: &dyn SurfaceMetric) -> Self {
        let curves = input.seams.features.curves.par_iter().map(|curve| measured(input, metric, curve)).collect();
        Self { input, curves }
    }

    fn length(&self, curve: usize) -> f64 {
        self.curves[curve].pieces.last().map_or(0.0, |piece| piece.behind[1])
    }

    /// How many vertices curves add to those that the areas of the patches ask for, in terms of the root of the factor on the metric:
    /// half the border's length, and of creases what the metrics of their two sides differ by.
    pub(crate) fn extra(&self) -> f64 {
        let of = |(i, curve): (usize, &MeasuredCurve)| self.length(i) - 0.5 * (curve.sides[0] + curve.sides[1]);
        self.curves.iter().enumerate().map(of).sum()
    }

    /// Seeds at the stops, and along curves about `spacing` (metric) apart; closer where the edges between them would stray
    /// farther than `hausd` (Euclidean) from the curve, and where fewer would make two edges of the mesh one. Of a required curve
    /// all vertices are seeds. `density` says how many times as many edges each curve shall have; 1 if it says nothing; with
    /// [`ALL_VERTICES`] all vertices are seeds.
    pub(crate) fn sampled(&self, spacing: f64, hausd: Option<f64>, density: &[usize]) -> FeatureSeeds {
        let features = &self.input.seams.features;
        let mut found = FeatureSeeds::default();
        let mut at: BTreeMap<VertexId, u32> = BTreeMap::new();
        for &v in &features.stops {
            at.insert(v, found.seeds.len() as u32);
            found.seeds.push(FeatureSeed { stop: Some(v), ..self.at_vertex(v) });
        }
        let shortest = self.shortest_between();
        for (i, curve) in features.curves.iter().enumerate() {
            if self.is_slit(curve) && curve.edges.len() == 1 {
                found.loose += 1;
                continue;
            }
            let [a, b] = curve.ends();
            let is_shortest = shortest.get(&in_order([a, b])) == Some(&i);
            let parts = (self.length(i) / spacing).round() as usize;
            let density = density.get(i).copied().unwrap_or(1);
            let least = self.least(curve, is_shortest);
            let stations = match parts.max(least).saturating_mul(density) {
                _ if curve.mark.is_required || density == ALL_VERTICES => at_vertices(curve),
                2 if parts < 2 => self.refined(i, &self.at_bulge(i), hausd),
                parts => self.refined(i, &self.stations(i, parts), hausd),
            };
            let inner = stations[1..stations.len() - 1].iter().map(|&station| self.at_station(curve, station));
            let first = found.seeds.len() as u32;
            let [begin, end] = if curve.has_stops { [at[&a], at[&b]] } else { [first; 2] };
            found.seeds.extend(if curve.has_stops { None } else { Some(self.at_vertex(a)) });
            let before = found.seeds.len() as u32;
            found.seeds.extend(inner);
            let chain: Vec<u32> = [begin].into_iter().chain(before..found.seeds.len() as u32).chain([end]).collect();
            let edge = |pair: &[u32]| FeatureEdge { ends: [pair[0], pair[1]], mark: curve.mark, curve: i };
            found.edges.extend(chain.windows(2).map(edge));
        }
        found
    }

    /// Of the curves with the same ends the shortest (Euclidean): those that bulge more are not to become one edge with it.
    fn shortest_between(&self) -> BTreeMap<[VertexId; 2], usize> {
        let mut shortest: BTreeMap<[VertexId; 2], (f64, usize)> = BTreeMap::new();
        for (i, curve) in self.input.seams.features.curves.iter().enumerate() {
            let edges = curve.edges.iter().map(|edge| edge.positions(&self.input.surface));
            let length = edges.map(|[a, b]| a.distance(b)).sum();
            let least = shortest.entry(in_order(curve.ends())).or_insert((length, i));
            *least = if length < least.0 { (length, i) } else { *least };
        }
        shortest.into_iter().map(|(ends, (_, i))| (ends, i)).collect()
    }

    /// The number of edges that a curve needs for the mesh to be one.
    fn least(&self, curve: &Curve, is_shortest: bool) -> usize {
        let [a, b] = curve.ends();
        match () {
            () if a == b => LEAST_OF_LOOP,
            // A slit without a seed between its ends would have two edges between them.
            () if self.is_slit(curve) || !is_shortest => 2,
            () => 1,
        }
    }

    /// Whether a curve ends inside a patch on both sides.
    fn is_slit(&self, curve: &Curve) -> bool {
        !curve.is_border() && curve.ends().iter().all(|&v| self.input.seams.copies(v).len() == 1)
    }

    /// Places on a curve, as edges and parameters, that cut it into so many parts or more. First and last are its ends.
    fn stations(&self, curve: usize, parts: usize) -> Vec<(usize, f64)> {
        let edges = &self.input.seams.features.curves[curve].edges;
        let total = self.length(curve);
        let mut stations: Vec<(usize, f64)> = vec![(0, 0.0)];
        for k in 1..parts {
            stations.push(self.station(curve, total * k as f64 / parts as f64));
        }
        stations.push((edges.len() - 1, 1.0));
        stations
    }

    /// The ends of a curve and its middle; or, where that is much nearer to the chord between the ends, the vertex farthest from it.
    fn at_bulge(&self, curve: usize) -> Vec<(usize, f64)> {
        let edges = &self.input.seams.features.curves[curve].edges;
        let last = edges.len() - 1;
        let at = |(edge, t): (usize, f64)| {
            let [a, b]: [Point3; 2] = edges[edge].positions(&self.input.surface);
            a.lerp(b, t)
        };
        let chord = [at((0, 0.0)), at((last, 1.0))];
        let bulge = |station: (usize, f64)| distance_to_segment(at(station), chord);
        let middle = self.station(curve, 0.5 * self.length(curve));
        let farthest = (1..=last).map(|i| (i, 0.0)).max_by(|&x, &y| bulge(x).total_cmp(&bulge(y)));
        let inner = farthest.filter(|&station| bulge(station) > 2.0 * bulge(middle)).unwrap_or(middle);
        vec![(0, 0.0), inner, (last, 1.0)]
    }

    /// Where a curve has this length behind it.
    fn station(&self, curve: usize, length: f64) -> (usize, f64) {
        let pieces = &self.curves[curve].pieces;
        let piece = pieces[pieces.partition_point(|piece| piece.behind[1] < length).min(pieces.len() - 1)];
        let [begin, end] = piece.behind;
        let share = if end > begin { (length - begin) / (end - begin) } else { 0.0 };
        (piece.edge, piece.range[0] + (piece.range[1] - piece.range[0]) * share.clamp(0.0, 1.0))
    }

    /// The stations, and between them vertices of the curve, so that no chord strays farther (Douglas and Peucker 1973).
    fn refined(&self, curve: usize, stations: &[(usize, f64)], most: Option<f64>) -> Vec<(usize, f64)> {
        let Some(most) = most else { return stations.to_vec() };
        let edges = &self.input.seams.features.curves[curve].edges;
        let surface = &self.input.surface;
        let at = |(edge, t): (usize, f64)| {
            let [a, b] = edges[edge].positions(surface);
            a.lerp(b, t)
        };
        let mut refined = vec![stations[0]];
        for pair in stations.windows(2) {
            let mut pending = vec![(pair[0], pair[1])];
            while let Some((from, to)) = pending.pop() {
                let between = from.0 + 1..=to.0;
                let strays = |&i: &usize| distance_to_segment(surface.position(edges[i].from), [at(from), at(to)]);
                let farthest = between.max_by(|i, j| strays(i).total_cmp(&strays(j)));
                match farthest.filter(|i| strays(i) > most) {
                    Some(i) => pending.extend([((i, 0.0), to), (from, (i, 0.0))]),
                    None => refined.push(to),
                }
            }
        }
        refined
    }

    fn at_station(&self, curve: &Curve, (edge, t): (usize, f64)) -> FeatureSeed {
        let on = curve.edges[edge];
        if t <= 0.0 || t >= 1.0 {
            return self.at_vertex(if t <= 0.0 { on.from } else { on.to });
        }
        FeatureSeed { places: self.lifted(on.places(&self.input.surface, t)), stop: None }
    }

    fn at_vertex(&self, v: VertexId) -> FeatureSeed {
        let copies = self.input.seams.copies(v).iter();
        let places = copies.filter_map(|&copy| self.input.surface.place_of(copy)).collect();
        FeatureSeed { places: self.lifted(places), stop: None }
    }

    /// On an equation's surface, places that are on it.
    fn lifted(&self, places: Vec<Place>) -> Vec<Place> {
        if self.input.implicit.is_none() {
            return places;
        }
        places.into_iter().map(|place| self.input.lift(&place, place.position).unwrap_or(place)).collect()
    }
}

/// All vertices of a curve.
fn at_vertices(curve: &Curve) -> Vec<(usize, f64)> {
    let last = curve.edges.len() - 1;
    (0..=last).map(|i| (i, 0.0)).chain([(last, 1.0)]).collect()
}

fn measured(input: &Input, metric: &dyn SurfaceMetric, curve: &Curve) -> MeasuredCurve {
    let (mut pieces, mut behind, mut sides) = (Vec::new(), 0.0, [0.0; 2]);
    for (edge, on) in curve.edges.iter().enumerate() {
        let speed = |t: f64| speeds(input, metric, on, t);
        let mut pending = vec![([0.0, 1.0], [speed(0.0), speed(1.0)], 0)];
        while let Some(([s, t], [at_s, at_t], depth)) = pending.pop() {
            let (half, middle) = (0.5 * (s + t), speed(0.5 * (s + t)));
            let greatest = [at_s, middle, at_t].map(|[a, b]| a.max(b));
            let [by_ends, by_three] =
                [0.5 * (greatest[0] + greatest[2]), (greatest[0] + 4.0 * greatest[1] + greatest[2]) / 6.0];
            let is_precise = depth >= LEAST_HALVINGS && (by_ends - by_three).abs() <= PRECISE * by_three;
            if depth == HALVINGS || is_precise {
                let length = by_three * (t - s);
                pieces.push(Piece { edge, range: [s, t], behind: [behind, behind + length] });
                behind += length;
                for (k, side) in sides.iter_mut().enumerate() {
                    *side += (at_s[k] + 4.0 * middle[k] + at_t[k]) / 6.0 * (t - s);
                }
            } else {
                pending.push(([half, t], [middle, at_t], depth + 1));
                pending.push(([s, half], [at_s, middle], depth + 1));
            }
        }
    }
    MeasuredCurve { pieces, sides }
}

/// The metric length of an edge by the metric at one of its points, on each side; 0 on a side that is none.
fn speeds(input: &Input, metric: &dyn SurfaceMetric, edge: &CurveEdge, t: f64) -> [f64; 2] {
    let [a, b] = edge.positions(&input.surface);
    let mut speeds = [0.0; 2];
    for (speed, place) in speeds.iter_mut().zip(edge.places(&input.surface, t)) {
        *speed = metric.at(&place).length(b - a);
    }
    speeds
}

fn distance_to_segment(p: Point3, [a, b]: [Point3; 2]) -> f64 {
    let (along, offset) = (b - a, p - a);
    let square = along.dot(along);
    let t = if square > 0.0 { (offset.dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a.lerp(b, t))
}
