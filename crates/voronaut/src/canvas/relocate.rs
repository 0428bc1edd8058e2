//! Stars brought to agree by moving vertices a little, where that is enough: it costs no vertex.

use super::agreement::Before;
use super::consistent::{Picker, Simplex};
use crate::error::Result;
use crate::geometry::Point;
use crate::triangulation::VertexId;

/// Places tried for one vertex of an inconsistent simplex.
const TRIES: usize = 20;

impl Picker<'_> {
    /// Moves vertices of inconsistent simplices where that leaves fewer of them, until none can be.
    ///
    /// # Errors
    /// The metric is not positive definite where a vertex was tried.
    pub(super) fn relocate(&mut self) -> Result<()> {
        loop {
            let mut is_idle = true;
            for simplex in self.inconsistent() {
                for v in [simplex.0, simplex.1[0], simplex.1[1]] {
                    is_idle &= !(self.is_inconsistent(simplex) && self.move_near(v, simplex)?);
                }
            }
            if is_idle {
                return Ok(());
            }
        }
    }

    /// Moves one vertex, if it is free, to the first place that leaves fewer inconsistent simplices.
    fn move_near(&mut self, v: VertexId, simplex: Simplex) -> Result<bool> {
        let topology = &self.stars.steiner.planar.topology;
        if topology.is_border_vertex(v) || topology.star(v).any(|h| topology.is_fixed(h)) {
            return Ok(false);
        }
        let Some((_, radius)) = self.stars.circle(simplex.0, simplex.1) else { return Ok(false) };
        let from = self.stars.steiner.planar.position(v);
        for _ in 0..TRIES {
            let away = self.in_ball(v, radius);
            self.counters.tries += 1;
            if self.move_to(v, from + away)? {
                self.counters.moved += 1;
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Moves a vertex if that leaves fewer inconsistent simplices, and none that is large or thin.
    fn move_to(&mut self, v: VertexId, to: Point) -> Result<bool> {
        let from = self.stars.steiner.planar.position(v);
        let mut dirty = self.stars.changed_by(v);
        if !self.stars.steiner.shift(v, to)? {
            return Ok(false);
        }
        dirty.extend(self.stars.changed_by(v));
        dirty.sort_unstable();
        dirty.dedup();
        let before = Before::of(&self.stars, dirty.iter().copied());
        self.stars.update(&dirty);
        let change = before.change(&self.stars);
        if change.after < change.before && dirty.iter().all(|&w| self.is_good(w)) {
            self.stars.steiner.legalise_around(v);
            return Ok(true);
        }
        before.restore(&mut self.stars);
        self.stars.steiner.shift(v, from)?;
        Ok(false)
    }
}
