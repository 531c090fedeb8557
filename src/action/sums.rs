//! Sums over many vertices.

use crate::parallel::prelude::*;

/// Terms that are added up together.
const BLOCK: usize = 4096;

/// `term(0) + ... + term(count - 1)`, in parallel, in an order that does not depend on the number of threads.
pub(super) fn sums<const N: usize>(count: usize, term: impl Fn(usize) -> [f64; N] + Sync) -> [f64; N] {
    // From zero: `sum` makes a negative zero of nothing.
    let plus = |sums: [f64; N], terms: [f64; N]| std::array::from_fn(|i| sums[i] + terms[i]);
    let of_block =
        |block: usize| (block * BLOCK..((block + 1) * BLOCK).min(count)).map(&term).fold([0.0; N], plus);
    let blocks: Vec<[f64; N]> = (0..count.div_ceil(BLOCK)).into_par_iter().map(of_block).collect();
    blocks.into_iter().fold([0.0; N], plus)
}
