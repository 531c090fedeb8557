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

mod cases;
mod domain;
mod expression;
mod field;
mod function;
mod membrane;
mod pair;
#[cfg(test)]
pub(crate) mod samples;
mod stack;

pub use cases::{Case, CaseError, ExactSolution, Parameter, Range};
pub use domain::Domain;
pub use expression::{Expression, ExpressionError};
pub use field::Field;
pub use function::{EvaluationError, Function};
pub use membrane::{Membrane, Support};
pub use pair::{ContactProblemBuilder, Pair};
pub use stack::StackBuilder;

use std::collections::HashSet;

use thiserror::Error;

use crate::text::Number;

/// Membranes from the top, and the obstacles above and below them. Valid once built, then immutable.
///
/// ```
/// use membrane_contact::problem::{ContactProblem, Membrane};
///
/// // The paper's pair.
/// let pair = ContactProblem::pair([1.0, 3.0], [-15.0, 10.0], 0.1)?;
/// assert_eq!(pair.as_pair().map(|pair| pair.tension()), Some([1.0, 3.0]));
/// // A membrane over a floor.
/// let sheet = Membrane::new(1.0).load(-10.0);
/// let obstacle = ContactProblem::obstacle(sheet.clone(), -0.3)?;
/// // Three membranes over it.
/// let stack = ContactProblem::stack()
///     .membrane(sheet.clone().height(0.2))
///     .membrane(sheet.clone().height(0.1))
///     .membrane(sheet)
///     .floor(-0.3)
///     .build()?;
/// assert_eq!([&pair, &obstacle, &stack].map(|problem| problem.membranes().len()), [2, 1, 3]);
/// # Ok::<(), membrane_contact::problem::ProblemError>(())
/// ```
#[derive(Debug, Clone)]
pub struct ContactProblem {
    membranes: Vec<Membrane>,
    ceiling: Option<Field>,
    floor: Option<Field>,
    /// The same as the paper's pair, where it is one.
    pair: Option<Pair>,
}

impl ContactProblem {
    /// The paper's pair, which starts from unit tensions, no loads, and both membranes fixed at height zero.
    pub fn builder() -> ContactProblemBuilder {
        ContactProblemBuilder::default()
    }

    /// The paper's pair: tensions `mu1`, `mu2`, loads `f1`, `f2`, and the height `g` at which membrane 1 is fixed.
    ///
    /// # Errors
    /// As [`ContactProblemBuilder::build`].
    pub fn pair<F: Into<Function>>(
        [mu1, mu2]: [f64; 2],
        [f1, f2]: [F; 2],
        g: impl Into<Function>,
    ) -> Result<Self, ProblemError> {
        Self::builder().tension(mu1, mu2).load(f1, f2).height(g).build()
    }

    /// One membrane over a floor: the classical obstacle problem.
    ///
    /// # Errors
    /// As [`StackBuilder::build`].
    pub fn obstacle(membrane: Membrane, floor: impl Into<Field>) -> Result<Self, ProblemError> {
        Self::stack().membrane(membrane).floor(floor).build()
    }

    /// Any number of membranes, added from the top.
    pub fn stack() -> StackBuilder {
        StackBuilder::default()
    }

    /// The membranes from the top.
    pub fn membranes(&self) -> &[Membrane] {
        &self.membranes
    }

    /// What no membrane is above.
    pub fn ceiling(&self) -> Option<&Field> {
        self.ceiling.as_ref()
    }

    /// What no membrane is below.
    pub fn floor(&self) -> Option<&Field> {
        self.floor.as_ref()
    }

    /// The data of the paper's pair, where it is one: two membranes without obstacles and foundations, of constant tensions,
    /// under loads that are one function each, fixed all around at `g >= 0` and at 0.
    pub fn as_pair(&self) -> Option<&Pair> {
        self.pair.as_ref()
    }

    /// The names of the regions that its data ask for, each once.
    pub fn regions(&self) -> Vec<&str> {
        let obstacles = [&self.ceiling, &self.floor].into_iter().flatten().flat_map(Field::names);
        each_once(self.membranes.iter().flat_map(Membrane::regions).chain(obstacles))
    }

    /// The names of the curves that its data ask for, each once.
    pub fn curves(&self) -> Vec<&str> {
        each_once(self.membranes.iter().flat_map(Membrane::curves))
    }
}

/// In the order in which they come first.
fn each_once<'n>(names: impl Iterator<Item = &'n str>) -> Vec<&'n str> {
    let mut seen = HashSet::new();
    names.filter(|name| seen.insert(*name)).collect()
}

impl ExactSolution {
    /// The problem that it solves.
    ///
    /// # Errors
    /// As [`ContactProblemBuilder::build`].
    pub fn problem(&self) -> Result<ContactProblem, ProblemError> {
        ContactProblem::pair(self.tension(), self.load_functions(), self.height_function())
    }
}

/// Why the data do not make a problem.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// A tension out of range.
    #[error("tension mu{membrane} is {}: give a positive, finite number", Number(*value))]
    Tension {
        /// Which, counted from 1 at the top.
        membrane: usize,
        /// The value given.
        value: f64,
    },
    /// A constant load out of range.
    #[error("load f{membrane} is {}: give a finite number", Number(*value))]
    Load {
        /// Which, counted from 1 at the top.
        membrane: usize,
        /// The value given.
        value: f64,
    },
    /// A constant height out of range.
    #[error(
        "height g is {}: give a number >= 0, so that membrane 1 is fixed above membrane 2 (or exchange the membranes)",
        Number(*value)
    )]
    Height {
        /// The value given.
        value: f64,
    },
    /// A foundation out of range.
    #[error("foundation c{membrane} is {}: give a finite number >= 0", Number(*value))]
    Foundation {
        /// Which, counted from 1 at the top.
        membrane: usize,
        /// The value given.
        value: f64,
    },
    /// A height, a line load or an obstacle that is no finite number.
    #[error("{datum} is {}: give a finite number", Number(*value))]
    NotFinite {
        /// Of which membrane, counted from 1 at the top; `None` for an obstacle.
        membrane: Option<usize>,
        /// Which datum.
        datum: String,
        /// The value given.
        value: f64,
    },
    /// No membrane.
    #[error("there is no membrane: add at least one")]
    NoMembrane,
}
