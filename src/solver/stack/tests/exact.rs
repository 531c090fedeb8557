//! Stacks with known solutions, by every solver; section 6 of the notes on stacks.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::{TOLERANCE, posed, slack, solve_by, solvers};
use crate::action::{GapSolution, StackSolution, certify_pair};
use crate::discretization::{IntegrationRule, PairDiscretization, StackDiscretization};
use crate::mesh::samples::irregular;
use crate::mesh::{Mesh, Pattern, rectangle};
use crate::numeric::largest;
use crate::problem::{ContactProblem, ExactStack, Function, Membrane, StackCase};
use crate::solver::{ActiveSet, Auto, ContactSolver, SolverOptions};

/// Rounding of displacements of size one on meshes of some thousand triangles.
const ROUNDING: f64 = 1e-12;

/// `(0, 1) x (0, 1/2)` in right triangles; `x = k/4` are mesh lines.
fn strip_mesh(cells: usize) -> Mesh {
    rectangle([0.0, 0.0], [1.0, 0.5], [2 * cells, cells], Pattern::Right).unwrap()
}

/// The exact solution of a case with its defaults.
pub(super) fn exact(case: StackCase) -> ExactStack {
    case.solution(&BTreeMap::new()).unwrap()
}

/// The largest distance of a displacement from the exact one at a vertex.
pub(super) fn distance(mesh: &Mesh, solution: &StackSolution, exact: &ExactStack) -> f64 {
    let of_membrane = |(i, u): (usize, &Vec<f64>)| {
        let pairs = mesh.points().iter().zip(u);
        largest(pairs.map(|(&[x, y], u)| (u - exact.u(i, x, y)).abs()))
    };
    largest((1..).zip(solution.displacement()).map(of_membrane))
}

/// The largest distance of the action in gap `k` of a strip from the mean of the exact one on both sides, at vertices that are
/// not held.
fn action_distance(mesh: &Mesh, solution: &StackSolution, exact: &ExactStack, k: usize) -> f64 {
    const BESIDE: f64 = 1e-9;
    let found = &solution.gap(k).unwrap().lambda;
    let inside = mesh.points().iter().zip(found).filter(|([x, _], _)| 0.0 < *x && *x < 1.0);
    largest(inside.map(|(&[x, y], found)| {
        let [left, right] = [-BESIDE, BESIDE].map(|beside| exact.lambda(k, x + beside, y));
        (found - 0.5 * (left + right)).abs()
    }))
}

/// S3, S8: three membranes, and two over a floor.
#[test]
fn strips_of_contact_are_nodally_exact() {
    for case in [StackCase::ThreeStrips, StackCase::StripOnFloor] {
        let (mesh, exact) = (strip_mesh(8), exact(case));
        let d = posed(&exact.problem().unwrap(), &mesh);
        for (name, mut solver) in solvers() {
            let solution = solve_by(&mut *solver, &d);
            let off = distance(&mesh, &solution, &exact);
            assert!(off < slack(name, ROUNDING), "{case}, {name}: {off:e}");
            for k in exact.gaps() {
                let off = action_distance(&mesh, &solution, &exact, k);
                assert!(
                    off < 1e4 * slack(name, ROUNDING),
                    "{case}, {name}: the action in gap {k} is off by {off:e}"
                );
            }
            assert!(solution.imbalance() < slack(name, ROUNDING));
        }
        // The negative test: another choice is seen.
        let other = case.solution(&[("x1".to_owned(), 0.6)].into()).unwrap();
        let solution = solve_by(&mut ActiveSet, &d);
        assert!(
            distance(&mesh, &solution, &other) > 1e-3 && action_distance(&mesh, &solution, &other, 1) > 1.0
        );
    }
}

/// Half the length of the edges of a line `x = const` that end at a vertex of it.
fn half_lengths(y: f64) -> f64 {
    if y == 0.0 || y == 0.5 { 1.0 / 32.0 } else { 1.0 / 16.0 }
}

