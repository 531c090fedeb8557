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
            0 => (SMALL_WITHOUT_HIERARCHY, "no coarser mesh is known".to_string()),
            _ => (SMALL, format!("the mesh has been refined {refinements} times")),
        };
        let size = format!("{unknowns} unknowns of each membrane");
        let (mut candidate, reason) = if unknowns <= small {
            (ActiveSet.solve(d, options)?, format!("{size} are few"))
        } else {
            (Multigrid.solve(d, options)?, format!("{size} are many, {hierarchy}"))
        };
        candidate.statistics.choice = Some(reason);
        Ok(candidate)
    }
}
