mod patches;

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::*;
use crate::action::certify_pair;
use crate::mesh::samples::irregular;
use crate::mesh::{Mesh, MeshSize, Pattern, disk, generate, l_shape, rectangle};
use crate::multigrid::half::MAX_CYCLES;
use crate::multigrid::hierarchy::{Hierarchy, LONGEST, Values};
use crate::multigrid::sweep::Bounded;
use crate::multigrid::truncation::Truncation;
use crate::numeric::{Random, largest};
use crate::problem::samples::drawn;
use crate::problem::{Case, ContactProblem, Domain, Function};
use crate::solver::{ActiveSet, Statistics};

const TOLERANCE: f64 = 1e-9;

/// Cycles on structured meshes at [`TOLERANCE`], whatever their size.
const CYCLES: usize = 10;

/// And where the solution is singular at a corner, and the first guess far off.
const CORNER_CYCLES: usize = 16;

/// Two energies of size one that differ by less are the same.
const ENERGY_ROUNDING: f64 = 1e-13;

/// What comes of these levels alone.
fn on_levels(hierarchy: Hierarchy, d: &PairDiscretization) -> Statistics {
    let levels = MembraneLevels::Stored(hierarchy);
    pair::multigrid::solve_on(&levels, d, NAME, &options(), Instant::now()).expect("it runs").statistics
}

fn problem(tension: [f64; 2], height: f64) -> ContactProblem {
    let load = Function::from_fn(|x: f64, y: f64| 30.0 * (12.566 * x).sin() * (9.425 * y).sin());
    ContactProblem::builder()
        .tension(tension[0], tension[1])
        .load(-10.0, load)
        .height(height)
        .build()
        .unwrap()
}

/// Right-angled, crossed, round, with a corner, graded, unstructured, without ancestry, refined.
fn meshes() -> Vec<Mesh> {
    let square = |cells| rectangle([0.0, 0.0], [1.0, 1.0], cells, Pattern::Right).unwrap();
    let unit = Domain::Rectangle { lower: [0.0, 0.0], upper: [1.0, 1.0] };
    vec![
        square([32, 32]),
        square([24, 40]),
        square([31, 17]),
        rectangle([0.0, 0.0], [1.0, 1.0], [16, 16], Pattern::Crossed).unwrap(),
        disk([0.5, 0.5], 0.5, 16).unwrap(),
        l_shape(1.0, 16, Pattern::Right).unwrap(),
        l_shape(1.0, 16, Pattern::Right).unwrap().graded([0.0, 0.0], 2.0).unwrap(),
        generate(&unit, MeshSize::EdgeLength { size: 0.04, min_angle: 25.0 }).unwrap(),
        irregular(6).refine().unwrap().mesh.refine().unwrap().mesh,
    ]
}

fn solve_by(solver: &mut dyn ContactSolver, d: &PairDiscretization, options: &SolverOptions) -> Candidate {
    solver.solve_pair(d, options).expect("it runs")
}

fn options() -> SolverOptions {
    SolverOptions { tolerance: TOLERANCE, ..SolverOptions::default() }
}

/// Whether every energy is below the one before, but for rounding.
fn falls(energies: &[f64]) -> bool {
    energies.windows(2).all(|pair| pair[1] <= pair[0] + ENERGY_ROUNDING * pair[0].abs())
}

#[test]
fn it_finds_what_the_active_set_method_finds() {
    for mesh in meshes() {
        for (tension, height) in [([1.0, 1.0], 0.05), ([1.0, 300.0], 0.0), ([7.0, 0.2], 0.3)] {
            let problem = problem(tension, height);
            let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
            let found = solve_by(&mut Multigrid, &d, &options());
            assert!(falls(&found.statistics.energies), "{:?}", found.statistics.energies);
            let found = certify_pair(&d, found, TOLERANCE).unwrap();
            let exact = certify_pair(&d, solve_by(&mut ActiveSet, &d, &options()), TOLERANCE).unwrap();
            assert_eq!(found.contact(), exact.contact());
            let scale = d.scales().force_density;
            let pairs = found.lambda().iter().zip(exact.lambda());
            assert!(largest(pairs.map(|(a, b)| (a - b).abs())) < 10.0 * TOLERANCE * scale);
        }
    }
}

