//! The choice between the built-in solvers.

use web_time::Instant;

use super::multigrid::PreparedMultigrid;
use super::{
    ActiveSet, Candidate, ContactSolver, Multigrid, PreparedSolver, SolverError, SolverOptions, Stalled,
};
use crate::discretization::PairDiscretization;
use crate::qp::Status;
use crate::text::grouped;

/// Up to as many unknowns of each membrane the active set method takes about as long as multigrid, and is exact to rounding
/// (`docs/performance.md` has the figures).
const SMALL: usize = 2000;

/// Without a hierarchy of meshes it is preferred a little longer: algebraic multigrid needs more cycles.
const SMALL_WITHOUT_HIERARCHY: usize = 5_000;

/// How many unknowns of a membrane are few on a mesh with so many refinements, and these in words.
pub(super) fn small(refinements: usize) -> (usize, String) {
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

    fn solve(&mut self, d: &PairDiscretization, options: &SolverOptions) -> Result<Candidate, SolverError> {
        PreparedAuto::new(d).solve(options)
    }

    fn prepare<'s>(&'s mut self, d: &'s PairDiscretization) -> Box<dyn PreparedSolver + 's> {
        Box::new(PreparedAuto::new(d))
    }
}

/// The choice for one discretization. A multigrid that has stalled is not tried again.
struct PreparedAuto<'d> {
    d: &'d PairDiscretization,
    /// Or what has stalled.
    multigrid: Result<PreparedMultigrid<'d>, Vec<Stalled>>,
}

impl<'d> PreparedAuto<'d> {
    fn new(d: &'d PairDiscretization) -> Self {
        Self { d, multigrid: Ok(PreparedMultigrid::new(d)) }
    }
}

impl PreparedSolver for PreparedAuto<'_> {
    fn solve(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        let d = self.d;
        let unknowns = d.interior().len();
        let refinements = d.mesh().ancestry().len();
        let (small, hierarchy) = small(refinements);
        let (mut candidate, size) = if unknowns <= small {
            (ActiveSet.solve(d, options)?, "few")
        } else {
            (self.multigrid_or_active_set(options)?, "many")
        };
        let stalled = if size == "many" && self.multigrid.is_err() { "; multigrid stalled" } else { "" };
        let reason =
            format!("by auto: {size} unknowns ({} a membrane), {hierarchy}{stalled}", grouped(unknowns));
        candidate.statistics.choice = Some(reason);
        Ok(candidate)
    }
}

impl PreparedAuto<'_> {
    /// Multigrid, and the active set method in the time that is left where it stalls: that needs no levels to be good.
    fn multigrid_or_active_set(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        let multigrid = match &mut self.multigrid {
            Ok(multigrid) => multigrid,
            Err(stalled) => {
                let mut candidate = ActiveSet.solve(self.d, options)?;
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
        let mut candidate =
            ActiveSet.solve(self.d, &SolverOptions { time_limit: left.flatten(), ..options.clone() })?;
        let method = format!("{} on algebraic levels", Multigrid.name());
        candidate.statistics = candidate.statistics.after(method, stalled.statistics);
        self.multigrid = Err(candidate.statistics.stalled.clone());
        Ok(candidate)
    }
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
            let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
            let mut auto = Auto;
            let mut prepared = auto.prepare(&d);
            let mut solve = || prepared.solve(&SolverOptions::default()).expect("it runs").statistics;
            let [first, second] = [solve(), solve()];
            assert_eq!([first.status, second.status], [Status::Solved; 2], "{first:?} {second:?}");
            // What has stalled in the first solve is not tried again, and the second one says so too.
            assert_eq!((&first.choice, &first.stalled), (&second.choice, &second.stalled));
            first
        };
        let found = choice(0.01);
        let reason = found.choice.expect("it was left open");
        assert_eq!(found.solver, ActiveSet.name());
        assert!(reason.ends_with("; multigrid stalled"), "{reason}");
        let methods: Vec<&str> = found.stalled.iter().map(|stalled| stalled.method.as_str()).collect();
        assert_eq!(methods, ["multigrid on levels of 6 refinements", "multigrid on algebraic levels"]);
        assert!(found.stalled.iter().all(|stalled| stalled.iterations > 0));
        let found = choice(1.0);
        let reason = found.choice.expect("it was left open");
        assert_eq!(found.solver, Multigrid.name());
        assert!(!reason.contains("stalled"), "{reason}");
        assert!(found.stalled.is_empty());
    }
}
