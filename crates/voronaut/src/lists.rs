//! Lists: in order, without repetitions, marked, in rows, in classes; tables by numbers.

use crate::parallel::join;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// What there is among these, each once, in order.
pub(crate) fn distinct<T: Ord>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut list: Vec<T> = items.into_iter().collect();
    list.sort_unstable();
    list.dedup();
    list
}

/// Things by their numbers, the least first; of equal ones in order.
pub(crate) fn ranked<T: Ord>(items: impl IntoIterator<Item = (f64, T)>) -> Vec<(f64, T)> {
    let mut list: Vec<(f64, T)> = items.into_iter().collect();
    list.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1)));
    list
}

/// The first of these, at most so many, as [`ranked`] has them.
pub(crate) fn least_ranked<T: Ord>(mut items: Vec<(f64, T)>, most: usize) -> Vec<(f64, T)> {
    if most < items.len() {
        items.select_nth_unstable_by(most, |a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1)));
        items.truncate(most);
    }
    ranked(items)
}

/// A few things, the smallest first.
pub(crate) fn in_order<T: Ord, const N: usize>(mut items: [T; N]) -> [T; N] {
    items.sort_unstable();
    items
}

/// Of each number below `count` whether it is one of these; what is not below is left out.
pub(crate) fn marked(count: usize, numbers: impl IntoIterator<Item = u32>) -> Vec<bool> {
    let mut marks = vec![false; count];
    for number in numbers {
        if let Some(mark) = marks.get_mut(number as usize) {
            *mark = true;
        }
    }
    marks
}

/// Items in numbered rows, one row after the other in one list.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows<T> {
    /// Where each row begins, and where the last one ends.
    starts: Vec<u32>,
    items: Vec<T>,
}

impl<T: Copy + Default> Rows<T> {
    /// So many rows of items with the numbers of their rows; those of a row stay in their order.
    pub(crate) fn new(rows: usize, items: impl Iterator<Item = (u32, T)> + Clone) -> Self {
        let mut starts = vec![0_u32; rows + 1];
        for (row, _) in items.clone() {
            starts[row as usize + 1] += 1;
        }
        for row in 0..rows {
            starts[row + 1] += starts[row];
        }
        let mut next = starts.clone();
        let mut list = vec![T::default(); starts[rows] as usize];
        for (row, item) in items {
            let at = &mut next[row as usize];
            list[*at as usize] = item;
            *at += 1;
        }
        Self { starts, items: list }
    }

    /// The same rows, each in order and without repetitions.
    pub(crate) fn distinct(mut self) -> Self
    where
        T: Ord,
    {
        let mut kept = 0;
        for row in 0..self.count() {
            let own = self.starts[row] as usize..self.starts[row + 1] as usize;
            self.items[own.clone()].sort_unstable();
            self.starts[row] = kept as u32;
            for i in own {
                let item = self.items[i];
                if kept == self.starts[row] as usize || self.items[kept - 1] != item {
                    self.items[kept] = item;
                    kept += 1;
                }
            }
        }
        self.items.truncate(kept);
        if let Some(last) = self.starts.last_mut() {
            *last = kept as u32;
        }
        self
    }

    /// All items, row by row, those of a row sorted.
    pub(crate) fn into_sorted_by_key<K: Ord>(mut self, key: impl Fn(&T) -> K + Sync) -> Vec<T>
    where
        T: Send,
    {
        sort_rows(&self.starts, &mut self.items, &key);
        self.items
    }

    /// All items, row by row.
    pub(crate) fn into_items(self) -> Vec<T> {
        self.items
    }

    /// How many rows there are.
    pub(crate) fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The items of a row.
    pub(crate) fn row(&self, row: usize) -> &[T] {
        &self.items[self.starts[row] as usize..self.starts[row + 1] as usize]
    }
}

/// Rows that are worth a thread's while.
const ROWS: usize = 4096;

/// Sorts the items of each row; the first one begins where `starts` says.
fn sort_rows<T: Send, K: Ord>(starts: &[u32], items: &mut [T], key: &(impl Fn(&T) -> K + Sync)) {
    let rows = starts.len() - 1;
    if rows > ROWS {
        let (first, second) = (&starts[..=rows / 2], &starts[rows / 2..]);
        let (before, after) = items.split_at_mut((second[0] - first[0]) as usize);
        join(|| sort_rows(first, before, key), || sort_rows(second, after, key));
        return;
    }
    for row in starts.windows(2) {
        items[(row[0] - starts[0]) as usize..(row[1] - starts[0]) as usize].sort_unstable_by_key(key);
    }
}

