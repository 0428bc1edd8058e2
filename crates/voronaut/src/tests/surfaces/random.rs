//! Numbers that look random and are the same every time.

/// By xorshift (Marsaglia 2003).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// The next number, from 0 to 1.
    pub(crate) fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
