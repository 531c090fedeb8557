//! Studies over many meshes.

mod converge;
mod table;

pub use converge::{ConvergenceStudy, StudyError};
pub use table::{LevelErrors, MEASURES, Measure, fitted_rate, markdown, rate};
