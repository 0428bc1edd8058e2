//! Loops on one core, with the names that rayon has for those on all.

use std::iter;

/// Runs both, one after the other.
pub(crate) fn join<A, B>(one: impl FnOnce() -> A, other: impl FnOnce() -> B) -> (A, B) {
    (one(), other())
}

/// An iterator that has rayon's methods where those of the standard library differ.
pub(crate) struct Plain<I>(I);

/// What becomes a loop.
pub(crate) trait IntoParallelIterator {
    /// The iterator within.
    type Iter: Iterator;

    /// The loop over all.
    fn into_par_iter(self) -> Plain<Self::Iter>;
}

impl<C: IntoIterator> IntoParallelIterator for C {
    type Iter = C::IntoIter;

    fn into_par_iter(self) -> Plain<Self::Iter> {
        Plain(self.into_iter())
    }
}

impl<I: Iterator> IntoParallelIterator for Plain<I> {
    type Iter = I;

    fn into_par_iter(self) -> Self {
        self
    }
}

/// Loops over slices.
pub(crate) trait ParallelSlice<T> {
    /// Over references.
    fn par_iter(&self) -> Plain<std::slice::Iter<'_, T>>;

    /// Over references that may be written to.
    fn par_iter_mut(&mut self) -> Plain<std::slice::IterMut<'_, T>>;

    /// Over parts of this length.
    fn par_chunks(&self, length: usize) -> Plain<std::slice::Chunks<'_, T>>;

    /// Over parts of this length that may be written to.
    fn par_chunks_mut(&mut self, length: usize) -> Plain<std::slice::ChunksMut<'_, T>>;

    /// Sorts; equal ones in any order.
    fn par_sort_unstable(&mut self)
    where
        T: Ord;
}

impl<T> ParallelSlice<T> for [T] {
    fn par_iter(&self) -> Plain<std::slice::Iter<'_, T>> {
        Plain(self.iter())
    }

    fn par_iter_mut(&mut self) -> Plain<std::slice::IterMut<'_, T>> {
        Plain(self.iter_mut())
    }

    fn par_chunks(&self, length: usize) -> Plain<std::slice::Chunks<'_, T>> {
        Plain(self.chunks(length))
    }

    fn par_chunks_mut(&mut self, length: usize) -> Plain<std::slice::ChunksMut<'_, T>> {
        Plain(self.chunks_mut(length))
    }

    fn par_sort_unstable(&mut self)
    where
        T: Ord,
    {
        self.sort_unstable();
    }
}

impl<I: Iterator> Plain<I> {
    /// Parts are as long as can be.
    pub(crate) fn with_min_len(self, _least: usize) -> Self {
        self
    }

    pub(crate) fn map<B>(self, f: impl FnMut(I::Item) -> B) -> Plain<impl Iterator<Item = B>> {
        Plain(self.0.map(f))
    }

    /// With a state that is made once.
    pub(crate) fn map_init<S, B>(
        self,
        init: impl FnOnce() -> S,
        mut f: impl FnMut(&mut S, I::Item) -> B,
    ) -> Plain<impl Iterator<Item = B>> {
        let mut state = init();
        Plain(self.0.map(move |item| f(&mut state, item)))
    }

    pub(crate) fn filter(self, f: impl FnMut(&I::Item) -> bool) -> Plain<impl Iterator<Item = I::Item>> {
        Plain(self.0.filter(f))
    }

    pub(crate) fn filter_map<B>(self, f: impl FnMut(I::Item) -> Option<B>) -> Plain<impl Iterator<Item = B>> {
        Plain(self.0.filter_map(f))
    }

    pub(crate) fn flat_map_iter<B: IntoIterator>(
        self,
        f: impl FnMut(I::Item) -> B,
    ) -> Plain<impl Iterator<Item = B::Item>> {
        Plain(self.0.flat_map(f))
    }

    pub(crate) fn flatten_iter(self) -> Plain<iter::Flatten<I>>
    where
        I::Item: IntoIterator,
    {
        Plain(self.0.flatten())
    }

    pub(crate) fn zip<O: IntoParallelIterator>(self, other: O) -> Plain<iter::Zip<I, O::Iter>> {
        Plain(self.0.zip(other.into_par_iter().0))
    }

    pub(crate) fn enumerate(self) -> Plain<iter::Enumerate<I>> {
        Plain(self.0.enumerate())
    }

    pub(crate) fn collect<C: FromIterator<I::Item>>(self) -> C {
        self.0.collect()
    }

    pub(crate) fn all(mut self, f: impl FnMut(I::Item) -> bool) -> bool {
        self.0.all(f)
    }

    pub(crate) fn find_map_first<B>(mut self, f: impl FnMut(I::Item) -> Option<B>) -> Option<B> {
        self.0.find_map(f)
    }

    pub(crate) fn for_each(self, f: impl FnMut(I::Item)) {
        self.0.for_each(f);
    }

    /// With a state that is made once.
    pub(crate) fn for_each_init<S>(self, init: impl FnOnce() -> S, mut f: impl FnMut(&mut S, I::Item)) {
        let mut state = init();
        self.0.for_each(move |item| f(&mut state, item));
    }
}
