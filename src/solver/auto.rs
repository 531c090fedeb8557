//! The choice between our own solvers.

use super::{ActiveSet, Candidate, ContactSolver, Multigrid, SolverError, SolverOptions};
use crate::discretization::Discretization;

/// Up to as many unknowns of each membrane the active set method takes no longer than multigrid, and is exact to rounding.
const SMALL: usize = 2000;

/// Without a hierarchy of meshes it is preferred a little longer: algebraic multigrid needs more cycles.
const SMALL_WITHOUT_HIERARCHY: usize = 10_000;

/// The active set method on small meshes, multigrid on others; which and why is in
/// [`Statistics::choice`](super::Statistics::choice).
#[derive(Debug, Clone, Copy, Default)]
pub struct Auto;

impl ContactSolver for Auto {
    fn name(&self) -> &str {
        "auto"
    }

    fn solve(&mut self, d: &Discretization, options: &SolverOptions) -> Result<Candidate, SolverError> {
        let unknowns = d.interior().len();
        let refinements = d.mesh().ancestry().len();
        let (small, hierarchy) = match refinements {
            0 => (SMALL_WITHOUT_HIERARCHY, "no coarser mesh known".to_string()),
            1 => (SMALL, "1 coarser mesh known".to_string()),
            _ => (SMALL, format!("{refinements} coarser meshes known")),
        };
        let (mut candidate, size) = if unknowns <= small {
            (ActiveSet.solve(d, options)?, "few")
        } else {
            (Multigrid.solve(d, options)?, "many")
        };
        let reason = format!("by auto: {size} unknowns ({unknowns} a membrane), {hierarchy}");
        candidate.statistics.choice = Some(reason);
        Ok(candidate)
    }
}
