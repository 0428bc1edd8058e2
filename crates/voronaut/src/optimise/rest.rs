//! Which seeds rest while others are relaxed.

use super::movers::State;
use crate::dual::Moving;

/// A seed rests for twice as many steps as the last time, up to this many.
const LONGEST: u16 = 64;
/// As many seeds are blamed as explain the rise so many times over.
const SURPLUS: f64 = 2.0;

/// Seeds that rest, because around them the energy rose: where the metric is rough, or edges cannot be flipped, the
/// energy jumps, and a few such places would keep all others from moving.
pub(super) struct Rest {
    /// Steps that each seed rests for still, and will rest for the next time.
    steps: Vec<[u16; 2]>,
}

impl Rest {
    /// Nobody rests.
    pub(super) fn new(seeds: usize) -> Self {
        Self { steps: vec![[0, 1]; seeds] }
    }

    /// Whether a seed moves.
    pub(super) fn is_awake(&self, seed: usize) -> bool {
        self.steps[seed][0] == 0
    }

    /// Begins a step.
    pub(super) fn next_step(&mut self) {
        self.steps.iter_mut().for_each(|[left, _]| *left = left.saturating_sub(1));
    }

    /// Puts the seeds to rest around which the energy rose most, with their neighbours. Returns how many.
    pub(super) fn blame(&mut self, dual: &impl Moving, before: &State, after: &State) -> usize {
        let topology = dual.topology();
        let rise = rise_around(dual, before, after);
        let rise_at = |i: usize| rise[before.seeds[i].id.index()];
        let mut order: Vec<usize> = (0..before.seeds.len()).filter(|&i| self.is_awake(i) && rise_at(i) > 0.0).collect();
        order.sort_by(|&i, &j| rise_at(j).total_cmp(&rise_at(i)).then(i.cmp(&j)));
        let mut is_blamed = vec![false; topology.vertex_slots()];
        let mut unexplained = SURPLUS * (after.energy - before.energy);
        for i in order {
            let v = before.seeds[i].id;
            if unexplained < 0.0 {
                break;
            }
            if !is_blamed[v.index()] {
                unexplained -= rise_at(i);
                is_blamed[v.index()] = true;
                topology.star(v).for_each(|h| is_blamed[topology.target(h).index()] = true);
            }
        }
        let mut count = 0;
        for (seed, steps) in before.seeds.iter().zip(&mut self.steps) {
            if is_blamed[seed.id.index()] && steps[0] == 0 {
                *steps = [steps[1], (2 * steps[1]).min(LONGEST)];
                count += 1;
            }
        }
        count
    }
}

/// By how much the energy of the cells at and around each seed has risen, by its id.
fn rise_around(dual: &impl Moving, before: &State, after: &State) -> Vec<f64> {
    let topology = dual.topology();
    let mut rise = vec![0.0; topology.vertex_slots()];
    for (&(v, was), &(_, now)) in before.shares.iter().zip(&after.shares) {
        rise[v.index()] += now - was;
        topology.star(v).for_each(|h| rise[topology.target(h).index()] += now - was);
    }
    rise
}
