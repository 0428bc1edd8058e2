//! Faces by their circumradius, the greatest first.

use crate::triangulation::FaceId;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Radii below and above these powers of two (metric units) are not told apart before their turn comes: seeds are wanted about a unit
/// apart.
const POWERS: [u64; 2] = [1023 - 8, 1023 + 8];
/// Rungs to a factor of two, as a power of two: with sixteen a heap holds some per cent of all faces.
const RUNGS: u64 = 4;
/// The bits of a number below those that tell its rung.
const SHIFT: u64 = 52 - RUNGS;

/// A number and what it belongs to; the greatest number first, of equal ones the smallest id.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Entry<T> {
    pub(super) value: f64,
    pub(super) of: T,
}

impl<T: Ord> Eq for Entry<T> {}
impl<T: Ord> PartialOrd for Entry<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl<T: Ord> Ord for Entry<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.value.total_cmp(&other.value).then(other.of.cmp(&self.of))
    }
}

/// A queue whose front is a heap. What is to come later is in rungs by its size, in no order: most faces are good, never have their turn,
/// and would only make the heap too large for the cache.
pub(super) struct Queue {
    front: BinaryHeap<Entry<FaceId>>,
    rungs: Vec<Vec<Entry<FaceId>>>,
}

impl Queue {
    /// Of these.
    pub(super) fn new(entries: Vec<Entry<FaceId>>) -> Self {
        let mut queue = Self { front: BinaryHeap::new(), rungs: Vec::new() };
        queue.rungs.resize_with(rung(f64::MAX) + 1, Vec::new);
        for entry in entries {
            queue.push(entry);
        }
        queue
    }

    /// Adds one.
    pub(super) fn push(&mut self, entry: Entry<FaceId>) {
        match self.rungs.get_mut(rung(entry.value)) {
            Some(rung) => rung.push(entry),
            None => self.front.push(entry),
        }
    }

    /// Takes the greatest.
    pub(super) fn pop(&mut self) -> Option<Entry<FaceId>> {
        while self.front.is_empty() {
            self.front = self.rungs.pop()?.into();
        }
        self.front.pop()
    }
}

/// No number has a higher rung than a greater one.
fn rung(value: f64) -> usize {
    let [least, most] = POWERS.map(|power| power << RUNGS);
    let bits = if value.is_sign_positive() { value.to_bits() } else { 0 };
    ((bits >> SHIFT).clamp(least, most) - least) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_come_in_the_order_of_a_heap() {
        let value = |i: u32| match i % 10 {
            0 => f64::MAX,
            1 => 0.0,
            2 => 1e-9,
            _ => (f64::from(i) * 0.618).fract() * 3.0,
        };
        let entry = |i: u32| Entry { value: value(i), of: FaceId(i) };
        let mut queue = Queue::new((0..500).map(entry).collect());
        let mut heap: BinaryHeap<_> = (0..500).map(entry).collect();
        for i in 500..1500 {
            queue.push(entry(i));
            heap.push(entry(i));
            assert!(queue.pop() == heap.pop() && (i % 3 > 0 || queue.pop() == heap.pop()));
        }
        while let Some(first) = heap.pop() {
            assert!(queue.pop() == Some(first));
        }
        assert!(queue.pop().is_none());
    }
}
