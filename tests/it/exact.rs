//! Solutions that are known exactly.

use membrane_contact::action::{Action, PairSolution, certify_pair};
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::{Mesh, Pattern, rectangle};
use membrane_contact::problem::{Case, ContactProblem, ExactSolution};
use membrane_contact::solver::ContactSolver;

use crate::common::{TOLERANCE, distance, exact, largest, solve, solvers};

/// Nodal error of a nodally exact case after the polish.
const NODALLY_EXACT: f64 = 1e-10;

/// Error of the action there, force per area: rounding over the mesh size squared.
const ACTION_EXACT: f64 = 1e-8;

fn unit_square(cells: usize) -> Mesh {
    rectangle([0.0, 0.0], [1.0, 1.0], [cells, cells], Pattern::Right).unwrap()
}

/// Multigrid stops at the tolerance: residuals of it, and displacements that follow from them.
const ITERATED: f64 = 10.0 * TOLERANCE;

fn nodal<T>(mesh: &Mesh, f: impl Fn(f64, f64) -> T) -> Vec<T> {
    mesh.points().iter().map(|&[x, y]| f(x, y)).collect()
}

/// The largest nodal error of both displacements.
fn nodal_error(mesh: &Mesh, exact: &ExactSolution, displacement: &[Vec<f64>; 2]) -> f64 {
    let [u1, u2] = [0, 1].map(|i| nodal(mesh, |x, y| exact.u(x, y)[i]));
    distance(&u1, &displacement[0]).max(distance(&u2, &displacement[1]))
}

/// `lambda_h` over vertices, by (4.5) alone.
fn recovered(d: &PairDiscretization, displacement: &[Vec<f64>; 2]) -> Vec<f64> {
    let mut lambda = vec![0.0; d.mesh().points().len()];
    for (&a, action) in d.interior().iter().zip(Action::recover(d, displacement)) {
        lambda[a] = action.lambda;
    }
    lambda
}

/// Certified and polished solutions of all backends.
fn solutions(exact: &ExactSolution, mesh: &Mesh) -> Vec<PairSolution> {
    let problem = exact.problem().expect("a case has valid data");
    let d = PairDiscretization::new(&problem, mesh.clone()).expect("the data are finite");
    let solve = |solver: &mut Box<dyn ContactSolver>| {
        certify_pair(&d, solve(solver.as_mut(), &d, true), TOLERANCE).expect("certified")
    };
    solvers().iter_mut().map(solve).collect()
}

/// Those of the solvers that are right to rounding; multigrid is so to its tolerance.
fn exact_solutions(exact: &ExactSolution, mesh: &Mesh) -> Vec<PairSolution> {
    let mut solutions = solutions(exact, mesh);
    solutions.retain(|solution| solution.statistics().solver != "multigrid");
    solutions
}

/// `q | q/2 | 0` left of, on and right of the line `x = x0`.
fn strip_action(mesh: &Mesh, x0: f64, q: f64) -> Vec<f64> {
    let inside = |x: f64, y: f64| 0.0 < x && x < 1.0 && 0.0 < y && y < 1.0;
    let action = |x: f64| {
        if x < x0 {
            q
        } else if x == x0 {
            0.5 * q
        } else {
            0.0
        }
    };
    nodal(mesh, |x, y| if inside(x, y) { action(x) } else { 0.0 })
}

#[test]
fn the_strip_is_nodally_exact_and_so_is_its_action() {
    let (x0, a0, mu1, mu2) = (0.5, 2.0, 1.0, 3.0);
    let q = 2.0 * a0 * mu1 * mu2 / (mu1 + mu2);
    let exact = exact(Case::Strip, &[("x0", x0), ("A0", a0), ("mu1", mu1), ("mu2", mu2)]);
    for cells in [8, 32, 64] {
        let mesh = unit_square(cells);
        for solution in exact_solutions(&exact, &mesh) {
            assert!(nodal_error(&mesh, &exact, solution.displacement()) < NODALLY_EXACT);
            assert!(distance(solution.lambda(), &strip_action(&mesh, x0, q)) < ACTION_EXACT);
        }
        for solution in solutions(&exact, &mesh) {
            assert!(nodal_error(&mesh, &exact, solution.displacement()) < ITERATED);
            assert!(distance(solution.lambda(), &strip_action(&mesh, x0, q)) < ITERATED * q);
        }
        // The free boundary half a cell further is another problem: the comparison sees it.
        let shifted = strip_action(&mesh, x0 + 0.5 / cells as f64, q);
        assert!(distance(&strip_action(&mesh, x0, q), &shifted) > ACTION_EXACT);
    }
}

