//! The polish: from an approximate answer to one that is exact to rounding.
//!
//! An interior-point answer at tolerance `t` has products `y_a w_a ~ t`, but near the free boundary both factors may be
//! `sqrt(t)`: the action is then wrong by percents. The answer still tells which vertices touch, and from that guess the
//! active set method is exact after a few repairs.

use web_time::Instant;

use super::SolverOptions;
use super::active_set::{guess, settle};
use super::candidate::{Candidate, unknowns};
use super::statistics::PolishReport;
use crate::discretization::{Displacement, PairDiscretization};
use crate::qp::{KktResiduals, Limits, QpProblem};

/// Linear solves for the gap. An accurate answer needs one to four; where the membranes touch without pushing, the contact
/// set moves by one layer of vertices at a time. A solve costs about a hundredth of an interior-point solve.
const MAX_STEPS: usize = 100;

/// Polishes the candidate and keeps the result if its KKT residuals are smaller. `None` when a linear system cannot be
/// solved, or the solve has to stop.
pub(super) fn polish(
    d: &PairDiscretization,
    qp: &QpProblem,
    candidate: &mut Candidate,
    options: &SolverOptions,
    start: Instant,
) -> Option<PolishReport> {
    let limits = limits(options, start)?;
    let residual = |displacement: &Displacement, multiplier: &[f64]| {
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

/// Those of a polish in a solve that has begun at `start`: the limit of iterations is the backend's. `None` where no time is left.
pub(super) fn limits(options: &SolverOptions, start: Instant) -> Option<Limits> {
    let limits = options.limits(MAX_STEPS, start).with_iterations(MAX_STEPS);
    limits.reached(0).is_none().then_some(limits)
}
