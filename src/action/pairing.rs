//! The discrete space `Y_h` of actions, its pairing with displacements, and the full discrete problem (4.7).

use crate::discretization::{Displacement, PairDiscretization};
use crate::fem::load;
use crate::problem::{EvaluationError, Function};

/// `<rho_h, v_h>_h = sum_a rho_a v_h(a) int phi_a` (4.3).
///
/// `rho` is over unknowns (its values on the dual cells), `v` over vertices; only its values at interior vertices enter.
pub fn pairing(d: &PairDiscretization, rho: &[f64], v: &[f64]) -> f64 {
    d.interior().iter().zip(rho).map(|(&a, rho)| rho * v[a] * d.dual_area()[a]).sum()
}

/// `Pi_h rho` (4.9) over unknowns: the element of `Y_h` with `<Pi_h rho, phi_a>_h = int rho phi_a`.
///
/// # Errors
/// [`EvaluationError`] when `rho` fails, or is NaN or infinite at a quadrature point.
pub fn project(d: &PairDiscretization, rho: &Function) -> Result<Vec<f64>, EvaluationError> {
    let moments = load(d.mesh(), rho)?;
    Ok(d.interior().iter().map(|&a| moments[a] / d.dual_area()[a]).collect())
}

/// Whether `rho`, over unknowns, is in the cone `Lambda_h` (4.2).
pub fn is_in_cone(rho: &[f64]) -> bool {
    rho.iter().all(|&rho| rho >= 0.0)
}

/// The first line of (4.7) tested with the hat functions of membrane 1, then of membrane 2:
/// `mu_i (grad u_ih, grad phi_a) - (f_i, phi_a) + (-1)^i <lambda_h, phi_a>_h`, over unknowns. Zero at the solution.
pub fn equilibrium(d: &PairDiscretization, displacement: &Displacement, lambda: &[f64]) -> [Vec<f64>; 2] {
    [0, 1].map(|i| {
        let sign = if i == 0 { -1.0 } else { 1.0 };
        let push = d.interior().iter().zip(lambda).map(|(&a, lambda)| sign * lambda * d.dual_area()[a]);
        d.imbalance(i, &displacement[i]).into_iter().zip(push).map(|(force, push)| force + push).collect()
    })
}