#[test]
fn cycles_do_not_depend_on_the_size_of_the_mesh() {
    let problem = problem([1.0, 1.0], 0.05);
    for cells in [16, 32, 64, 128] {
        for pattern in [Pattern::Right, Pattern::Crossed] {
            let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [cells; 2], pattern).unwrap();
            let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
            let statistics = solve_by(&mut Multigrid, &d, &options()).statistics;
            assert_eq!(statistics.status, Status::Solved);
            assert!(statistics.iterations <= CYCLES, "{cells} cells: {}", statistics.iterations);
        }
    }
    // Neither gap nor action in an annulus: there the discrete gap falls to zero over many powers of ten.
    let biactive = Case::Annulus.solution(&BTreeMap::new()).unwrap().problem().unwrap();
    for cells in [32, 64, 128, 256] {
        let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [cells; 2], Pattern::Right).unwrap();
        let d = PairDiscretization::new(&biactive, mesh.clone()).unwrap();
        let iterations = solve_by(&mut Multigrid, &d, &options()).statistics.iterations;
        assert!(iterations <= CYCLES, "annulus, {cells} cells: {iterations}");
    }
    // Touching without a force in a ring, which the coarser levels believe to be wider than it is.
    let ring = Case::LShape.solution(&BTreeMap::new()).unwrap().problem().unwrap();
    for cells in [64, 128, 256] {
        let mesh = l_shape(2.0, cells, Pattern::Right).unwrap();
        let d = PairDiscretization::new(&ring, mesh.clone()).unwrap();
        let statistics = solve_by(&mut Multigrid, &d, &options()).statistics;
        assert_eq!(statistics.status, Status::Solved);
        assert!(statistics.iterations <= CORNER_CYCLES, "ring, {cells} cells: {}", statistics.iterations);
    }
    // Stopped early, it says so and is not certified.
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [32; 2], Pattern::Right).unwrap();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let stopped = solve_by(&mut Multigrid, &d, &SolverOptions { max_iterations: Some(2), ..options() });
    assert_eq!((stopped.statistics.status, stopped.statistics.iterations), (Status::IterationLimit, 2));
    assert!(certify_pair(&d, stopped, TOLERANCE).is_err());
}

#[test]
fn an_energy_that_rises_is_seen() {
    assert!(falls(&[1.0, 0.5, 0.5, -1.0]));
    assert!(!falls(&[1.0, 0.5, 0.6, -1.0]));
}

/// `1/2 x'A x - b'x`, summed up.
fn energy(bounded: &Bounded, x: &[f64]) -> f64 {
    (0..x.len()).map(|i| -0.5 * x[i] * (bounded.residual(i, x) + bounded.b[i])).sum()
}

#[test]
fn a_change_of_the_energy_is_known_where_the_energies_are_not() {
    /// Of a sum of as many terms, relative.
    const SUM_ROUNDING: f64 = 1e-10;
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [16; 2], Pattern::Right).unwrap();
    let problem = problem([1.0, 1.0], 0.05);
    let hierarchy = Hierarchy::new(&PairDiscretization::new(&problem, mesh.clone()).unwrap());
    let level = &hierarchy.levels()[hierarchy.finest()];
    let mut random = Random::new(3);
    let mut vector = || -> Vec<f64> {
        let mut at = |i: usize| if level.is_held(i) { 0.0 } else { random.between(0.5, 1.0) };
        (0..level.pattern.rows()).map(&mut at).collect()
    };
    let (x, step) = (vector(), vector());
    let bounded = |b| Bounded { level, b, lower: 0.0, weight: b, tolerance: 1.0 };
    let rows = 0..x.len();
    let zeros = vec![0.0; x.len()];
    // Near the least energy.
    let b: Vec<f64> = rows.map(|i| -(1.0 + 1e-7) * bounded(&zeros).residual(i, &x)).collect();
    let bounded = bounded(&b);
    let after = |size: f64| x.iter().zip(&step).map(|(x, step)| x + size * step).collect::<Vec<f64>>();
    let change = energy(&bounded, &after(1.0)) - energy(&bounded, &x);
    assert!((bounded.energy_change(&x, &after(1.0)) - change).abs() < SUM_ROUNDING * change.abs());
    // A short step is known to many digits, the difference of its energies to none.
    let size = 1e-9;
    let slope: f64 = step.iter().enumerate().map(|(i, step)| -bounded.residual(i, &x) * step).sum();
    let far_off = |change: f64| (change - size * slope).abs() > 0.1 * (size * slope).abs();
    assert!(!far_off(bounded.energy_change(&x, &after(size))));
    assert!(far_off(energy(&bounded, &after(size)) - energy(&bounded, &x)));
}

