//! The bound is never below the true error.

use super::{ErrorBound, bound};
use crate::action::certify_pair;
use crate::discretization::{Displacement, PairDiscretization};
use crate::estimate::tests::{exact, mesh, problem, solve};
use crate::estimate::{ErrorBounds, energy_error as measure};
use crate::geometry::friedrichs;
use crate::mesh::samples::irregular;
use crate::mesh::{Mesh, disk, polygon};
use crate::numeric::Random;
use crate::problem::{Case, ContactProblem, Domain, ExactSolution, Function};
use crate::qp::Clarabel;
use crate::solver::{ActiveSet, ContactSolver, Multigrid, QpSolver, SolverOptions};

/// Far from the asymptotic range the bound may be this many times the error.
const COARSE: f64 = 3.0;

/// Rounding of a bound and an error that are zero.
const ROUNDING: f64 = 1e-10;

/// `|||u - u_h|||` of any displacements.
fn energy_error(d: &PairDiscretization, displacement: &Displacement, exact: &ExactSolution) -> f64 {
    measure(d, displacement, exact).unwrap()
}

fn assert_bounds(name: &str, exact: &ExactSolution, mesh: &Mesh) {
    let problem = problem(exact);
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let solution = solve(&d);
    let bound = bound(&problem, &exact.domain(), &d, solution.displacement());
    let error = energy_error(&d, solution.displacement(), exact);
    assert!(bound.total >= error, "{name}: {} is below {error}", bound.total);
    // The negative test: a third of it is no bound.
    assert!(bound.total <= COARSE * error + ROUNDING, "{name}: {} is far above {error}", bound.total);
}

#[test]
fn on_the_exact_cases() {
    for case in Case::ALL {
        for (mu1, mu2) in [(1.0, 1.0), (1.0, 20.0), (20.0, 1.0)] {
            let exact = exact(case, &[("mu1", mu1), ("mu2", mu2)]);
            for cells in [6, 20] {
                assert_bounds(
                    &format!("{case}, {mu1}, {mu2}, {cells}"),
                    &exact,
                    &mesh(&exact.domain(), cells),
                );
            }
            if exact.domain() == Domain::unit_square() {
                assert_bounds(&format!("{case}, irregular"), &exact, &irregular(15));
            }
        }
    }
}

/// The membranes of a disk with a height that varies: `u1 = 2 + x^2 - y^2` is harmonic, `u2 = 0`.
#[test]
fn on_a_disk_whose_height_varies() {
    let domain = Domain::Disk { centre: [0.0, 0.0], radius: 1.0 };
    let height = Function::from_fn(|x, y| 2.0 + x * x - y * y);
    let problem = ContactProblem::builder().tension(2.0, 1.0).height(height).build().unwrap();
    for rings in [4, 8, 16] {
        let mesh = disk([0.0, 0.0], 1.0, rings).unwrap();
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let displacement = solve(&d).displacement().clone();
        let found = bound(&problem, &domain, &d, &displacement);
        let error = (2.0 * seminorm_of_difference_sq(&d, &displacement[0])).sqrt();
        assert!(found.total >= error && found.total <= 2.0 * error, "{rings}: {found:?} {error}");
        // The negative test: of the polygon alone, whose trace is another, no more than the flux is known.
        assert!(found.parts.boundary > 0.1 * found.parts.flux, "{:?}", found.parts);
    }
}

/// `|x^2 - y^2 - u_h|_{H1}^2` over the mesh: the gradient `(2 x, -2 y)` less a constant, by the midpoints of the edges.
fn seminorm_of_difference_sq(d: &PairDiscretization, u: &[f64]) -> f64 {
    let mesh = d.mesh();
    let on_triangle = |k: usize| {
        let corners = mesh.corners(k);
        let slope = crate::fem::gradient(corners, mesh.triangles()[k].map(|a| u[a]));
        let at_midpoint = |j: usize| {
            let [x, y] = [0, 1].map(|axis| 0.5 * (corners[j][axis] + corners[(j + 1) % 3][axis]));
            (2.0 * x - slope[0]).powi(2) + (-2.0 * y - slope[1]).powi(2)
        };
        mesh.triangle_area(k) / 3.0 * (0..3).map(at_midpoint).sum::<f64>()
    };
    (0..mesh.triangles().len()).map(on_triangle).sum()
}

/// A polygon around the origin whose vertices lie at random distances.
fn random_polygon(random: &mut Random) -> Vec<[f64; 2]> {
    let corners = 3 + random.below(6);
    let at = |k: usize| std::f64::consts::TAU * k as f64 / corners as f64;
    (0..corners)
        .map(|k| (at(k), random.between(0.4, 1.0)))
        .map(|(angle, radius)| [radius * angle.cos(), radius * angle.sin()])
        .collect()
}

