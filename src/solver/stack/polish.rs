//! The polish of an answer for a stack.

use web_time::Instant;

use super::active_set::{guess, settle};
use crate::discretization::StackDiscretization;
use crate::qp::{KktResiduals, QpProblem};
use crate::solver::{Candidate, PolishReport, SolverOptions};

/// Polishes the candidate and keeps the result if its KKT residuals are smaller; as for the pair.
pub(in crate::solver) fn polish(
    d: &StackDiscretization,
    qp: &QpProblem,
    candidate: &mut Candidate,
    options: &SolverOptions,
    start: Instant,
) -> Option<PolishReport> {
    let limits = options.limits_of_polish(start)?;
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
