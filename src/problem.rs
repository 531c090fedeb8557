//! The continuous problem: a stack of membranes between obstacles, and the paper's pair (1.1).
//!
//! From the top, `u_0` the ceiling, `u_1 .. u_N` the membranes, `u_(N+1)` the floor; either obstacle may be missing. In every gap
//! `k`, between layers `k` and `k + 1`, they push each other apart with the action `lambda_k`:
//!
//! ```text
//! -div(mu_i grad u_i) + c_i u_i = f_i + lambda_i - lambda_(i-1)   in omega
//! u_k - u_(k+1) >= 0,   lambda_k >= 0,   lambda_k (u_k - u_(k+1)) = 0
//! u_i = g_i   or   mu_i d_n u_i = t_i   on each part of the boundary
//! ```
//!
//! The paper's pair is `N = 2` without obstacles, with constant tensions, held at `g >= 0` and at 0 all around:
//!
//! ```text
//! -mu1 Lap u1 - lambda = f1    in omega        u1 = g >= 0   on the boundary
//! -mu2 Lap u2 + lambda = f2    in omega        u2 = 0        on the boundary
//! u1 - u2 >= 0,   lambda >= 0,   lambda (u1 - u2) = 0
//! ```

mod builder;
mod cases;
mod domain;
mod error;
mod expression;
mod field;
mod function;
mod membrane;
mod pair;
#[cfg(test)]
pub(crate) mod samples;
mod stack;
mod support;

pub use builder::ContactProblemBuilder;
pub use cases::{
    Case, CaseError, Exact, ExactSolution, ExactStack, LineAction, NamedCase, Parameter, Range, StackCase,
};
pub use domain::Domain;
pub use error::ProblemError;
pub use expression::{Expression, ExpressionError};
pub use field::Field;
pub use function::{EvaluationError, Function};
pub use membrane::{Membrane, Support};
pub use pair::Pair;
pub use stack::{ContactProblem, StackBuilder};
pub use support::{ByCurve, TractionError};

impl ExactSolution {
    /// The problem that it solves.
    ///
    /// # Errors
    /// As [`ContactProblemBuilder::build`].
    pub fn problem(&self) -> Result<ContactProblem, ProblemError> {
        ContactProblem::pair(self.tension(), self.load_functions(), self.height_function())
    }
}

impl Exact {
    /// The problem that it solves.
    ///
    /// # Errors
    /// As [`ExactSolution::problem`] and [`ExactStack::problem`].
    pub fn problem(&self) -> Result<ContactProblem, ProblemError> {
        match self {
            Self::Pair(exact) => exact.problem(),
            Self::Stack(exact) => exact.problem(),
        }
    }
}
