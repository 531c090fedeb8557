//! Any QP backend as a solver of stacks.

use web_time::Instant;

use super::active_set::{guess, settle};
use super::{StackCandidate, StackSolver};
use crate::discretization::StackDiscretization;
use crate::qp::{Answer, KktResiduals, QpOptions, QpProblem, Status, TimeLimit, stack_qp};
use crate::solver::polish::MAX_STEPS;
use crate::solver::qp_solver::solve_nondimensional;
use crate::solver::{ContactSolver, PolishReport, QpSolver, SolverError, SolverOptions, Statistics};

impl StackSolver for QpSolver {
    fn solve_stack(
        &mut self,
        d: &StackDiscretization,
        options: &SolverOptions,
    ) -> Result<StackCandidate, SolverError> {
        options.check()?;
        let start = Instant::now();
        let qp = stack_qp(d);
        let posing = start.elapsed().as_secs_f64();
        let asked = QpOptions {
            tolerance: options.tolerance,
            max_iterations: options.max_iterations,
            time_limit: options
                .time_limit
                .map(|limit| limit.left_since(start).unwrap_or(TimeLimit::SHORTEST)),
            interrupt: options.interrupt.clone(),
            warm_start: None,
        };
        let solution = solve_nondimensional(self.backend_mut(), &qp, &asked)?;
        let statistics = Statistics {
            iterations: solution.iterations,
            setup_seconds: posing + solution.setup_seconds,
            ..Statistics::of(self.name(), solution.status)
        };
        let mut candidate =
            StackCandidate::from_answer(d, Answer { x: solution.x, y: solution.y }, statistics);
        if options.polish {
            candidate.statistics.polish = polish(d, &qp, &mut candidate, options, start);
        }
        candidate.statistics.solve_seconds =
            start.elapsed().as_secs_f64() - candidate.statistics.setup_seconds;
        Ok(candidate)
    }
}

/// Polishes the candidate and keeps the result if its KKT residuals are smaller; see [`solver::polish`](crate::solver::polish).
fn polish(
    d: &StackDiscretization,
    qp: &QpProblem,
    candidate: &mut StackCandidate,
    options: &SolverOptions,
    start: Instant,
) -> Option<PolishReport> {
    // The limit of iterations is the backend's.
    let limits = options.limits(MAX_STEPS, start).with_iterations(MAX_STEPS);
    if limits.reached(0).is_some() {
        return None;
    }
    let residual = |u: &[Vec<f64>], y: &[f64]| KktResiduals::new(qp, &d.restrict(u), y).worst();
    let polished = settle(d, guess(d, &candidate.displacement, &candidate.multiplier), &limits).ok()?;
    let residual_before = residual(&candidate.displacement, &candidate.multiplier);
    let residual_after = residual(&polished.equilibrium.displacement, &polished.equilibrium.multiplier);
    let kept = residual_after < residual_before;
    if kept {
        candidate.displacement = polished.equilibrium.displacement;
        candidate.multiplier = polished.equilibrium.multiplier;
    }
    Some(PolishReport {
        kept,
        repairs: polished.repairs,
        settled: polished.status == Status::Solved,
        residual_before,
        residual_after,
    })
}
