//! The case file: problem, mesh and solver from TOML.

mod file;
mod mesh;
mod problem;
mod section;
mod solver;

pub use file::CaseFile;
pub use mesh::MeshSource;
pub use solver::{BackendName, SolverSettings};
