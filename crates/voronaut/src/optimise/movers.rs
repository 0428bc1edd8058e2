//! The seeds that can move, the energy, and its gradient; and regions where geodesics are not resolved, whose triangles and circles a
//! diagram on a canvas decides on.

use super::cell::{CellsOf, Moments};
use crate::canvas::{self, Canvas};
use crate::dual::{Dual, Kind, Moving};
use crate::error::Result;
use crate::geometry::{Point, Vector, from_frame, to_frame};
use crate::net::{Ball, circles_on_canvas};
use crate::parallel::prelude::*;
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
    /// The area of its cell.
    pub(super) mass: f64,
    /// Whether the metric is rough at the seed or one of its neighbours: no quasi-Newton step helps there.
    pub(super) is_rough: bool,
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
        let shares = moments.par_iter().with_min_len(1024).map(|&(v, m)| (v, m.second / square));
        let shares: Vec<(VertexId, f64)> = shares.collect();
        let energy = shares.iter().map(|(_, share)| share).sum();
        let straight = !cells.lower_energy();
        let movable = moments.into_par_iter().with_min_len(256);
        let (seeds, gradient) = movable.filter_map(|(v, m)| Mover::new(dual, v, &m, straight)).unzip();
        Ok(Self { energy, shares, seeds, gradient })
    }
}

fn is_rough_around(dual: &impl Moving, v: VertexId) -> bool {
    dual.local(v).is_rough || dual.topology().star(v).any(|h| dual.local(dual.topology().target(h)).is_rough)
}

impl Mover {
    /// The seed, and the gradient of the scaled energy there; `None` of a corner, one that is held, and of a seed on a segment without room.
    fn new(dual: &impl Moving, id: VertexId, moments: &Moments, straight: bool) -> Option<(Self, Vector)> {
        let freedom = match dual.kind(id) {
            Kind::Corner(_) | Kind::Held => return None,
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
        Some((Self { id, freedom, mass: moments.mass, is_rough: is_rough_around(dual, id) }, gradient))
    }

    /// A first guess of the inverse Hessian times a covector: the gradient, so scaled, is minus the step to the centroid.
    pub(super) fn scaled(&self, dual: &impl Moving, gradient: Vector) -> Vector {
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

    /// A covector in the orthonormal frame.
    pub(super) fn pull(&self, dual: &impl Moving, gradient: Vector) -> Vector {
        let tensor = dual.local(self.id).tensor;
        let frame = tensor.cholesky();
        let pull = to_frame(frame, tensor.inverse().apply(gradient));
        self.line(frame).map_or(pull, |line| line * line.dot(pull))
    }

    /// The direction of the segment that it slides along, in an orthonormal frame.
    pub(super) fn line(&self, frame: [f64; 3]) -> Option<Vector> {
        let Freedom::Along(t) = self.freedom else { return None };
        let line = to_frame(frame, t);
        Some(line * (1.0 / line.norm()))
    }

    /// Where a step leads a seed that is on no segment: the move, if nothing is in its way.
    pub(super) fn whole_move(&self, dual: &impl Moving, step: Vector) -> Option<(VertexId, Vector)> {
        let local = dual.local(self.id);
        let step = step * (LONGEST / local.tensor.length(step)).min(1.0);
        match self.freedom {
            Freedom::Exponential => Some((self.id, local.exp(step))),
            Freedom::Straight => Some((self.id, step)),
            Freedom::Along(_) => None,
        }
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

/// Rings of triangles of the mesh around a region's seeds that its canvas covers: their cells are then whole.
const RINGS: usize = 2;

/// Seeds, and a canvas that holds their cells.
pub(super) struct Region {
    canvas: Canvas,
    /// The seeds that it is around.
    pub(super) core: Vec<VertexId>,
    near: Vec<VertexId>,
    is_inner: Vec<bool>,
}

impl Region {
    /// Of some seeds and their neighbours, with so many canvas vertices per seed. `None` where the metric is no metric there.
    pub(super) fn around(dual: &Dual, seeds: &[VertexId], per_seed: usize) -> Option<Self> {
        let topology = dual.topology();
        let mut is_inner = vec![false; topology.vertex_slots()];
        for &v in seeds {
            is_inner[v.index()] = true;
            topology.star(v).for_each(|h| is_inner[topology.target(h).index()] = true);
        }
        let inner: Vec<VertexId> = topology.vertices().filter(|v| is_inner[v.index()]).collect();
        let part = dual.part_around(&inner, RINGS);
        let near: Vec<VertexId> = part.topology.vertices().collect();
        let canvas = Canvas::from_planar(canvas::Kind::Intrinsic, part, dual.field(), per_seed * near.len()).ok()?;
        Some(Self { canvas, core: seeds.to_vec(), near, is_inner })
    }

    /// Whether one of these is its seed.
    pub(super) fn touches(&self, seeds: &[u32]) -> bool {
        seeds.iter().any(|&i| self.is_inner.get(i as usize) == Some(&true))
    }

    /// Its seeds.
    pub(super) fn seeds(&self) -> impl Iterator<Item = VertexId> {
        self.is_inner.iter().enumerate().filter(|(_, inner)| **inner).map(|(i, _)| VertexId(i as u32))
    }

    /// The circles of the triangles with a seed of its own, all seeds being somewhere; `None` where one lies outside the
    /// canvas.
    pub(super) fn circles(&self, dual: &Dual, at: impl Fn(VertexId) -> Point) -> Option<Vec<Ball<3>>> {
        let seeds: Vec<(u32, Point)> = self.near.iter().map(|&v| (v.0, at(v))).collect();
        let mut balls = circles_on_canvas(&self.canvas, dual.field(), &seeds).ok()?;
        balls.retain(|ball| self.touches(&ball.corners));
        Some(balls)
    }
}
