//! The continuous problem (1.1): two membranes, their loads, and the height at which the first is fixed.
//!
//! ```text
//! -mu1 Lap u1 - lambda = f1    in omega        u1 = g >= 0   on the boundary
//! -mu2 Lap u2 + lambda = f2    in omega        u2 = 0        on the boundary
//! u1 - u2 >= 0,   lambda >= 0,   lambda (u1 - u2) = 0
//! ```

mod cases;
mod domain;
mod expression;
mod function;
#[cfg(test)]
pub(crate) mod samples;

pub use cases::{Case, CaseError, ExactSolution, Parameter, Range};
pub use domain::Domain;
pub use expression::{Expression, ExpressionError};
pub use function::{EvaluationError, Function};

use thiserror::Error;

use crate::text::Number;

/// The data of (1.1): tensions, loads, boundary height. Valid once built, then immutable.
///
/// ```
/// use membrane_contact::problem::ContactProblem;
///
/// let problem = ContactProblem::builder().tension(1.0, 3.0).load(-15.0, 10.0).height(0.1).build()?;
/// assert_eq!(problem.tension(), [1.0, 3.0]);
/// # Ok::<(), membrane_contact::problem::ProblemError>(())
/// ```
#[derive(Debug, Clone)]
pub struct ContactProblem {
    tension: [f64; 2],
    load: [Function; 2],
    height: Function,
}

impl ContactProblem {
    /// Starts from unit tensions, no loads, and both membranes fixed at height zero.
    pub fn builder() -> ContactProblemBuilder {
        ContactProblemBuilder { tension: [1.0; 2], load: [0.0.into(), 0.0.into()], height: 0.0.into() }
    }

    /// `[mu1, mu2]`, force per length, positive.
    pub fn tension(&self) -> [f64; 2] {
        self.tension
    }

    /// `[f1, f2]`, force per area, positive upwards.
    pub fn load(&self) -> &[Function; 2] {
        &self.load
    }

    /// `g`, the height at which membrane 1 is fixed on the boundary; its values elsewhere are not used.
    pub fn height(&self) -> &Function {
        &self.height
    }
}

impl ExactSolution {
    /// The problem that it solves.
    ///
    /// # Errors
    /// As [`ContactProblemBuilder::build`].
    pub fn problem(&self) -> Result<ContactProblem, ProblemError> {
        let [mu1, mu2] = self.tension();
        let [f1, f2] = self.load_functions();
        ContactProblem::builder().tension(mu1, mu2).load(f1, f2).height(self.height_function()).build()
    }
}

/// Collects the data of a [`ContactProblem`].
#[derive(Debug, Clone)]
pub struct ContactProblemBuilder {
    tension: [f64; 2],
    load: [Function; 2],
    height: Function,
}

impl ContactProblemBuilder {
    /// The tensions `mu1`, `mu2` (force per length).
    pub fn tension(mut self, mu1: f64, mu2: f64) -> Self {
        self.tension = [mu1, mu2];
        self
    }

    /// The loads `f1`, `f2` (force per area, positive upwards).
    pub fn load(mut self, f1: impl Into<Function>, f2: impl Into<Function>) -> Self {
        self.load = [f1.into(), f2.into()];
        self
    }

    /// The height `g` of membrane 1 on the boundary.
    pub fn height(mut self, g: impl Into<Function>) -> Self {
        self.height = g.into();
        self
    }

    /// Checks what can be checked without a mesh.
    ///
    /// # Errors
    /// A tension that is not positive and finite, a constant load that is not finite, a constant height that is
    /// negative or not finite. Functions of the point are checked where they are evaluated, by
    /// [`Discretization::new`](crate::discretization::Discretization::new).
    pub fn build(self) -> Result<ContactProblem, ProblemError> {
        for (membrane, mu) in [1, 2].into_iter().zip(self.tension) {
            if !(mu > 0.0 && mu.is_finite()) {
                return Err(ProblemError::Tension { membrane, value: mu });
            }
        }
        for (membrane, load) in [1, 2].into_iter().zip(&self.load) {
            if let Function::Constant(value) = *load
                && !value.is_finite()
            {
                return Err(ProblemError::Load { membrane, value });
            }
        }
        if let Function::Constant(value) = self.height
            && !(value >= 0.0 && value.is_finite())
        {
            return Err(ProblemError::Height { value });
        }
        Ok(ContactProblem { tension: self.tension, load: self.load, height: self.height })
    }
}

/// Why the data do not make a problem.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// A tension out of range.
    #[error("tension mu{membrane} is {}: give a positive, finite number", Number(*value))]
    Tension {
        /// 1 or 2.
        membrane: usize,
        /// The value given.
        value: f64,
    },
    /// A constant load out of range.
    #[error("load f{membrane} is {}: give a finite number", Number(*value))]
    Load {
        /// 1 or 2.
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_data_build_and_each_invalid_datum_is_named() {
        let valid = || ContactProblem::builder().tension(1.0, 3.0).load(-1.0, 2.0).height(0.5);
        assert!(valid().build().is_ok());
        for mu in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                valid().tension(1.0, mu).build(),
                Err(ProblemError::Tension { membrane: 2, .. })
            ));
        }
        for f in [f64::NAN, f64::NEG_INFINITY] {
            assert!(matches!(valid().load(f, 0.0).build(), Err(ProblemError::Load { membrane: 1, .. })));
        }
        for g in [-1e-9, f64::NAN, f64::INFINITY] {
            assert!(matches!(valid().height(g).build(), Err(ProblemError::Height { .. })));
        }
    }
}
