//! What every solver is.

use super::candidate::Candidate;
use super::error::SolverError;
use super::options::SolverOptions;
use crate::discretization::{Discretization, PairDiscretization, StackDiscretization};

/// Anything that solves contact problems: a [`QpBackend`](crate::qp::QpBackend) by way of [`QpSolver`](super::QpSolver), or a method of
/// its own.
pub trait ContactSolver: Send {
    /// The name in summaries and messages.
    fn name(&self) -> &str;

    /// Solves the paper's pair (3.4), or stops early and says so in the statistics.
    ///
    /// # Errors
    /// [`SolverError`] when it cannot run at all.
    fn solve_pair(
        &mut self,
        d: &PairDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError>;

    /// Solves any other stack, likewise.
    ///
    /// # Errors
    /// [`SolverError`] when it cannot run at all, or not for such a stack.
    fn solve_stack(
        &mut self,
        d: &StackDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError>;

    /// Solves either.
    ///
    /// # Errors
    /// [`SolverError`] when it cannot run at all, or not for such a stack.
    fn solve(&mut self, d: &Discretization, options: &SolverOptions) -> Result<Candidate, SolverError> {
        match d {
            Discretization::Pair(d) => self.solve_pair(d, options),
            Discretization::Stack(d) => self.solve_stack(d, options),
        }
    }

    /// The solver for one discretization, to be solved more than once: what can be used again is made once. As it is, nothing
    /// is kept.
    fn prepare<'s>(&'s mut self, d: &'s Discretization) -> Box<dyn PreparedSolver + 's> {
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
    d: &'s Discretization,
}

impl<S: ContactSolver + ?Sized> PreparedSolver for Unprepared<'_, S> {
    fn solve(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        self.solver.solve(self.d, options)
    }
}