#[test]
fn a_warm_start_needs_no_cycles_from_its_own_answer() {
    let problem = problem([1.0, 2.0], 0.05);
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [32; 2], Pattern::Right).unwrap();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let cold = solve_by(&mut Multigrid, &d, &options());
    let again = SolverOptions { warm_start: Some(cold.clone().into()), ..options() };
    assert!(cold.statistics.iterations > 3);
    assert!(solve_by(&mut Multigrid, &d, &again).statistics.iterations <= 1);
}

/// Where triangles are long and thin, coarser meshes are no good; algebraic levels are, and the method goes over to them.
#[test]
fn on_stretched_triangles_the_levels_are_algebraic() {
    let mesh = rectangle([0.0, 0.0], [1.0, 0.01], [64; 2], Pattern::Right).unwrap();
    let problem = ContactProblem::builder().tension(1.0, 3.0).load(-1.5e5, 1e5).height(0.1).build().unwrap();
    let posed = Discretization::new(&problem, mesh.clone()).unwrap();
    let d = posed.as_pair().unwrap();
    let status = |genealogy: &Genealogy| on_levels(Hierarchy::of_pair(d, genealogy), d).status;
    assert_eq!(status(&Genealogy::of(&mesh)), Status::Stalled);
    assert_eq!(status(&Genealogy::unknown(mesh.points().len())), Status::Solved);
    let candidate = solve_by(&mut Multigrid, d, &options());
    let tried = &candidate.statistics.stalled;
    assert!(tried.len() == 1 && tried[0].iterations > 0, "what stalled is recorded: {tried:?}");
    // Once it has gone over, it stays there; and is the solver that it would be anew.
    let mut multigrid = Multigrid;
    let mut prepared = multigrid.prepare(&posed);
    let [first, again] = [(); 2].map(|()| prepared.solve(&options()).expect("it runs"));
    assert_eq!(first.statistics.stalled, *tried);
    assert_eq!(again.statistics.stalled, *tried, "the record stays");
    assert_eq!(first.displacement, candidate.displacement);
    assert_eq!(again.displacement, candidate.displacement);
    assert!(certify_pair(d, candidate, TOLERANCE).is_ok());
}

/// What stalled counts where it was spent, and is named once, also when it has stalled before.
#[test]
fn the_seconds_of_what_stalled_are_those_of_setup_and_of_solving() {
    let took = |setup_seconds: f64, solve_seconds: f64, iterations: usize| Statistics {
        setup_seconds,
        solve_seconds,
        iterations,
        ..Statistics::of(NAME, Status::Stalled)
    };
    let first = took(2.0, 20.0, 7).after("another".into(), took(1.0, 10.0, 5));
    let all = took(4.0, 40.0, 9).after(NAME.into(), first);
    assert_eq!((all.setup_seconds, all.solve_seconds, all.iterations), (7.0, 70.0, 9));
    let stalled: Vec<_> = all.stalled.iter().map(|tried| (tried.method.as_str(), tried.iterations)).collect();
    assert_eq!(stalled, [("another", 5), (NAME, 7)]);
}

