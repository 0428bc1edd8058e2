//! How seeds are relaxed.

use super::options::{Centroid, Seeding};
use super::{BLOCKED_SHARE, EXCHANGED_SHARE, Job};
use crate::canvas::Canvas;
use crate::dual::Dual;
use crate::error::Result;
use crate::optimise::{Cells, OnCanvas, Relaxed, exchange, meet_blocked_flips, mend_worst, relax};

/// Relaxation goes in so many parts.
const PARTS: usize = 4;
/// Triangles that are mended in the end, as a share of all.
const MENDED_SHARE: f64 = 0.002;
/// Relative error of the energy that tangent planes give, where all seeds are rough.
const ROUGH_DOUBT: f64 = 0.03;

impl Job<'_> {
    /// Relaxes in four parts, with an exchange of seeds before each but the first.
    ///
    /// # Errors
    /// The metric is found invalid at a seed.
    pub(super) fn relax(&mut self, dual: &mut Dual, canvas: Option<&Canvas>) -> Result<Relaxed> {
        dual.reorder();
        let steps = self.options.lloyd;
        self.progress.begin("relaxing", steps as u64)?;
        let cells = match (self.options.centroid, canvas) {
            (Centroid::Canvas, Some(canvas)) => Cells::Canvas(OnCanvas::new(canvas, self.field)),
            (Centroid::Weighted, Some(canvas)) => Cells::Weighted(OnCanvas::new(canvas, self.field)),
            _ => Cells::Tangent,
        };
        let mut relaxed = relax(dual, &cells, steps / PARTS, self.progress)?;
        for part in 1..PARTS {
            let mut left = (steps * (part + 1)) / PARTS - (steps * part) / PARTS;
            if self.exchange(dual, &cells, &mut relaxed)? {
                left = left.saturating_sub(1);
            }
            relaxed.append(relax(dual, &cells, left, self.progress)?);
        }
        self.fit_scale(dual);
        if self.exchanges() {
            mend_worst(dual, (dual.topology().face_count() as f64 * MENDED_SHARE).ceil() as usize);
            dual.take_touched();
        }
        dual.verdict()?;
        Ok(relaxed)
    }

    /// Exchanges seeds and takes a step; if both together raise the energy (in a rough metric: by more than its doubt), both
    /// are taken back. Says whether a step was taken.
    fn exchange(&self, dual: &mut Dual, cells: &Cells, relaxed: &mut Relaxed) -> Result<bool> {
        if !self.exchanges() {
            return Ok(false);
        }
        let count = dual.vertex_count();
        let most = |share: f64| (count as f64 * share) as usize;
        let before = dual.saved();
        self.fit_scale(dual);
        let met = meet_blocked_flips(dual, most(BLOCKED_SHARE));
        exchange(dual, self.fill(count), most(EXCHANGED_SHARE).max(met))?;
        let Some(&energy) = relaxed.energy.last() else { return Ok(false) };
        let step = relax(dual, cells, 1, self.progress)?;
        let doubt = if self.options.centroid == Centroid::Tangent { ROUGH_DOUBT * rough_share(dual) } else { 0.0 };
        let rises = step.energy.last().is_none_or(|&now| now > (1.0 + doubt) * energy);
        if rises && self.options.centroid != Centroid::Weighted {
            dual.restore(&before);
            return Ok(false);
        }
        relaxed.append(step);
        Ok(true)
    }

    /// Farthest points that are not to be relaxed stay as they are.
    fn exchanges(&self) -> bool {
        self.options.lloyd > 0 || self.options.seeding != Seeding::Farthest
    }
}

/// The share of seeds at which the metric is rough.
fn rough_share(dual: &Dual) -> f64 {
    let rough = dual.topology().vertices().filter(|&v| dual.local(v).is_rough).count();
    rough as f64 / dual.vertex_count() as f64
}
