//! Why a solver cannot run.

use thiserror::Error;

use crate::multigrid::cholesky::NotFactored;
use crate::qp::BackendError;
use crate::text::Number;

/// A solver cannot run.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SolverError {
    /// The quadratic programming backend cannot.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// A linear system cannot be factored.
    #[error(
        "the stiffness matrix cannot be factored: memory is short, or the mesh has triangles that are too thin"
    )]
    NotFactored,
    /// The tolerance is out of range.
    #[error("the tolerance is {}: give a number between 0 and 1", Number(*_0))]
    Tolerance(f64),
}

impl From<NotFactored> for SolverError {
    fn from(_: NotFactored) -> Self {
        Self::NotFactored
    }
}