/// The second line of (4.7) for one `chi_h` in the cone, over unknowns: `<chi_h - lambda_h, u1h - u2h>_h`. Not negative at
/// the solution, whatever `chi_h`.
pub fn variation(d: &PairDiscretization, displacement: &Displacement, lambda: &[f64], chi: &[f64]) -> f64 {
    let [u1, u2] = displacement;
    let gap: Vec<f64> = u1.iter().zip(u2).map(|(u1, u2)| u1 - u2).collect();
    pairing(d, chi, &gap) - pairing(d, lambda, &gap)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::action::certify_pair;
    use crate::mesh::{Mesh, Pattern, rectangle};
    use crate::problem::ContactProblem;
    use crate::problem::samples::drawn;
    use crate::solver::{ActiveSet, ContactSolver, SolverOptions};

    /// Forces here are of size 1, sums of up to 81 of them are rounded.
    const ROUNDING: f64 = 1e-12;

    fn mesh() -> Mesh {
        rectangle([0.0, 0.0], [1.0, 1.0], [8, 8], Pattern::Crossed).unwrap()
    }

    fn problem(f1: f64, f2: f64, g: f64) -> ContactProblem {
        let load = Function::from_fn(move |x, y| f1 * (1.0 + x * y));
        ContactProblem::builder().tension(1.0, 3.0).load(load, f2).height(g).build().unwrap()
    }

    /// `[u1, u2]` over vertices and `lambda` over unknowns.
    fn solve(d: &PairDiscretization) -> (Displacement, Vec<f64>) {
        let candidate = ActiveSet.solve_pair(d, &SolverOptions::default()).unwrap();
        let solution = certify_pair(d, candidate, 1e-8).unwrap();
        let lambda = d.interior().iter().map(|&a| solution.lambda()[a]).collect();
        (solution.displacement().clone(), lambda)
    }

    fn largest(values: &[f64]) -> f64 {
        crate::numeric::largest(values.iter().map(|value| value.abs()))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn the_solution_solves_both_lines_of_the_full_problem(
            problem in drawn(Function::Constant), chi in prop::collection::vec(0.0..9.0, 113)
        ) {
            let d = PairDiscretization::new(&problem, mesh()).unwrap();
            let (displacement, lambda) = solve(&d);
            prop_assert!(is_in_cone(&lambda));
            for line in equilibrium(&d, &displacement, &lambda) {
                prop_assert!(largest(&line) < ROUNDING);
            }
            prop_assert_eq!(chi.len(), lambda.len());
            prop_assert!(variation(&d, &displacement, &lambda, &chi) > -ROUNDING);
            for factor in [0.0, 2.0] {
                let chi: Vec<f64> = lambda.iter().map(|lambda| factor * lambda).collect();
                prop_assert!(variation(&d, &displacement, &lambda, &chi).abs() < ROUNDING);
            }
        }
    }

    #[test]
    fn a_wrong_sign_or_factor_of_the_action_is_seen_by_the_first_line() {
        let mesh = mesh();
        let d = PairDiscretization::new(&problem(-15.0, 5.0, 0.1), mesh.clone()).unwrap();
        let (displacement, lambda) = solve(&d);
        assert!(largest(&lambda) > 1.0, "there is contact");
        for factor in [-1.0, 0.0, 1.01, 3.0] {
            let wrong: Vec<f64> = lambda.iter().map(|lambda| factor * lambda).collect();
            for line in equilibrium(&d, &displacement, &wrong) {
                assert!(largest(&line) > 1e-4, "factor {factor}");
            }
        }
        assert!(!is_in_cone(&[1.0, -1e-300]) && !is_in_cone(&[f64::NAN]));
    }

    #[test]
    fn a_gap_that_closes_makes_the_second_line_fail_for_some_chi() {
        let mesh = mesh();
        let d = PairDiscretization::new(&problem(-15.0, 5.0, 0.1), mesh.clone()).unwrap();
        let (mut displacement, lambda) = solve(&d);
        let k = lambda.iter().position(|&lambda| lambda > 0.0).expect("contact");
        displacement[0][d.interior()[k]] -= 0.1;
        let chi: Vec<f64> =
            (0..lambda.len()).map(|j| if j == k { 2.0 * lambda[j] } else { lambda[j] }).collect();
        assert!(variation(&d, &displacement, &lambda, &chi) < -1e-4);
        assert_eq!(variation(&d, &displacement, &lambda, &lambda), 0.0, "it is a variation of lambda");
    }

    #[test]
    fn the_projection_keeps_moments_and_constants() {
        let mesh = mesh();
        let d = PairDiscretization::new(&problem(0.0, 0.0, 0.0), mesh.clone()).unwrap();
        let constant = project(&d, &Function::Constant(2.5)).unwrap();
        assert!(constant.iter().all(|rho| (rho - 2.5).abs() < ROUNDING));

        let rho = Function::from_fn(|x, y| 1.0 + x * x - 3.0 * x * y);
        let projected = project(&d, &rho).unwrap();
        let moments = load(&mesh, &rho).unwrap();
        for (k, &a) in d.interior().iter().enumerate() {
            let hat: Vec<f64> = (0..mesh.points().len()).map(|b| f64::from(a == b)).collect();
            assert!(
                (pairing(&d, &projected, &hat) - projected[k] * d.dual_area()[a]).abs() < ROUNDING,
                "(4.4)"
            );
            assert!((pairing(&d, &projected, &hat) - moments[a]).abs() < ROUNDING, "(4.9)");
        }
        let [x, y] = mesh.points()[d.interior()[0]];
        assert!((projected[0] - rho.eval(x, y).unwrap()).abs() > ROUNDING, "it is no interpolation");
        assert!(project(&d, &Function::Constant(f64::NAN)).is_err());
    }
}
