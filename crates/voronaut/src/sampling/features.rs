//! Seeds on the features of a surface: at stops, and along curves at even metric length.

use super::plan::MetricArc;
use crate::geometry::kept_within;
use crate::lists::in_order;
use crate::manifold::surface::metric::SurfaceMetric;
use crate::manifold::surface::{CUT, Curve, CurveEdge, Mark};
use crate::manifold::{Manifold, Place};
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;
use std::collections::BTreeMap;

/// Seeds of a closed curve, and edges of a curve from a stop to itself, at least.
const LEAST_OF_LOOP: usize = 3;

/// A density of seeds on a curve: all of its vertices.
pub(crate) const ALL_VERTICES: usize = usize::MAX;

/// A surface's feature curves with their metric lengths. Where the metric differs on the two sides of a crease, that counts in
/// which it is longer.
pub(crate) struct MeasuredCurves<'a> {
    manifold: &'a Manifold,
    curves: Vec<MeasuredCurve>,
}

struct MeasuredCurve {
    /// Its length in the metric of the side where it is longer.
    arc: MetricArc,
    /// The mean of its lengths in the metrics of both sides; 0 on a side that is none.
    mean: f64,
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

    /// Of the seeds that are there those that are left without every other one of each curve: all of required curves, and of others so many that
    /// no loop has less than it needs.
    pub(crate) fn every_other(&self, there: &[bool]) -> Vec<bool> {
        let mut left = there.to_vec();
        for edges in self.edges.chunk_by(|x, y| x.curve == y.curve) {
            let inner = edges[1..].iter().map(|edge| edge.ends[0] as usize);
            let inner: Vec<usize> = inner.filter(|&seed| there[seed]).collect();
            if !edges[0].mark.is_required && inner.len() + 1 >= 2 * LEAST_OF_LOOP {
                inner.into_iter().step_by(2).for_each(|seed| left[seed] = false);
            }
        }
        left
    }
}

impl<'a> MeasuredCurves<'a> {
    /// Measures the curves of a surface's seams.
    pub(crate) fn new(manifold: &'a Manifold, metric: &dyn SurfaceMetric) -> Self {
        let curves = manifold.features().curves.par_iter().map(|curve| measured(manifold, metric, curve)).collect();
        Self { manifold, curves }
    }

    /// How many vertices curves add to those that the areas of the patches ask for, in terms of the root of the factor on the metric:
    /// half the border's length, and of creases what the metrics of their two sides differ by.
    pub(crate) fn extra(&self) -> f64 {
        self.curves.iter().map(|curve| curve.arc.length() - curve.mean).sum()
    }

    /// Seeds at the stops, and along curves about `spacing` (metric) apart; closer where the edges between them would stray
    /// farther than `hausd` (Euclidean) from the curve, and where fewer would make two edges of the mesh one. Of a required curve
    /// all vertices are seeds, of one with the label [`CUT`] its ends. `density` says how many times as many edges each curve shall have; 1 if it says nothing; with
    /// [`ALL_VERTICES`] all vertices are seeds.
    pub(crate) fn sampled(&self, spacing: f64, hausd: Option<f64>, density: &[usize]) -> FeatureSeeds {
        let features = self.manifold.features();
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
            let (arc, last) = (&self.curves[i].arc, curve.edges.len());
            let parts = (arc.length() / spacing).round() as usize;
            let density = density.get(i).copied().unwrap_or(1);
            // That many edges the curve needs for the mesh to be one: a slit without a seed between its ends would have two between them.
            let least = match shortest.get(&in_order([a, b])) {
                _ if a == b => LEAST_OF_LOOP,
                Some(&shortest) if shortest == i && !self.is_slit(curve) => 1,
                _ => 2,
            };
            let stations = match parts.max(least).saturating_mul(density) {
                _ if curve.mark.is_required || density == ALL_VERTICES => {
                    (0..=last).map(|vertex| vertex as f64).collect()
                }
                _ if curve.mark.label == CUT => vec![0.0, last as f64],
                2 if parts < 2 => self.refined(curve, self.at_bulge(i), hausd),
                parts => {
                    let inner = (1..parts).map(|k| arc.parameter(k as f64 / parts as f64));
                    self.refined(curve, [0.0].into_iter().chain(inner).chain([last as f64]).collect(), hausd)
                }
            };
            let inner = stations[1..stations.len() - 1].iter().map(|&station| self.at_station(curve, station));
            let first = found.seeds.len() as u32;
            let [begin, end] = if curve.has_stops { [at[&a], at[&b]] } else { [first; 2] };
            found.seeds.extend((!curve.has_stops).then(|| self.at_vertex(a)));
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
        for (i, curve) in self.manifold.features().curves.iter().enumerate() {
            let edges = curve.edges.iter().map(|edge| edge.positions(self.manifold.surface()));
            let length = edges.map(|[a, b]| a.distance(b)).sum();
            let least = shortest.entry(in_order(curve.ends())).or_insert((length, i));
            *least = if length < least.0 { (length, i) } else { *least };
        }
        shortest.into_iter().map(|(ends, (_, i))| (ends, i)).collect()
    }

