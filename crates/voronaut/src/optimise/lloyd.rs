//! Relaxation: seeds move so that the energy of centroidal Voronoi tessellations falls (Lloyd 1982; Du, Faber and
//! Gunzburger 1999).

use super::cell::CellsOf;
use super::directions::{by_memory, to_centroids};
use super::movers::{Mover, State};
use super::quasi_newton::Memory;
use super::survey::Rest;
use crate::dual::Moving;
use crate::error::Result;
use crate::geometry::Vector;
use crate::parallel::prelude::*;
use crate::progress::Progress;
use crate::triangulation::VertexId;

/// A step that raises the energy is taken back and tried again, shorter or with fewer seeds, this many times.
const BACKTRACKS: u32 = 8;
/// After so many of them the quasi-Newton directions give way to Lloyd's steps, and after so many steps are halved in any case.
const LLOYD_AFTER: u32 = 3;
const SHORTER_AFTER: u32 = 6;
/// Relaxation ends when so many steps in a row gain too little: one alone may have been a short one.
const IN_A_ROW: u32 = 2;

/// How a relaxation went.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Relaxed {
    /// The energy before the first step and after each: the sum over all cells of the integral of the squared distance
    /// to the seed, in the metric as given (not scaled), as far as the cells that were used know it. With
    /// `centroid=weighted` it may rise, else it never does.
    pub energy: Vec<f64>,
    /// Root mean square of the moves (metric units), one entry per step.
    pub moves: Vec<f64>,
    /// Flips done.
    pub flips: u64,
    /// Moves cut short or left out, to keep the triangulation embedded.
    pub held: u64,
    /// Steps taken back because they raised the energy.
    pub taken_back: u64,
    /// Whether it ended early, because the energy would not fall any more.
    pub stalled: bool,
}

impl Relaxed {
    /// What came after this.
    pub(crate) fn append(&mut self, next: Relaxed) {
        // What happened in between counts as part of the first step.
        let is_first = self.energy.is_empty();
        self.energy.extend(next.energy.into_iter().skip(usize::from(!is_first)));
        self.moves.extend(next.moves);
        self.flips += next.flips;
        self.held += next.held;
        self.taken_back += next.taken_back;
        self.stalled = next.stalled;
    }
}

/// When relaxation and polishing end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patience {
    /// After so many steps.
    pub steps: usize,
    /// Or when steps lower the energy, or the error, by less than this share each.
    pub gain: f64,
}

impl Patience {
    /// Nothing is done.
    pub(crate) const NONE: Self = Self { steps: 0, gain: 0.0 };
}

/// Lowers the energy in at most so many steps; ends early when they gain too little.
///
/// Directions are those of a quasi-Newton method whose first guess is how springs between seeds give way ([`Springs`](super::springs::Springs)), and
/// along Lloyd's step to the centroid where the metric is rough. Free seeds move by the second-order exponential map, those on a segment slide along it, corners stay.
/// After each step edges are flipped. A step that would raise the energy is taken back, and the seeds to blame rest
/// before the others are shortened. The triangulation stays embedded throughout. The result does not depend on the
/// number of threads.
///
/// # Errors
/// The metric is found invalid at a seed.
pub(crate) fn relax<M: Moving>(
    dual: &mut M,
    cells: &impl CellsOf<M>,
    Patience { steps, gain }: Patience,
    progress: &dyn Progress,
) -> Result<Relaxed> {
    let mut relaxed = Relaxed::default();
    if steps == 0 {
        return Ok(relaxed);
    }
    dual.measure();
    let state = State::of(dual, cells)?;
    relaxed.energy.push(state.energy);
    let mut descent =
        Descent { cells, gain, memory: Memory::default(), rest: Rest::new(state.seeds.len()), state, relaxed };
    let (mut small, mut saved) = (0, None);
    for _ in 0..steps {
        let before = descent.state.energy;
        let done = descent.step(dual, &mut saved)?;
        progress.advance(1)?;
        progress.sketch(&|| dual.sketch());
        let is_small = cells.lower_energy() && before - descent.state.energy < gain * before;
        small = if is_small { small + 1 } else { 0 };
        if !done || small == IN_A_ROW {
            descent.relaxed.stalled = true;
            break;
        }
    }
    Ok(descent.relaxed)
}

struct Descent<'a, C> {
    cells: &'a C,
    gain: f64,
    memory: Memory,
    rest: Rest,
    state: State,
    relaxed: Relaxed,
}

