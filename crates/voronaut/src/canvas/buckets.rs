//! A queue that is sorted roughly, and cheap for that.

/// What is to be done, largest first to within a fourth of an octave; last in, first out within that.
pub(super) struct Buckets<T> {
    buckets: Vec<Vec<T>>,
}

impl<T> Default for Buckets<T> {
    fn default() -> Self {
        Self { buckets: Vec::new() }
    }
}

impl<T> Buckets<T> {
    /// Queues an item by its size; one without a finite positive size is passed over.
    pub(super) fn push(&mut self, size: f64, item: T) {
        if !(size > 0.0 && size.is_finite()) {
            return;
        }
        // Exponent and the first two bits of the mantissa: grows with the size.
        let bucket = (size.to_bits() >> 50) as usize;
        if bucket >= self.buckets.len() {
            self.buckets.resize_with(bucket + 1, Vec::new);
        }
        self.buckets[bucket].push(item);
    }

    /// Takes an item of the largest size class.
    pub(super) fn pop(&mut self) -> Option<T> {
        while let Some(last) = self.buckets.last_mut() {
            if let Some(item) = last.pop() {
                return Some(item);
            }
            self.buckets.pop();
        }
        None
    }
}
