//! The contract of a QP backend, checked for every one in the build.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use membrane_contact::action::certify_pair;
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::{Pattern, rectangle};
use membrane_contact::problem::Case;
use membrane_contact::qp::{
    Clarabel, Interrupt, KktResiduals, QpBackend, QpOptions, QpProblem, Status, TimeLimit, contact_qp,
};
use membrane_contact::solver::{ActiveSet, Candidate, ContactSolver, SolverOptions, StartingPoint};
use membrane_contact::sprs::{CsMat, TriMat};

use crate::common::{TOLERANCE, distance, exact, solve, solvers};

/// Backends stop by criteria of their own, which bound ours up to a small factor.
const SLACK: f64 = 10.0;

fn backends() -> Vec<Box<dyn QpBackend>> {
    vec![
        Box::new(Clarabel),
        #[cfg(feature = "osqp")]
        Box::new(membrane_contact::qp::Osqp),
    ]
}

fn matrix(shape: (usize, usize), entries: &[(usize, usize, f64)]) -> CsMat<f64> {
    let mut triplets = TriMat::new(shape);
    for &(row, column, value) in entries {
        triplets.add_triplet(row, column, value);
    }
    triplets.to_csc()
}

/// A program with the solution `(x, y)`, derived by hand.
struct Example {
    qp: QpProblem,
    x: Vec<f64>,
    y: Vec<f64>,
}

fn examples() -> Vec<Example> {
    let example =
        |p: &[(usize, usize, f64)], q: &[f64], a: &[(usize, usize, f64)], b: &[f64], x: &[f64], y: &[f64]| {
            let p = matrix((q.len(), q.len()), p);
            let a = matrix((b.len(), q.len()), a);
            let qp = QpProblem::new(p, q.to_vec(), a, b.to_vec()).expect("valid");
            Example { qp, x: x.to_vec(), y: y.to_vec() }
        };
    vec![
        // min 1/2 x^2 - 2 x subject to x <= 1: x = 1, and 1 - 2 = -y
        example(&[(0, 0, 1.0)], &[-2.0], &[(0, 0, -1.0)], &[-1.0], &[1.0], &[1.0]),
        // the same without the bound in the way: x = 2, y = 0
        example(&[(0, 0, 1.0)], &[-2.0], &[(0, 0, -1.0)], &[-3.0], &[2.0], &[0.0]),
        // min (x1^2 + x2^2)/2 + x1 - x2 subject to x1 >= x2: x = (0, 0), and (1, -1) = (y, -y)
        example(
            &[(0, 0, 1.0), (1, 1, 1.0)],
            &[1.0, -1.0],
            &[(0, 0, 1.0), (0, 1, -1.0)],
            &[0.0],
            &[0.0, 0.0],
            &[1.0],
        ),
        // min x1^2 + x1 x2 + x2^2 - 3 x1 subject to x1 + x2 >= 2, x2 >= -5: on x1 + x2 = 2 the objective is
        // x1^2 - 5 x1 + 4, so x = (5/2, -1/2), and (2 x1 + x2 - 3, x1 + 2 x2) = (3/2, 3/2) = (y1, y1 + y2)
        example(
            &[(0, 0, 2.0), (0, 1, 1.0), (1, 1, 2.0)],
            &[-3.0, 0.0],
            &[(0, 0, 1.0), (0, 1, 1.0), (1, 1, 1.0)],
            &[2.0, -5.0],
            &[2.5, -0.5],
            &[1.5, 0.0],
        ),
    ]
}

#[test]
fn hand_derived_examples_are_optimal_and_their_flipped_duals_are_not() {
    for (k, Example { qp, x, y }) in examples().iter().enumerate() {
        assert_eq!(KktResiduals::new(qp, x, y).worst(), 0.0, "example {k}");
        let flipped: Vec<f64> = y.iter().map(|y| -y).collect();
        let pushed = y.iter().any(|&y| y != 0.0);
        assert_eq!(KktResiduals::new(qp, x, &flipped).worst() > 0.0, pushed, "example {k}");
    }
}

#[test]
fn every_backend_finds_primal_and_dual_with_our_sign() {
    for mut backend in backends() {
        for (k, Example { qp, x, y }) in examples().iter().enumerate() {
            let solution = backend.solve(qp, &QpOptions::default()).expect("it runs");
            assert_eq!(solution.status, Status::Solved, "{}, example {k}", backend.name());
            assert!(distance(&solution.x, x) < SLACK * TOLERANCE, "{}, example {k}", backend.name());
            assert!(distance(&solution.y, y) < SLACK * TOLERANCE, "{}, example {k}", backend.name());
        }
    }
}

