//! Limited-memory quasi-Newton directions (L-BFGS: Nocedal 1980), as used for centroidal Voronoi tessellations by Liu et al.
//! (2009), on top of a first guess.

use crate::geometry::Vector;
use crate::parallel::prelude::*;
use std::collections::VecDeque;

/// So many steps are remembered.
const MEMORY: usize = 7;
/// Vectors that are worth a thread's while.
const PART: usize = 4096;

/// A step that was taken, and how the gradient changed along it.
struct Pair {
    step: Vec<Vector>,
    change: Vec<Vector>,
    /// Their product.
    product: f64,
}

/// The last steps and what they did to the gradient.
#[derive(Default)]
pub(super) struct Memory {
    pairs: VecDeque<Pair>,
}

impl Memory {
    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.pairs.clear();
    }

    /// Remembers a step, unless the energy is not convex along it.
    pub(super) fn remember(&mut self, step: Vec<Vector>, change: Vec<Vector>) {
        let product = dot(&step, &change);
        let least = 1e-10 * (dot(&step, &step) * dot(&change, &change)).sqrt();
        if product > least {
            self.pairs.truncate(MEMORY - 1);
            self.pairs.push_front(Pair { step, change, product });
        }
    }

    /// The descent direction for a gradient: minus the inverse Hessian, as far as known, times the gradient. `scale`
    /// multiplies by a first guess of the inverse Hessian.
    pub(super) fn direction(&self, gradient: &[Vector], scale: impl Fn(&mut [Vector])) -> Vec<Vector> {
        let mut direction = gradient.to_vec();
        let mut shares = Vec::with_capacity(self.pairs.len());
        for pair in &self.pairs {
            let share = dot(&pair.step, &direction) / pair.product;
            add(&mut direction, &pair.change, -share);
            shares.push(share);
        }
        scale(&mut direction);
        for (pair, share) in self.pairs.iter().zip(shares).rev() {
            let back = dot(&pair.change, &direction) / pair.product;
            add(&mut direction, &pair.step, share - back);
        }
        direction.par_iter_mut().with_min_len(PART).for_each(|d| *d = -*d);
        direction
    }
}

/// The sum of the products.
pub(super) fn dot(a: &[Vector], b: &[Vector]) -> f64 {
    let part = |(a, b): (&[Vector], &[Vector])| -> f64 { a.iter().zip(b).map(|(u, v)| u.dot(*v)).sum() };
    // Parts of one length, summed in order: the same for any number of threads.
    let parts: Vec<f64> = a.par_chunks(PART).zip(b.par_chunks(PART)).map(part).collect();
    parts.into_iter().sum()
}

/// Adds a multiple of other vectors.
pub(super) fn add(to: &mut [Vector], what: &[Vector], times: f64) {
    to.par_iter_mut().zip(what).with_min_len(PART).for_each(|(sum, &w)| *sum = *sum + w * times);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadratic_energy_is_minimised_in_a_few_steps() {
        // E = sum of k |x|^2 / 2 with k = 1, 2, ... , 6, from (1, 1): gradient k x.
        let gradient = |x: &[Vector]| x.iter().enumerate().map(|(i, &v)| v * (i + 1) as f64).collect::<Vec<Vector>>();
        let mut x = vec![Vector::new(1.0, 1.0); 6];
        let mut memory = Memory::default();
        for _ in 0..12 {
            let before = gradient(&x);
            let step = memory.direction(&before, |g| g.iter_mut().for_each(|v| *v = *v * 0.25));
            // The best length along the direction of a quadratic energy.
            let length = -dot(&step, &before) / dot(&step, &gradient(&step));
            let step: Vec<Vector> = step.iter().map(|&s| s * length).collect();
            x.iter_mut().zip(&step).for_each(|(p, &s)| *p = *p + s);
            let change = gradient(&x).iter().zip(&before).map(|(&a, &b)| a - b).collect();
            memory.remember(step, change);
        }
        assert!(dot(&x, &x).sqrt() < 1e-6, "{x:?}");
    }
}
