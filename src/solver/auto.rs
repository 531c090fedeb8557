//! The choice between our own solvers.

use std::time::Instant;

use super::{ActiveSet, Candidate, ContactSolver, Multigrid, SolverError, SolverOptions};
use crate::discretization::Discretization;
use crate::qp::Status;

/// Up to as many unknowns of each membrane the active set method takes no longer than multigrid, and is exact to rounding.
const SMALL: usize = 2000;

/// Without a hierarchy of meshes it is preferred a little longer: algebraic multigrid needs more cycles.
const SMALL_WITHOUT_HIERARCHY: usize = 10_000;

/// The active set method on small meshes, multigrid on others, and the active set method again where that does not converge,
/// on very stretched triangles; which and why is in [`Statistics::choice`](super::Statistics::choice).
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
            (multigrid_or_active_set(d, options)?, "many")
        };
        let solver = &candidate.statistics.solver;
        let stalled = if size == "many" && *solver != Multigrid.name() { "; multigrid stalled" } else { "" };
        let reason = format!("by auto: {size} unknowns ({unknowns} a membrane), {hierarchy}{stalled}");
        candidate.statistics.choice = Some(reason);
        Ok(candidate)
    }
}

/// Multigrid, and the active set method in the time that is left where it stalls: that needs no levels to be good.
fn multigrid_or_active_set(d: &Discretization, options: &SolverOptions) -> Result<Candidate, SolverError> {
    let start = Instant::now();
    let candidate = Multigrid.solve(d, options)?;
    let left = options.time_limit.map(|limit| limit.left_since(start));
    if candidate.statistics.status != Status::Stalled || left == Some(None) {
        return Ok(candidate);
    }
    ActiveSet.solve(d, &SolverOptions { time_limit: left.flatten(), ..options.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Pattern, rectangle};
    use crate::problem::ContactProblem;

    /// Very flat crossed cells: large positive entries off the diagonal, which no levels of multigrid are good for.
    #[test]
    fn where_multigrid_stalls_the_active_set_method_takes_over() {
        let problem =
            ContactProblem::builder().tension(1.0, 3.0).load(-1.5e5, 1e5).height(0.1).build().unwrap();
        let choice = |height: f64| {
            let mesh = rectangle([0.0, 0.0], [1.0, height], [64; 2], Pattern::Crossed).unwrap();
            let d = Discretization::new(&problem, mesh.clone()).unwrap();
            let statistics = Auto.solve(&d, &SolverOptions::default()).expect("it runs").statistics;
            assert_eq!(statistics.status, Status::Solved, "{statistics:?}");
            (statistics.solver, statistics.choice.expect("it was left open"))
        };
        let (solver, reason) = choice(0.01);
        assert_eq!(solver, ActiveSet.name());
        assert!(reason.ends_with("; multigrid stalled"), "{reason}");
        let (solver, reason) = choice(1.0);
        assert_eq!(solver, Multigrid.name());
        assert!(!reason.contains("stalled"), "{reason}");
    }
}