/// Levels that are kept are those that would be made anew, whatever was asked for before.
#[test]
fn a_prepared_solver_finds_what_the_solver_finds() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [32; 2], Pattern::Right).unwrap();
    let posed = Discretization::new(&problem([1.0, 2.0], 0.05), mesh).unwrap();
    let d = posed.as_pair().unwrap();
    let mut multigrid = Multigrid;
    let mut prepared = multigrid.prepare(&posed);
    for tolerance in [1e-3, 1e-9, 1e-6] {
        let options = SolverOptions { tolerance, ..SolverOptions::default() };
        let found = prepared.solve(&options).expect("it runs");
        assert_eq!(found.displacement, solve_by(&mut Multigrid, d, &options).displacement);
        assert_eq!(
            certify_pair(d, found, 1e-9).is_ok(),
            tolerance == 1e-9,
            "the tolerance is that asked for"
        );
    }
}

/// Slow progress is progress, as on 2 x 8 flat crossed cells; none is none.
#[test]
fn a_slow_pace_is_kept_and_none_is_given_up() {
    let mesh = rectangle([0.0, 0.0], [1.55, 0.5], [2, 8], Pattern::Crossed).unwrap();
    let d = PairDiscretization::new(&problem([1.0, 1.0], 0.0), mesh.clone()).unwrap();
    let slow = on_levels(Hierarchy::new(&d), &d);
    assert_eq!(slow.status, Status::Solved);
    assert!(slow.iterations > 2 * CYCLES, "it is slow: {}", slow.iterations);

    let unreachable = SolverOptions { tolerance: 1e-30, ..options() };
    let cycles = solve_by(&mut Multigrid, &d, &unreachable).statistics.iterations;
    assert!(cycles < MAX_CYCLES, "rounding is noticed: {cycles}");
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let problem = problem([1.0, 2.0], 0.05);
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [200, 120], Pattern::Right).unwrap();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let [one, four] = [1, 4].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solve_by(&mut Multigrid, &d, &options()))
    });
    assert_eq!(one.displacement, four.displacement);
    assert_eq!(one.multiplier, four.multiplier);
}

/// `P' T A T P` of a level with all its rows by brute force, where `fine` is dense and truncated.
fn product(fine: &[Vec<f64>], hierarchy: &Hierarchy, l: usize) -> Vec<Vec<f64>> {
    let levels = hierarchy.levels();
    let rows = levels[l].pattern.rows();
    let mut coarse = vec![vec![0.0; rows]; rows];
    for (i, row) in fine.iter().enumerate() {
        for (j, value) in row.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            let transfer = &levels[l + 1].transfer;
            transfer.for_each_parent(i, |a, p| {
                transfer.for_each_parent(j, |b, q| coarse[a][b] += p * value * q);
            });
        }
    }
    coarse
}

/// The largest difference of a truncated matrix from one by brute force, at vertices that are not held.
fn truncation_defect(hierarchy: &Hierarchy, truncation: &Truncation, frozen: &[bool]) -> f64 {
    let levels = hierarchy.levels();
    let finest = hierarchy.finest();
    let top = &levels[finest];
    let rows = top.pattern.rows();
    let free = |i: usize| !frozen[i] && !top.is_held(i);
    let mut dense = vec![vec![0.0; rows]; rows];
    for i in (0..rows).filter(|&i| free(i)) {
        dense[i][i] = top.values.diagonal[i];
        for (&j, &a) in top.pattern.row(i).iter().zip(&top.values.off_diagonal[top.pattern.range(i)]) {
            dense[i][j as usize] = if free(j as usize) { a } else { 0.0 };
        }
    }
    let mut defect: f64 = 0.0;
    for l in (0..finest).rev() {
        dense = product(&dense, hierarchy, l);
        let values = truncation.values(l);
        let level = &levels[l];
        for i in (0..dense.len()).filter(|&i| !level.is_held(i)) {
            defect = defect.max((dense[i][i] - values.diagonal[i]).abs());
            for (&j, &a) in level.pattern.row(i).iter().zip(&values.off_diagonal[level.pattern.range(i)]) {
                if !level.is_held(j as usize) {
                    defect = defect.max((dense[i][j as usize] - a).abs());
                }
            }
        }
    }
    defect
}

