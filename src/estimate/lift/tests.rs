//! The lift against closed forms, direct solves and itself.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::*;
use crate::action::{PairSolution, certify_pair};
use crate::discretization::principal_submatrix;
use crate::estimate::norms::cut_rule;
use crate::fem::stiffness;
use crate::mesh::samples::{irregular, square};
use crate::mesh::{VertexKind, l_shape};
use crate::multigrid::cholesky::Cholesky;
use crate::problem::{Case, ContactProblem, ExactSolution};
use crate::solver::{ActiveSet, ContactSolver, SolverOptions};

/// The iteration stops when it adds `1e-12` of the square; sums of some thousand terms round less.
const ITERATION: f64 = 1e-11;

fn exact(case: Case) -> ExactSolution {
    case.solution(&BTreeMap::new()).unwrap()
}

/// No curves, no corner.
fn plain() -> CutRule {
    cut_rule(&exact(Case::NoContact), 1)
}

fn at_rest() -> ContactProblem {
    ContactProblem::builder().load(0.0, 0.0).height(1.0).build().unwrap()
}

fn norm_on(mesh: &Mesh, refinements: usize, rho: fn([f64; 2]) -> f64) -> DualNorm {
    let d = PairDiscretization::new(&at_rest(), mesh.clone()).unwrap();
    let sub = SubTriangulation::new(mesh).unwrap();
    dual_norm(&d, &sub, &plain(), refinements, |_, point| rho(point)).unwrap()
}

fn sine([x, y]: [f64; 2]) -> f64 {
    (PI * x).sin() * (PI * y).sin()
}

#[test]
fn a_sine_has_its_norm_up_to_the_estimate() {
    let expected = 1.0 / (8.0 * PI * PI).sqrt();
    for mesh in [square(8), irregular(8)] {
        let norm = norm_on(&mesh, 1, sine);
        assert!(norm.coarser < norm.value && norm.value < expected, "figures grow: {norm:?}");
        assert!(expected - norm.value < norm.estimate(), "{norm:?}");
        assert!(norm.estimate() < 5e-3 * expected, "{norm:?}");
        assert_eq!(norm.quadrature, 0.0, "nothing is cut");
        let doubled = norm_on(&mesh, 1, |point| 2.0 * sine(point)).value;
        assert!((doubled - 2.0 * norm.value).abs() < ITERATION, "a norm");
    }
}

#[test]
fn the_missing_part_falls_by_four_with_each_refinement() {
    let mesh = irregular(3);
    let expected = 1.0 / (8.0 * PI * PI);
    let missing = [1, 2, 3].map(|refinements| expected - norm_on(&mesh, refinements, sine).value.powi(2));
    for pair in missing.windows(2) {
        assert!((3.5..4.5).contains(&(pair[0] / pair[1])), "{missing:?}");
    }
}

#[test]
fn the_iteration_agrees_with_a_direct_solve() {
    let rho = |[x, y]: [f64; 2]| 1.0 + x * x - 3.0 * y;
    for mesh in [square(1), square(2), irregular(5), l_shape(1.0, 3, Default::default()).unwrap()] {
        let norm = norm_on(&mesh, 1, rho);
        let sub = SubTriangulation::new(&mesh).unwrap();
        let fine = sub.mesh().refine().unwrap().mesh;
        for (mesh, figure) in [(sub.mesh(), norm.coarser), (&fine, norm.value)] {
            let free: Vec<usize> =
                (0..mesh.points().len()).filter(|&a| mesh.kind()[a] == VertexKind::Interior).collect();
            let [functional, _] = functionals(mesh, &plain(), |_, point| rho(point));
            let b: Vec<f64> = free.iter().map(|&a| functional[a]).collect();
            let matrix = principal_submatrix(&stiffness(mesh), &free);
            let z = Cholesky::new(matrix.clone()).ok().unwrap().solve(&b).ok().unwrap();
            let direct = b.iter().zip(&z).map(|(b, z)| b * z).sum::<f64>().sqrt();
            assert!((figure - direct).abs() < ITERATION * direct, "{figure} {direct}");
        }
        assert!(norm.value > (1.0 + 1e-3) * norm.coarser, "the two spaces differ");
    }
}

#[test]
fn functionals_are_restricted_to_what_they_are_on_the_coarse_mesh() {
    let rho = |_: usize, [x, y]: [f64; 2]| 1.0 + x * x - 3.0 * y;
    let mesh = irregular(4);
    let d = PairDiscretization::new(&at_rest(), mesh.clone()).unwrap();
    let sub = SubTriangulation::new(&mesh).unwrap();
    let (spaces, finest) = Spaces::new(&d, &sub, 1).unwrap();
    let [fine, change] = functionals(&finest, &plain(), rho);
    let on_sub = spaces.restrict(&spaces.functional(&fine));
    let on_mesh = spaces.restrict(&on_sub);
    let [on_sub, on_mesh] = [on_sub, on_mesh].map(|functional| functional.over_vertices(&spaces));
    for (restricted, mesh) in [(on_sub, sub.mesh()), (on_mesh, &mesh)] {
        let [direct, _] = functionals(mesh, &plain(), rho);
        for (a, b) in restricted.iter().zip(&direct) {
            assert!((a - b).abs() < 1e-14, "{a} {b}");
            assert!((a - 2.0 * b).abs() > 1e-5);
        }
    }
    assert!(change.iter().all(|&change| change == 0.0));
}

