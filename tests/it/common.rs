//! What the integration tests share.

use std::collections::BTreeMap;

use membrane_contact::discretization::PairDiscretization;
use membrane_contact::problem::{Case, ExactSolution};
use membrane_contact::qp::Clarabel;
#[cfg(feature = "osqp")]
use membrane_contact::qp::Osqp;
use membrane_contact::solver::{
    ActiveSet, Auto, Candidate, ContactSolver, Multigrid, QpSolver, SolverOptions,
};

/// What is asked of backends and of the certificate: the program's default.
pub const TOLERANCE: f64 = 1e-8;

/// Every solver of this build.
pub fn solvers() -> Vec<Box<dyn ContactSolver>> {
    vec![
        Box::new(QpSolver::new(Clarabel)),
        #[cfg(feature = "osqp")]
        Box::new(QpSolver::new(Osqp)),
        Box::new(ActiveSet),
        Box::new(Multigrid),
        Box::new(Auto),
    ]
}

/// Solves at [`TOLERANCE`].
pub fn solve(solver: &mut dyn ContactSolver, d: &PairDiscretization, polish: bool) -> Candidate {
    let options = SolverOptions { tolerance: TOLERANCE, polish, ..SolverOptions::default() };
    solver.solve_pair(d, &options).expect("the backend runs")
}

/// A built-in case with some parameters chosen.
pub fn exact(case: Case, parameters: &[(&str, f64)]) -> ExactSolution {
    let parameters: BTreeMap<String, f64> =
        parameters.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
    case.solution(&parameters).expect("parameters in range")
}

/// The largest value, at least zero; infinite as soon as one is NaN, which `f64::max` would lose.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(|x| if x.is_nan() { f64::INFINITY } else { x }).fold(0.0, f64::max)
}

/// The largest distance of two functions over the same points; infinite where one has no value.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    largest(a.iter().zip(b).map(|(a, b)| (a - b).abs()))
}

#[test]
fn what_has_no_value_is_at_no_distance() {
    assert_eq!(distance(&[1.0, 2.0], &[1.5, 2.0]), 0.5);
    for [a, b] in [[f64::NAN, 1.0], [1.0, f64::NAN]] {
        assert_eq!(distance(&[a, b], &[1.0, 1.0]), f64::INFINITY);
    }
}
