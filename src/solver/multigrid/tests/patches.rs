//! Patches and stored rows, one forced after the other.

use super::*;
use crate::action::PairSolution;
use crate::mesh::samples::square_without;
use crate::multigrid::hierarchy::inside;
use crate::multigrid::patches::Patches;

/// Cycles on uniform refinements of triangles of all shapes.
const PATCH_CYCLES: usize = 13;

/// Two solutions within the tolerance of the certificate, relative to the displacement.
const SAME_DISPLACEMENT: f64 = 1e-6;

/// Also such as are not worth it.
fn patches_for(mesh: &Mesh, k: &StiffnessMatrix) -> Patches {
    Patches::of_size(2, 4, mesh, k, &inside(mesh)).expect("there are patches")
}

fn on_patches(d: &PairDiscretization, options: &SolverOptions) -> Candidate {
    let patches = patches_for(d.mesh(), d.stiffness());
    let levels = MembraneLevels::Patches(Box::new(patches), Cow::Borrowed(d.stiffness()));
    pair::multigrid::solve_on(&levels, d, NAME, options, Instant::now()).expect("it runs")
}

fn on_rows(d: &PairDiscretization) -> Candidate {
    let levels = MembraneLevels::Stored(Hierarchy::new(d));
    pair::multigrid::solve_on(&levels, d, NAME, &options(), Instant::now()).expect("it runs")
}

/// Certifies what both find, and compares; the cycles on patches.
fn compare(d: &PairDiscretization) -> usize {
    let on_patches = on_patches(d, &options());
    let cycles = on_patches.statistics.iterations;
    assert!(falls(&on_patches.statistics.energies), "{:?}", on_patches.statistics.energies);
    let [found, expected]: [PairSolution; 2] =
        [on_patches, on_rows(d)].map(|candidate| certify_pair(d, candidate, TOLERANCE).unwrap());
    for (found, expected) in found.displacement().iter().zip(expected.displacement()) {
        let size = largest(expected.iter().map(|u| u.abs())).max(f64::MIN_POSITIVE);
        let error = largest(found.iter().zip(expected).map(|(a, b)| (a - b).abs()));
        assert!(error < SAME_DISPLACEMENT * size, "{error} {size}");
    }
    cycles
}

fn refined(mesh: Mesh, times: usize) -> Mesh {
    (0..times).fold(mesh, |mesh, _| mesh.refine().unwrap().mesh)
}

#[test]
fn patches_find_what_stored_rows_find() {
    let square = |cells| rectangle([0.0, 0.0], [1.0, 1.0], [cells; 2], Pattern::Right).unwrap();
    let meshes = [
        square(64),
        square(128),
        refined(irregular(3), 4),
        refined(irregular(3), 5),
        refined(square_without(4, |i, j| i == 1 && j > 0 && j < 3), 4),
        l_shape(1.0, 64, Pattern::Right).unwrap(),
    ];
    for mesh in meshes {
        for (tension, height) in [([1.0, 1.0], 0.05), ([1e-3, 20.0], 0.02), ([1.0, 2.0], 0.0)] {
            let d = PairDiscretization::new(&problem(tension, height), mesh.clone()).unwrap();
            let cycles = compare(&d);
            assert!(cycles <= PATCH_CYCLES, "{cycles}");
        }
    }
}

/// Neither single precision below nor the order of sums knows a unit.
#[test]
fn patches_know_no_unit() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [32; 2], Pattern::Right).unwrap();
    let cycles = |force: f64, tension: f64, height: f64| {
        let load =
            Function::from_fn(move |x: f64, y: f64| force * 30.0 * (12.566 * x).sin() * (9.425 * y).sin());
        let problem = ContactProblem::builder()
            .tension(tension, tension)
            .load(-10.0 * force, load)
            .height(height)
            .build()
            .unwrap();
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let candidate = on_patches(&d, &options());
        let cycles = candidate.statistics.iterations;
        certify_pair(&d, candidate, TOLERANCE).unwrap();
        cycles
    };
    let expected = cycles(1.0, 1.0, 0.05);
    for (force, tension) in [(1e38, 1e38), (1e-38, 1e-38), (1e36, 1e-3), (1e-38, 1.0), (1.0, 1e38)] {
        let found = cycles(force, tension, 0.05 * force / tension);
        assert_eq!(found, expected, "forces {force:e}, tensions {tension:e}");
    }
}

/// What the assembled matrix differs by from the stencils is put on the side of the load.
#[test]
fn the_assembled_matrix_decides() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [32; 2], Pattern::Right).unwrap();
    let d = PairDiscretization::new(&problem([1.0, 1.0], 0.05), mesh).unwrap();
    // Stencils that are off by far more than rounding.
    let off = d.stiffness().map(|entry| (1.0 + 1e-7) * entry);
    let patches = patches_for(d.mesh(), &off);
    let levels = MembraneLevels::Patches(Box::new(patches), Cow::Borrowed(d.stiffness()));
    let found = pair::multigrid::solve_on(&levels, &d, NAME, &options(), Instant::now()).unwrap();
    assert_eq!(found.statistics.status, Status::Solved);
    certify_pair(&d, found, TOLERANCE).unwrap();

    let patches = patches_for(d.mesh(), &off);
    let levels = MembraneLevels::Patches(Box::new(patches), Cow::Owned(off));
    let found = pair::multigrid::solve_on(&levels, &d, NAME, &options(), Instant::now()).unwrap();
    assert!(certify_pair(&d, found, TOLERANCE).is_err(), "another matrix is noticed");
}

#[test]
fn patches_start_and_stop_where_they_are_told() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [64; 2], Pattern::Right).unwrap();
    let d = PairDiscretization::new(&problem([1.0, 3.0], 0.05), mesh).unwrap();
    let stopped = on_patches(&d, &SolverOptions { max_iterations: Some(2), ..options() });
    assert_eq!((stopped.statistics.status, stopped.statistics.iterations), (Status::IterationLimit, 2));
    assert!(certify_pair(&d, stopped, TOLERANCE).is_err());
    let solved = on_patches(&d, &options());
    let again = SolverOptions { warm_start: Some(solved.into()), ..options() };
    assert!(on_patches(&d, &again).statistics.iterations <= 1);
}

#[test]
fn patches_do_not_depend_on_the_number_of_threads() {
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [192, 128], Pattern::Right).unwrap();
    let d = PairDiscretization::new(&problem([1.0, 2.0], 0.05), mesh).unwrap();
    let [one, three] = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| on_patches(&d, &options()))
    });
    assert_eq!(one.displacement, three.displacement);
    assert_eq!(one.multiplier, three.multiplier);
    assert_eq!(one.statistics.energies, three.statistics.energies);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn random_problems_are_solved_on_patches(
        problem in drawn(|size| Function::from_fn(move |x, y| size * (1.0 + x * y))),
        cells in 1..4usize,
        refinements in 4..6usize,
    ) {
        let d = PairDiscretization::new(&problem, refined(irregular(cells), refinements)).unwrap();
        compare(&d);
    }
}
