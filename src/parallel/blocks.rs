//! Work cut into blocks: enough in each to be worth a thread, and the same blocks for every number of threads.

use std::ops::Range;

use super::prelude::*;
use super::scope;

/// Vertices, triangles or rows that are worked on together.
pub(crate) const BLOCK: usize = 4096;

/// `0..count` in blocks of [`BLOCK`].
pub(crate) fn blocks(count: usize) -> Vec<Range<usize>> {
    blocks_of(BLOCK, count)
}

/// `0..count` in blocks of `size`.
pub(crate) fn blocks_of(size: usize, count: usize) -> Vec<Range<usize>> {
    (0..count).step_by(size).map(|first| first..(first + size).min(count)).collect()
}

/// Blocks put together, all of them at once.
pub(crate) fn concat<T: Copy + Default + Send + Sync>(blocks: Vec<&[T]>) -> Vec<T> {
    let mut all = vec![T::default(); blocks.iter().map(|block| block.len()).sum()];
    let mut rest = all.as_mut_slice();
    scope(|scope| {
        for block in blocks {
            let place = rest.split_off_mut(..block.len()).expect("blocks are parts of the whole");
            scope.spawn(move |_| place.copy_from_slice(block));
        }
    });
    all
}

/// `term(0) + ... + term(count - 1)`, in parallel, in an order that does not depend on the number of threads.
pub(crate) fn sums<const N: usize>(count: usize, term: impl Fn(usize) -> [f64; N] + Sync) -> [f64; N] {
    // From zero: `sum` makes a negative zero of nothing.
    let plus = |sums: [f64; N], terms: [f64; N]| std::array::from_fn(|i| sums[i] + terms[i]);
    let of_block = |block: Range<usize>| block.map(&term).fold([0.0; N], plus);
    let of_blocks: Vec<[f64; N]> = blocks(count).into_par_iter().map(of_block).collect();
    of_blocks.into_iter().fold([0.0; N], plus)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_all_of_it_in_order() {
        assert!(blocks(0).is_empty());
        for count in [1, BLOCK, BLOCK + 1, 3 * BLOCK - 1] {
            let blocks = blocks(count);
            assert!(blocks.iter().all(|block| !block.is_empty() && block.len() <= BLOCK));
            assert!(blocks.into_iter().flatten().eq(0..count), "{count}");
        }
    }

    #[test]
    fn blocks_are_put_together_in_order() {
        let numbers: Vec<usize> = (0..3 * BLOCK + 5).collect();
        let parts = |[first, second]: [usize; 2]| {
            vec![&numbers[..first], &numbers[first..second], &numbers[second..]]
        };
        assert_eq!(concat(parts([BLOCK, 2 * BLOCK + 1])), numbers);
        assert_eq!(concat(parts([0, 0])), numbers);
        assert!(concat::<usize>(Vec::new()).is_empty());
        assert_ne!(concat(parts([BLOCK, BLOCK]).into_iter().rev().collect()), numbers);
    }

    #[test]
    fn sums_have_one_order_with_every_number_of_threads() {
        // Terms whose sum depends on its order.
        let term = |k: usize| [(1.0 + k as f64).recip() * if k.is_multiple_of(3) { 1e9 } else { 1.0 }, 1.0];
        let count = 5 * BLOCK + 7;
        let with_threads = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| sums(count, term))
        };
        assert_eq!(with_threads(1), with_threads(4));
        assert_eq!(with_threads(1)[1], count as f64);
        let at_once = (0..count).map(term).fold(0.0, |sum, [value, _]| sum + value);
        assert_ne!(with_threads(1)[0], at_once, "the order matters here");
    }
}
