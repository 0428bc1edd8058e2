//! Numbers as bytes that deflate well: differences, and of them the lowest bytes together, then the next.

use flate2::Compression;
use flate2::write::DeflateEncoder;
use serde_json::{Value, json};
use std::io::Write as _;

/// Numbers whose bytes are to be kept apart.
#[derive(Debug, Default)]
pub(super) struct Planes(Vec<u32>);

impl Planes {
    pub(super) fn push(&mut self, number: u32) {
        self.0.push(number);
    }

    /// A number that may be negative: small ones of either sign are small.
    pub(super) fn push_signed(&mut self, number: i32) {
        self.push((number << 1 ^ number >> 31).cast_unsigned());
    }

    /// Integers by how each differs from the one before.
    pub(super) fn of_integers(all: impl IntoIterator<Item = i32>) -> Self {
        let mut planes = Self::default();
        let mut before = 0;
        for number in all {
            planes.push_signed(number.wrapping_sub(before));
            before = number;
        }
        planes
    }

    /// Numbers in single precision by how each differs from the one before, in steps from one such number to the next.
    pub(super) fn of_reals(all: impl IntoIterator<Item = f64>) -> Self {
        Self::of_integers(all.into_iter().map(|number| {
            let bits = (number as f32).to_bits().cast_signed();
            // In the order of the numbers: negative ones run backwards.
            bits ^ ((bits >> 31).cast_unsigned() >> 1).cast_signed()
        }))
    }
}

/// All that a page holds besides its description, each part deflated by itself.
#[derive(Debug, Default)]
pub(super) struct Store(Vec<u8>);

impl Store {
    /// How many bytes there are so far.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// What it holds.
    pub(super) fn as_bytes(&self) -> &[u8] {
        &self.0
    }

    /// Adds bytes; says where they are, and how many they are now, for the description.
    pub(super) fn bytes(&mut self, bytes: &[u8]) -> Value {
        self.part(bytes, bytes.len(), 1)
    }

    /// Adds numbers; says where they are, and how many bytes each takes when inflated.
    pub(super) fn planes(&mut self, planes: &Planes) -> Value {
        let all = planes.0.iter().fold(0, |all, number| all | number);
        let width = 4 - all.leading_zeros() / 8;
        let of_place = |place: u32| planes.0.iter().map(move |number| (number >> (8 * place)) as u8);
        let bytes: Vec<u8> = (0..width).flat_map(of_place).collect();
        self.part(&bytes, planes.0.len(), width)
    }

    fn part(&mut self, bytes: &[u8], count: usize, width: u32) -> Value {
        let start = self.0.len();
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
        // Nothing fails that writes to memory.
        let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
        self.0.extend(written.unwrap_or_default());
        json!({ "at": start, "bytes": self.0.len() - start, "count": count, "width": width })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::DeflateDecoder;
    use std::io::Read as _;

    #[test]
    fn planes_are_as_wide_as_they_must_be() {
        let mut store = Store::default();
        let told = store.planes(&Planes::of_integers([3, -1, 300]));
        assert_eq!([&told["count"], &told["width"]], [3, 2]);
        assert_eq!(store.planes(&Planes::default())["width"], 0);
        // Differences 3, -4, 301, doubled, odd where negative: 6, 7, 602.
        let mut inflated = Vec::new();
        DeflateDecoder::new(store.as_bytes()).read_to_end(&mut inflated).unwrap();
        assert_eq!(inflated, [6, 7, 90, 0, 0, 2]);
    }

    #[test]
    fn reals_are_ordered_as_integers() {
        let all = [-2.0, -0.5, -0.0, 0.0, 1e-3, 7.0];
        let Planes(steps) = Planes::of_reals(all);
        assert!(steps[1..].iter().all(|step| step % 2 == 0), "rising numbers have rising steps: {steps:?}");
    }
}
