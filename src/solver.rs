//! Solvers of the reduced discrete problem (3.4).

mod active_set;
mod auto;
mod candidate;
mod contact_solver;
mod decoupled;
mod error;
mod multigrid;
mod options;
mod polish;
mod qp_solver;
mod stack;
mod statistics;

pub use active_set::ActiveSet;
pub use auto::Auto;
pub use candidate::{Candidate, StartingPoint};
pub use contact_solver::{ContactSolver, PreparedSolver};
pub use error::SolverError;
pub use multigrid::Multigrid;
pub use options::SolverOptions;
pub use qp_solver::QpSolver;
pub use stack::{StackCandidate, StackSolver};
pub use statistics::{PolishReport, Stalled, Statistics};
