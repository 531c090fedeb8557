//! The polish: from an approximate answer to one that is exact to rounding.
//!
//! An interior-point answer at tolerance `t` has products `y_a w_a ~ t`, but near the free boundary both factors may be
//! `sqrt(t)`: the action is then wrong by percents. The answer still tells which vertices touch, and from that guess the
//! active set method is exact after a few repairs.

use crate::multigrid::cholesky::NotFactored;
use crate::qp::{KktResiduals, QpProblem};
use crate::solver::repair::Settled;
use crate::solver::{Candidate, PolishReport};

/// Keeps what the active set method has made of the candidate if its KKT residuals are smaller; `unknowns` are those of displacements in
/// the program. `None` when a linear system could not be solved.
pub(super) fn polish(
    qp: &QpProblem,
    candidate: &mut Candidate,
    unknowns: impl Fn(&[Vec<f64>]) -> Vec<f64>,
    settled: Result<Settled, NotFactored>,
) -> Option<PolishReport> {
    let residual = |u: &[Vec<f64>], y: &[f64]| KktResiduals::new(qp, &unknowns(u), y).worst();
    let polished = settled.ok()?;
    let before = residual(&candidate.displacement, &candidate.multiplier);
    let after = residual(&polished.displacement, &polished.multiplier);
    let report = PolishReport::new(polished.repairs, polished.status, [before, after]);
    if report.kept {
        candidate.displacement = polished.displacement;
        candidate.multiplier = polished.multiplier;
    }
    Some(report)
}
