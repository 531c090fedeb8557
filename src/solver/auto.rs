//! The choice between the built-in solvers.

use web_time::Instant;

use super::multigrid::PreparedMultigrid;
use super::{
    ActiveSet, Candidate, ContactSolver, Multigrid, PreparedSolver, SolverError, SolverOptions, Stalled,
};
use crate::discretization::{Discretization, PairDiscretization, StackDiscretization, Structure};
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
        PreparedAuto::new(Structure::Pair(d)).solve(options)
    }

    fn solve_stack(
        &mut self,
        d: &StackDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError> {
        PreparedAuto::new(d.into()).solve(options)
    }

    fn prepare<'s>(&'s mut self, d: &'s Discretization) -> Box<dyn PreparedSolver + 's> {
        Box::new(PreparedAuto::new(d.structure()))
    }
}

/// The choice for one discretization. A multigrid that has stalled is not tried again.
struct PreparedAuto<'d> {
    structure: Structure<'d>,
    /// Or what has stalled.
    multigrid: Result<PreparedMultigrid<'d>, Vec<Stalled>>,
}

impl<'d> PreparedAuto<'d> {
    fn new(structure: Structure<'d>) -> Self {
        Self { structure, multigrid: Ok(PreparedMultigrid::new(structure)) }
    }
}

impl PreparedSolver for PreparedAuto<'_> {
    fn solve(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        let (kind, unknowns) = match self.structure {
            Structure::Obstacle(d) | Structure::Coupled(d) => (Some(kind(d)), d.unknowns()),
            Structure::Pair(d) => (None, d.interior().len()),
        };
        let (few, hierarchy) = small(self.structure.mesh().ancestry().len());
        let (candidate, size) = if unknowns <= few {
            (by_active_set(self.structure, options)?, "few")
        } else {
            (self.multigrid_or_active_set(options)?, "many")
        };
        let stalled = if size == "many" && self.multigrid.is_err() { "; multigrid stalled" } else { "" };
        let unknowns = grouped(unknowns);
        let size = match kind {
            None => format!("{size} unknowns ({unknowns} a membrane)"),
            Some(kind) => format!("{kind}, {size} unknowns ({unknowns})"),
        };
        Ok(chosen(candidate, &format!("{size}, {hierarchy}{stalled}")))
    }
}

/// The candidate with the reason for which its solver was chosen.
fn chosen(mut candidate: Candidate, reason: &str) -> Candidate {
    candidate.statistics.choice = Some(format!("by auto: {reason}"));
    candidate
}

impl PreparedAuto<'_> {
    /// Multigrid, and the active set method in the time that is left where it stalls: that needs no levels to be good.
    fn multigrid_or_active_set(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        let multigrid = match &mut self.multigrid {
            Ok(multigrid) => multigrid,
            Err(stalled) => {
                let mut candidate = by_active_set(self.structure, options)?;
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
        let mut candidate = by_active_set(self.structure, &options)?;
        let method = format!("{} on algebraic levels", Multigrid.name());
        candidate.statistics = candidate.statistics.after(method, stalled.statistics);
        self.multigrid = Err(candidate.statistics.stalled.clone());
        Ok(candidate)
    }
}

fn by_active_set(structure: Structure, options: &SolverOptions) -> Result<Candidate, SolverError> {
    match structure {
        Structure::Pair(d) => ActiveSet.solve_pair(d, options),
        Structure::Obstacle(d) | Structure::Coupled(d) => ActiveSet.solve_stack(d, options),
    }
}

/// What kind of stack it is.
fn kind(d: &StackDiscretization) -> String {
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
