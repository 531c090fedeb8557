//! Any other stack of membranes between obstacles.

pub(super) mod active_set;
pub(super) mod multigrid;
mod reduced;
#[cfg(test)]
mod tests;
