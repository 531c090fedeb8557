//! Bounds for any problem.

use super::{ErrorBound, ErrorBounds, MeasureError, NoBound};
use crate::action::ContactSolution;
use crate::discretization::{Discretization, StackDiscretization};
use crate::problem::{ContactProblem, Domain};

/// The bounds of several errors on one discretization: of the paper's pair by [`ErrorBounds`], of any other stack by
/// [`ErrorBound::of_stack`].
pub enum ContactBounds<'a> {
    /// Of the pair.
    Pair(ErrorBounds<'a>),
    /// Of any other stack.
    Stack(&'a StackDiscretization),
}

impl<'a> ContactBounds<'a> {
    /// For `d`, the discretization of `problem`; `domain` as in [`ErrorBound::new`], and for a stack of no use.
    pub fn new(problem: &'a ContactProblem, domain: Option<&'a Domain>, d: &'a Discretization) -> Self {
        match d {
            Discretization::Pair(d) => Self::Pair(ErrorBounds::new(problem, domain, d)),
            Discretization::Stack(d) => Self::Stack(d),
        }
    }

    /// Bounds the error of a certified solution, or says why there is no bound.
    ///
    /// # Errors
    /// [`MeasureError`] when it is the solution of another problem, or the data of a pair have no value on the boundary.
    pub fn of_solution(
        &self,
        solution: &ContactSolution,
    ) -> Result<Result<ErrorBound, NoBound>, MeasureError> {
        Ok(match (self, solution) {
            (Self::Pair(bounds), ContactSolution::Pair(solution)) => Ok(bounds.of_solution(solution)?),
            (Self::Stack(d), ContactSolution::Stack(solution)) => ErrorBound::of_stack(d, solution),
            _ => Err(NoBound::OtherMesh),
        })
    }
}
