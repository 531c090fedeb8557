//! Studies over many meshes: errors and their rates, solvers and their times.

pub mod comparison;
mod converge;
mod fit;
mod table;

pub use converge::{ConvergenceStudy, StudyError};
pub use fit::exponent;
pub use table::{LevelErrors, MEASURES, Measure, fitted_rate, markdown, rate};
