//! Which solver is chosen.

use super::*;
use crate::mesh::{Pattern, rectangle};
use crate::problem::{ContactProblem, Membrane};
use crate::solver::Statistics;

/// Very flat crossed cells: large positive entries off the diagonal, which no levels of multigrid are good for.
#[test]
fn where_multigrid_stalls_the_active_set_method_takes_over() {
    let problem = ContactProblem::builder().tension(1.0, 3.0).load(-1.5e5, 1e5).height(0.1).build().unwrap();
    let choice = |height: f64| {
        let mesh = rectangle([0.0, 0.0], [1.0, height], [64; 2], Pattern::Crossed).unwrap();
        let d = Discretization::new(&problem, mesh).unwrap();
        let mut auto = Auto;
        let mut prepared = auto.prepare(&d);
        let mut solve = || prepared.solve(&SolverOptions::default()).expect("it runs").statistics;
        let [first, second] = [solve(), solve()];
        assert_eq!([first.status, second.status], [Status::Solved; 2], "{first:?} {second:?}");
        // What has stalled in the first solve is not tried again, and the second one says so too.
        assert_eq!((&first.choice, &first.stalled), (&second.choice, &second.stalled));
        first
    };
    let found = choice(0.01);
    let reason = found.choice.expect("it was left open");
    assert_eq!(found.solver, ActiveSet.name());
    assert!(reason.ends_with("; multigrid stalled"), "{reason}");
    let methods: Vec<&str> = found.stalled.iter().map(|stalled| stalled.method.as_str()).collect();
    assert_eq!(methods, ["multigrid on levels of 6 refinements", "multigrid on algebraic levels"]);
    assert!(found.stalled.iter().all(|stalled| stalled.iterations > 0));
    let found = choice(1.0);
    let reason = found.choice.expect("it was left open");
    assert_eq!(found.solver, Multigrid.name());
    assert!(!reason.contains("stalled"), "{reason}");
    assert!(found.stalled.is_empty());
}

fn chosen(problem: &ContactProblem, [width, height]: [f64; 2], cells: usize) -> Statistics {
    let mesh = rectangle([0.0, 0.0], [width, height], [cells; 2], Pattern::Crossed).unwrap();
    let d = StackDiscretization::new(problem, mesh).unwrap();
    Auto.solve_stack(&d, &SolverOptions::default()).unwrap().statistics
}

#[test]
fn it_depends_on_the_structure_and_on_the_unknowns() {
    let sheet = |load: f64| Membrane::new(1.0).load(load);
    let floor = ContactProblem::obstacle(sheet(-20.0), -0.1).unwrap();
    let ceiling = ContactProblem::stack().membrane(sheet(20.0)).ceiling(0.1).build().unwrap();
    let coupled = ContactProblem::stack().membrane(sheet(-9.0)).membrane(sheet(9.0)).floor(-1.0);
    let coupled = coupled.build().unwrap();
    let few = "few unknowns (481), 4 coarser meshes known";
    let many = |unknowns: &str| format!("many unknowns ({unknowns}), 4 coarser meshes known");
    for (problem, cells, solver, choice) in [
        (&floor, 16, "active-set", format!("one membrane over a floor, {few}")),
        (&floor, 48, "multigrid", format!("one membrane over a floor, {}", many("4,513"))),
        (&ceiling, 16, "active-set", format!("one membrane under a ceiling, {few}")),
        (&coupled, 48, "multigrid", format!("2 coupled membranes over a floor, {}", many("9,026"))),
    ] {
        let found = chosen(problem, [1.0; 2], cells);
        assert_eq!((found.solver.as_str(), found.status), (solver, Status::Solved));
        assert_eq!(found.choice, Some(format!("by auto: {choice}")));
    }
}

/// Very flat crossed cells: large positive entries off the diagonal, which no levels of multigrid are good for.
#[test]
fn where_multigrid_stalls_on_a_stack_too() {
    let sheet = Membrane::new(1.0).load(-5e4).height(0.1);
    let problem = ContactProblem::stack().membrane(sheet).build().unwrap();
    let found = chosen(&problem, [1.0, 0.01], 64);
    assert_eq!((found.solver.as_str(), found.status), ("active-set", Status::Solved));
    assert!(found.choice.expect("it was left open").ends_with("; multigrid stalled"));
    let methods: Vec<&str> = found.stalled.iter().map(|stalled| stalled.method.as_str()).collect();
    assert_eq!(methods, ["multigrid on levels of 6 refinements", "multigrid on algebraic levels"]);
    let found = chosen(&problem, [1.0, 1.0], 64);
    assert_eq!((found.solver.as_str(), found.stalled.len()), ("multigrid", 0));
}

/// Whatever has stalled on a coupled stack, the active set method takes over, says why, and is not asked about it again.
#[test]
fn where_multigrid_has_stalled_on_coupled_membranes() {
    let sheet = |load: f64| Membrane::new(1.0).load(load);
    let problem = ContactProblem::stack().membrane(sheet(-9.0)).membrane(sheet(9.0)).build().unwrap();
    let mesh = rectangle([0.0, 0.0], [1.0; 2], [32; 2], Pattern::Crossed).unwrap();
    let d = StackDiscretization::new(&problem, mesh).unwrap();
    let stalled = vec![Stalled { method: "multigrid on algebraic levels".into(), iterations: 7 }];
    let mut auto = PreparedAuto { multigrid: Err(stalled.clone()), ..PreparedAuto::new((&d).into()) };
    for _ in 0..2 {
        let found = auto.solve(&SolverOptions::default()).unwrap().statistics;
        assert_eq!((found.solver.as_str(), found.status), ("active-set", Status::Solved));
        assert!(found.choice.expect("it was left open").ends_with("; multigrid stalled"));
        assert_eq!(found.stalled, stalled);
    }
}
