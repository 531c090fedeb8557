//! The active set method.

use super::{Candidate, ContactSolver, SolverError, SolverOptions, pair, stack};
use crate::discretization::{PairDiscretization, StackDiscretization};

/// The contact set, found by repair of a guess: that of the warm start, else, for a pair, which is decoupled, that of the next
/// coarser level, solved likewise. In a step on any other stack, all that touches moves as one.
///
/// Works on any mesh. It ends with the exact contact set, so displacements and action are right to rounding. Every step
/// factors a matrix anew, of a pattern that is analysed once for each level. A contact set that would come back is
/// noticed, and left by single repairs.
#[derive(Debug, Clone, Copy, Default)]
pub struct ActiveSet;

impl ContactSolver for ActiveSet {
    fn name(&self) -> &str {
        "active-set"
    }

    fn solve_pair(
        &mut self,
        d: &PairDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError> {
        pair::active_set::solve(d, self.name(), options)
    }

    fn solve_stack(
        &mut self,
        d: &StackDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError> {
        stack::active_set::solve(d, self.name(), options)
    }
}
