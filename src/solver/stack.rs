//! Solvers of a stack of membranes between obstacles.

mod active_set;
mod auto;
mod multigrid;
mod qp_solver;
mod reduced;
#[cfg(test)]
mod tests;

use super::{SolverError, SolverOptions, Statistics};
use crate::discretization::{Displacements, StackDiscretization};

/// Displacements and multipliers of a stack that nobody has checked yet.
#[derive(Debug, Clone)]
pub struct StackCandidate {
    /// Over vertices, one for each membrane from the top, fixed values included.
    pub displacement: Displacements,
    /// `y = lambda_k |D_a|` over [rows](StackDiscretization::rows). Unit: force.
    pub multiplier: Vec<f64>,
    /// How it was found.
    pub statistics: Statistics,
}

impl StackCandidate {
    /// The candidate that an answer to [`stack_qp`](crate::qp::stack_qp) stands for.
    ///
    /// # Panics
    /// When the answer has not one entry for each unknown and each row.
    pub fn from_answer(d: &StackDiscretization, answer: crate::qp::Answer, statistics: Statistics) -> Self {
        assert_eq!(answer.x.len(), d.unknowns(), "an answer has a displacement for each unknown");
        assert_eq!(answer.y.len(), d.rows().len(), "an answer has a multiplier for each row");
        Self { displacement: d.extend(&answer.x), multiplier: answer.y, statistics }
    }
}

/// Anything that solves a stack: the [active set method](super::ActiveSet), [multigrid](super::Multigrid) for one membrane with at
/// most one obstacle, the [choice](super::Auto) between them, or a [`QpBackend`](crate::qp::QpBackend) by way of
/// [`QpSolver`](super::QpSolver). The options' warm start is one of the paper's pair, and not used.
pub trait StackSolver: Send {
    /// Solves the problem, or stops early and says so in the statistics.
    ///
    /// # Errors
    /// [`SolverError`] when it cannot run at all.
    fn solve_stack(
        &mut self,
        d: &StackDiscretization,
        options: &SolverOptions,
    ) -> Result<StackCandidate, SolverError>;
}