/// Solution of a case on a regular mesh, and what to do with it.
fn with_solution<T>(
    case: Case,
    cells: usize,
    f: impl Fn(&PairDiscretization, &SubTriangulation, &ExactSolution, &PairSolution) -> T,
) -> T {
    let exact = exact(case);
    let ([mu1, mu2], [f1, f2]) = (exact.tension(), exact.load_functions());
    let problem = ContactProblem::builder().tension(mu1, mu2).load(f1, f2).height(exact.height_function());
    let mesh = irregular(cells);
    let d = PairDiscretization::new(&problem.build().unwrap(), mesh.clone()).unwrap();
    let candidate = ActiveSet.solve_pair(&d, &SolverOptions::default()).unwrap();
    let solution = certify_pair(&d, candidate, 1e-8).unwrap();
    f(&d, &SubTriangulation::new(&mesh).unwrap(), &exact, &solution)
}

#[test]
fn the_estimate_covers_what_two_more_refinements_add_to_a_discontinuous_error() {
    for case in [Case::Circle, Case::Annulus, Case::FullContact] {
        with_solution(case, 8, |d, sub, exact, solution| {
            let rule = cut_rule(exact, 3);
            let rho = |t: usize, [x, y]: [f64; 2]| exact.lambda(x, y) - solution.lambda()[sub.vertex_of(t)];
            let [usual, fine] = [1, 3].map(|refinements| dual_norm(d, sub, &rule, refinements, rho).unwrap());
            let missing = fine.value - usual.value;
            assert!(missing < usual.estimate(), "{case}: {missing:e} {usual:?}");
            assert!(missing > 0.1 * usual.estimate(), "{case}: not by accident: {missing:e} {usual:?}");
        });
    }
}

/// The figures of `rho` on `T_h`, `S_h` and `S_h` refined once.
fn figures(
    d: &PairDiscretization,
    sub: &SubTriangulation,
    rule: &CutRule,
    rho: impl Fn(usize, [f64; 2]) -> f64 + Sync,
) -> [f64; 3] {
    let (spaces, mesh) = Spaces::new(d, sub, 1).unwrap();
    let [fine, _] = functionals(&mesh, rule, |t, point| rho(t / 4, point));
    let fine = spaces.functional(&fine);
    let on_sub = spaces.restrict(&fine);
    let on_mesh = spaces.restrict(&on_sub);
    [on_mesh, on_sub, fine].map(|rho| spaces.dual_norm(&rho).unwrap())
}

/// `60 b - 1` with the bubble `b`, the product of the barycentric coordinates, is orthogonal to the affine functions of
/// its triangle.
#[test]
fn a_lift_on_the_mesh_itself_is_blind() {
    let mesh = irregular(6);
    let d = PairDiscretization::new(&at_rest(), mesh.clone()).unwrap();
    let sub = SubTriangulation::new(&mesh).unwrap();
    let rho = |t: usize, point: [f64; 2]| {
        let corners = mesh.corners(sub.triangle_of(t));
        let [a, b, c] = corners;
        let parts = [[point, b, c], [a, point, c], [a, b, point]].map(twice_signed_area);
        60.0 * parts.iter().product::<f64>() / twice_signed_area(corners).powi(3) - 1.0
    };
    let [blind, coarser, value] = figures(&d, &sub, &plain(), rho);
    assert!(blind < 1e-14 && coarser > 1e-3 && value > coarser, "{blind:e} {coarser:e} {value:e}");
}

#[test]
fn of_an_action_that_jumps_the_mesh_itself_sees_three_quarters() {
    for case in [Case::Circle, Case::FullContact] {
        with_solution(case, 16, |d, sub, exact, solution| {
            let rho = |t: usize, [x, y]: [f64; 2]| exact.lambda(x, y) - solution.lambda()[sub.vertex_of(t)];
            let [blind, coarser, value] = figures(d, sub, &cut_rule(exact, 3), rho);
            assert!(
                blind < 0.75 * value && coarser > 0.85 * value,
                "{case}: {blind:e} {coarser:e} {value:e}"
            );
        });
    }
}

#[test]
fn the_change_of_the_quadrature_bounds_the_change_of_the_figure() {
    with_solution(Case::Circle, 8, |d, sub, exact, solution| {
        let rho = |t: usize, [x, y]: [f64; 2]| exact.lambda(x, y) - solution.lambda()[sub.vertex_of(t)];
        let [coarse, fine] = [2, 5].map(|depth| dual_norm(d, sub, &cut_rule(exact, depth), 1, rho).unwrap());
        let unresolved = dual_norm(d, sub, &plain(), 1, rho).unwrap();
        let change = (coarse.value - fine.value).abs();
        assert!(change < coarse.quadrature && fine.quadrature < coarse.quadrature / 8.0);
        assert!((unresolved.value - fine.value).abs() > coarse.quadrature);
    });
}