#[test]
fn every_backend_says_when_it_stops_early_and_returns_its_iterate() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [16, 16], Pattern::Right).unwrap();
    let problem = exact(Case::Circle, &[]).problem().unwrap();
    let qp = contact_qp(&PairDiscretization::new(&problem, mesh.clone()).unwrap()).nondimensional();
    for mut backend in backends() {
        let stopped = QpOptions { max_iterations: Some(3), ..QpOptions::default() };
        let solution = backend.solve(&qp, &stopped).expect("it runs");
        assert_eq!((solution.status, solution.iterations), (Status::IterationLimit, 3), "{}", backend.name());
        assert_eq!((solution.x.len(), solution.y.len()), (qp.q().len(), qp.b().len()));
        assert!(KktResiduals::new(&qp, &solution.x, &solution.y).worst() > TOLERANCE);

        let hurried = QpOptions { time_limit: Some(TimeLimit::SHORTEST), ..QpOptions::default() };
        assert_eq!(
            backend.solve(&qp, &hurried).expect("it runs").status,
            Status::TimeLimit,
            "{}",
            backend.name()
        );
    }
}

#[test]
fn residuals_follow_the_tolerance() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [16, 16], Pattern::Right).unwrap();
    let problem = exact(Case::Circle, &[]).problem().unwrap();
    let qp = contact_qp(&PairDiscretization::new(&problem, mesh.clone()).unwrap()).nondimensional();
    for mut backend in backends() {
        for tolerance in [1e-3, 1e-5, 1e-8] {
            let solution =
                backend.solve(&qp, &QpOptions { tolerance, ..QpOptions::default() }).expect("it runs");
            let residual = KktResiduals::new(&qp, &solution.x, &solution.y).worst();
            assert!(residual <= SLACK * tolerance, "{}: {residual} at {tolerance}", backend.name());
        }
    }
}

#[test]
fn programs_without_a_solution_are_never_solved() {
    let identity = || matrix((1, 1), &[(0, 0, 1.0)]);
    // x >= 1 and -x >= 0
    let infeasible =
        QpProblem::new(identity(), vec![0.0], matrix((2, 1), &[(0, 0, 1.0), (1, 0, -1.0)]), vec![1.0, 0.0])
            .unwrap();
    // min -x subject to x >= 0
    let unbounded = QpProblem::new(matrix((1, 1), &[]), vec![-1.0], identity(), vec![0.0]).unwrap();
    for mut backend in backends() {
        let status = |qp, backend: &mut dyn QpBackend| {
            backend.solve(qp, &QpOptions::default()).expect("it runs").status
        };
        assert_eq!(status(&infeasible, backend.as_mut()), Status::Infeasible, "{}", backend.name());
        assert_eq!(status(&unbounded, backend.as_mut()), Status::Unbounded, "{}", backend.name());
    }
}

#[test]
fn results_and_iterations_are_the_same_in_every_run() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [16, 16], Pattern::Crossed).unwrap();
    let problem = exact(Case::Circle, &[]).problem().unwrap();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    for mut solver in solvers() {
        let [first, second] = [(); 2].map(|()| solve(solver.as_mut(), &d, true));
        assert_eq!(first.displacement, second.displacement);
        assert_eq!(first.multiplier, second.multiplier);
        assert_eq!(first.statistics.iterations, second.statistics.iterations);
    }
}

#[cfg(feature = "osqp")]
#[test]
fn osqp_needs_fewer_iterations_from_a_warm_start() {
    use membrane_contact::qp::Osqp;
    use membrane_contact::solver::QpSolver;

    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [24, 24], Pattern::Right).unwrap();
    let problem = exact(Case::Circle, &[]).problem().unwrap();
    let nearby = exact(Case::Circle, &[("q", 10.1)]).problem().unwrap();
    let solution =
        solve(&mut QpSolver::new(Osqp), &PairDiscretization::new(&problem, mesh.clone()).unwrap(), true);
    let d = PairDiscretization::new(&nearby, mesh.clone()).unwrap();
    let [cold, warm] = [None, Some(solution.into())].map(|warm_start| {
        let options = SolverOptions { warm_start, ..SolverOptions::default() };
        QpSolver::new(Osqp).solve_pair(&d, &options).expect("it runs").statistics.iterations
    });
    assert!(warm < cold, "{warm} iterations from a warm start, {cold} without");
}

