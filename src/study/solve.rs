//! The one call: from a problem and a mesh to a certified solution with its bound.

use std::sync::Arc;

use thiserror::Error;

use super::accuracy::{AccuracyError, Bounded, Tolerance, solve_bounded};
use crate::action::ContactSolution;
use crate::discretization::{Discretization, DiscretizationError};
use crate::estimate::{ErrorBound, NoBound};
use crate::mesh::Mesh;
use crate::problem::ContactProblem;
use crate::solver::{Auto, SolverOptions};

/// What [`solve`] returns.
#[derive(Debug, Clone)]
pub struct Solved {
    /// The problem on its mesh.
    pub discretization: Discretization,
    /// Displacements, action and contact set, certified.
    pub solution: ContactSolution,
    /// How far the displacements are from the exact ones at most, or why that is not known.
    pub bound: Result<ErrorBound, NoBound>,
}

/// There is no certified solution.
#[derive(Debug, Error)]
pub enum SolveError {
    /// The problem cannot be posed on the mesh.
    #[error(transparent)]
    Discretization(#[from] DiscretizationError),
    /// It cannot be solved, or not within the tolerance.
    #[error(transparent)]
    Accuracy(#[from] AccuracyError),
}

/// Solves `problem` on `mesh` by the built-in solver that suits it, certifies the result within `options.tolerance`, and
/// bounds its error. The boundary of the domain is taken for the polygon that the mesh covers.
///
/// This is [`Discretization::new`], [`Auto`], [`certify`](crate::action::certify) and [`ContactBounds`](crate::estimate::ContactBounds) in one; for another
/// solver, or a tolerance that follows the bound, see [`solve_bounded`].
///
/// ```
/// use membrane_contact::prelude::*;
///
/// let problem = ContactProblem::builder().tension(1.0, 3.0).load(-15.0, 10.0).height(0.1).build()?;
/// let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [32, 32], Pattern::Right)?;
/// let solved = solve(&problem, mesh, &SolverOptions::default())?;
/// assert!(solved.solution.total_force() > 0.0);
/// println!("energy error at most {:.3}", solved.bound?.total);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SolveError`].
pub fn solve(
    problem: &ContactProblem,
    mesh: impl Into<Arc<Mesh>>,
    options: &SolverOptions,
) -> Result<Solved, SolveError> {
    let discretization = Discretization::new(problem, mesh)?;
    let tolerance = Tolerance::Fixed(options.tolerance);
    let Bounded { solution, bound, .. } =
        solve_bounded(problem, None, &discretization, &mut Auto, options, tolerance)?;
    Ok(Solved { discretization, solution, bound })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Pattern, rectangle};
    use crate::problem::Function;

    fn solved(tolerance: f64, height: f64) -> Result<Solved, SolveError> {
        let height = Function::from_fn(move |x, _| height + x);
        let problem = ContactProblem::builder().load(-15.0, 10.0).height(height).build().unwrap();
        let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [8, 8], Pattern::Right).unwrap();
        solve(&problem, mesh, &SolverOptions { tolerance, ..SolverOptions::default() })
    }

    #[test]
    fn one_call_leads_to_a_certified_solution_with_its_bound() {
        let Solved { discretization, solution, bound } = solved(1e-8, 0.1).unwrap();
        let gap = solution.gap(1).unwrap();
        assert_eq!(gap.lambda.len(), discretization.mesh().points().len());
        assert!(bound.unwrap().total > 0.0 && gap.contact.contains(&true));
    }

    #[test]
    fn every_stage_says_what_is_wrong() {
        assert!(matches!(solved(1e-8, -2.0), Err(SolveError::Discretization(_))));
        assert!(matches!(solved(2.0, 0.1), Err(SolveError::Accuracy(AccuracyError::Solver(_)))));
    }
}