/// The negative test of the exactness above, and the figures that the README shows (`-- --nocapture` prints them): of
/// answers as they are, before the certificate makes them complementary.
#[test]
fn an_interior_point_answer_is_not_exact_before_the_polish() {
    let exact = exact(Case::Strip, &[]);
    let problem = exact.problem().unwrap();
    println!("backend  cells  polish  error of u  error of lambda");
    for cells in [8, 32, 64] {
        let mesh = unit_square(cells);
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        for mut solver in solvers() {
            for polish in [false, true] {
                let candidate = solve(solver.as_mut(), &d, polish);
                let displacement = candidate.as_pair().expect("of two membranes");
                let error = nodal_error(&mesh, &exact, displacement);
                let action_error = distance(&recovered(&d, displacement), &strip_action(&mesh, 0.5, 1.5));
                assert!(certify_pair(&d, candidate, TOLERANCE).is_ok(), "certified either way");
                println!("{:8} {cells:5}  {polish:6}  {error:10.1e}  {action_error:15.1e}", solver.name());
                if solver.name() == "clarabel" {
                    assert_eq!(
                        action_error < ACTION_EXACT,
                        polish,
                        "the polish makes it exact: {action_error}"
                    );
                }
            }
        }
    }
}

/// Where contact reaches the edge, the cells of the boundary belong to it. Full contact under constant loads: the force
/// `(mu1 f2 - mu2 f1) / M` on the area 1. The strip: the force `q` up to the free boundary, where a column of cells has half of it, but
/// for cells of the size `h^2` at its ends.
#[test]
fn extended_totals_reach_the_edge_and_the_papers_do_not() {
    let near = |a: f64, b: f64| (a - b).abs() < 10.0 * ITERATED;
    let full = ContactProblem::builder().tension(1.0, 3.0).load(-8.0, 4.0).height(0.0).build().unwrap();
    let (x0, a0) = (0.5, 2.0);
    let strip = exact(Case::Strip, &[("x0", x0), ("A0", a0)]);
    let [mu1, mu2] = strip.tension();
    let q = 2.0 * a0 * mu1 * mu2 / (mu1 + mu2);
    for cells in [8, 32] {
        let mesh = unit_square(cells);
        let h = 1.0 / cells as f64;
        let inside = (1.0 - h).powi(2);
        let d = PairDiscretization::new(&full, mesh.clone()).unwrap();
        for mut solver in solvers() {
            let solution = certify_pair(&d, solve(solver.as_mut(), &d, true), TOLERANCE).unwrap();
            let force = (4.0 + 3.0 * 8.0) / 4.0;
            assert!(near(solution.total_force_extended(), force), "{}", solution.total_force_extended());
            assert!(near(solution.contact_area_extended(), 1.0), "{}", solution.contact_area_extended());
            assert!(near(solution.total_force(), force * inside), "{}", solution.total_force());
            assert!(near(solution.contact_area(), inside), "{}", solution.contact_area());
        }
        for solution in solutions(&strip, &mesh) {
            let missed = q * x0 - solution.total_force_extended();
            assert!(0.0 < missed && missed < q * h * h, "{missed}");
            let columns = x0 - 0.5 * h;
            assert!(near(solution.contact_area_extended(), columns + h * (1.0 - h)));
            assert!(near(solution.total_force(), q * columns * (1.0 - h)), "{}", solution.total_force());
        }
    }
    // Where the membranes are apart along the edge, both are the same.
    for solution in solutions(&exact(Case::Circle, &[]), &unit_square(16)) {
        assert_eq!(solution.total_force_extended(), solution.total_force());
        assert_eq!(solution.contact_area_extended(), solution.contact_area());
        assert!(solution.total_force() > 0.0);
    }
}

