//! Whatever the solver, what is certified is in the cones and complementary to the last bit: `u1 >= u2`, (4.2) and (4.8).

use membrane_contact::action::{ContactSolution, certify};
use membrane_contact::discretization::Discretization;
use membrane_contact::mesh::{Mesh, Pattern, VertexKind, rectangle};
use membrane_contact::problem::{Case, ContactProblem};
use membrane_contact::solver::{
    ActiveSet, Candidate, ContactSolver, Multigrid, SolverOptions, StartingPoint, Statistics,
};

use crate::common::{TOLERANCE, exact, solve, solvers};

/// What is asked of a solver that need not be accurate.
const LOOSE: f64 = 1e-3;

fn square(cells: usize) -> Mesh {
    rectangle([0.0, 0.0], [1.0, 1.0], [cells; 2], Pattern::Right).unwrap()
}

/// The example of FreeFEM, with other tensions, in other units of length of the membranes and of force.
fn freefem(tension: [f64; 2], length: f64, force: f64) -> ContactProblem {
    let [mu1, mu2] = tension.map(|mu| mu * force / length);
    let builder = ContactProblem::builder().tension(mu1, mu2).height(0.2 * length);
    builder.load(-15.0 * force, 10.0 * force).build().unwrap()
}

/// Partial contact in several units, with one membrane stiff, full contact, contact without a force, none.
fn problems() -> Vec<(String, ContactProblem)> {
    let mut problems: Vec<_> =
        [([1.0, 1.0], 1.0, 1.0), ([1.0, 1e6], 1.0, 1e6), ([1e6, 1.0], 1e-6, 1e6), ([1.0, 1.0], 1e3, 1e-9)]
            .map(|(tension, length, force)| {
                (format!("{tension:?}, {length}, {force}"), freefem(tension, length, force))
            })
            .into();
    let biactive = exact(Case::Biactive, &[("q", 1e-12)]);
    problems.push(("biactive, pushed a little".into(), biactive.problem().unwrap()));
    for case in [Case::Circle, Case::Annulus, Case::FullContact, Case::Biactive, Case::NoContact] {
        problems.push((case.to_string(), exact(case, &[]).problem().unwrap()));
    }
    problems
}

/// The vertices that are not as they must be.
fn faults(d: &Discretization, solution: &ContactSolution) -> Vec<String> {
    let (gap, lambda, contact) = (solution.gap(), solution.lambda(), solution.contact());
    let is_fine = |a: usize| match d.mesh().kind()[a] {
        VertexKind::Interior => {
            let (touches, pressed) = (gap[a] == 0.0, lambda[a] > 0.0);
            gap[a] >= 0.0 && lambda[a] >= 0.0 && contact[a] == touches && (touches || !pressed)
        }
        _ => gap[a] == d.height()[a] && lambda[a] == 0.0 && !contact[a],
    };
    let describe = |a: usize| format!("vertex {a}: {:e}, {:e}, {}", gap[a], lambda[a], contact[a]);
    (0..gap.len()).filter(|&a| !is_fine(a)).map(describe).collect()
}

fn contacts(solution: &ContactSolution) -> usize {
    solution.contact().iter().filter(|&&contact| contact).count()
}

fn pressed(solution: &ContactSolution) -> usize {
    solution.lambda().iter().filter(|&&lambda| lambda > 0.0).count()
}

#[test]
fn every_solver_touches_where_it_presses_and_presses_nowhere_else() {
    let mesh = square(16);
    for (name, problem) in problems() {
        let d = Discretization::new(&problem, &mesh).unwrap();
        let reference = certify(&d, solve(&mut ActiveSet, &d, true), TOLERANCE).unwrap();
        for mut solver in solvers() {
            let solver_name = solver.name().to_owned();
            let solution = certify(&d, solve(&mut *solver, &d, true), TOLERANCE).unwrap();
            assert_eq!(faults(&d, &solution), [""; 0], "{solver_name}, {name}");
            assert_eq!(solution.contact(), reference.contact(), "{solver_name}, {name}");
        }
    }
}

#[test]
fn so_does_what_is_not_polished_or_loose() {
    let mesh = square(16);
    let mut certified = 0;
    for (name, problem) in problems() {
        let d = Discretization::new(&problem, &mesh).unwrap();
        for (tolerance, polish) in [(TOLERANCE, false), (LOOSE, false), (LOOSE, true)] {
            for mut solver in solvers() {
                let options = SolverOptions { tolerance, polish, ..SolverOptions::default() };
                let candidate = solver.solve(&d, &options).unwrap();
                let is = format!("{}, {name}, {tolerance:e}, {polish}", solver.name());
                match certify(&d, candidate, tolerance) {
                    Ok(solution) => {
                        assert_eq!(faults(&d, &solution), [""; 0], "{is}");
                        certified += 1;
                    }
                    Err(rejected) => println!("{is}: {rejected}"),
                }
            }
        }
    }
    assert!(certified > 0, "{certified}");
}

/// 36,561 vertices of FreeFEM's 257 x 257 touch; on each of them the membranes press.
#[test]
fn multigrid_and_active_set_find_the_contact_of_freefem() {
    let problem = freefem([1.0, 1.0], 1.0, 1.0);
    let mesh = square(256);
    let d = Discretization::new(&problem, &mesh).unwrap();
    let solvers: [&mut dyn ContactSolver; 2] = [&mut ActiveSet, &mut Multigrid];
    for solver in solvers {
        let solution = certify(&d, solve(solver, &d, true), TOLERANCE).unwrap();
        println!("{}: {} {}", solver.name(), contacts(&solution), pressed(&solution));
        assert_eq!(faults(&d, &solution), [""; 0], "{}", solver.name());
        assert_eq!((contacts(&solution), pressed(&solution)), (36_561, 36_561), "{}", solver.name());
    }
}
