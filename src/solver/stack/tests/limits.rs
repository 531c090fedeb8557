//! Stacks in which membranes touch without any action: every contact set is right, and none may come back for ever.

use super::{posed, solve_by, solvers};
use crate::mesh::samples::irregular;
use crate::numeric::largest;
use crate::problem::{ContactProblem, Function, Membrane};

/// Rounding of displacements of size one.
const ROUNDING: f64 = 1e-11;

fn stack(load: f64) -> ContactProblem {
    let f = move |mu: f64| Function::from_fn(move |x, y| mu * load * (1.0 + x * y));
    let stack = [1.0, 2.0, 3.0]
        .into_iter()
        .fold(ContactProblem::stack(), |stack, mu| stack.membrane(Membrane::new(mu).load(f(mu)).height(0.1)));
    stack.build().unwrap()
}

/// S13: loads in proportion to the tensions bend all membranes alike; or there are none.
#[test]
fn membranes_that_bend_alike_do_not_push() {
    for load in [0.0, 1.0, -20.0] {
        let d = posed(&stack(load), &irregular(10));
        for (name, mut solver) in solvers() {
            let solution = solve_by(&mut *solver, &d);
            let [first, second, third] = [0, 1, 2].map(|i| &solution.displacement()[i]);
            let apart = largest((0..first.len()).map(|a| (first[a] - third[a]).abs()));
            assert!(apart < ROUNDING, "{name}, {load}: {apart:e}");
            assert_eq!(first.len(), second.len());
            for gap in solution.gaps() {
                let action = largest(gap.lambda.iter().copied());
                assert!(action < 1e-6, "{name}, {load}: {action:e}");
            }
        }
    }
    // The negative test: loads that differ push.
    let pushed = ContactProblem::stack()
        .membrane(Membrane::new(1.0).load(-20.0).height(0.1))
        .membrane(Membrane::new(2.0).height(0.1))
        .floor(-9.0)
        .build()
        .unwrap();
    let solution = solve_by(&mut crate::solver::ActiveSet, &posed(&pushed, &irregular(10)));
    assert!(solution.gap(1).unwrap().total_force > 1.0);
}