/// Milder than [`crate::problem::samples::drawn`]: on so coarse a mesh, the bound is not [`COARSE`] for tensions far apart.
fn random_problem(random: &mut Random) -> ContactProblem {
    let [a, b, c, e] = [0; 4].map(|_| random.between(-20.0, 20.0));
    let [height, slope] = [random.between(0.0, 0.1), random.between(0.0, 0.02)];
    ContactProblem::builder()
        .tension(random.between(0.5, 5.0), random.between(0.5, 5.0))
        .load(
            Function::from_fn(move |x, y| a - 10.0 + b * x * y),
            Function::from_fn(move |x, y| c + e * (4.0 * x + y).sin()),
        )
        // Affine: then traces on finer meshes are the same.
        .height(Function::from_fn(move |x, y| height + slope * (2.0 + x - y)))
        .build()
        .unwrap()
}

#[test]
fn on_random_polygons_against_a_finer_solution() {
    for seed in 0..30 {
        let mut random = Random::new(seed);
        let coarse = polygon(&random_polygon(&mut random), &[], 0.25, 20.0).unwrap();
        let problem = random_problem(&mut random);
        let d = PairDiscretization::new(&problem, coarse.clone()).unwrap();
        let solution = solve(&d);
        let found = ErrorBound::new(&problem, None, &d, solution.displacement()).unwrap().total;
        let first = coarse.refine().unwrap();
        let second = first.mesh.refine().unwrap();
        let mut difference = solution.displacement().clone();
        for parents in [&first.parents, &second.parents] {
            for u in &mut difference {
                let midpoints: Vec<f64> = parents.iter().map(|&[a, b]| 0.5 * (u[a] + u[b])).collect();
                u.extend(midpoints);
            }
        }
        let d_fine = PairDiscretization::new(&problem, second.mesh.clone()).unwrap();
        let finer = solve(&d_fine);
        for (u, finer) in difference.iter_mut().zip(finer.displacement()) {
            u.iter_mut().zip(finer).for_each(|(u, finer)| *u -= finer);
        }
        let energy_sq = |i: usize| {
            let u = &difference[i];
            let at = |a: usize| u[a] * d_fine.stiffness_row(a, |b| u[b]);
            problem.as_pair().expect("a pair").tension()[i] * (0..u.len()).map(at).sum::<f64>()
        };
        let distance = (energy_sq(0) + energy_sq(1)).sqrt();
        assert!(found >= distance, "seed {seed}: {found} is below {distance}");
        assert!(found <= COARSE * distance, "seed {seed}: {found} is far above {distance}");
    }
}

/// Displacements of every solver, loose, stopped early, or moved at random: nothing that has the right boundary values is too
/// bad to be bounded.
#[test]
fn of_displacements_that_do_not_solve_the_problem() {
    let exact = exact(Case::Circle, &[("mu1", 1.0), ("mu2", 3.0)]);
    let problem = problem(&exact);
    let mesh = mesh(&exact.domain(), 24);
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let loose = SolverOptions { tolerance: 1e-2, polish: false, ..SolverOptions::default() };
    let early = SolverOptions { max_iterations: Some(1), ..SolverOptions::default() };
    let solvers = || -> Vec<Box<dyn ContactSolver>> {
        vec![
            Box::new(ActiveSet),
            Box::new(Multigrid),
            Box::new(QpSolver::new(Clarabel)),
            #[cfg(feature = "osqp")]
            Box::new(QpSolver::new(crate::qp::Osqp)),
        ]
    };
    let mut of_solvers = Vec::new();
    for options in [&loose, &early] {
        for mut solver in solvers() {
            of_solvers.push((solver.name().to_owned(), solver.solve_pair(&d, options).unwrap().displacement));
        }
    }
    let solved = solve(&d).displacement().to_vec();
    let mut random = Random::new(7);
    for size in [1e-4, 1e-2, 1.0] {
        let mut moved = solved.clone();
        for u in &mut moved {
            d.interior().iter().for_each(|&a| u[a] += random.between(-size, size));
        }
        of_solvers.push((format!("moved by {size}"), moved));
    }
    let still = vec![d.height().to_vec(), vec![0.0; d.height().len()]];
    of_solvers.push(("at rest".into(), still));
    let mut algebraic = 0;
    for (name, displacement) in of_solvers {
        let displacement = Displacement::try_from(displacement).unwrap();
        let found = bound(&problem, &exact.domain(), &d, &displacement);
        let error = energy_error(&d, &displacement, &exact);
        assert!(found.total >= error, "{name}: {} is below {error}", found.total);
        // The negative test: what the discretisation alone explains is below the error of some of them.
        algebraic += usize::from(found.parts.discretization() < error);
    }
    assert!(algebraic > 0);
}