/// S7, S10: the action has a density along a line where a tension jumps in contact, and on a free end under line loads.
#[test]
fn nodal_forces_have_the_line_actions_in_them() {
    for case in [StackCase::TensionJump, StackCase::FreeEnd] {
        let exact = exact(case);
        let [line] = exact.line_actions(1).try_into().unwrap();
        let mut mesh = strip_mesh(8);
        for (name, curve) in exact.regions() {
            mesh = mesh.with_region(name, |[x, y]| curve.signed_distance(x, y) > 0.0).unwrap();
        }
        let d = posed(&exact.problem().unwrap(), &mesh);
        for (name, mut solver) in solvers() {
            let solution = solve_by(&mut *solver, &d);
            let off = distance(&mesh, &solution, &exact);
            assert!(off < slack(name, ROUNDING), "{case}, {name}: {off:e}");
            let gap = solution.gap(1).unwrap();
            let on_line = |x: f64, y: f64| line.curve.signed_distance(x, y).abs() < 1e-9;
            for (a, &[x, y]) in mesh.points().iter().enumerate().filter(|(_, p)| on_line(p[0], p[1])) {
                let beside = [-1e-9, 1e-9].map(|beside| exact.lambda(1, x + beside, y));
                let mean = 0.5 * (beside[0] + beside[1]);
                let expected = mean * d.dual_area()[a] + line.density * half_lengths(y);
                // At the ends of a line inside, its two sides have not the same area.
                let at_end = x < 1.0 && (y == 0.0 || y == 0.5);
                let off = (gap.force[a] - expected).abs();
                assert!(
                    off < if at_end { 1e-3 } else { slack(name, ROUNDING) },
                    "{case}, {name}: ({x}, {y}): {off:e}"
                );
                // As a density, away from the ends of the line.
                if 0.1 < y && y < 0.4 {
                    let density = gap.line_density[a];
                    assert!((density - line.density).abs() < 1e-9, "{case}, {name}: {density}");
                }
            }
            let elsewhere = mesh
                .points()
                .iter()
                .enumerate()
                .filter(|(_, p)| !on_line(p[0], p[1]) && 0.1 < p[1] && p[1] < 0.4);
            assert!(elsewhere.into_iter().all(|(a, _)| gap.line_density[a] == 0.0), "{case}, {name}");
        }
    }
}

/// S9: a foundation and a floor; the lumped foundation is of second order.
#[test]
fn a_foundation_over_a_floor_converges_at_second_order() {
    let exact = exact(StackCase::Foundation);
    let errors = [4, 8, 16].map(|cells| {
        let mesh = strip_mesh(cells);
        let solution = solve_by(&mut ActiveSet, &posed(&exact.problem().unwrap(), &mesh));
        distance(&mesh, &solution, &exact)
    });
    for pair in errors.windows(2) {
        let rate = (pair[0] / pair[1]).log2();
        assert!((1.8..2.2).contains(&rate), "{errors:?}");
    }
}

/// S13: contact without any action; solvers stop, and displacements are right.
#[test]
fn biactive_stacks_end_by_every_solver() {
    let exact = exact(StackCase::BiactiveStack);
    let mesh = rectangle([0.0; 2], [1.0; 2], [16; 2], Pattern::Right).unwrap();
    let d = posed(&exact.problem().unwrap(), &mesh);
    for (name, mut solver) in solvers() {
        let solution = solve_by(&mut *solver, &d);
        let off = distance(&mesh, &solution, &exact);
        assert!(off < 5e-3, "{name}: {off:e}");
        let gaps = solution.gaps();
        assert!(gaps.iter().all(|gap| gap.total_force < 1e-2), "{name}");
    }
}

/// N = 1 over a floor is the gap of a pair.
#[test]
fn one_membrane_over_a_floor_is_the_gap_of_a_pair() {
    let mesh = irregular(12);
    let load = || Function::from_fn(|x, y| -20.0 + 30.0 * (PI * x).sin() * y);
    let pair = ContactProblem::pair(
        [2.0, 2.0],
        [load(), Function::from_fn(move |x, y| 20.0 - 30.0 * (PI * x).sin() * y)],
        0.1,
    )
    .unwrap();
    let d = PairDiscretization::new(&pair, mesh.clone()).unwrap();
    let of_pair =
        certify_pair(&d, ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap(), TOLERANCE).unwrap();
    // m = mu1 mu2 / (mu1 + mu2) = 1, and m w solves the problem of the load (f1 - f2) / 2 = f1.
    let sheet = Membrane::new(1.0).load(load()).height(0.1);
    let d = posed(&ContactProblem::obstacle(sheet, 0.0).unwrap(), &mesh);
    let contact = of_pair.contact().iter().filter(|&&contact| contact).count();
    assert!(contact > 5);
    for (name, mut solver) in solvers() {
        let solution = solve_by(&mut *solver, &d);
        let gap = solution.gap(1).unwrap();
        let off = largest(gap.gap.iter().zip(of_pair.gap()).map(|(one, other)| (one - other).abs()));
        assert!(off < slack(name, ROUNDING), "{name}: {off:e}");
        assert_eq!(gap.contact, of_pair.contact(), "{name}");
        let off = largest(gap.lambda.iter().zip(of_pair.lambda()).map(|(one, other)| (one - other).abs()));
        assert!(off < 1e3 * slack(name, ROUNDING), "{name}: {off:e}");
    }
}

