//! Multigrid for stacks whose membranes and obstacles know of each other.

use std::f64::consts::PI;

use proptest::prelude::*;

use super::posed;
use crate::action::{StackSolution, certify_stack};
use crate::discretization::StackDiscretization;
use crate::mesh::samples::{irregular, with_sides_and_patch};
use crate::mesh::{Mesh, Pattern, rectangle};
use crate::numeric::largest;
use crate::problem::samples::stack::drawn;
use crate::problem::{ContactProblem, Function, Membrane};
use crate::qp::Status;
use crate::solver::{ActiveSet, Auto, Candidate, ContactSolver, Multigrid, SolverOptions, StartingPoint};

const TOLERANCE: f64 = 1e-10;

/// What residuals of [`TOLERANCE`] may leave of a displacement, and twice that of an action, relative to the data.
const AGREEMENT: f64 = 1e-8;

/// Cycles at [`TOLERANCE`], whatever the size of the mesh and the number of membranes.
const CYCLES: usize = 7;

/// And where tensions jump or meshes are stretched.
const HARD_CYCLES: usize = 9;

/// What the sums of an energy leave of its last digits.
const ENERGY_ROUNDING: f64 = 1e-12;

fn options() -> SolverOptions {
    SolverOptions { tolerance: TOLERANCE, ..SolverOptions::default() }
}

fn square(cells: usize) -> Mesh {
    rectangle([0.0, 0.0], [1.0, 1.0], [cells; 2], Pattern::Right).unwrap()
}

fn solved(d: &StackDiscretization) -> Candidate {
    Multigrid.solve_stack(d, &options()).unwrap()
}

fn certified(d: &StackDiscretization, candidate: Candidate) -> StackSolution {
    certify_stack(d, candidate, TOLERANCE).unwrap()
}

fn falls(energies: &[f64]) -> bool {
    energies.windows(2).all(|pair| pair[1] <= pair[0] + ENERGY_ROUNDING * pair[0].abs())
}

/// The upper ones press on the lower ones, here more and there less.
fn load(i: usize, n: usize) -> Function {
    let mean = if n == 1 { -15.0 } else { 13.0 * (2.0 * i as f64 / (n - 1) as f64 - 1.0) };
    let [k, m] = [[2.0, 1.0], [4.0, 3.0], [3.0, 2.0], [1.0, 4.0], [5.0, 1.0]][i].map(|k| k * PI);
    Function::from_fn(move |x, y| mean + 20.0 * (k * x).sin() * (m * y).sin())
}

/// Tensions that are not in proportion.
fn smooth(i: usize) -> Function {
    match i % 3 {
        0 => Function::from_fn(|x, _| 1.0 + 2.0 * x * x),
        1 => Function::from_fn(|_, y| 1.0 + 2.0 * y),
        _ => Function::from_fn(|x, _| 3.0 - 2.0 * x),
    }
}

/// Jumps by a factor of 100, where four parts meet; other ones for each membrane.
fn checkerboard(i: usize) -> Function {
    Function::from_fn(move |x, y| {
        let field = [x, y].map(|x| (4.0 * x + 1e-9).floor() as usize);
        if (field[0] + field[1] + i).is_multiple_of(2) { 100.0 } else { 1.0 }
    })
}

fn stack(tension: impl Fn(usize) -> Function, n: usize, [ceiling, floor]: [bool; 2]) -> ContactProblem {
    let mut stack = ContactProblem::stack();
    if ceiling {
        stack = stack.ceiling(0.02 * n as f64 + 0.05);
    }
    for i in 0..n {
        let height = 0.02 * (n - 1 - i) as f64;
        stack = stack.membrane(Membrane::new(tension(i)).load(load(i, n)).height(height));
    }
    let stack = if floor { stack.floor(-0.05) } else { stack };
    stack.build().unwrap()
}

/// The cycles on the finest of these meshes, of which the coarser ones need no more either.
fn cycles(problem: &ContactProblem, meshes: &[Mesh], most: usize) {
    let counts: Vec<usize> = meshes
        .iter()
        .map(|mesh| {
            let d = posed(problem, mesh);
            let candidate = solved(&d);
            let statistics = candidate.statistics.clone();
            assert!(falls(&statistics.energies), "{:?}", statistics.energies);
            assert_eq!(statistics.level_iterations.last(), Some(&statistics.iterations));
            certified(&d, candidate);
            statistics.iterations
        })
        .collect();
    assert!(counts.iter().all(|&count| count <= most), "{counts:?}");
}

#[test]
fn cycles_do_not_depend_on_the_mesh_or_on_the_number_of_membranes() {
    let meshes: Vec<Mesh> = [16, 32, 64, 128].map(square).into();
    let constant = |i: usize| Function::Constant(1.0 + 0.5 * i as f64);
    for n in [1, 2, 3, 5] {
        // One membrane over a floor alone is another problem's.
        let meshes = if n == 5 { &meshes[..3] } else { &meshes };
        cycles(&stack(smooth, n, [n == 1, true]), meshes, CYCLES);
        cycles(&stack(constant, n.max(2), [false; 2]), meshes, CYCLES);
    }
    cycles(&stack(smooth, 3, [true; 2]), &meshes, CYCLES);
}