impl<C> Descent<'_, C> {
    /// One step that lowers the energy; false if none was found, and the dual is as before.
    fn step<M: Moving>(&mut self, dual: &mut M, saved: &mut Option<M::Saved>) -> Result<bool>
    where
        C: CellsOf<M>,
    {
        // The memory of one step serves the next: it is large, and new pages cost more than the copy.
        if let Some(saved) = saved.as_mut() {
            dual.save_over(saved);
        }
        let before: &M::Saved = saved.get_or_insert_with(|| dual.save());
        let mut is_lloyd = !self.cells.lower_energy();
        let mut direction =
            if is_lloyd { to_centroids(&self.state, dual) } else { by_memory(&self.state, dual, &self.memory) };
        let mut share = 1.0;
        self.rest.next_step();
        for attempt in 1..=BACKTRACKS {
            let (held, flips) = self.advance(dual, &direction, share)?;
            let next = State::of(dual, self.cells)?;
            if next.energy <= self.state.energy || !self.cells.lower_energy() {
                (self.relaxed.held, self.relaxed.flips) = (self.relaxed.held + held, self.relaxed.flips + flips);
                self.accept(dual, before, next);
                return Ok(true);
            }
            let resting = self.rest.blame(dual, &self.state, &next);
            dual.take_back(before);
            self.relaxed.taken_back += 1;
            if attempt > LLOYD_AFTER && !is_lloyd {
                self.memory.clear();
                is_lloyd = true;
                direction = to_centroids(&self.state, dual);
            } else if resting == 0 || attempt > SHORTER_AFTER {
                share *= 0.5;
            }
            if !self.promises(dual, &direction, share) {
                break;
            }
        }
        Ok(false)
    }

    /// Whether a share of a direction would gain enough if the energy were quadratic, with its minimum at the end of the whole direction.
    fn promises(&self, dual: &impl Moving, direction: &[Vector], share: f64) -> bool {
        let awake = (0..direction.len()).filter(|&i| self.rest.is_awake(i));
        let slope: f64 = awake.map(|i| direction[i].dot(self.state.gradient[i])).sum();
        let energy = self.state.energy * dual.factor().powi(2);
        -slope * share * (1.0 - 0.5 * share) > self.gain * energy
    }

    /// Moves all seeds that do not rest by a share of a direction and settles the triangulation; moves held back, and flips.
    fn advance(&self, dual: &mut impl Moving, direction: &[Vector], share: f64) -> Result<(u64, u64)> {
        let seeds = &self.state.seeds;
        let awake: Vec<usize> = (0..seeds.len()).filter(|&i| self.rest.is_awake(i)).collect();
        let whole: Vec<_> = {
            let dual = &*dual;
            let awake = awake.par_iter().with_min_len(1024);
            awake.map(|&i| seeds[i].whole_move(dual, direction[i] * share)).collect()
        };
        // Most move at once; what is left goes one by one, as far as it can.
        let moves: Vec<(VertexId, Vector)> = whole.par_iter().with_min_len(1024).filter_map(|&whole| whole).collect();
        let mut moved = dual.shift_together(&moves).into_iter();
        let mut held = 0;
        for (i, whole) in awake.into_iter().zip(whole) {
            if whole.is_none() || moved.next() == Some(false) {
                held += u64::from(!seeds[i].shift(dual, direction[i] * share));
            }
        }
        let flips = dual.settle_moves()?;
        Ok((held, flips))
    }

    fn accept<M: Moving>(&mut self, dual: &M, before: &M::Saved, next: State)
    where
        C: CellsOf<M>,
    {
        let seeds = &self.state.seeds;
        let moved = |s: &Mover| {
            let step = dual.moved_since(before, s.id);
            (step, dual.local(s.id).tensor.dot(step, step))
        };
        let moves: (Vec<Vector>, Vec<f64>) = seeds.par_iter().with_min_len(1024).map(moved).unzip();
        let (mut step, squares) = moves;
        self.relaxed.moves.push((squares.into_iter().sum::<f64>() / step.len().max(1) as f64).sqrt());
        if self.cells.lower_energy() {
            let mut change = next.gradient.clone();
            let both = step.par_iter_mut().zip(&mut change).zip(&self.state.gradient).zip(seeds).enumerate();
            both.with_min_len(1024).for_each(|(i, (((step, change), &was), seed))| {
                *change = *change - was;
                // Rough and resting seeds would spoil the memory of the others.
                if seed.is_rough || !self.rest.is_awake(i) {
                    (*step, *change) = (Vector::default(), Vector::default());
                }
            });
            self.memory.remember(step, change);
        }
        self.relaxed.energy.push(next.energy);
        self.state = next;
    }
}