/// A stack of two with a floor out of reach is the pair.
#[test]
fn a_floor_out_of_reach_leaves_the_pair_as_it_is() {
    let mesh = irregular(12);
    let load = Function::from_fn(|x, y| -30.0 * x * (1.0 - y));
    let pair = ContactProblem::pair([1.0, 3.0], [load.clone(), 10.0.into()], 0.05).unwrap();
    let d = PairDiscretization::new(&pair, mesh.clone()).unwrap();
    let of_pair =
        certify_pair(&d, ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap(), TOLERANCE).unwrap();
    let membranes = [Membrane::new(1.0).load(load).height(0.05), Membrane::new(3.0).load(10.0)];
    let [upper, lower] = membranes;
    let problem = ContactProblem::stack().membrane(upper).membrane(lower).floor(-100.0).build().unwrap();
    assert!(problem.as_pair().is_none());
    let d = posed(&problem, &mesh);
    for (name, mut solver) in solvers() {
        let solution = solve_by(&mut *solver, &d);
        for i in 0..2 {
            let pairs = solution.displacement()[i].iter().zip(&of_pair.displacement()[i]);
            let off = largest(pairs.map(|(one, other)| (one - other).abs()));
            assert!(off < slack(name, ROUNDING), "{name}: {off:e}");
        }
        assert_eq!(solution.gap(1).unwrap().contact, of_pair.contact());
        assert_eq!(solution.gap(2).unwrap().contact_vertices(), 0);
    }
}

/// S11: a quarter with lines of symmetry is the full model.
#[test]
fn a_quarter_with_lines_of_symmetry_is_the_full_model() {
    let load = || Function::from_fn(|x, y| -40.0 + 25.0 * ((2.0 * PI * x).cos() + (2.0 * PI * y).cos()));
    let problem = |symmetric: bool| {
        let membrane = |mu: f64, height: f64| {
            let whole = Membrane::new(mu).height(height);
            if symmetric { whole.free_on("right").free_on("top") } else { whole }
        };
        let upper = membrane(1.0, 0.2).load(load());
        ContactProblem::stack().membrane(upper).membrane(membrane(2.0, 0.0)).floor(-0.5).build().unwrap()
    };
    let whole = rectangle([0.0, 0.0], [1.0, 1.0], [16, 16], Pattern::Crossed).unwrap();
    let quarter = rectangle([0.0, 0.0], [0.5, 0.5], [8, 8], Pattern::Crossed).unwrap();
    let of_whole = solve_by(&mut ActiveSet, &posed(&problem(false), &whole));
    let of_quarter = solve_by(&mut ActiveSet, &posed(&problem(true), &quarter));
    assert!(of_whole.gap(1).unwrap().contact_vertices() > 50);
    for (a, point) in quarter.points().iter().enumerate() {
        let b = whole.points().iter().position(|other| other == point).expect("a vertex of both");
        for i in 0..2 {
            let off = (of_quarter.displacement()[i][a] - of_whole.displacement()[i][b]).abs();
            assert!(off < 1e-10, "{point:?}: {off:e}");
        }
        for k in 1..=2 {
            let off = (of_quarter.gap(k).unwrap().lambda[a] - of_whole.gap(k).unwrap().lambda[b]).abs();
            // Corners of the quarter are held.
            assert!(off < 1e-9, "{point:?}: {off:e}");
        }
    }
}