/// Disjoint sets of the numbers below a bound (union-find with path halving): nearly linear in all.
#[derive(Clone, Debug)]
pub(crate) struct Classes {
    parent: Vec<u32>,
}

impl Classes {
    /// Every number alone.
    pub(crate) fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    /// The least number of the set.
    pub(crate) fn of(&self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            i = self.parent[i as usize];
        }
        i
    }

    /// Makes one set of two; whether they were two.
    pub(crate) fn join(&mut self, i: u32, j: u32) -> bool {
        let (i, j) = (self.shorten(i), self.shorten(j));
        self.parent[i.max(j) as usize] = i.min(j);
        i != j
    }

    /// Lets every number know its set at once: [`Classes::of`] takes one step then.
    pub(crate) fn flatten(&mut self) {
        for i in 0..self.parent.len() {
            // The parent is smaller, and so flat already.
            self.parent[i] = self.parent[self.parent[i] as usize];
        }
    }

    /// [`Classes::of`], with the way there shortened.
    pub(crate) fn shorten(&mut self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            let up = self.parent[self.parent[i as usize] as usize];
            self.parent[i as usize] = up;
            i = up;
        }
        i
    }
}

/// A table by a few numbers each, that the program made itself. What it holds must not depend on the order in which it is gone through.
pub(crate) type Table<K, V> = HashMap<K, V, BuildHasherDefault<Mixer>>;

/// Mixes numbers by multiplication, as `rustc-hash` does: the standard library's hash withstands who chooses keys to collide, and takes
/// several times as long.
#[derive(Clone, Copy, Default)]
pub(crate) struct Mixer(u64);

/// An odd number without pattern, whose multiples differ in their high bits (that of `rustc-hash`).
const MULTIPLIER: u64 = 0xf135_7aea_2e62_a9c5;
/// Brings the high bits of the product, which all bits of the keys have a say in, to where tables look.
const TURN: u32 = 26;

impl Hasher for Mixer {
    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.write_u64(u64::from_le_bytes(word));
        }
    }

    fn write_u32(&mut self, number: u32) {
        self.write_u64(u64::from(number));
    }

    fn write_u64(&mut self, number: u64) {
        self.0 = self.0.wrapping_add(number).wrapping_mul(MULTIPLIER);
    }

    fn write_usize(&mut self, number: usize) {
        self.write_u64(number as u64);
    }

    fn finish(&self) -> u64 {
        self.0.rotate_left(TURN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_stands_for_its_set() {
        let mut classes = Classes::new(7);
        assert!(classes.join(6, 4) && classes.join(4, 2) && !classes.join(6, 2));
        assert!(classes.join(1, 3) && classes.join(3, 6));
        classes.flatten();
        assert_eq!([0, 1, 2, 3, 4, 5, 6].map(|i| classes.of(i)), [0, 1, 1, 1, 1, 5, 1]);
    }

    #[test]
    fn numbers_of_neighbours_are_mixed_well() {
        use std::hash::BuildHasher;
        let by = BuildHasherDefault::<Mixer>::default();
        let quads = (0..1 << 14).map(|i: u32| [i, i + 1, i + 100, i + 101]);
        let places = quads.map(|quad| by.hash_one(quad) & ((1 << 14) - 1));
        // Thrown at random, 1 - 1/e of all places are taken.
        let taken = distinct(places).len() as f64 / f64::from(1 << 14);
        assert!(taken > 0.6, "{taken}");
    }

    #[test]
    fn items_are_in_their_rows_in_order_and_once() {
        let rows = Rows::new(4, [(2, 'a'), (0, 'b'), (2, 'c'), (3, 'd')].into_iter());
        assert_eq!([0, 1, 2, 3].map(|row| rows.row(row).to_vec()), [vec!['b'], vec![], vec!['a', 'c'], vec!['d']]);
        assert_eq!(distinct([3, 1, 3, 2, 1]), [1, 2, 3]);
        let again = Rows::new(4, [(2, 9), (0, 5), (2, 3), (2, 9), (3, 9), (0, 5)].into_iter()).distinct();
        assert_eq!([0, 1, 2, 3].map(|row| again.row(row).to_vec()), [vec![5], vec![], vec![3, 9], vec![9]]);
    }
}
