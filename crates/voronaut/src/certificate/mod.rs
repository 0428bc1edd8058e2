//! Certificates (RR-9103, sections 4, 5 and 8 to 11): whether the report's theorems hold of given seeds, metric and
//! canvas, by how much they miss, and what it would take. The derivations are in `docs/guarantees.md`.
//!
//! What is said is no proof: the metric is sampled, and geodesics are computed. It never says that a theorem holds of
//! which a hypothesis was not looked at. Of section 12 (surfaces) there is what has constants: Theorem 10.20.

mod constants;
mod convexity;
mod coverage;
mod distortion;
mod on_surface;
mod sizing;
mod theorems;
mod verdict;
mod walk;

pub use constants::{Constants, Figures};
pub use convexity::Convexity;
pub(crate) use coverage::Coverage;
pub(crate) use distortion::distortion_around;
pub(crate) use sizing::{Area, sized_canvas};
pub use sizing::{Cost, longest_edge};
pub use theorems::Evidence;
pub use verdict::{Condition, Outcome, Verdict};
pub use walk::{Found, Walks};

use crate::diagram::Diagram;
use crate::geodesic::{Fineness, Paths};
use crate::geometry::{Point, Tensor};
use crate::net::{Ball, Net, neighbours};
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;
use serde::Serialize;

/// The radius of the neighbourhood U of Theorem 9.10 in epsilons: nothing that the proof of the theorem speaks of is
/// farther away.
const REACH: f64 = 6.0;
/// Canvas vertices at which distances are held against geodesics, at most about.
const SAMPLES: usize = 1000;
/// Entries of tensors that differ by no more than this share are the same but for rounding.
const ROUNDING: f64 = 1e-12;

/// The certificate of a diagram. Lengths are of the metric.
#[derive(Clone, Debug, Serialize)]
pub struct Certificate {
    /// Which formulas were used.
    pub constants: Constants,
    /// Seeds that the verdicts are about.
    pub covered: usize,
    /// Seeds too near to the border, of which nothing is said.
    pub border_not_covered: usize,
    /// The distance from the border at which seeds are covered.
    pub border_distance: f64,
    /// The net of the inner cells, which all end at other cells.
    #[serde(flatten)]
    pub net: Figures,
    /// mu / epsilon.
    pub lambda: f64,
    /// The greatest distortion within 6 epsilon of a covered seed: sampled, with a reserve.
    pub psi: f64,
    /// Whether the tensor is the same at all canvas vertices.
    pub is_uniform: bool,
    /// Half the longest canvas edge: what sizing fields s0 are held against.
    pub size: f64,
    /// The greatest error of canvas distances that was found, at samples.
    pub distance_error: f64,
    /// Curvature and convex disks.
    pub convexity: Convexity,
    /// What is said of each theorem.
    pub verdicts: Vec<Verdict>,
    /// The least s0 that a theorem with a finite one asks for with these distances (section 9.4), and the canvas that
    /// it takes.
    pub asked_size: Option<f64>,
    /// Vertices of the canvas that it takes.
    pub asked_canvas: Option<Cost>,
    /// Walks to the witnesses of the covered cells' Voronoi vertices.
    pub walks: Walks,
    /// The covered cells.
    pub cells: Vec<Cell>,
}

/// A covered cell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cell {
    /// Its seed.
    pub seed: u32,
    /// The seed's distance from the border.
    pub depth: f64,
    /// The greatest distortion within 6 epsilon of the seed.
    pub psi: f64,
    /// The farthest of its Voronoi vertices.
    pub epsilon: f64,
    /// The nearest other seed.
    pub mu: f64,
    /// The least protected of its Voronoi vertices.
    pub delta: f64,
    /// By how much the cell, with its own psi and delta, misses the conditions of section 9.4: of the distortion, and
    /// of the canvas; infinite where no canvas and no distortion would do.
    pub factor: f64,
}