/// Of solutions of every solver, as they are and loose, with their own action: what was cut off of gaps and actions is in the bound.
#[test]
fn of_solutions_that_were_projected() {
    let exact = exact(Case::Circle, &[("mu1", 1.0), ("mu2", 3.0)]);
    let problem = problem(&exact);
    let mesh = mesh(&exact.domain(), 24);
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let solvers: [Box<dyn ContactSolver>; 3] =
        [Box::new(ActiveSet), Box::new(Multigrid), Box::new(QpSolver::new(Clarabel))];
    let mut cut = 0;
    for mut solver in solvers {
        for tolerance in [1e-2, 1e-4, 1e-8] {
            let options = SolverOptions { tolerance, polish: false, ..SolverOptions::default() };
            let solution = certify_pair(&d, solver.solve_pair(&d, &options).unwrap(), tolerance).unwrap();
            let found = ErrorBounds::new(&problem, None, &d).of_solution(&solution).unwrap();
            let error = energy_error(&d, solution.displacement(), &exact);
            let is = format!("{}, {tolerance:e}: {found:?}, error {error:e}", solver.name());
            assert!(found.total >= error, "{is}");
            // Each membrane is out of balance with the action by no less than what was cut off of it.
            let lost_sq = |i: usize| {
                let force = d.imbalance(i, &solution.displacement()[i]);
                let rest = d.interior().iter().zip(force).map(|(&a, force)| {
                    let sign = if i == 0 { 1.0 } else { -1.0 };
                    d.dual_area()[a] * (sign * force / d.dual_area()[a] - solution.lambda()[a]).powi(2)
                });
                rest.sum::<f64>() / d.tension()[i]
            };
            let lost = friedrichs([1.0, 1.0]) * (lost_sq(0) + lost_sq(1)).sqrt();
            assert!((found.parts.algebraic - lost).abs() <= 1e-9 * lost.max(1.0), "{is} {lost:e}");
            assert!(d.interior().iter().all(|&a| found.actions[0][a] == solution.lambda()[a]), "one action");
            cut += usize::from(found.parts.algebraic > 0.1 * found.parts.discretization());
        }
    }
    assert!(cut > 0, "there is something to be seen");
}

/// Each membrane for itself in equilibrium with its load, as if the other were not there: fluxes and actions are perfect, and the
/// error is all in the overlap.
#[test]
fn of_membranes_that_pass_through_each_other() {
    let exact = exact(Case::FullContact, &[]);
    let problem = problem(&exact);
    let mesh = mesh(&exact.domain(), 16);
    // So high that they do not meet.
    const HIGH: f64 = 100.0;
    let [f1, f2] = exact.load_functions();
    let [mu1, mu2] = exact.tension();
    let apart = ContactProblem::builder().tension(mu1, mu2).load(f1, f2).height(HIGH).build().unwrap();
    let [mut u1, u2] = solve(&PairDiscretization::new(&apart, mesh.clone()).unwrap()).displacement().clone();
    u1.iter_mut().for_each(|u1| *u1 -= HIGH);
    assert!(u1.iter().zip(&u2).any(|(u1, u2)| u1 < u2), "they overlap");
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let displacement = [u1, u2];
    let found = bound(&problem, &exact.domain(), &d, &displacement);
    let error = energy_error(&d, &displacement, &exact);
    assert!(found.total >= error, "{} is below {error}", found.total);
    // The negative test: fluxes and loads alone know nothing of it.
    assert!(found.parts.discretization() < 0.5 * error, "{:?}", found.parts);
}

/// Between the polygon and the circle the membranes are continued by their heights; there, all of the gradient is error.
#[test]
fn on_a_disk_up_to_its_circle() {
    let exact = exact(Case::Disk, &[]);
    let problem = problem(&exact);
    for rings in [8, 32] {
        let mesh = mesh(&exact.domain(), rings);
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let displacement = solve(&d).displacement().clone();
        let found = bound(&problem, &exact.domain(), &d, &displacement);
        let beyond_sq = beyond_the_polygon_sq(&exact, &mesh);
        let error = energy_error(&d, &displacement, &exact).hypot(beyond_sq.sqrt());
        assert!(found.total >= error && found.total <= 1.35 * error, "{}, {error}", found.total);
        // The negative test: a bound on the polygon alone.
        let polygon = ErrorBound::new(&problem, None, &d, &displacement).unwrap();
        assert!(polygon.total < error, "{} {error}", polygon.total);
    }
}

/// `sum_i mu_i |grad u_i|^2` integrated between the unit circle and the chords of the mesh, for a radial solution.
fn beyond_the_polygon_sq(exact: &ExactSolution, mesh: &Mesh) -> f64 {
    let on_circle = |point: &&[f64; 2]| (point[0].hypot(point[1]) - 1.0).abs() < 1e-9;
    let sides = mesh.points().iter().filter(on_circle).count();
    let half = std::f64::consts::PI / sides as f64;
    let (angles, radii) = (40, 20);
    let mut sum = 0.0;
    for j in 0..angles {
        // From the middle of a chord to its end.
        let angle = half * (j as f64 + 0.5) / angles as f64;
        let chord = half.cos() / angle.cos();
        for k in 0..radii {
            let r = chord + (1.0 - chord) * (k as f64 + 0.5) / radii as f64;
            let weight = r * (1.0 - chord) / radii as f64 * half / angles as f64;
            let squares = exact.grad_u(r, 0.0).map(|[x, y]| x * x + y * y);
            sum += weight * (exact.tension()[0] * squares[0] + exact.tension()[1] * squares[1]);
        }
    }
    2.0 * sides as f64 * sum
}
