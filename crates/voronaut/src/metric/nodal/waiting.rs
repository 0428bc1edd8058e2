//! Vertices that wait for their turn, by the density of their metrics.

use crate::geometry::Tensor;

/// The step from a level to the next, in the logarithm of the determinant: sizes that grow by 3 %. It is no number that metrics are
/// made with (digits of the golden ratio), so that their determinants do not lie just between two levels.
const STEP: f64 = 0.121_803_398_874_989_5;
/// All determinants of finite positive numbers are in fewer levels.
const MOST_LEVELS: f64 = 16_384.0;

/// Vertices in levels below the greatest determinant there was at first. Within a level they have no order: of determinants that
/// differ by rounding neither is the greater.
pub(super) struct Waiting {
    densest: f64,
    levels: Vec<Vec<u32>>,
    still_waits: Vec<bool>,
    first: usize,
}

impl Waiting {
    /// All vertices.
    pub(super) fn all(tensors: &[Tensor]) -> Self {
        let densest = tensors.iter().map(|m| m.determinant()).fold(0.0, f64::max).ln();
        let mut all = Self { densest, levels: Vec::new(), still_waits: vec![false; tensors.len()], first: 0 };
        tensors.iter().enumerate().for_each(|(v, &tensor)| all.add(v as u32, tensor));
        all
    }

    /// A vertex with its metric of now, which is no coarser than it was.
    pub(super) fn add(&mut self, v: u32, tensor: Tensor) {
        let level = ((self.densest - tensor.determinant().ln()) / STEP).clamp(0.0, MOST_LEVELS) as usize;
        if level >= self.levels.len() {
            self.levels.resize_with(level + 1, Vec::new);
        }
        self.levels[level].push(v);
        self.still_waits[v as usize] = true;
        self.first = self.first.min(level);
    }

    /// All of the densest level where any wait; they wait no longer. `None` where none wait.
    pub(super) fn next(&mut self) -> Option<Vec<u32>> {
        while self.first < self.levels.len() {
            let mut all = std::mem::take(&mut self.levels[self.first]);
            // Those that were taken from a denser level since.
            all.retain(|&v| std::mem::take(&mut self.still_waits[v as usize]));
            if !all.is_empty() {
                return Some(all);
            }
            self.first += 1;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_densest_come_first_and_those_alike_together() {
        let sized = |h: f64| Tensor::isotropic(h);
        // 1 and 3 differ by rounding, 0 and 2 do not.
        let mut waiting = Waiting::all(&[sized(1.0), sized(0.1), sized(2.0), sized(0.1 * (1.0 - 1e-15)), sized(1e-3)]);
        assert_eq!(waiting.next().unwrap(), [4]);
        assert_eq!(waiting.next().unwrap(), [1, 3]);
        // What becomes denser is taken once, before what was denser until then.
        waiting.add(2, sized(0.01));
        waiting.add(3, sized(0.02));
        let rest: Vec<_> = std::iter::from_fn(|| waiting.next()).collect();
        assert_eq!(rest, [[2], [3], [0]]);
    }

    #[test]
    fn any_determinant_has_a_level() {
        let sizes = [1e-150, 1e-70, 1.0, 1e70, 1e150];
        let mut waiting = Waiting::all(&sizes.map(Tensor::isotropic));
        let all: Vec<u32> = std::iter::from_fn(|| waiting.next()).flatten().collect();
        assert_eq!(all.len(), sizes.len());
    }
}