#[test]
fn the_active_set_needs_one_solve_from_its_own_answer_and_few_from_a_nearby_one() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [24, 24], Pattern::Right).unwrap();
    let steps = |parameters: &[(&str, f64)], warm_start: Option<StartingPoint>| {
        let problem = exact(Case::Circle, parameters).problem().unwrap();
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let options = SolverOptions { warm_start, ..SolverOptions::default() };
        ActiveSet.solve_pair(&d, &options).expect("it runs")
    };
    let cold = steps(&[], None);
    assert_eq!(steps(&[], Some(cold.clone().into())).statistics.iterations, 1);
    let on_all_levels = |found: Candidate| found.statistics.level_iterations.iter().sum::<usize>();
    let from_cold = on_all_levels(steps(&[("R", 0.32)], None));
    let from_nearby = on_all_levels(steps(&[("R", 0.32)], Some(cold.into())));
    assert!(from_nearby < from_cold, "{from_nearby} steps from a nearby solution, {from_cold} without");
}

#[test]
fn the_active_set_stopped_early_is_rejected() {
    // Where coarser meshes are known, the contact set that they guess may be exact; 25 cells have none.
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [25, 25], Pattern::Right).unwrap();
    let problem = exact(Case::Circle, &[]).problem().unwrap();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let options = SolverOptions { max_iterations: Some(1), ..SolverOptions::default() };
    let stopped = ActiveSet.solve_pair(&d, &options).expect("it runs");
    assert_eq!((stopped.statistics.status, stopped.statistics.iterations), (Status::IterationLimit, 1));
    assert!(certify_pair(&d, stopped, TOLERANCE).is_err());
}

#[test]
fn options_out_of_range_are_refused() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [2, 2], Pattern::Right).unwrap();
    let problem = exact(Case::Circle, &[]).problem().unwrap();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let with = |options: SolverOptions| solvers()[0].solve_pair(&d, &options).map(|_| ());
    assert!(with(SolverOptions::default()).is_ok());
    for tolerance in [0.0, 1.0, -1e-8, f64::NAN] {
        assert!(with(SolverOptions { tolerance, ..SolverOptions::default() }).is_err());
    }
}

#[test]
fn a_limit_of_time_is_kept_from_the_shortest_to_the_longest_by_every_solver() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [40, 40], Pattern::Right).unwrap();
    let problem = exact(Case::Circle, &[]).problem().unwrap();
    let d = PairDiscretization::new(&problem, mesh).unwrap();
    for mut solver in solvers() {
        let mut status = |seconds: f64| {
            let time_limit = Some(TimeLimit::from_seconds(seconds).expect("a limit"));
            let options = SolverOptions { time_limit, ..SolverOptions::default() };
            solver.solve_pair(&d, &options).expect("it runs").statistics.status
        };
        assert_eq!(status(1e-300), Status::TimeLimit);
        assert_eq!((status(60.0), status(1e19)), (Status::Solved, Status::Solved));
    }
    // What is no limit cannot be asked for.
    for seconds in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300] {
        assert!(TimeLimit::from_seconds(seconds).is_err());
    }
}

#[test]
fn an_interrupt_is_heard_between_the_steps_of_a_solver() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [40, 40], Pattern::Right).unwrap();
    let problem = exact(Case::Circle, &[]).problem().unwrap();
    let d = PairDiscretization::new(&problem, mesh).unwrap();
    for mut solver in solvers().into_iter().filter(|solver| solver.name() != "osqp") {
        let mut solved = |questions: usize| {
            let asked = Arc::new(AtomicUsize::new(0));
            let count = Arc::clone(&asked);
            let interrupt = Interrupt::new(move || count.fetch_add(1, Ordering::Relaxed) >= questions);
            let options = SolverOptions { interrupt: Some(interrupt), ..SolverOptions::default() };
            let candidate = solver.solve_pair(&d, &options).expect("it runs");
            (candidate, asked.load(Ordering::Relaxed))
        };
        let (whole, questions) = solved(usize::MAX);
        assert_eq!(whole.statistics.status, Status::Solved);
        assert!(questions > 0 && certify_pair(&d, whole, TOLERANCE).is_ok(), "{questions} questions");
        let (stopped, _) = solved(0);
        assert_eq!(stopped.statistics.status, Status::Interrupted);
        let rejected = certify_pair(&d, stopped, TOLERANCE).expect_err("it has not arrived");
        assert!(rejected.remedy().contains("asked to stop"), "{}", rejected.remedy());
    }
}
