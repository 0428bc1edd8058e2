//! Random numbers that are the same every time.

use crate::elementary::Elementary;
use crate::geometry::{Tensor, Vector, from_frame};

/// A generator of numbers that look even and independent, the same from the same start: splitmix64 (Steele et al. 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// A generator that starts from a number.
    pub fn new(start: u64) -> Self {
        Self(start)
    }

    /// A number in [0, 1).
    pub fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A vector in the unit disk, evenly.
    fn in_disk(&mut self) -> Vector {
        let (radius, angle) = (self.number().sqrt(), std::f64::consts::TAU * self.number());
        Vector::new(radius * angle.cosine(), radius * angle.sine())
    }

    /// A vector no longer than a radius in a tensor's metric, evenly.
    pub(crate) fn in_ball(&mut self, tensor: Tensor, radius: f64) -> Vector {
        from_frame(tensor.cholesky(), self.in_disk() * radius)
    }
}
