//! How far seeds are from the border, and which of them the theorems, whose domain has none, speak of.

use super::constants::Figures;
use crate::diagram::Diagram;
use crate::geodesic::{Geodesic, Marching, Sources, Wave, chord};
use crate::geometry::Point;
use crate::net::Net;
use crate::triangulation::{HalfEdge, VertexId};
use std::collections::{HashMap, HashSet};

/// A covered seed is at least so many times the epsilon of the whole domain, and so many of the inner cells', from the
/// border: no point, seed or path that the proofs speak of is beyond it (`docs/guarantees.md`, "The border").
const DEPTH: [f64; 2] = [2.0, 5.0];

/// Seeds by their distance from the border.
#[derive(Clone, Debug)]
pub(crate) struct Coverage {
    /// Metric distance of each seed from the border, by marching, less half the longest canvas edge there.
    pub depths: Vec<f64>,
    /// Seeds farther from the border than any point is from its seed: their cells end at other cells.
    pub complete: Vec<bool>,
    /// Seeds at least [`Coverage::least`] from it: the theorems are about them.
    pub covered: Vec<bool>,
    /// That distance.
    pub least: f64,
}

impl Coverage {
    /// Of the seeds of a diagram; `longest` is the longest edge of its canvas, for points are as far from canvas
    /// vertices. Before [`Coverage::cover`] no seed is covered.
    pub(super) fn new(diagram: &Diagram, net: &Net, longest: f64) -> Self {
        let depths = depths(diagram);
        let complete: Vec<bool> = depths.iter().map(|&depth| depth > net.epsilon + longest).collect();
        let covered = vec![false; depths.len()];
        Self { depths, complete, covered, least: f64::INFINITY }
    }

    /// Of seeds of a domain without border: all.
    pub(super) fn whole(seeds: usize) -> Self {
        Self { depths: vec![f64::INFINITY; seeds], complete: vec![true; seeds], covered: vec![true; seeds], least: 0.0 }
    }

    /// Says which seeds are covered, from the epsilon of the complete cells.
    pub(super) fn cover(&mut self, net: &Net, longest: f64, inner: &Figures) {
        self.least = DEPTH[0] * (net.epsilon + longest) + DEPTH[1] * inner.epsilon;
        self.covered = self.depths.iter().map(|&depth| depth >= self.least).collect();
    }

    /// Number of covered seeds.
    pub(crate) fn count(&self) -> usize {
        self.covered.iter().filter(|&&covered| covered).count()
    }
}

/// The net of the complete cells, whose canvas vertices are no farther from their seeds than `farthest`, and what keeps it from being one.
pub(super) fn inner_net<P>(
    coverage: &Coverage,
    farthest: f64,
    net: &Net<P>,
    exact: &[[u32; 3]],
) -> (Figures, Option<String>) {
    let touches = |corners: &[u32; 3]| corners.iter().any(|&i| coverage.complete[i as usize]);
    let balls: Vec<_> = net.triangles.iter().filter(|ball| touches(&ball.corners)).collect();
    if balls.is_empty() {
        let none = Figures { epsilon: f64::NAN, mu: net.mu, delta: f64::NAN };
        return (none, Some("no cell is known to end at other cells only: all seeds are near the border".into()));
    }
    let figures = Figures {
        // In a metric that varies, the farthest point of a cell need not be a Voronoi vertex.
        epsilon: balls.iter().map(|ball| ball.radius).fold(farthest, f64::max),
        mu: net.mu,
        delta: balls.iter().map(|ball| ball.protection()).fold(f64::INFINITY, f64::min),
    };
    let wanted = exact.iter().filter(|corners| touches(corners)).count();
    let outside = balls.iter().filter(|ball| !ball.is_interior).count();
    let chords = net.by_chord;
    let open = open_stars(coverage, exact);
    let reason = if balls.len() < wanted {
        Some(format!("{} triangles of inner cells have no circle that geodesics find", wanted - balls.len()))
    } else if outside > 0 {
        Some(format!("{outside} circles of inner cells have their centres outside the domain"))
    } else if chords > 0 {
        Some(format!("{chords} lengths that mu and delta are from: geodesics are not resolved there"))
    } else {
        (open > 0).then(|| format!("the triangles around {open} inner seeds do not close"))
    };
    (figures, reason)
}

/// How far a canvas vertex of a complete cell is from its seed at most.
pub(super) fn farthest(coverage: &Coverage, diagram: &Diagram) -> f64 {
    let vertices = diagram.vertices();
    let is_inner = |v: &VertexId| diagram.colour(*v).is_some_and(|i| coverage.complete[i as usize]);
    vertices.filter(is_inner).map(|v| diagram.distance(v)).fold(0.0, f64::max)
}

/// Complete seeds whose triangles are no closed fan.
fn open_stars(coverage: &Coverage, exact: &[[u32; 3]]) -> usize {
    let mut links: HashMap<u32, HashMap<u32, u32>> = HashMap::new();
    let mut doubled: HashSet<u32> = HashSet::new();
    for &[a, b, c] in exact {
        for [i, from, to] in [[a, b, c], [b, c, a], [c, a, b]] {
            if links.entry(i).or_default().insert(from, to).is_some() {
                doubled.insert(i);
            }
        }
    }
    let is_closed = |i: u32| {
        let Some(link) = links.get(&i).filter(|_| !doubled.contains(&i)) else { return false };
        let Some(&first) = link.keys().min() else { return false };
        let around = std::iter::successors(link.get(&first), |at| link.get(at).filter(|_| **at != first));
        let steps = around.take(link.len() + 1).collect::<Vec<_>>();
        steps.len() == link.len() && steps.last() == Some(&&first)
    };
    let complete = (0..coverage.complete.len() as u32).filter(|&i| coverage.complete[i as usize]);
    complete.filter(|&i| !is_closed(i)).count()
}

fn depths(diagram: &Diagram) -> Vec<f64> {
    let canvas = diagram.canvas();
    let topology = canvas.topology();
    let borders: Vec<HalfEdge> = topology.edges().filter(|&h| topology.twin(h).is_none()).collect();
    let mut sources = Sources::new(canvas.vertex_count());
    for &h in &borders {
        sources.add(topology.origin(h), 0.0, 0);
        sources.add(topology.target(h), 0.0, 0);
    }
    let half = borders.iter().map(|&h| 0.5 * topology.length(h)).fold(0.0, f64::max);
    let found = Marching { canvas: topology, wave: Wave::Plane }.propagate(&sources);
    let seeds = (0..diagram.colours() as u32).map(|i| diagram.seed(i).unwrap_or_default());
    seeds.map(|p| (depth_of(diagram, p, |v| found.label(v).distance) - half).max(0.0)).collect()
}

/// What the distances at the corners around a point leave it at least.
fn depth_of(diagram: &Diagram, p: Point, at: impl Fn(VertexId) -> f64) -> f64 {
    let (canvas, field) = (diagram.canvas(), diagram.field());
    let corners = canvas.weights(p).unwrap_or_default();
    corners.into_iter().map(|(v, _)| at(v) - chord(field, p, canvas.position(v))).fold(0.0, f64::max)
}
