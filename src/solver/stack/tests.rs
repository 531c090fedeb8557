//! Stacks by every solver.

mod coupled;
mod exact;
mod limits;
mod properties;
mod published;
mod radial;

use crate::action::{StackSolution, certify_stack};
use crate::discretization::StackDiscretization;
use crate::mesh::Mesh;
use crate::problem::ContactProblem;
#[cfg(feature = "clarabel")]
use crate::qp::Clarabel;
#[cfg(any(feature = "clarabel", feature = "osqp"))]
use crate::solver::QpSolver;
use crate::solver::{ActiveSet, Auto, ContactSolver, Multigrid, SolverOptions};

/// What is asked of solvers and of the certificate.
const TOLERANCE: f64 = 1e-9;

fn solvers() -> Vec<(&'static str, Box<dyn ContactSolver>)> {
    vec![
        ("auto", Box::new(Auto)),
        ("active-set", Box::new(ActiveSet)),
        ("multigrid", Box::new(Multigrid)),
        #[cfg(feature = "clarabel")]
        ("clarabel", Box::new(QpSolver::new(Clarabel))),
        #[cfg(feature = "osqp")]
        ("osqp", Box::new(QpSolver::new(crate::qp::Osqp))),
    ]
}

fn solve_by(solver: &mut dyn ContactSolver, d: &StackDiscretization) -> StackSolution {
    let options = SolverOptions { tolerance: TOLERANCE, ..SolverOptions::default() };
    certify_stack(d, solver.solve_stack(d, &options).unwrap(), TOLERANCE).unwrap()
}

/// What may be left of rounding: multigrid is right to its tolerance only.
fn slack(solver: &str, rounding: f64) -> f64 {
    if solver == "multigrid" { rounding.max(TOLERANCE) } else { rounding }
}

fn posed(problem: &ContactProblem, mesh: &Mesh) -> StackDiscretization {
    StackDiscretization::new(problem, mesh.clone()).unwrap()
}
