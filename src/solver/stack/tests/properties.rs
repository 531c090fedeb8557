//! Stacks drawn at random: up to five membranes, with regions, free sides, foundations, obstacles.

use proptest::prelude::*;

use super::{TOLERANCE, posed, solve_by, solvers};
use crate::action::certify_stack;
use crate::mesh::samples::{renumbered, with_sides_and_patch};
use crate::mesh::{Mesh, Pattern, rectangle};
use crate::numeric::largest;
use crate::problem::samples::stack::{Drawn, Numbers, drawn};
use crate::solver::{ActiveSet, ContactSolver, SolverOptions};

/// Solvers certified within [`TOLERANCE`] agree so far, relative to the displacements.
const AGREEMENT: f64 = 1e-6;

/// What rounding leaves of displacements of different numberings, relative.
const ROUNDING: f64 = 1e-9;

fn mesh() -> Mesh {
    with_sides_and_patch(rectangle([0.0, 0.0], [1.0, 1.0], [7, 7], Pattern::Right).unwrap())
}

fn all(u: &[Vec<f64>]) -> impl Iterator<Item = f64> {
    u.iter().flatten().copied()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn all_solvers_agree_and_all_forces_balance(drawn in drawn()) {
        let d = posed(&drawn.problem(1.0, 0.0), &mesh());
        let expected = solve_by(&mut ActiveSet, &d);
        prop_assert!(expected.imbalance() < ROUNDING, "{:e}", expected.imbalance());
        prop_assert_eq!(expected.gaps().len(), d.gaps().len());
        for gap in expected.gaps() {
            let is_complementary = |a: usize| gap.gap[a] >= 0.0 && gap.force[a] >= 0.0 && gap.gap[a] * gap.force[a] == 0.0;
            prop_assert!((0..gap.gap.len()).all(is_complementary));
        }
        for (name, mut solver) in solvers() {
            let solution = solve_by(&mut *solver, &d);
            let off = largest(all(solution.displacement()).zip(all(expected.displacement())).map(|(p, q)| (p - q).abs()));
            prop_assert!(off <= AGREEMENT * d.scales().displacement, "{}: {:e}", name, off);
        }
    }

    /// In units twice, or a sixteenth, as large, everything is the same to the last bit.
    #[test]
    fn powers_of_two_scale_the_solution_exactly(drawn in drawn()) {
        let solution = |size: f64| solve_by(&mut ActiveSet, &posed(&drawn.problem(size, 0.0), &mesh()));
        let one = solution(1.0);
        for size in [2.0, 0.0625] {
            let scaled = solution(size);
            prop_assert!(all(scaled.displacement()).zip(all(one.displacement())).all(|(p, q)| p == size * q));
            for (scaled, one) in scaled.gaps().iter().zip(one.gaps()) {
                prop_assert_eq!(&scaled.contact, &one.contact);
            }
        }
    }

    /// Right triangles have no obtuse angles: a push upwards moves no membrane down.
    #[test]
    fn a_push_upwards_moves_nothing_down(drawn in drawn(), push in 0.0..20.0f64) {
        let solution = |push: f64| solve_by(&mut ActiveSet, &posed(&drawn.problem(1.0, push), &mesh()));
        let (lower, upper) = (solution(0.0), solution(push));
        let slack = ROUNDING * posed(&drawn.problem(1.0, 0.0), &mesh()).scales().displacement;
        prop_assert!(all(lower.displacement()).zip(all(upper.displacement())).all(|(p, q)| p <= q + slack));
    }

    #[test]
    fn the_numbering_of_the_mesh_does_not_matter(drawn in drawn(), seed in any::<u64>()) {
        let mesh = mesh();
        let (other, number) = renumbered(&mesh, seed);
        let other = with_sides_and_patch(Mesh::new(other.points().to_vec(), other.triangles().to_vec()).unwrap());
        let [one, other] = [&mesh, &other].map(|mesh| {
            let d = posed(&drawn.problem(1.0, 0.0), mesh);
            (solve_by(&mut ActiveSet, &d), d.scales().displacement)
        });
        for (one_u, other_u) in one.0.displacement().iter().zip(other.0.displacement()) {
            for (a, u) in one_u.iter().enumerate() {
                prop_assert!((u - other_u[number[a]]).abs() <= ROUNDING * one.1);
            }
        }
    }
}

/// Each fault of a candidate is seen by the certificate.
#[test]
fn the_certificate_sees_what_is_broken() {
    let numbers = |load: f64| Numbers {
        tension: [1.0, 3.0],
        load: [load, 0.0, 0.0],
        foundation: 0.0,
        free: [true, false, false],
        traction: 0.0,
        step: 0.02,
    };
    let drawn =
        Drawn { membranes: vec![numbers(-20.0), numbers(5.0), numbers(-9.0)], obstacles: [false, true] };
    let d = posed(&drawn.problem(1.0, 0.0), &mesh());
    let candidate = ActiveSet.solve_stack(&d, &SolverOptions::default()).unwrap();
    let pressed: Vec<usize> = (0..d.rows().len())
        .filter(|&row| candidate.multiplier[row] > 1e-3 && d.rows()[row].gap < 3)
        .collect();
    let row = pressed[pressed.len() / 2];
    let (gap, vertex) = (d.rows()[row].gap, d.rows()[row].vertex);
    let check = |change: &dyn Fn(&mut crate::solver::Candidate)| {
        let mut broken = candidate.clone();
        change(&mut broken);
        certify_stack(&d, broken, TOLERANCE).map(|_| ()).map_err(|rejected| rejected.residuals.unwrap())
    };
    assert_eq!(check(&|_| ()), Ok(()));
    const SEEN: f64 = 1e-5;
    let moved = check(&|candidate| candidate.displacement[gap - 1][vertex] += 1e-3).unwrap_err();
    assert!(
        moved.stationarity.value > SEEN
            && moved.action_mismatch.value > SEEN
            && moved.complementarity.value > SEEN
    );
    let passed = check(&|candidate| candidate.displacement[gap - 1][vertex] -= 1e-3).unwrap_err();
    assert!(passed.primal.value > SEEN);
    let flipped = check(&|candidate| candidate.multiplier[row] *= -1.0).unwrap_err();
    assert!(flipped.dual_sign.value > SEEN && flipped.dual_mismatch.value > SEEN);
    let doubled = check(&|candidate| candidate.multiplier[row] *= 2.0).unwrap_err();
    assert!(doubled.dual_mismatch.value > SEEN && doubled.stationarity.value > SEEN);
    let held = (0..d.dual_area().len()).find(|&a| d.height(1, a).is_some()).unwrap();
    let trace = check(&|candidate| candidate.displacement[0][held] += 1e-3).unwrap_err();
    assert!(trace.primal.value > SEEN);
    let nan = check(&|candidate| candidate.displacement[1][vertex] = f64::NAN).unwrap_err();
    assert!(nan.stationarity.value.is_infinite());
    let mut short = candidate.clone();
    short.multiplier.pop();
    assert!(certify_stack(&d, short, TOLERANCE).unwrap_err().residuals.is_none());
}
