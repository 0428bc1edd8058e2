//! Certificates (RR-9103, sections 4, 5 and 8 to 11): whether the report's theorems hold of given seeds, metric and
//! canvas, by how much they miss, and what it would take. The derivations are in `docs/guarantees.md`.
//!
//! What is said is no proof: the metric is sampled, and geodesics are computed. It never says that a theorem holds of
//! which a hypothesis was not looked at. On surfaces (section 12) theorems of what is near a seed are those of the plane, in a chart.

mod constants;
mod convexity;
mod coverage;
mod distortion;
mod on_surface;
mod sight;
mod sizing;
mod theorems;
mod verdict;
mod walk;

pub use constants::{Constants, Figures};
pub use convexity::Convexity;
pub(crate) use coverage::Coverage;
pub(crate) use distortion::distortion_around;
pub use sizing::Cost;
pub(crate) use sizing::{Area, longest_edge, sized_canvas};
pub(crate) use theorems::Evidence;
pub use verdict::{Condition, Outcome, Verdict};
pub use walk::Walks;

use crate::diagram::{Diagram, Ground};
use crate::geodesic::{Fineness, Paths};
use crate::geometry::Tensor;
use crate::net::{Ball, Net, neighbours};
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;
use serde::Serialize;
use sight::{Sight, Sights};

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
    pub(crate) fn new(diagram: &Diagram, exact: &[[u32; 3]], net: &Net, constants: Constants) -> Self {
        let disks = |coverage: &Coverage, epsilon: f64| convexity::convexity(diagram, net, coverage, epsilon);
        Self::of(diagram, diagram, exact, net, constants, disks, Evidence::verdicts)
    }

    fn of<'a, G: Ground<'a>, P: Copy + Sync>(
        diagram: &Diagram<'a, G>,
        sights: &impl Sights<P>,
        exact: &[[u32; 3]],
        net: &Net<P>,
        constants: Constants,
        disks: impl FnOnce(&Coverage, f64) -> Convexity,
        verdicts: impl FnOnce(&Evidence) -> Vec<Verdict>,
    ) -> Self {
        let longest = longest_edge(diagram.ground().topology());
        let mut coverage = Coverage::new(diagram, net.epsilon, longest);
        let farthest = coverage::farthest(&coverage, diagram);
        let (inner, open) = coverage::inner_net(&coverage, farthest, net, exact);
        coverage.cover(net.epsilon, longest, &inner);
        let none = || (coverage.count() == 0).then(|| format!("no seed is {:.3e} from the border", coverage.least));
        let mut cells = cells(sights, net, &coverage, &inner);
        let [size, euclidean_size] = sizing::half_longest(diagram, |i| coverage.complete[i as usize]);
        let evidence = Evidence {
            constants,
            net: inner,
            // A value that is none is the greatest.
            psi: cells
                .iter()
                .map(|cell| cell.psi)
                .reduce(|a, b| if b > a || b.is_nan() { b } else { a })
                .unwrap_or(f64::NAN),
            uniform: uniform(diagram),
            size,
            euclidean_size,
            distance_error: distance_error(diagram, sights, net, &coverage),
            convexity: disks(&coverage, inner.epsilon),
            doubt: open.or_else(none),
        };
        let is_walked = |ball: &&Ball<3, P>| ball.corners.iter().any(|&i| coverage.covered[i as usize]);
        let walks = Walks::of(diagram, |at| sights.face(at), net.triangles.iter().filter(is_walked));
        for cell in &mut cells {
            cell.factor = factor(cell, &evidence);
        }
        let verdicts = verdicts(&evidence);
        let asked_size = verdicts.iter().find(|verdict| verdict.theorem == "9.4").and_then(|verdict| verdict.size);
        let covered = coverage.count();
        Self {
            constants,
            covered,
            border_not_covered: coverage.covered.len() - covered,
            border_distance: coverage.least,
            net: inner,
            lambda: inner.lambda(),
            psi: evidence.psi,
            is_uniform: evidence.uniform.is_some(),
            size,
            distance_error: evidence.distance_error,
            convexity: evidence.convexity,
            verdicts,
            asked_size,
            asked_canvas: asked_size.map(|size| Area::of(diagram.ground()).cost(size)),
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

fn cells<P: Copy + Sync>(sights: &impl Sights<P>, net: &Net<P>, coverage: &Coverage, inner: &Figures) -> Vec<Cell> {
    let mut around = vec![Vec::new(); coverage.covered.len()];
    for ball in &net.triangles {
        ball.corners.iter().for_each(|&i| around[i as usize].push(*ball));
    }
    let paths = Paths::default();
    let cell = |&i: &u32| {
        let balls = &around[i as usize];
        let sight = sights.around([i]);
        let psi = |sight| distortion_around(Sight::field(sight), Sight::seed(sight, i), REACH * inner.epsilon);
        let distance = |j: u32| {
            let sight = sights.around([i, j])?;
            Some(sight.length(&paths, sight.seed(i), sight.seed(j), Fineness::COARSEST).0)
        };
        let others = balls.iter().flat_map(|ball| ball.corners).filter(|&j| j != i);
        Cell {
            seed: i,
            depth: coverage.depths[i as usize],
            psi: sight.as_ref().map_or(f64::NAN, psi),
            epsilon: balls.iter().map(|ball| ball.radius).fold(0.0, f64::max),
            mu: others.map(|j| distance(j).unwrap_or(f64::NAN)).fold(f64::INFINITY, f64::min),
            delta: balls.iter().map(Ball::protection).fold(f64::INFINITY, f64::min),
            factor: f64::NAN,
        }
    };
    let covered: Vec<u32> = (0..coverage.covered.len() as u32).filter(|&i| coverage.covered[i as usize]).collect();
    covered.par_iter().with_min_len(8).map(cell).collect()
}

/// The eigenvalues of the tensor if it is the same at all canvas vertices, and so is the tangent plane.
fn uniform<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>) -> Option<[f64; 2]> {
    let ground = diagram.ground();
    let frozen = |v: VertexId| ground.frozen(ground.place(v));
    let first = frozen(VertexId(0));
    let scale = first.tensor.xx + first.tensor.yy;
    let is_same = |v: VertexId| {
        let other = frozen(v);
        let Tensor { xx, xy, yy } = other.tensor - first.tensor;
        (other.plane.normal - first.plane.normal).norm() <= ROUNDING
            && xx.abs().max(xy.abs()).max(yy.abs()) <= ROUNDING * scale
    };
    let eigen = first.tensor.eigen();
    let vertices = (0..diagram.vertex_count() as u32).into_par_iter();
    vertices.with_min_len(1024).all(|v| is_same(VertexId(v))).then_some([eigen.small, eigen.large])
}

/// How far canvas distances are from lengths of geodesics at most, or beyond those to the seeds of neighbouring cells, with the
/// errors of these, at samples of the covered cells; NaN where there are none, or geodesics are not found.
fn distance_error<'a, G: Ground<'a>, P: Copy>(
    diagram: &Diagram<'a, G>,
    sights: &impl Sights<P>,
    net: &Net<P>,
    coverage: &Coverage,
) -> f64 {
    let neighbours = neighbours(coverage.covered.len(), net.triangles.iter().map(|ball| ball.corners));
    let is_covered = |v: &VertexId| diagram.colour(*v).is_some_and(|i| coverage.covered[i as usize]);
    let all: Vec<VertexId> = diagram.vertices().filter(is_covered).collect();
    let paths = Paths::default();
    let error = |v: &VertexId| {
        let colour = diagram.colour(*v)?;
        let sight = sights.around([colour])?;
        let (p, seed) = (sight.vertex(*v), sight.seed(colour));
        let found = diagram.distance(*v);
        if p == seed {
            return Some(found);
        }
        let (length, share) = sight.length(&paths, p, seed, Fineness::MIDDLE);
        let mut error = (length - found).abs() + share * length;
        // A seed that should have won is nearer than what was found.
        for &other in &neighbours[colour as usize] {
            let (length, share) = sight.length(&paths, p, sight.seed(other), Fineness::MIDDLE);
            let excess = found - length + share * length;
            error = if excess > error || excess.is_nan() { excess } else { error };
        }
        Some(error)
    };
    let sampled: Vec<VertexId> = all.iter().copied().step_by((all.len() / SAMPLES).max(1)).collect();
    let errors: Vec<f64> = sampled.par_iter().with_min_len(16).map(|v| error(v).unwrap_or(f64::NAN)).collect();
    let worst = errors.into_iter().reduce(|a, b| if b > a || b.is_nan() { b } else { a });
    worst.unwrap_or(f64::NAN)
}