#[test]
fn jumps_bearings_and_spirals_need_few_more() {
    let meshes: Vec<Mesh> = [32, 64, 128].map(square).into();
    for n in [1, 2, 3] {
        cycles(&stack(checkerboard, n, [n == 1, true]), &meshes, HARD_CYCLES);
    }
    // A ceiling out of reach makes of the others' obstacle problem one of a stack.
    for eccentricity in [0.1, 0.9, 0.99] {
        let tension = Function::from_fn(move |x, _| (1.0 + eccentricity * x.cos()).powi(3));
        let film = Membrane::new(tension).load(Function::from_fn(move |x, _| eccentricity * x.sin()));
        let bearing = ContactProblem::stack().membrane(film).floor(0.0).ceiling(1e3).build().unwrap();
        let meshes = [32, 64, 128]
            .map(|cells| rectangle([0.0, 0.0], [2.0 * PI, 20.0], [cells; 2], Pattern::Right).unwrap());
        cycles(&bearing, &meshes, HARD_CYCLES);
    }
    // Graeser, Kornhuber (2009).
    let spiral = Function::from_fn(|x: f64, y: f64| {
        let (r, angle) = (x.hypot(y), y.atan2(x));
        let turns = if r == 0.0 { 0.0 } else { (2.0 * PI / r + PI / 2.0 - angle).sin() };
        turns + r * (r + 1.0) / (r - 2.0) - 3.0 * r + 3.6
    });
    let spiral =
        ContactProblem::stack().membrane(Membrane::new(1.0)).floor(spiral).ceiling(1e3).build().unwrap();
    let meshes =
        [32, 64, 128].map(|cells| rectangle([-1.0, -1.0], [1.0, 1.0], [cells; 2], Pattern::Right).unwrap());
    cycles(&spiral, &meshes, HARD_CYCLES);
}

/// The largest distance of two displacements and of two sets of actions, relative to the data.
fn distances(d: &StackDiscretization, one: &StackSolution, other: &StackSolution) -> [f64; 2] {
    let off = |a: &[f64], b: &[f64]| largest(a.iter().zip(b).map(|(a, b)| (a - b).abs()));
    let u = one.displacement().iter().zip(other.displacement()).map(|(a, b)| off(a, b));
    let lambda = one.gaps().iter().zip(other.gaps()).map(|(a, b)| off(&a.lambda, &b.lambda));
    [largest(u) / d.scales().displacement, largest(lambda) / d.scales().force_density]
}

