//! How far seeds are from the border, and which of them the theorems, whose domain has none, speak of.

use super::constants::Figures;
use crate::diagram::{Diagram, Ground};
use crate::geodesic::{Geodesic, Marching, Sources, Wave};
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
    /// vertices. Before [`Coverage::cover`] no seed is covered. Where there is no border all are as deep as can be.
    pub(super) fn new<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>, epsilon: f64, longest: f64) -> Self {
        let depths = depths(diagram);
        let complete: Vec<bool> = depths.iter().map(|&depth| depth > epsilon + longest).collect();
        let covered = vec![false; depths.len()];
        Self { depths, complete, covered, least: f64::INFINITY }
    }

    /// Says which seeds are covered, from the epsilon of the complete cells.
    pub(super) fn cover(&mut self, epsilon: f64, longest: f64, inner: &Figures) {
        self.least = DEPTH[0] * (epsilon + longest) + DEPTH[1] * inner.epsilon;
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
pub(super) fn farthest<'a, G: Ground<'a>>(coverage: &Coverage, diagram: &Diagram<'a, G>) -> f64 {
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

fn depths<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>) -> Vec<f64> {
    let topology = diagram.ground().topology();
    let borders: Vec<HalfEdge> = topology.edges().filter(|&h| topology.twin(h).is_none()).collect();
    let mut sources = Sources::new(diagram.vertex_count());
    for &h in &borders {
        sources.add(topology.origin(h), 0.0, 0);
        sources.add(topology.target(h), 0.0, 0);
    }
    let half = borders.iter().map(|&h| 0.5 * topology.length(h)).fold(0.0, f64::max);
    let found = Marching { canvas: topology, wave: Wave::Plane }.propagate(&sources);
    // What the distances of the vertices around a seed leave it at least.
    let depth = |i: u32| {
        let around = diagram.starts_of(i);
        around.map(|(v, distance)| found.label(v).distance - distance).fold(0.0, f64::max)
    };
    (0..diagram.colours() as u32).map(|i| (depth(i) - half).max(0.0)).collect()
}
