//! Studies over many meshes: errors and their rates, meshes that follow the error, solvers and their times.

mod accuracy;
mod adapt;
#[cfg(feature = "files")]
pub mod comparison;
mod converge;
mod fit;
mod marking;
mod prolongation;
mod solve;
mod stack;
mod table;

pub use accuracy::{AccuracyError, Bounded, Tolerance, solve_bounded};
pub use adapt::{AdaptiveLevel, AdaptiveStudy, Checkpoint};
pub use converge::{ConvergenceStudy, StudyError};
pub use fit::exponent;
pub use marking::mark;
pub use solve::{SolveError, Solved, solve};
pub use stack::StackStudy;
pub use table::{LevelErrors, MEASURES, Measure, fitted_rate, markdown, measures, rate};
