//! What every combination of features can do: pose, solve by the built-in solvers, certify, bound.

use membrane_contact::prelude::*;

/// As close as two certified solutions are, relative.
const AGREED: f64 = 1e-6;

#[test]
fn the_built_in_solvers_need_no_feature() {
    let problem = ContactProblem::builder().tension(1.0, 3.0).load(-15.0, 10.0).height(0.1).build().unwrap();
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [32, 32], Pattern::Right).unwrap();
    let solved = solve(&problem, mesh, &SolverOptions::default()).unwrap();
    let force = solved.solution.total_force();
    assert!(force > 0.0 && solved.bound.unwrap().total > 0.0);

    let solvers: [Box<dyn ContactSolver>; 2] = [Box::new(Multigrid), Box::new(ActiveSet)];
    for mut solver in solvers {
        let candidate = solver.solve(&solved.discretization, &SolverOptions::default()).unwrap();
        let solution = certify(&solved.discretization, candidate, 1e-8).unwrap();
        assert!((solution.total_force() / force - 1.0).abs() < AGREED, "{}", solver.name());
    }
}