#[test]
fn truncated_matrices_follow_every_change_of_the_contact_set() {
    /// Rounding of matrix entries of size ten.
    const ROUNDING: f64 = 1e-12;
    let problem = problem([1.0, 1.0], 0.05);
    let square = rectangle([0.0, 0.0], [1.0, 1.0], [16; 2], Pattern::Right).unwrap();
    for mesh in [square, irregular(4).refine().unwrap().mesh, irregular(13)] {
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let hierarchy = Hierarchy::new(&d);
        let mut truncation = Truncation::new(&hierarchy, hierarchy.finest());
        truncation.reset(hierarchy.finest());
        let rows = hierarchy.vertex().len();
        let mut frozen = vec![false; rows];
        let mut random = Random::new(7);
        for _ in 0..4 {
            let changed: Vec<u32> = (0..rows as u32).filter(|_| random.below(5) == 0).collect();
            changed.iter().for_each(|&i| frozen[i as usize] = !frozen[i as usize]);
            assert!(truncation_defect(&hierarchy, &truncation, &frozen) > ROUNDING, "without the update");
            truncation.update(hierarchy.finest(), &frozen, &changed);
            assert!(truncation_defect(&hierarchy, &truncation, &frozen) < ROUNDING);
        }
        truncation.reset(hierarchy.finest());
        assert!(truncation_defect(&hierarchy, &truncation, &vec![false; rows]) < ROUNDING);
    }
}

#[test]
fn truncated_rows_have_no_part_in_a_stencil() {
    /// Rounding of products of size ten.
    const ROUNDING: f64 = 1e-12;
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [128; 2], Pattern::Right).unwrap();
    let d = PairDiscretization::new(&problem([1.0, 1.0], 0.05), mesh.clone()).unwrap();
    let hierarchy = Hierarchy::new(&d);
    let finest = hierarchy.finest();
    let mut truncation = Truncation::new(&hierarchy, hierarchy.finest());
    truncation.reset(finest);
    let level = &hierarchy.levels()[finest - 1];
    let x: Vec<f64> = (0..level.pattern.rows()).map(|i| (i as f64).sin()).collect();
    // The largest difference of the products by runs from those row by row.
    let defect = |values: &Values| {
        let mut defect: f64 = 0.0;
        for run in 0..level.runs.with_row(x.len() - 1) {
            let mut products = [0.0; LONGEST];
            let products =
                values.off_diagonal_products((&level.pattern, &level.runs), run, &x, &mut products);
            for (i, product) in level.runs.rows(run).zip(products) {
                defect = defect.max((product - values.off_diagonal_product(&level.pattern, i, &x)).abs());
            }
        }
        defect
    };
    let touches = |&a: &u32| {
        let [x, y] = mesh.points()[a as usize];
        x.hypot(y) < 0.7
    };
    let frozen: Vec<bool> = hierarchy.vertex().iter().map(touches).collect();
    let changed: Vec<u32> = (0..frozen.len() as u32).filter(|&i| frozen[i as usize]).collect();
    truncation.update(finest, &frozen, &changed);
    assert!(defect(truncation.values(finest - 1)) < ROUNDING);
    // The negative test: the rows are changed, but nobody tells the runs.
    let mut unaware = level.values.clone();
    unaware.off_diagonal.clone_from(&truncation.values(finest - 1).off_diagonal);
    assert!(defect(&unaware) > 0.1);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn random_data_are_solved_and_the_energy_falls(
        cells in 3..14usize,
        refinements in 0..3usize,
        problem in drawn(|height| Function::Constant(10.0 * height)),
    ) {
        let mesh = (0..refinements).fold(irregular(cells), |mesh, _| mesh.refine().unwrap().mesh);
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let found = solve_by(&mut Multigrid, &d, &options());
        prop_assert!(falls(&found.statistics.energies), "{:?}", found.statistics.energies);
        prop_assert!(certify_pair(&d, found, TOLERANCE).is_ok());
    }
}
