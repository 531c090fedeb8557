//! What is used of rayon, on one thread.

/// The traits, as in `rayon::prelude`.
pub(crate) mod prelude {
    pub(crate) use super::{IntoParallelIterator, ParallelSlice, ParallelSliceMut};
}

#[cfg(feature = "files")]
pub(crate) fn current_num_threads() -> usize {
    1
}

pub(crate) fn join<A, B>(one: impl FnOnce() -> A, other: impl FnOnce() -> B) -> (A, B) {
    (one(), other())
}

/// Where tasks are spawned: each is done at once.
pub(crate) struct Scope;

impl Scope {
    pub(crate) fn spawn(&self, task: impl FnOnce(&Self)) {
        task(self);
    }
}

pub(crate) fn scope<R>(tasks: impl FnOnce(&Scope) -> R) -> R {
    tasks(&Scope)
}

/// An iterator under the names that rayon gives to its methods.
pub(crate) struct Sequential<I>(I);

impl<I: Iterator> Sequential<I> {
    pub(crate) fn with_min_len(self, _: usize) -> Self {
        self
    }

    pub(crate) fn map<B, F: FnMut(I::Item) -> B>(self, f: F) -> Sequential<std::iter::Map<I, F>> {
        Sequential(self.0.map(f))
    }

    pub(crate) fn map_init<T, B>(
        self,
        init: impl Fn() -> T,
        mut f: impl FnMut(&mut T, I::Item) -> B,
    ) -> Sequential<impl Iterator<Item = B>> {
        let mut state = init();
        Sequential(self.0.map(move |item| f(&mut state, item)))
    }

    pub(crate) fn filter<F: FnMut(&I::Item) -> bool>(self, f: F) -> Sequential<std::iter::Filter<I, F>> {
        Sequential(self.0.filter(f))
    }

    pub(crate) fn enumerate(self) -> Sequential<std::iter::Enumerate<I>> {
        Sequential(self.0.enumerate())
    }

    pub(crate) fn zip<J: IntoIterator>(self, other: J) -> Sequential<std::iter::Zip<I, J::IntoIter>> {
        Sequential(self.0.zip(other))
    }

    pub(crate) fn all(mut self, f: impl FnMut(I::Item) -> bool) -> bool {
        self.0.all(f)
    }

    pub(crate) fn chain<J>(self, other: J) -> Sequential<std::iter::Chain<I, J::IntoIter>>
    where
        J: IntoIterator<Item = I::Item>,
    {
        Sequential(self.0.chain(other))
    }

    pub(crate) fn for_each(self, f: impl FnMut(I::Item)) {
        self.0.for_each(f);
    }

    pub(crate) fn reduce(
        self,
        identity: impl Fn() -> I::Item,
        f: impl FnMut(I::Item, I::Item) -> I::Item,
    ) -> I::Item {
        self.0.fold(identity(), f)
    }

    pub(crate) fn max(self) -> Option<I::Item>
    where
        I::Item: Ord,
    {
        self.0.max()
    }

    pub(crate) fn count(self) -> usize {
        self.0.count()
    }

    pub(crate) fn collect<C: FromIterator<I::Item>>(self) -> C {
        self.0.collect()
    }
}

impl<I: Iterator> IntoIterator for Sequential<I> {
    type Item = I::Item;
    type IntoIter = I;

    fn into_iter(self) -> I {
        self.0
    }
}

pub(crate) trait IntoParallelIterator: IntoIterator + Sized {
    fn into_par_iter(self) -> Sequential<Self::IntoIter> {
        Sequential(self.into_iter())
    }
}

impl<I: IntoIterator> IntoParallelIterator for I {}

pub(crate) trait ParallelSlice<T> {
    fn par_iter(&self) -> Sequential<std::slice::Iter<'_, T>>;
    fn par_chunks(&self, size: usize) -> Sequential<std::slice::Chunks<'_, T>>;
}

impl<T> ParallelSlice<T> for [T] {
    fn par_iter(&self) -> Sequential<std::slice::Iter<'_, T>> {
        Sequential(self.iter())
    }

    fn par_chunks(&self, size: usize) -> Sequential<std::slice::Chunks<'_, T>> {
        Sequential(self.chunks(size))
    }
}

pub(crate) trait ParallelSliceMut<T> {
    fn par_iter_mut(&mut self) -> Sequential<std::slice::IterMut<'_, T>>;
    fn par_chunks_mut(&mut self, size: usize) -> Sequential<std::slice::ChunksMut<'_, T>>;
    fn par_sort_unstable_by(&mut self, order: impl FnMut(&T, &T) -> std::cmp::Ordering);
}

impl<T> ParallelSliceMut<T> for [T] {
    fn par_iter_mut(&mut self) -> Sequential<std::slice::IterMut<'_, T>> {
        Sequential(self.iter_mut())
    }

    fn par_chunks_mut(&mut self, size: usize) -> Sequential<std::slice::ChunksMut<'_, T>> {
        Sequential(self.chunks_mut(size))
    }

    fn par_sort_unstable_by(&mut self, order: impl FnMut(&T, &T) -> std::cmp::Ordering) {
        self.sort_unstable_by(order);
    }
}
