//! The polish: from an approximate answer to one that is exact to rounding.
//!
//! An interior-point answer at tolerance `t` has products `y_a w_a ~ t`, but near the free boundary both factors may be
//! `sqrt(t)`: the action is then wrong by percents. The answer still tells which vertices touch, and from that guess the
//! active set method is exact after a few repairs.

use web_time::Instant;

use super::active_set::{guess, settle};
use super::unknowns::unknowns;
use crate::discretization::PairDiscretization;
use crate::qp::{KktResiduals, QpProblem};
use crate::solver::{Candidate, PolishReport, SolverOptions};

/// Polishes the candidate and keeps the result if its KKT residuals are smaller. `None` when a linear system cannot be
/// solved, or the solve has to stop.
pub(in crate::solver) fn polish(
    d: &PairDiscretization,
    qp: &QpProblem,
    candidate: &mut Candidate,
    options: &SolverOptions,
    start: Instant,
) -> Option<PolishReport> {
    let limits = options.limits_of_polish(start)?;
    let residual = |displacement: &[Vec<f64>], multiplier: &[f64]| {
        KktResiduals::new(qp, &unknowns(d, displacement), multiplier).worst()
    };
    let polished = settle(d, guess(d, &candidate.displacement, &candidate.multiplier), &limits).ok()?;
    let residual_before = residual(&candidate.displacement, &candidate.multiplier);
    let residual_after = residual(&polished.displacement, &polished.multiplier);
    let report = PolishReport::new(polished.repairs, polished.status, [residual_before, residual_after]);
    if report.kept {
        candidate.displacement = polished.displacement;
        candidate.multiplier = polished.multiplier;
    }
    Some(report)
}