/// G1 of the notes, found by an independent program: energy, contact and total actions of three membranes of varying tensions.
#[test]
fn the_reference_values_are_reproduced() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [32, 32], Pattern::Right).unwrap();
    let membranes = [
        (
            Function::from_fn(|x, _| 1.0 + 2.0 * x * x),
            Function::from_fn(|x, y| -12.0 + 18.0 * (2.0 * PI * x).sin() * (PI * y).sin()),
            0.04,
        ),
        (
            Function::from_fn(|_, y| 1.0 + 2.0 * y),
            Function::from_fn(|x, y| 25.0 * (4.0 * PI * x).sin() * (3.0 * PI * y).sin()),
            0.02,
        ),
        (
            Function::from_fn(|x, _| 3.0 - 2.0 * x),
            Function::from_fn(|x, y| 6.0 - 20.0 * (3.0 * PI * x).sin() * (2.0 * PI * y).sin()),
            0.0,
        ),
    ];
    let stack = membranes.into_iter().fold(ContactProblem::stack(), |stack, (mu, f, g)| {
        stack.membrane(Membrane::new(mu).load(f).height(g))
    });
    let problem = stack.build().unwrap();
    let d = StackDiscretization::by_rule(&problem, mesh.clone(), IntegrationRule::Vertices).unwrap();
    for (name, mut solver) in solvers() {
        let solution = solve_by(&mut *solver, &d);
        // To the digits that are given.
        assert!((solution.energy() + 0.201_490_276_169).abs() < 1e-11, "{name}: {}", solution.energy());
        let totals: Vec<f64> = solution.gaps().iter().map(|gap| gap.total_force).collect();
        assert!(
            (totals[0] - 6.982_501_3).abs() < 1e-6 && (totals[1] - 5.476_097_42).abs() < 1e-7,
            "{name}: {totals:?}"
        );
        let contact: Vec<usize> = solution.gaps().iter().map(GapSolution::contact_vertices).collect();
        assert_eq!(contact, [529, 431], "{name}");
    }
    // By quadrature, the energy is another one.
    let solution = solve_by(&mut Auto, &posed(&problem, &mesh));
    assert!((solution.energy() + 0.201_490_276_169).abs() > 1e-5, "{}", solution.energy());
}

/// A membrane that nothing holds but the one below it, which it is pressed against: the total action is its load, wherever it acts.
#[test]
fn membranes_that_are_only_pressed_are_held_by_their_neighbours() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [12, 12], Pattern::Right).unwrap();
    let loose = |load: f64| Membrane::new(1.0).load(load).free().pressed();
    let held = Membrane::new(2.0).load(3.0);
    let hat = Function::from_fn(|x, y| if x + y < 0.9 { -20.0 } else { 1.0 });
    let cases = [
        // From the top: on the lower one; two on it; hung under the upper one; on a floor; one in between, up and down.
        (ContactProblem::stack().membrane(loose(-6.0)).membrane(held.clone()), vec![(1, 6.0)]),
        (
            ContactProblem::stack().membrane(loose(-6.0)).membrane(loose(2.0)).membrane(held.clone()),
            vec![(1, 6.0), (2, 4.0)],
        ),
        (ContactProblem::stack().membrane(held.clone()).membrane(loose(5.0)), vec![(1, 5.0)]),
        (
            ContactProblem::stack().membrane(loose(-2.0)).floor(Function::from_fn(|x, _| 0.2 * x * x)),
            vec![(1, 2.0)],
        ),
        (ContactProblem::stack().membrane(held.clone()).membrane(loose(-7.0)).floor(-0.3), vec![(2, 7.0)]),
    ];
    for (stack, totals) in cases {
        let d = posed(&stack.build().unwrap(), &mesh);
        for (name, mut solver) in solvers() {
            let solution = solve_by(&mut *solver, &d);
            for &(gap, total) in &totals {
                let found = solution.gap(gap).unwrap().total_force;
                assert!((found - total).abs() < 1e-8, "{name}: gap {gap} has {found}");
            }
        }
    }
    // Where the load is uneven, it rests on a part only.
    let uneven = Membrane::new(1.0).load(hat).free().pressed();
    let d = posed(&ContactProblem::stack().membrane(uneven).membrane(held).build().unwrap(), &mesh);
    let solution = solve_by(&mut ActiveSet, &d);
    let vertices = solution.gap(1).unwrap().contact_vertices();
    assert!((1..100).contains(&vertices), "{vertices}");
    assert!(solution.imbalance() < ROUNDING);
}
