//! Solvers of the discrete problem: of the paper's pair (3.4), and of any other stack.

mod active_set;
mod auto;
mod candidate;
mod contact_solver;
mod error;
mod multigrid;
mod options;
mod pair;
mod qp_solver;
mod repair;
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
pub use statistics::{PolishReport, Stalled, Statistics};
