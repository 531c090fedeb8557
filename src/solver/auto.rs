//! The choice between the built-in solvers.

use web_time::Instant;

use super::multigrid::{PreparedMultigrid, Problem};
use super::{
    ActiveSet, Candidate, ContactSolver, Multigrid, PreparedSolver, SolverError, SolverOptions, Stalled,
};
use crate::discretization::{Discretization, PairDiscretization, StackDiscretization};
use crate::qp::Status;
use crate::text::grouped;

/// Up to as many unknowns of each membrane the active set method takes about as long as multigrid, and is exact to rounding
/// (`docs/performance.md` has the figures).
const SMALL: usize = 2000;

/// Without a hierarchy of meshes it is preferred a little longer: algebraic multigrid needs more cycles.
const SMALL_WITHOUT_HIERARCHY: usize = 5_000;

/// How many unknowns of a membrane are few on a mesh with so many refinements, and these in words.
fn small(refinements: usize) -> (usize, String) {
    match refinements {
        0 => (SMALL_WITHOUT_HIERARCHY, "no coarser mesh known".into()),
        1 => (SMALL, "1 coarser mesh known".into()),
        _ => (SMALL, format!("{refinements} coarser meshes known")),
    }
}

/// The active set method on small meshes, multigrid on others, and the active set method again where that does not converge,
/// on very stretched triangles; which and why is in [`Statistics::choice`](super::Statistics::choice).
#[derive(Debug, Clone, Copy, Default)]
pub struct Auto;

impl ContactSolver for Auto {
    fn name(&self) -> &str {
        "auto"
    }

    fn solve_pair(
        &mut self,
        d: &PairDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError> {
        PreparedAuto::new(Problem::Pair(d)).solve(options)
    }

    fn solve_stack(
        &mut self,
        d: &StackDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError> {
        PreparedAuto::new(Problem::Stack(d)).solve(options)
    }

    fn prepare<'s>(&'s mut self, d: &'s Discretization) -> Box<dyn PreparedSolver + 's> {
        Box::new(PreparedAuto::new(d.into()))
    }
}

/// The choice for one discretization. A multigrid that has stalled is not tried again.
struct PreparedAuto<'d> {
    problem: Problem<'d>,
    /// Or what has stalled.
    multigrid: Result<PreparedMultigrid<'d>, Vec<Stalled>>,
}

impl<'d> PreparedAuto<'d> {
    fn new(problem: Problem<'d>) -> Self {
        Self { problem, multigrid: Ok(PreparedMultigrid::new(problem)) }
    }
}

impl PreparedSolver for PreparedAuto<'_> {
    fn solve(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        let (refinements, unknowns) = match self.problem {
            Problem::Pair(d) => (d.mesh().ancestry().len(), d.interior().len()),
            Problem::Stack(d) => (d.mesh().ancestry().len(), d.unknowns()),
        };
        let (few, hierarchy) = small(refinements);
        let by_active_set = |problem: Problem| problem.by_active_set(options);
        let (mut candidate, reason) = match self.problem {
            Problem::Stack(d) if !d.is_obstacle_problem() => {
                let reason = format!("{} ({} unknowns)", structure(d), grouped(unknowns));
                (by_active_set(self.problem)?, reason)
            }
            problem => {
                let (candidate, size) = if unknowns <= few {
                    (by_active_set(problem)?, "few")
                } else {
                    (self.multigrid_or_active_set(options)?, "many")
                };
                let stalled =
                    if size == "many" && self.multigrid.is_err() { "; multigrid stalled" } else { "" };
                let size = match problem {
                    Problem::Pair(_) => format!("{size} unknowns ({} a membrane)", grouped(unknowns)),
                    Problem::Stack(d) => format!("{}, {size} unknowns ({})", structure(d), grouped(unknowns)),
                };
                (candidate, format!("{size}, {hierarchy}{stalled}"))
            }
        };
        candidate.statistics.choice = Some(format!("by auto: {reason}"));
        Ok(candidate)
    }
}

impl PreparedAuto<'_> {
    /// Multigrid, and the active set method in the time that is left where it stalls: that needs no levels to be good.
    fn multigrid_or_active_set(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        let multigrid = match &mut self.multigrid {
            Ok(multigrid) => multigrid,
            Err(stalled) => {
                let mut candidate = self.problem.by_active_set(options)?;
                candidate.statistics.stalled.clone_from(stalled);
                return Ok(candidate);
            }
        };
        let start = Instant::now();
        let stalled = multigrid.solve(options)?;
        let left = options.time_limit.map(|limit| limit.left_since(start));
        if stalled.statistics.status != Status::Stalled || left == Some(None) {
            return Ok(stalled);
        }
        // Its levels go before the other method needs memory.
        self.multigrid = Err(Vec::new());
        let options = SolverOptions { time_limit: left.flatten(), ..options.clone() };
        let mut candidate = self.problem.by_active_set(&options)?;
        let method = format!("{} on algebraic levels", Multigrid.name());
        candidate.statistics = candidate.statistics.after(method, stalled.statistics);
        self.multigrid = Err(candidate.statistics.stalled.clone());
        Ok(candidate)
    }
}

impl Problem<'_> {
    fn by_active_set(self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        match self {
            Self::Pair(d) => ActiveSet.solve_pair(d, options),
            Self::Stack(d) => ActiveSet.solve_stack(d, options),
        }
    }
}

/// What kind of stack it is.
fn structure(d: &StackDiscretization) -> String {
    let obstacles = match d.has_obstacles() {
        [false, false] => "",
        [true, false] => " under a ceiling",
        [false, true] => " over a floor",
        [true, true] => " between a ceiling and a floor",
    };
    match d.membranes() {
        1 => format!("one membrane{obstacles}"),
        n => format!("{n} coupled membranes{obstacles}"),
    }
}

#[cfg(test)]
mod tests;
