//! Multigrid for stacks: any number of membranes between obstacles, all at once.
//!
//! Section 4 of the notes on stacks (Graeser, Kornhuber, J. Comput. Math. 27 (2009) 1, for more than one membrane).

mod chain;
mod coarse;
mod conjugate;
mod cycles;
mod galerkin;
mod level;
mod levels;
mod matrix;
mod partition;
mod reduced;
mod settle;
mod sweep;
#[cfg(test)]
mod tests;

pub(crate) use cycles::{MAX_CYCLES, StackGoal, solve};
pub(crate) use levels::StackLevels;
