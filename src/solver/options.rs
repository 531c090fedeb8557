//! What is asked of a solver.

use web_time::Instant;

use super::candidate::StartingPoint;
use super::error::SolverError;
use crate::qp::{Interrupt, Limits, TimeLimit};

/// Linear solves for the gap. An accurate answer needs one to four; where the membranes touch without pushing, the contact
/// set moves by one layer of vertices at a time. A solve costs about a hundredth of an interior-point solve.
const POLISH_STEPS: usize = 100;

/// What is asked of a solver.
#[derive(Debug, Clone)]
pub struct SolverOptions {
    /// Largest residual of the optimality conditions, relative to the data ([`Scales`](crate::discretization::Scales)).
    pub tolerance: f64,
    /// Where to stop at the latest; `None`: the solver's own limit.
    pub max_iterations: Option<usize>,
    /// When to stop at the latest; `None`: no limit. Solvers look at the clock between their steps, of which a factorisation or
    /// the set-up of all levels is one.
    pub time_limit: Option<TimeLimit>,
    /// What asks it to stop, between the same steps; `None`: nothing does.
    pub interrupt: Option<Interrupt>,
    /// Whether to make the result exact by solving for its contact set.
    pub polish: bool,
    /// A guess on this mesh to start from, for solvers that can.
    pub warm_start: Option<StartingPoint>,
}

impl Default for SolverOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            max_iterations: None,
            time_limit: None,
            interrupt: None,
            polish: true,
            warm_start: None,
        }
    }
}

impl SolverOptions {
    /// When a solve that has begun at `start` stops; after `iterations`, where nothing else is asked for.
    pub(crate) fn limits(&self, iterations: usize, start: Instant) -> Limits {
        let iterations = self.max_iterations.unwrap_or(iterations);
        Limits::new(iterations, self.time_limit, start, self.interrupt.clone())
    }

    /// Those of a polish in a solve that has begun at `start`: the limit of iterations is the backend's. `None` where no time is left.
    pub(super) fn limits_of_polish(&self, start: Instant) -> Option<Limits> {
        let limits = self.limits(POLISH_STEPS, start).with_iterations(POLISH_STEPS);
        limits.reached(0).is_none().then_some(limits)
    }

    pub(crate) fn check(&self) -> Result<(), SolverError> {
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err(SolverError::Tolerance(self.tolerance));
        }
        Ok(())
    }
}
