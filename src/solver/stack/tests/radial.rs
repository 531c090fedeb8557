//! Rotationally symmetric stacks on disks; section 6 of the notes on stacks.

use super::exact::{distance, exact};
use super::{posed, solve_by};
use crate::action::StackSolution;
use crate::mesh::{Mesh, disk};
use crate::problem::{ExactStack, StackCase};
use crate::solver::ActiveSet;

/// Away from the circles at which it jumps, an action is that of the continuous problem.
fn is_action(mesh: &Mesh, solution: &StackSolution, exact: &ExactStack, k: usize) -> bool {
    let scale = 1.0 + exact.lambda(k, 0.0, 0.0);
    let near = |x: f64, y: f64| {
        x.hypot(y) > 0.95 || exact.interfaces().iter().any(|curve| curve.signed_distance(x, y).abs() < 0.08)
    };
    let mut found = mesh.points().iter().zip(&solution.gap(k).unwrap().lambda);
    found.all(|(&[x, y], found)| near(x, y) || (found - exact.lambda(k, x, y)).abs() < 0.05 * scale)
}

/// S1, S4, S5, S6: over a floor, three membranes, varying tensions.
#[test]
fn displacements_are_of_second_order_and_actions_are_those_of_the_continuous_problem() {
    let cases = [StackCase::FloorDisk, StackCase::ThreeDiscs, StackCase::GradedDisk, StackCase::TwoTensions];
    for case in cases {
        let exact = exact(case);
        let problem = exact.problem().unwrap();
        let mut last = None;
        let errors = [8, 16, 32].map(|rings| {
            let mesh = disk([0.0, 0.0], 1.0, rings).unwrap();
            let solution = solve_by(&mut ActiveSet, &posed(&problem, &mesh));
            let error = distance(&mesh, &solution, &exact);
            last = Some((mesh, solution));
            error
        });
        let rate = (errors[0] / errors[2]).log2() / 2.0;
        assert!((1.6..2.6).contains(&rate), "{case}: {errors:?}");
        let (mesh, solution) = last.unwrap();
        for k in exact.gaps() {
            assert!(is_action(&mesh, &solution, &exact, k), "{case}, gap {k}");
        }
        let parameter = case.parameters().iter().find(|p| ["q", "f1"].contains(&p.name)).unwrap();
        let other = case.solution(&[(parameter.name.to_owned(), 1.5 * parameter.default)].into()).unwrap();
        assert!(!is_action(&mesh, &solution, &other, 1), "{case}: another action passes");
    }
}
