//! The only way to a solution.

use thiserror::Error;

use super::projection::Projection;
use super::{Action, PairSolution, Residuals};
use crate::discretization::{Displacement, PairDiscretization};
use crate::qp::Status;
use crate::solver::{Candidate, Statistics};

/// Checks a candidate against `K`, `F`, `g` and hands it out as a solution when every residual, beyond what rounding of
/// the terms explains, is at most `tolerance`.
///
/// The solution is exactly in the cones (3.3), (4.2) and exactly complementary (4.8), which a candidate is up to its residuals
/// only: where both a gap and an action are left, the smaller one, in units of the data, becomes zero. The residuals
/// are those of the candidate and count all that is cut off, a positive gap beside a positive action by their product; see
/// [`CutOff`](super::CutOff).
///
/// # Errors
/// [`Rejected`], with all residuals, when one is larger or not a number, or when a vector has the wrong length.
pub fn certify_pair(
    d: &PairDiscretization,
    candidate: Candidate,
    tolerance: f64,
) -> Result<PairSolution, Box<Rejected>> {
    let Candidate { displacement, multiplier, statistics } = candidate;
    let fits = |u: &Displacement| u.iter().all(|u| u.len() == d.mesh().points().len());
    let pair = Displacement::try_from(displacement).ok().filter(fits);
    let Some(displacement) = pair.filter(|_| multiplier.len() == d.interior().len()) else {
        return Err(Box::new(Rejected { reason: Reason::Lengths, residuals: None, statistics }));
    };
    let action = Action::recover(d, &displacement);
    let residuals = Residuals::new(d, &displacement, &multiplier, &action);
    if let Some(reason) = Reason::of(&residuals, tolerance) {
        return Err(Box::new(Rejected { reason, residuals: Some(residuals), statistics }));
    }
    let projection = Projection::new(d, displacement, &multiplier, action);
    Ok(PairSolution::new(d, projection, residuals, statistics))
}

impl Reason {
    /// The worst check, where it is above the tolerance or not a number.
    pub(super) fn of(residuals: &Residuals, tolerance: f64) -> Option<Self> {
        let worst =
            residuals.named().into_iter().max_by(|p, q| p.1.beyond_rounding.total_cmp(&q.1.beyond_rounding));
        let above = worst.filter(|(_, residual)| !(residual.beyond_rounding <= tolerance));
        above.map(|(check, residual)| Self::Residual { check, value: residual.value, tolerance })
    }
}

/// A candidate that is not a solution.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{} does not certify: {reason}", statistics.solver)]
pub struct Rejected {
    /// What is wrong.
    pub reason: Reason,
    /// All residuals; `None` when there are no vectors, or such of the wrong lengths.
    pub residuals: Option<Residuals>,
    /// How the candidate was found.
    pub statistics: Statistics,
}

impl Rejected {
    /// Of a solver that was not waited for any longer.
    pub fn without_result(statistics: Statistics) -> Self {
        Self { reason: Reason::NoResult, residuals: None, statistics }
    }

    /// What to do about it.
    pub fn remedy(&self) -> &'static str {
        match self.statistics.status {
            _ if self.reason == Reason::NoResult => "allow more time, or choose another solver",
            Status::Interrupted => "it was asked to stop: solve again",
            Status::Stalled => {
                "choose another solver (active-set needs no good triangles), or a larger tolerance"
            }
            _ => "allow more iterations or time, or a larger tolerance, or keep the polish on",
        }
    }
}

/// Why a candidate is rejected.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Reason {
    /// A residual is too large.
    #[error("{check} {value:.1e} is above the tolerance {tolerance:.1e}")]
    Residual {
        /// The worst check.
        check: &'static str,
        /// Its residual.
        value: f64,
        /// What is allowed.
        tolerance: f64,
    },
    /// The vectors do not belong to the discretization.
    #[error("its vectors do not have one entry for each vertex and each unknown")]
    Lengths,
    /// There is no candidate.
    #[error("it has not finished in time")]
    NoResult,
}
