//! The case file: problem, mesh and solver from TOML.

mod file;
mod identity;
mod mesh;
mod problem;
mod section;
mod solver;

pub use file::CaseFile;
pub(super) use identity::CaseId;
pub use mesh::MeshSource;
pub use solver::{SolverName, SolverSettings};