impl Certificate {
    /// Certifies a diagram on a canvas that is a triangulation. `net` is that of its seeds, with epsilon that of the
    /// whole domain, from the triangles of the exact dual (`recipe::net`).
    pub fn new(diagram: &Diagram, exact: &[[u32; 3]], net: &Net, constants: Constants) -> Self {
        let longest = longest_edge(diagram.canvas());
        let mut coverage = Coverage::new(diagram, net, longest);
        let farthest = coverage::farthest(&coverage, diagram);
        let (inner, open) = coverage::inner_net(&coverage, farthest, net, exact);
        coverage.cover(net, longest, &inner);
        let none = || (coverage.count() == 0).then(|| format!("no seed is {:.3e} from the border", coverage.least));
        let cells = cells(diagram, net, &coverage, &inner);
        let psi = cells.iter().map(|cell| cell.psi).reduce(f64::max).unwrap_or(f64::NAN);
        let [size, euclidean_size] = sizing::half_longest(diagram, |i| coverage.complete[i as usize]);
        let evidence = Evidence {
            constants,
            net: inner,
            psi,
            uniform: uniform(diagram),
            size,
            euclidean_size,
            distance_error: distance_error(diagram, net, &coverage),
            convexity: convexity::convexity(diagram, net, &coverage, inner.epsilon),
            doubt: open.or_else(none),
        };
        let is_walked = |ball: &&Ball<3>| ball.corners.iter().any(|&i| coverage.covered[i as usize]);
        let walks = Walks::of(diagram, net.triangles.iter().filter(is_walked));
        let area = Area::of(diagram.canvas(), diagram.field());
        Self::of(&evidence, evidence.verdicts(), &coverage, walks, cells, Some(area))
    }

    fn of(
        evidence: &Evidence,
        verdicts: Vec<Verdict>,
        coverage: &Coverage,
        walks: Walks,
        mut cells: Vec<Cell>,
        area: Option<Area>,
    ) -> Self {
        for cell in &mut cells {
            cell.factor = factor(cell, evidence);
        }
        let asked_size = verdicts.iter().find(|verdict| verdict.theorem == "9.4").and_then(|verdict| verdict.size);
        let covered = coverage.count();
        Self {
            constants: evidence.constants,
            covered,
            border_not_covered: coverage.covered.len() - covered,
            border_distance: coverage.least,
            net: evidence.net,
            lambda: evidence.net.lambda(),
            psi: evidence.psi,
            is_uniform: evidence.uniform.is_some(),
            size: evidence.size,
            distance_error: evidence.distance_error,
            convexity: evidence.convexity,
            verdicts,
            asked_size,
            asked_canvas: asked_size.zip(area).map(|(size, area)| area.cost(size)),
            walks,
            cells,
        }
    }

    /// The verdict on a theorem, by its number.
    pub(crate) fn verdict(&self, theorem: &str) -> Option<&Verdict> {
        self.verdicts.iter().find(|verdict| verdict.theorem == theorem)
    }

    /// Whether the verdicts are about this triangle: all its seeds are covered.
    #[cfg(test)]
    pub(crate) fn covers(&self, triangle: [u32; 3]) -> bool {
        triangle.iter().all(|i| self.cells.binary_search_by_key(i, |cell| cell.seed).is_ok())
    }
}

fn factor(cell: &Cell, evidence: &Evidence) -> f64 {
    let own = Figures { delta: cell.delta, ..evidence.net };
    let allowed = evidence.constants.distortion_allowed(&own) - 1.0;
    let of_psi = Condition::below("", cell.psi - 1.0, allowed).factor;
    let size = evidence.constants.size(&own, cell.psi, evidence.distance_error);
    size.map_or(of_psi.max(1.0), |size| of_psi.max(evidence.size / size))
}

