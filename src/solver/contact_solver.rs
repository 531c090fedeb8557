//! What every solver is.

use super::candidate::Candidate;
use super::error::SolverError;
use super::options::SolverOptions;
use crate::discretization::PairDiscretization;

/// Anything that solves (3.4): a [`QpBackend`](crate::qp::QpBackend) by way of [`QpSolver`](super::QpSolver), or a method of its own.
pub trait ContactSolver: Send {
    /// The name in summaries and messages.
    fn name(&self) -> &str;

    /// Solves the problem, or stops early and says so in the statistics.
    ///
    /// # Errors
    /// [`SolverError`] when it cannot run at all.
    fn solve(&mut self, d: &PairDiscretization, options: &SolverOptions) -> Result<Candidate, SolverError>;

    /// The solver for one discretization, to be solved more than once: what can be used again is made once. As it is, nothing
    /// is kept.
    fn prepare<'s>(&'s mut self, d: &'s PairDiscretization) -> Box<dyn PreparedSolver + 's> {
        Box::new(Unprepared { solver: self, d })
    }
}

/// A solver together with the one discretization that it solves.
pub trait PreparedSolver {
    /// Solves the problem, likewise.
    ///
    /// # Errors
    /// [`SolverError`] when it cannot run at all.
    fn solve(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError>;
}

/// A solver that keeps nothing.
struct Unprepared<'s, S: ?Sized> {
    solver: &'s mut S,
    d: &'s PairDiscretization,
}

impl<S: ContactSolver + ?Sized> PreparedSolver for Unprepared<'_, S> {
    fn solve(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        self.solver.solve(self.d, options)
    }
}
