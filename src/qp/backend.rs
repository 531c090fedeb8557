//! What a QP solver is to this crate.

use thiserror::Error;

use super::limits::Interrupt;
use super::problem::QpProblem;
use super::status::Status;
use super::time_limit::TimeLimit;

/// A solver of [`QpProblem`]s. Implement it to plug in a solver of your own: see `examples/custom_backend.rs`.
///
/// The problem arrives in units in which `x` and `P x + q` have size about 1, so that one absolute tolerance fits. The
/// answer is judged by residuals recomputed elsewhere, never by the status.
pub trait QpBackend: Send {
    /// The name in summaries and messages.
    fn name(&self) -> &str;

    /// Solves the problem, or stops early and says so in the [`Status`].
    ///
    /// # Errors
    /// [`BackendError`] when the solver cannot run on this problem at all.
    fn solve(&mut self, qp: &QpProblem, options: &QpOptions) -> Result<QpSolution, BackendError>;
}

/// What is asked of a backend.
#[derive(Debug, Clone)]
pub struct QpOptions {
    /// Largest residual of the optimality conditions, in the problem's units (size 1).
    pub tolerance: f64,
    /// Where to stop at the latest; `None`: the backend's own limit.
    pub max_iterations: Option<usize>,
    /// When to stop at the latest; `None`: no limit.
    pub time_limit: Option<TimeLimit>,
    /// What asks it to stop; `None`: nothing does.
    pub interrupt: Option<Interrupt>,
    /// A guess `(x, y)`, for backends that can use one.
    pub warm_start: Option<(Vec<f64>, Vec<f64>)>,
}

impl Default for QpOptions {
    fn default() -> Self {
        Self { tolerance: 1e-8, max_iterations: None, time_limit: None, interrupt: None, warm_start: None }
    }
}

/// What a backend returns: its last iterate, whatever the status.
#[derive(Debug, Clone)]
pub struct QpSolution {
    /// Primal point. Shape: `variables`.
    pub x: Vec<f64>,
    /// Multipliers of `A x >= b`, non-negative at an optimum. Shape: `constraints`.
    pub y: Vec<f64>,
    /// Why the backend stopped.
    pub status: Status,
    /// Iterations made.
    pub iterations: usize,
    /// Seconds spent before the first iteration (analysis, factorisation).
    pub setup_seconds: f64,
    /// Seconds spent iterating.
    pub solve_seconds: f64,
}

/// A backend cannot run on a problem.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{backend} cannot run: {reason}")]
pub struct BackendError {
    /// The backend's name.
    pub backend: String,
    /// What it says.
    pub reason: String,
}
