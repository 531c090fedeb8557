//! Work on all cores, or, without the feature `parallel`, on one: the same results either way.

mod blocks;
#[cfg(not(feature = "parallel"))]
mod sequential;

pub(crate) use blocks::{BLOCK, blocks, blocks_of, concat, sums};

#[cfg(feature = "parallel")]
pub(crate) use rayon::{join, prelude, scope};
#[cfg(not(feature = "parallel"))]
pub(crate) use sequential::{join, prelude, scope};

/// For the record of a comparison.
#[cfg(all(feature = "files", feature = "parallel"))]
pub(crate) use rayon::current_num_threads;
#[cfg(all(feature = "files", not(feature = "parallel")))]
pub(crate) use sequential::current_num_threads;
