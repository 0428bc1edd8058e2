//! A small generator of random numbers, the same on every machine: a failing case is named by its number alone.

use voronaut::geometry::{Point, Vector};

/// `SplitMix64` (Steele, Lea and Flood 2014).
pub(crate) struct Random(u64);

impl Random {
    /// The stream that belongs to a case.
    pub(crate) fn of_case(case: u64) -> Self {
        let mut random = Self(case.wrapping_mul(0xd134_2543_de82_ef95));
        random.next();
        random
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in low..high.
    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// Log-uniform in low..high.
    pub(crate) fn size(&mut self, low: f64, high: f64) -> f64 {
        self.within(low.ln(), high.ln()).exp()
    }

    /// A whole number in low..=high.
    pub(crate) fn whole(&mut self, low: u32, high: u32) -> u32 {
        low + (self.next() % u64::from(high - low + 1)) as u32
    }

    /// True with this probability.
    pub(crate) fn chance(&mut self, probability: f64) -> bool {
        self.within(0.0, 1.0) < probability
    }

    /// An angle of a full turn.
    pub(crate) fn turn(&mut self) -> f64 {
        self.within(0.0, std::f64::consts::TAU)
    }

    /// A point of the square of this half-width around the origin.
    pub(crate) fn point(&mut self, half_width: f64) -> Point {
        Point::new(self.within(-half_width, half_width), self.within(-half_width, half_width))
    }
}

/// The point at this angle and distance from a centre.
pub(crate) fn polar(centre: Point, angle: f64, radius: f64) -> Point {
    let (sin, cos) = angle.sin_cos();
    centre + Vector::new(cos, sin) * radius
}
