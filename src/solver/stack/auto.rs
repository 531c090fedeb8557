//! The choice between the built-in solvers of stacks.

use web_time::Instant;

use super::{StackCandidate, StackSolver};
use crate::discretization::StackDiscretization;
use crate::qp::Status;
use crate::solver::auto::small;
use crate::solver::{ActiveSet, Auto, ContactSolver, Multigrid, SolverError, SolverOptions};
use crate::text::grouped;

/// Multigrid for many unknowns of a stack that it solves, as for the pair; the active set method for others, and where multigrid
/// stalls.
impl StackSolver for Auto {
    fn solve_stack(
        &mut self,
        d: &StackDiscretization,
        options: &SolverOptions,
    ) -> Result<StackCandidate, SolverError> {
        let structure = structure(d);
        let unknowns = grouped(d.unknowns());
        let (few, hierarchy) = small(d.mesh().ancestry().len());
        let (mut candidate, reason) = if !Multigrid::solves_stack(d.membranes(), d.has_obstacles()) {
            (ActiveSet.solve_stack(d, options)?, format!("{structure} ({unknowns} unknowns)"))
        } else if d.unknowns() <= few {
            let reason = format!("{structure}, few unknowns ({unknowns}), {hierarchy}");
            (ActiveSet.solve_stack(d, options)?, reason)
        } else {
            let candidate = multigrid_or_active_set(d, options)?;
            let stalled =
                if candidate.statistics.solver == Multigrid.name() { "" } else { "; multigrid stalled" };
            (candidate, format!("{structure}, many unknowns ({unknowns}), {hierarchy}{stalled}"))
        };
        candidate.statistics.choice = Some(format!("by {}: {reason}", self.name()));
        Ok(candidate)
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

/// Multigrid, and the active set method in the time that is left where it stalls: that needs no levels to be good.
fn multigrid_or_active_set(
    d: &StackDiscretization,
    options: &SolverOptions,
) -> Result<StackCandidate, SolverError> {
    let start = Instant::now();
    let stalled = Multigrid.solve_stack(d, options)?;
    let left = options.time_limit.map(|limit| limit.left_since(start));
    if stalled.statistics.status != Status::Stalled || left == Some(None) {
        return Ok(stalled);
    }
    let options = SolverOptions { time_limit: left.flatten(), ..options.clone() };
    let mut candidate = ActiveSet.solve_stack(d, &options)?;
    let method = format!("{} on algebraic levels", Multigrid.name());
    candidate.statistics = candidate.statistics.after(method, stalled.statistics);
    Ok(candidate)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Pattern, rectangle};
    use crate::problem::{ContactProblem, Membrane};
    use crate::solver::Statistics;

    fn chosen(problem: &ContactProblem, [width, height]: [f64; 2], cells: usize) -> Statistics {
        let mesh = rectangle([0.0, 0.0], [width, height], [cells; 2], Pattern::Crossed).unwrap();
        let d = StackDiscretization::new(problem, mesh).unwrap();
        Auto.solve_stack(&d, &SolverOptions::default()).unwrap().statistics
    }

    #[test]
    fn it_depends_on_the_structure_and_on_the_unknowns() {
        let sheet = |load: f64| Membrane::new(1.0).load(load);
        let floor = ContactProblem::obstacle(sheet(-20.0), -0.1).unwrap();
        let ceiling = ContactProblem::stack().membrane(sheet(20.0)).ceiling(0.1).build().unwrap();
        let coupled = ContactProblem::stack().membrane(sheet(-9.0)).membrane(sheet(9.0)).floor(-1.0);
        let coupled = coupled.build().unwrap();
        let few = "few unknowns (481), 4 coarser meshes known";
        for (problem, cells, solver, choice) in [
            (&floor, 16, "active-set", format!("one membrane over a floor, {few}")),
            (
                &floor,
                48,
                "multigrid",
                "one membrane over a floor, many unknowns (4,513), 4 coarser meshes known".into(),
            ),
            (&ceiling, 16, "active-set", format!("one membrane under a ceiling, {few}")),
            (&coupled, 48, "active-set", "2 coupled membranes over a floor (9,026 unknowns)".into()),
        ] {
            let found = chosen(problem, [1.0; 2], cells);
            assert_eq!((found.solver.as_str(), found.status), (solver, Status::Solved));
            assert_eq!(found.choice, Some(format!("by auto: {choice}")));
        }
    }

    /// Very flat crossed cells: large positive entries off the diagonal, which no levels of multigrid are good for.
    #[test]
    fn where_multigrid_stalls_the_active_set_method_takes_over() {
        let sheet = Membrane::new(1.0).load(-5e4).height(0.1);
        let problem = ContactProblem::stack().membrane(sheet).build().unwrap();
        let found = chosen(&problem, [1.0, 0.01], 64);
        assert_eq!((found.solver.as_str(), found.status), ("active-set", Status::Solved));
        assert!(found.choice.expect("it was left open").ends_with("; multigrid stalled"));
        let methods: Vec<&str> = found.stalled.iter().map(|stalled| stalled.method.as_str()).collect();
        assert_eq!(methods, ["multigrid on levels of 6 refinements", "multigrid on algebraic levels"]);
        let found = chosen(&problem, [1.0, 1.0], 64);
        assert_eq!((found.solver.as_str(), found.stalled.len()), ("multigrid", 0));
    }
}
