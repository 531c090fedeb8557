//! The sparse convex quadratic program, its one sign convention, and the solvers for it.
//!
//! ```text
//! minimise    1/2 x'P x + q'x + c
//! subject to  A x >= b                      (multiplier y >= 0)
//!
//! optimal:    P x + q = A'y,   A x >= b,   y >= 0,   y_k (A x - b)_k = 0
//! ```
//!
//! This is the convention everywhere: a [`QpBackend`] converts at its rim.

mod answer;
mod backend;
#[cfg(feature = "clarabel")]
mod clarabel;
mod contact;
#[cfg(feature = "files")]
mod export;
#[cfg(feature = "files")]
mod import;
mod kkt;
mod limits;
#[cfg(feature = "osqp")]
mod osqp;
mod problem;
mod status;
mod time_limit;

#[cfg(feature = "clarabel")]
pub use self::clarabel::Clarabel;
#[cfg(feature = "osqp")]
pub use self::osqp::Osqp;
pub use answer::Answer;
pub use backend::{BackendError, QpBackend, QpOptions, QpSolution};
pub use contact::{contact_qp, qp_of, stack_qp};
#[cfg(feature = "files")]
pub use export::{QpPart, write_matrix_market, write_npz, write_qps, write_stack_npz};
#[cfg(feature = "files")]
pub use import::{AnswerError, Shape, read_answer};
pub use kkt::KktResiduals;
pub use limits::Interrupt;
pub(crate) use limits::Limits;
pub use problem::{QpError, QpProblem};
pub use status::Status;
pub use time_limit::{TimeLimit, TimeLimitError};
