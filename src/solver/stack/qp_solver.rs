//! Any QP backend as a solver of stacks.

use web_time::Instant;

use super::active_set::{guess, settle};
use super::{StackCandidate, StackSolver};
use crate::discretization::StackDiscretization;
use crate::qp::{KktResiduals, QpProblem, stack_qp};
use crate::solver::polish::limits;
use crate::solver::{PolishReport, QpSolver, SolverError, SolverOptions};

impl StackSolver for QpSolver {
    fn solve_stack(
        &mut self,
        d: &StackDiscretization,
        options: &SolverOptions,
    ) -> Result<StackCandidate, SolverError> {
        options.check()?;
        let start = Instant::now();
        let qp = stack_qp(d);
        let (answer, statistics) = self.answer(&qp, options, None, start)?;
        let mut candidate = StackCandidate::from_answer(d, answer, statistics);
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
    let limits = limits(options, start)?;
    let residual = |u: &[Vec<f64>], y: &[f64]| KktResiduals::new(qp, &d.restrict(u), y).worst();
    let polished = settle(d, guess(d, &candidate.displacement, &candidate.multiplier), &limits).ok()?;
    let before = residual(&candidate.displacement, &candidate.multiplier);
    let after = residual(&polished.equilibrium.displacement, &polished.equilibrium.multiplier);
    let report = PolishReport::new(polished.repairs, polished.status, [before, after]);
    if report.kept {
        candidate.displacement = polished.equilibrium.displacement;
        candidate.multiplier = polished.equilibrium.multiplier;
    }
    Some(report)
}
