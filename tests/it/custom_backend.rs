//! The example of a user-written backend does what it shows.

#[path = "../../examples/custom_backend.rs"]
#[expect(dead_code, reason = "the example's main is not called here")]
mod example;

use membrane_contact::action::certify_pair;
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::{Pattern, rectangle};
use membrane_contact::problem::Case;
use membrane_contact::qp::Status;
use membrane_contact::solver::{ContactSolver, QpSolver, SolverOptions};

use crate::common::{TOLERANCE, distance, exact, solve, solvers};

#[test]
fn a_third_backend_is_certified_and_agrees_with_the_others() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [12, 12], Pattern::Right).unwrap();
    let problem = exact(Case::Circle, &[]).problem().unwrap();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let mut own = QpSolver::new(example::MethodOfMultipliers { penalty: 100.0 });
    assert_eq!(own.name(), "method-of-multipliers");

    let unpolished = solve(&mut own, &d, false);
    assert_eq!(unpolished.statistics.status, Status::Solved);
    assert!(certify_pair(&d, unpolished, TOLERANCE).is_ok());
    let solution = certify_pair(&d, solve(&mut own, &d, true), TOLERANCE).unwrap();
    for mut other in solvers() {
        let other = certify_pair(&d, solve(other.as_mut(), &d, true), TOLERANCE).unwrap();
        assert_eq!(solution.contact(), other.contact());
        assert!(distance(solution.lambda(), other.lambda()) < TOLERANCE);
    }
}

#[test]
fn stopped_early_it_says_so_and_is_rejected() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [12, 12], Pattern::Right).unwrap();
    let problem = exact(Case::Circle, &[]).problem().unwrap();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let options = SolverOptions { polish: false, max_iterations: Some(1), ..SolverOptions::default() };
    let stopped = QpSolver::new(example::MethodOfMultipliers { penalty: 1.0 })
        .solve_pair(&d, &options)
        .expect("it runs");
    assert_eq!(stopped.statistics.status, Status::IterationLimit);
    assert!(certify_pair(&d, stopped, TOLERANCE).is_err());
}