fn agrees(d: &StackDiscretization) -> Result<(), String> {
    let candidate = solved(d);
    if !falls(&candidate.statistics.energies) {
        return Err(format!("{:?}", candidate.statistics.energies));
    }
    let exact = certify_stack(d, ActiveSet.solve_stack(d, &options()).unwrap(), TOLERANCE).unwrap();
    let found = certify_stack(d, candidate, TOLERANCE).map_err(|rejected| rejected.to_string())?;
    let [u, lambda] = distances(d, &found, &exact);
    if !(u < AGREEMENT && lambda < 10.0 * AGREEMENT) {
        return Err(format!("{u:e}, {lambda:e}"));
    }
    for (found, exact) in found.gaps().iter().zip(exact.gaps()) {
        if found.contact != exact.contact {
            return Err(format!("another contact set in gap {}", exact.number));
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Own supports, free sides, foundations, line loads, tensions by region; up to five membranes, with and without obstacles.
    #[test]
    fn random_stacks_are_those_of_the_active_set_method(drawn in drawn(), cells in 3..6usize, refinements in 0..3usize) {
        let coarse = rectangle([0.0, 0.0], [1.0, 1.0], [cells; 2], Pattern::Right).unwrap();
        let mesh = (0..refinements).fold(coarse, |mesh, _| mesh.refine().unwrap().mesh);
        let d = posed(&drawn.problem(1.0, 0.0), &with_sides_and_patch(mesh));
        prop_assert_eq!(agrees(&d), Ok(()));
    }
}

/// Crossed cells, an irregular mesh with and without coarser ones, one that is graded.
#[test]
fn it_finds_what_the_active_set_method_finds_on_other_meshes() {
    let refined = irregular(6).refine().unwrap().mesh.refine().unwrap().mesh;
    let meshes = [
        rectangle([0.0, 0.0], [1.0, 1.0], [12; 2], Pattern::Crossed).unwrap(),
        irregular(20),
        refined,
        square(24).graded([0.5, 0.5], 2.0).unwrap(),
    ];
    for mesh in meshes {
        for (n, obstacles) in [(1, [true; 2]), (2, [false; 2]), (3, [false, true])] {
            assert_eq!(agrees(&posed(&stack(smooth, n, obstacles), &mesh)), Ok(()), "{n}");
        }
    }
}

/// The negative test of the agreement.
#[test]
fn another_problem_is_told_apart() {
    let of = |height: f64| {
        let sheet = |load: f64| Membrane::new(1.0).load(load);
        let stack =
            ContactProblem::stack().membrane(sheet(-9.0).height(height)).membrane(sheet(5.0)).floor(-1.0);
        let d = posed(&stack.build().unwrap(), &square(16));
        let found = certified(&d, solved(&d));
        (d, found)
    };
    let ((d, one), (_, other)) = (of(0.02), of(0.02 + 1e-6));
    assert!(distances(&d, &one, &other)[0] > AGREEMENT);
    assert!(!falls(&[1.0, 0.5, 0.5 + 1e-11]) && falls(&[1.0, 0.5, 0.5]));
}

/// A membrane that nothing but the one below holds starts on it.
#[test]
fn a_membrane_that_is_pressed_lies_on_its_neighbour() {
    let loose = Membrane::new(1.0).load(-6.0).free().pressed();
    let stack =
        ContactProblem::stack().membrane(loose).membrane(Membrane::new(2.0).load(1.0)).build().unwrap();
    for cells in [16, 64] {
        let d = posed(&stack, &square(cells));
        let candidate = solved(&d);
        assert!(candidate.statistics.iterations <= HARD_CYCLES, "{}", candidate.statistics.iterations);
        let force = certified(&d, candidate).gap(1).unwrap().total_force;
        assert!((force - 6.0).abs() < AGREEMENT, "{force}");
    }
}

#[test]
fn a_warm_start_is_used_and_limits_are_kept() {
    let d = posed(&stack(smooth, 3, [false, true]), &square(32));
    let cold = solved(&d);
    let again = SolverOptions { warm_start: Some(StartingPoint::from(cold.clone())), ..options() };
    let warm = Multigrid.solve_stack(&d, &again).unwrap();
    assert!(warm.statistics.iterations < cold.statistics.iterations.min(2));
    assert_eq!(warm.statistics.level_iterations.len(), 1);
    let stopped = SolverOptions { max_iterations: Some(2), ..options() };
    let candidate = Multigrid.solve_stack(&d, &stopped).unwrap();
    assert_eq!((candidate.statistics.status, candidate.statistics.iterations), (Status::IterationLimit, 2));
    assert!(certify_stack(&d, candidate, TOLERANCE).is_err());
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let d = posed(&stack(smooth, 3, [false, true]), &square(96));
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let found = pool.install(|| solved(&d));
        (found.displacement, found.multiplier, found.statistics.energies)
    };
    let one = with_threads(1);
    for threads in [2, 3, 4] {
        assert!(with_threads(threads) == one, "{threads}");
    }
}

/// Tensions that jump by more than cycles can make up for.
#[test]
fn where_it_stalls_the_active_set_method_takes_over() {
    let chosen = |contrast: f64| {
        let board = |i: usize| {
            Function::from_fn(move |x, y| {
                let field = [x, y].map(|x| (8.0 * x + 1e-9).floor() as usize);
                if (field[0] + field[1] + i).is_multiple_of(2) { contrast } else { 1.0 }
            })
        };
        let d = posed(&stack(board, 3, [false, true]), &square(64));
        Auto.solve_stack(&d, &SolverOptions::default()).unwrap().statistics
    };
    let found = chosen(1e10);
    assert_eq!((found.solver.as_str(), found.status), ("active-set", Status::Solved));
    assert!(found.choice.unwrap().ends_with("; multigrid stalled"));
    let methods: Vec<&str> = found.stalled.iter().map(|stalled| stalled.method.as_str()).collect();
    assert_eq!(methods, ["multigrid on levels of 5 refinements", "multigrid on algebraic levels"]);
    let found = chosen(100.0);
    assert_eq!((found.solver.as_str(), found.stalled.len()), ("multigrid", 0));
}

/// Very flat crossed cells have large positive entries off the diagonal: coarser meshes are no good for them.
#[test]
fn where_it_stalls_on_the_refinements_algebraic_levels_take_over() {
    let sheet = |load: f64| Membrane::new(1.0).load(load);
    let problem = ContactProblem::stack().membrane(sheet(-1e3).height(0.1)).membrane(sheet(1e3)).floor(-1e3);
    let problem = problem.build().unwrap();
    let found = |height: f64| {
        let mesh = rectangle([0.0, 0.0], [1.0, height], [64; 2], Pattern::Crossed).unwrap();
        let d = posed(&problem, &mesh);
        let found = Auto.solve_stack(&d, &SolverOptions::default()).unwrap();
        certify_stack(&d, found, SolverOptions::default().tolerance).unwrap().statistics().clone()
    };
    let flat = found(0.01);
    assert_eq!((flat.solver.as_str(), flat.status), ("multigrid", Status::Solved));
    let methods: Vec<&str> = flat.stalled.iter().map(|stalled| stalled.method.as_str()).collect();
    assert_eq!(methods, ["multigrid on levels of 6 refinements"]);
    assert!(flat.iterations <= 2 * HARD_CYCLES, "{}", flat.iterations);
    let square = found(1.0);
    assert_eq!((square.solver.as_str(), square.stalled.len()), ("multigrid", 0));
}