fn cells(diagram: &Diagram, net: &Net, coverage: &Coverage, inner: &Figures) -> Vec<Cell> {
    let field = diagram.field();
    let mut around = vec![Vec::new(); coverage.covered.len()];
    for ball in &net.triangles {
        ball.corners.iter().for_each(|&i| around[i as usize].push(*ball));
    }
    let paths = Paths::default();
    let seed = |i: u32| diagram.seed(i).unwrap_or_default();
    let distance = |i: u32, j: u32| {
        paths.length(field, seed(i), seed(j), Fineness::COARSEST).map_or(f64::NAN, |length| length.value)
    };
    let cell = |&i: &u32| {
        let balls = &around[i as usize];
        let others = balls.iter().flat_map(|ball| ball.corners).filter(|&j| j != i);
        Cell {
            seed: i,
            depth: coverage.depths[i as usize],
            psi: distortion_around(field, seed(i), REACH * inner.epsilon),
            epsilon: balls.iter().map(|ball| ball.radius).fold(0.0, f64::max),
            mu: others.map(|j| distance(i, j)).fold(f64::INFINITY, f64::min),
            delta: balls.iter().map(Ball::protection).fold(f64::INFINITY, f64::min),
            factor: f64::NAN,
        }
    };
    let covered: Vec<u32> = (0..coverage.covered.len() as u32).filter(|&i| coverage.covered[i as usize]).collect();
    covered.par_iter().with_min_len(8).map(cell).collect()
}

/// The eigenvalues of the tensor if it is the same at all canvas vertices.
fn uniform(diagram: &Diagram) -> Option<[f64; 2]> {
    let field = diagram.field();
    let positions = &diagram.canvas().embedded().positions;
    let first = field.at(*positions.first()?);
    let scale = first.xx + first.yy;
    let is_same = |&p: &Point| {
        let Tensor { xx, xy, yy } = field.at(p) - first;
        xx.abs().max(xy.abs()).max(yy.abs()) <= ROUNDING * scale
    };
    let eigen = first.eigen();
    positions.par_iter().with_min_len(1024).all(is_same).then_some([eigen.small, eigen.large])
}

/// How far canvas distances are from lengths of geodesics at most, or beyond those to the seeds of neighbouring cells, with the
/// errors of these, at samples of the covered cells; NaN where there are none, or geodesics are not found.
fn distance_error(diagram: &Diagram, net: &Net, coverage: &Coverage) -> f64 {
    let field = diagram.field();
    let neighbours = neighbours(coverage.covered.len(), net.triangles.iter().map(|ball| ball.corners));
    let canvas = diagram.canvas();
    let vertices = diagram.vertices();
    let is_covered = |v: &VertexId| diagram.colour(*v).is_some_and(|i| coverage.covered[i as usize]);
    let all: Vec<VertexId> = vertices.filter(is_covered).collect();
    let paths = Paths::default();
    let error = |v: &VertexId| {
        let (p, colour) = (canvas.position(*v), diagram.colour(*v)?);
        let seed = diagram.seed(colour)?;
        if p == seed {
            return Some(diagram.distance(*v));
        }
        let found = diagram.distance(*v);
        let length = paths.length(field, p, seed, Fineness::MIDDLE)?;
        let mut error = (length.value - found).abs() + length.error * length.value;
        // A seed that should have won is nearer than what was found.
        for &other in &neighbours[colour as usize] {
            let length = paths.length(field, p, diagram.seed(other)?, Fineness::MIDDLE)?;
            error = error.max(found - length.value + length.error * length.value);
        }
        Some(error)
    };
    let sampled: Vec<VertexId> = all.iter().copied().step_by((all.len() / SAMPLES).max(1)).collect();
    let errors: Vec<f64> = sampled.par_iter().with_min_len(16).map(|v| error(v).unwrap_or(f64::NAN)).collect();
    let worst = errors.into_iter().reduce(|a, b| if b > a || b.is_nan() { b } else { a });
    worst.unwrap_or(f64::NAN)
}
