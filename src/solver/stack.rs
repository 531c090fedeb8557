//! Any other stack of membranes between obstacles.

mod actions;
pub(super) mod active_set;
pub(super) mod coupled;
pub(super) mod obstacle;
mod reduced;
#[cfg(test)]
mod tests;
