//! The seeds that can move, the energy, and its gradient.

use super::cell::{Moments, from_frame};
use super::cells::CellsOf;
use super::quasi_newton::{Memory, dot};
use crate::dual::{Kind, Moving};
use crate::error::Result;
use crate::geometry::Vector;
use crate::triangulation::VertexId;

/// A seed whose move would turn a triangle over tries this many times with half of the move.
const HALVINGS: u32 = 4;
/// Longest move in one step (metric length).
const LONGEST: f64 = 0.5;
/// Seeds slide along segments only as far as their edges there keep within these lengths (metric), well inside the unit
/// range: where the interior would have another number of them on the boundary, they would open gaps.
const SLIDING: [f64; 2] = [0.75, 1.33];

/// The energy, and its gradient at the seeds that can move.
pub(super) struct State {
    /// In the metric as given.
    pub(super) energy: f64,
    /// Each seed's share.
    pub(super) shares: Vec<(VertexId, f64)>,
    /// The seeds that can move.
    pub(super) seeds: Vec<Mover>,
    /// The gradient there (covectors), up to a common factor.
    pub(super) gradient: Vec<Vector>,
}

/// A seed that can move.
pub(super) struct Mover {
    pub(super) id: VertexId,
    freedom: Freedom,
    mass: f64,
}

#[derive(Clone, Copy, PartialEq)]
enum Freedom {
    /// By the exponential map.
    Exponential,
    /// Straight.
    Straight,
    /// Along a segment of this direction.
    Along(Vector),
}

impl State {
    /// Of a dual whose rough edges are measured.
    ///
    /// # Errors
    /// Those of [`CellsOf::moments`].
    pub(super) fn of<M: Moving>(dual: &M, cells: &impl CellsOf<M>) -> Result<Self> {
        let moments = cells.moments(dual)?;
        let square = dual.factor().powi(2);
        let shares: Vec<_> = moments.iter().map(|&(v, m)| (v, m.second / square)).collect();
        let energy = shares.iter().map(|(_, share)| share).sum();
        let straight = !cells.lower_energy();
        let movable = moments.into_iter().filter_map(|(v, m)| Mover::new(dual, v, &m, straight));
        let (seeds, gradient) = movable.unzip();
        Ok(Self { energy, shares, seeds, gradient })
    }

    /// Where to go: the quasi-Newton direction at smooth seeds, Lloyd's step at rough ones.
    pub(super) fn direction(&self, dual: &impl Moving, memory: &Memory) -> Vec<Vector> {
        let lloyd: Vec<Vector> = self.seeds.iter().zip(&self.gradient).map(|(s, &g)| -s.scaled(dual, g)).collect();
        let mut direction = memory.direction(&self.gradient, |gradient| {
            self.seeds.iter().zip(gradient).map(|(seed, g)| seed.scaled(dual, g)).collect()
        });
        // Not downhill: only Lloyd's step surely is.
        if dot(&direction, &self.gradient) > 0.0 {
            return lloyd;
        }
        for ((seed, d), &step) in self.seeds.iter().zip(&mut direction).zip(&lloyd) {
            if is_rough_around(dual, seed.id) {
                *d = step;
            }
        }
        direction
    }
}

/// Whether the metric is rough at a seed or one of its neighbours: no quasi-Newton step helps there.
pub(super) fn is_rough_around(dual: &impl Moving, v: VertexId) -> bool {
    dual.local(v).is_rough || dual.topology().star(v).any(|h| dual.local(dual.topology().target(h)).is_rough)
}

impl Mover {
    /// The seed, and the gradient of the scaled energy there; `None` of a corner, and of a seed on a segment without room.
    fn new(dual: &impl Moving, id: VertexId, moments: &Moments, straight: bool) -> Option<(Self, Vector)> {
        let freedom = match dual.kind(id) {
            Kind::Corner(_) => return None,
            Kind::Free if straight => Freedom::Straight,
            Kind::Free => Freedom::Exponential,
            Kind::Curve => {
                let along = dual.along_segment(id)?;
                Freedom::Along(along * (1.0 / along.norm()))
            }
        };
        let tensor = dual.local(id).tensor;
        let pull = tensor.apply(from_frame(tensor.cholesky(), moments.first)) * -2.0;
        let gradient = if let Freedom::Along(t) = freedom { t * pull.dot(t) } else { pull };
        Some((Self { id, freedom, mass: moments.mass }, gradient))
    }

    /// A first guess of the inverse Hessian times a covector: the gradient, so scaled, is minus the step to the centroid.
    fn scaled(&self, dual: &impl Moving, gradient: Vector) -> Vector {
        if self.mass <= 0.0 {
            return Vector::default();
        }
        let tensor = dual.local(self.id).tensor;
        let step = match self.freedom {
            Freedom::Along(t) => t * (gradient.dot(t) / tensor.dot(t, t)),
            Freedom::Straight | Freedom::Exponential => tensor.inverse().apply(gradient),
        };
        step * (0.5 / self.mass)
    }

    /// Moves the seed, or as far as the embedding allows; says whether it went all the way.
    pub(super) fn shift(&self, dual: &mut impl Moving, step: Vector) -> bool {
        let local = *dual.local(self.id);
        let step = step * (LONGEST / local.tensor.length(step)).min(1.0);
        let mut share = 1.0;
        for _ in 0..=HALVINGS {
            let is_done = match self.freedom {
                Freedom::Exponential => dual.shift_by(self.id, local.exp(step) * share),
                Freedom::Straight => dual.shift_by(self.id, step * share),
                Freedom::Along(_) => dual.slide_by(self.id, step * share, SLIDING),
            };
            if is_done {
                return share >= 1.0;
            }
            share *= 0.5;
        }
        false
    }
}