/// `lambda = 10 (1 + x y)` on all of the square: 12.5.
#[test]
fn the_extended_force_of_full_contact_is_the_integral_of_the_action() {
    let exact = exact(Case::FullContact, &[]);
    let errors = [16, 64].map(|cells| {
        let of = |solution: &PairSolution| (solution.total_force_extended() - 12.5).abs();
        largest(solutions(&exact, &unit_square(cells)).iter().map(of))
    });
    assert!(errors[0] < 0.05 && errors[1] < errors[0] / 8.0, "of second order: {errors:?}");
}

#[test]
fn full_contact_touches_everywhere_and_nowhere_else_is_pushed() {
    let exact = exact(Case::FullContact, &[]);
    let mesh = unit_square(16);
    let d_interior = 15 * 15;
    for solution in solutions(&exact, &mesh) {
        assert_eq!(solution.contact().iter().filter(|&&contact| contact).count(), d_interior);
        assert!(solution.gap().iter().all(|&gap| gap == 0.0), "the membranes are one");
        for (a, &[x, y]) in mesh.points().iter().enumerate().filter(|&(a, _)| solution.contact()[a]) {
            // lambda = 10 (1 + x y) is not constant: its mean over the weighted patch differs by O(h^2)
            let h = 1.0 / 16.0;
            assert!((solution.lambda()[a] - exact.lambda(x, y)).abs() < 10.0 * h * h);
        }
    }
}

#[test]
fn apart_the_membranes_do_not_push() {
    let exact = exact(Case::NoContact, &[]);
    for solution in exact_solutions(&exact, &unit_square(16)) {
        assert!(solution.contact().iter().all(|&contact| !contact));
        assert!(solution.lambda().iter().all(|&lambda| lambda == 0.0));
        assert_eq!((solution.total_force(), solution.contact_area()), (0.0, 0.0));
    }
}

#[test]
fn everywhere_biactive_does_not_cycle() {
    for q in [0.0, 1e-12, 1e-8] {
        let exact = exact(Case::Biactive, &[("q", q)]);
        let mesh = unit_square(16);
        for solution in solutions(&exact, &mesh) {
            assert!(distance(&solution.displacement()[0], &solution.displacement()[1]) < NODALLY_EXACT);
            assert!(solution.contact().iter().filter(|&&contact| contact).count() == 15 * 15);
            // q (1 + x y) lies between q and 2 q; the loads of size 10 leave their rounding, over h^2
            let rounding = 1e-11;
            assert!(
                solution.lambda().iter().all(|&lambda| -rounding < lambda && lambda < 2.0 * q + rounding)
            );
        }
    }
}

#[test]
fn curved_free_boundaries_are_found_to_the_order_of_the_mesh_size() {
    for (case, parameters) in [(Case::Circle, [("R", 0.3)].as_slice()), (Case::Annulus, &[])] {
        let exact = exact(case, parameters);
        let errors = [16, 64].map(|cells| {
            let mesh = unit_square(cells);
            let errors: Vec<f64> = solutions(&exact, &mesh)
                .iter()
                .map(|solution| nodal_error(&mesh, &exact, solution.displacement()))
                .collect();
            largest(errors)
        });
        // Of second order, but for where the curve passes among the vertices: better than 4^(-3/2) at a quarter of h.
        assert!(errors[1] < 0.125 * errors[0], "{case}: {errors:?}");
    }
}

#[test]
fn a_mesh_without_interior_vertices_has_a_solution() {
    let mesh = Mesh::new(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], vec![[0, 1, 2]]).unwrap();
    for solution in solutions(&exact(Case::NoContact, &[]), &mesh) {
        assert_eq!(solution.displacement(), &[vec![1.0, 2.0, 1.0], vec![0.0; 3]]);
    }
}