    /// Whether a curve ends inside a patch on both sides.
    fn is_slit(&self, curve: &Curve) -> bool {
        !curve.is_border() && curve.ends().iter().all(|&v| self.manifold.seams().copies(v).len() == 1)
    }

    /// The ends of a curve and its middle; or, where that is much nearer to the chord between the ends, the vertex farthest from it.
    fn at_bulge(&self, i: usize) -> Vec<f64> {
        let curve = &self.manifold.features().curves[i];
        let ends = [0.0, curve.edges.len() as f64];
        let bulge = |station: f64| self.stray(curve, ends, station);
        let middle = self.curves[i].arc.parameter(0.5);
        let vertices = (1..curve.edges.len()).map(|vertex| vertex as f64);
        let farthest = vertices.max_by(|&x, &y| bulge(x).total_cmp(&bulge(y)));
        let inner = farthest.filter(|&station| bulge(station) > 2.0 * bulge(middle)).unwrap_or(middle);
        vec![ends[0], inner, ends[1]]
    }

    /// The stations, and between them vertices of the curve, so that no chord strays farther.
    fn refined(&self, curve: &Curve, stations: Vec<f64>, most: Option<f64>) -> Vec<f64> {
        let Some(most) = most else { return stations };
        let strays = |chord: [f64; 2]| {
            let vertices = (chord[0] as usize + 1..chord[1].ceil() as usize).map(|vertex| vertex as f64);
            let found = vertices.map(|vertex| (self.stray(curve, chord, vertex), vertex));
            found.max_by(|x, y| x.0.total_cmp(&y.0)).filter(|&(stray, _)| stray > most).map(|(_, vertex)| vertex)
        };
        let inner = stations.windows(2).flat_map(|pair| kept_within([pair[0], pair[1]], strays));
        [stations[0]].into_iter().chain(inner).collect()
    }

    /// How far (Euclidean) a station is from the chord between two others.
    fn stray(&self, curve: &Curve, chord: [f64; 2], station: f64) -> f64 {
        let at = |station: f64| {
            let (edge, t) = on_edge(curve, station);
            let [a, b] = edge.positions(self.manifold.surface());
            a.lerp(b, t)
        };
        let ([a, b], p) = (chord.map(at), at(station));
        p.distance(p.nearest_between(a, b))
    }

    fn at_station(&self, curve: &Curve, station: f64) -> FeatureSeed {
        let (on, t) = on_edge(curve, station);
        if t <= 0.0 || t >= 1.0 {
            return self.at_vertex(if t <= 0.0 { on.from } else { on.to });
        }
        FeatureSeed { places: self.lifted(on.places(self.manifold.surface(), t)), stop: None }
    }

    fn at_vertex(&self, v: VertexId) -> FeatureSeed {
        let copies = self.manifold.seams().copies(v).iter();
        let places = copies.filter_map(|&copy| self.manifold.place_of(copy)).collect();
        FeatureSeed { places: self.lifted(places), stop: None }
    }

    /// On an equation's surface, places that are on it.
    fn lifted(&self, places: Vec<Place>) -> Vec<Place> {
        if self.manifold.equation().is_none() {
            return places;
        }
        places.into_iter().map(|place| self.manifold.lift(&place, place.position).unwrap_or(place)).collect()
    }
}

/// The edge of a curve that a station is on, and where on it. Stations count the edges behind them.
fn on_edge(curve: &Curve, station: f64) -> (&CurveEdge, f64) {
    let edge = (station as usize).min(curve.edges.len() - 1);
    (&curve.edges[edge], station - edge as f64)
}

fn measured(manifold: &Manifold, metric: &dyn SurfaceMetric, curve: &Curve) -> MeasuredCurve {
    let arc = |of: fn([f64; 2]) -> f64| {
        MetricArc::new(curve.edges.len(), |s, t| {
            let middle = 0.5 * (s + t);
            let first = middle.floor();
            let edge = &curve.edges[first as usize];
            let [at_s, at_middle, at_t] = [s, middle, t].map(|at| of(speeds(manifold, metric, edge, at - first)));
            (at_s + 4.0 * at_middle + at_t) / 6.0 * (t - s)
        })
    };
    MeasuredCurve { arc: arc(|[a, b]| a.max(b)), mean: arc(|[a, b]| 0.5 * (a + b)).length() }
}

/// The metric length of an edge by the metric at one of its points, on each side; 0 on a side that is none.
fn speeds(manifold: &Manifold, metric: &dyn SurfaceMetric, edge: &CurveEdge, t: f64) -> [f64; 2] {
    let [a, b] = edge.positions(manifold.surface());
    let mut speeds = [0.0; 2];
    for (speed, place) in speeds.iter_mut().zip(edge.places(manifold.surface(), t)) {
        *speed = metric.at(&place).length(b - a);
    }
    speeds
}
