//! Loops on one core, with the names that rayon has for those on all: iterators of the standard library, and what they do not have.

use std::slice::{Chunks, ChunksMut, Iter, IterMut};

/// Runs both, one after the other.
pub(crate) fn join<A, B>(one: impl FnOnce() -> A, other: impl FnOnce() -> B) -> (A, B) {
    (one(), other())
}

/// What becomes a loop.
pub(crate) trait IntoParallelIterator: IntoIterator + Sized {
    /// The loop over all.
    fn into_par_iter(self) -> Self::IntoIter {
        self.into_iter()
    }
}

impl<C: IntoIterator> IntoParallelIterator for C {}

/// Loops over slices.
pub(crate) trait ParallelSlice<T> {
    /// Over references.
    fn par_iter(&self) -> Iter<'_, T>;

    /// Over references that may be written to.
    fn par_iter_mut(&mut self) -> IterMut<'_, T>;

    /// Over parts of this length.
    fn par_chunks(&self, length: usize) -> Chunks<'_, T>;

    /// The same, to be written to.
    fn par_chunks_mut(&mut self, length: usize) -> ChunksMut<'_, T>;

    /// Sorts; equal ones in any order.
    fn par_sort_unstable(&mut self)
    where
        T: Ord;
}

impl<T> ParallelSlice<T> for [T] {
    fn par_iter(&self) -> Iter<'_, T> {
        self.iter()
    }

    fn par_iter_mut(&mut self) -> IterMut<'_, T> {
        self.iter_mut()
    }

    fn par_chunks(&self, length: usize) -> Chunks<'_, T> {
        self.chunks(length)
    }

    fn par_chunks_mut(&mut self, length: usize) -> ChunksMut<'_, T> {
        self.chunks_mut(length)
    }

    fn par_sort_unstable(&mut self)
    where
        T: Ord,
    {
        self.sort_unstable();
    }
}

/// Methods that loops on all cores have.
pub(crate) trait ParallelIterator: Iterator + Sized {
    /// Parts are as long as can be.
    fn with_min_len(self, _least: usize) -> Self {
        self
    }

    /// With a state that is made once.
    fn map_init<S, B>(
        self,
        init: impl FnOnce() -> S,
        mut f: impl FnMut(&mut S, Self::Item) -> B,
    ) -> impl Iterator<Item = B> {
        let mut state = init();
        self.map(move |item| f(&mut state, item))
    }

    fn flat_map_iter<B: IntoIterator>(self, f: impl FnMut(Self::Item) -> B) -> impl Iterator<Item = B::Item> {
        self.flat_map(f)
    }

    fn flatten_iter(self) -> impl Iterator<Item = <Self::Item as IntoIterator>::Item>
    where
        Self::Item: IntoIterator,
    {
        self.flatten()
    }

    fn find_map_first<B>(mut self, f: impl FnMut(Self::Item) -> Option<B>) -> Option<B> {
        self.find_map(f)
    }
}

impl<I: Iterator> ParallelIterator for I {}
