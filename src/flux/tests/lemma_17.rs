//! Lemma 17, and the energy split of the exact decoupling.

use std::collections::BTreeMap;

use super::samples::{cubic_problem, loads, meshes, solve, touches_in_part};
use crate::action::PairSolution;
use crate::discretization::{Displacement, PairDiscretization};
use crate::fem::{DEGREE_4, element_means};
use crate::flux::{Flux, Reconstruction, Reconstructor};
use crate::mesh::samples::irregular;
use crate::mesh::{Mesh, SubTriangulation, disk};
use crate::numeric::{Random, largest};
use crate::problem::{Case, ContactProblem, Function};

/// Rounding of integrals over cells of loads of the size 20, and of abscissae of 16 digits.
const ROUNDING: f64 = 1e-12;

/// A fault of one cell: a fraction of its area, at least `1e-4`.
const SEEN: f64 = 1e-7;

/// The exact Laplacian is taken as a difference quotient of exact gradients over this step.
const STEP: f64 = 1e-4;

/// What the step leaves: its square, times the fourth derivatives of the solution, times the area of a cell.
const QUOTIENT: f64 = 1e-7;

/// `int_T f`, for polynomials of degree 4 exact.
fn integral(mesh: &Mesh, t: usize, f: impl Fn([f64; 2]) -> f64) -> f64 {
    let corners = mesh.corners(t);
    let at = |b: &[f64; 3]| f([0, 1].map(|axis| (0..3).map(|j| b[j] * corners[j][axis]).sum::<f64>()));
    let terms = DEGREE_4.points.iter().zip(DEGREE_4.weights);
    mesh.triangle_area(t) * terms.map(|(b, weight)| weight * at(b)).sum::<f64>()
}

/// Both sides of (4.15) over the vertices for one membrane, with `exact` the function `mu_i Lap u_i - (-1)^i lambda`.
fn both_sides(
    d: &PairDiscretization,
    solution: &PairSolution,
    flux: &Flux,
    membrane: usize,
    f: &Function,
    exact: impl Fn([f64; 2]) -> f64,
) -> Displacement {
    let (mesh, sub) = (d.mesh(), flux.sub_triangulation());
    let (means, sign) = (element_means(mesh, f).unwrap(), [-1.0, 1.0][membrane]);
    let [mut left, mut right] = [(); 2].map(|()| vec![0.0; mesh.points().len()]);
    for t in 0..sub.mesh().triangles().len() {
        let (a, k) = (sub.vertex_of(t), sub.triangle_of(t));
        let constant = flux.divergence(t) + sign * solution.lambda()[a];
        left[a] += integral(sub.mesh(), t, |x| constant + exact(x));
        right[a] -= integral(sub.mesh(), t, |[x, y]| f.eval(x, y).unwrap() - means[k]);
    }
    right.iter_mut().zip(&d.load()[membrane]).for_each(|(right, load)| *right += load);
    for (k, corners) in mesh.triangles().iter().enumerate() {
        // int_K f_ih phi_a
        corners.iter().for_each(|&a| right[a] -= means[k] * mesh.triangle_area(k) / 3.0);
    }
    [left, right]
}

/// The largest difference over interior vertices, and the largest right side.
fn compare(d: &PairDiscretization, [left, right]: &Displacement) -> [f64; 2] {
    let over = |value: &dyn Fn(usize) -> f64| largest(d.interior().iter().map(|&a| value(a)));
    [over(&|a| (left[a] - right[a]).abs()), over(&|a| right[a].abs())]
}

/// By (1.1), `mu_i Lap u_i - (-1)^i lambda = -f_i` for the exact solution, whatever it is.
#[test]
fn lemma_17_with_loads_that_oscillate() {
    let problem = cubic_problem();
    for (name, mesh) in meshes() {
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let sub = SubTriangulation::new(&mesh).unwrap();
        let solution = solve(&d);
        assert!(touches_in_part(&d, &solution), "{name}");
        let reconstructor = Reconstructor::new(&d, &sub, loads(&problem, &mesh));
        for kind in Reconstruction::ALL {
            let flux = reconstructor.reconstruct(solution.displacement(), kind);
            for (i, (flux, f)) in flux.iter().zip(problem.as_pair().expect("a pair").load()).enumerate() {
                let sides = both_sides(&d, &solution, flux, i, f, |[x, y]| -f.eval(x, y).unwrap());
                let [difference, oscillation] = compare(&d, &sides);
                assert!(difference < ROUNDING, "{name}, {}: {difference:e}", kind.name());
                // Without the oscillation, or with the other membrane's action, it would not hold.
                assert!(oscillation > SEEN, "{name}: {oscillation:e}");
                let exchanged = both_sides(&d, &solution, flux, 1 - i, f, |[x, y]| -f.eval(x, y).unwrap());
                assert!(compare(&d, &exchanged)[0] > SEEN);
            }
        }
    }
}

/// Constant loads, exact solution known with its Laplacian and its action, both of which jump: (4.15) with zero on the
/// right.
#[test]
fn lemma_17_against_an_exact_solution() {
    let exact = Case::Disk.solution(&BTreeMap::new()).unwrap();
    let problem: ContactProblem = exact.problem().unwrap();
    let mesh = disk([0.0, 0.0], 1.0, 9).unwrap();
    let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
    let sub = SubTriangulation::new(&mesh).unwrap();
    let solution = solve(&d);
    assert!(touches_in_part(&d, &solution));
    let reconstructor = Reconstructor::new(&d, &sub, loads(&problem, &mesh));
    let flux = reconstructor.reconstruct(solution.displacement(), Reconstruction::Full);
    let laplacian = |i: usize, [x, y]: [f64; 2]| {
        let slope = |x: f64, y: f64| exact.grad_u(x, y)[i];
        (slope(x + STEP, y)[0] - slope(x - STEP, y)[0] + slope(x, y + STEP)[1] - slope(x, y - STEP)[1])
            / (2.0 * STEP)
    };
    for (i, sign) in [(0, -1.0), (1, 1.0)] {
        let mu = problem.as_pair().expect("a pair").tension()[i];
        let pde = |point: [f64; 2]| mu * laplacian(i, point) - sign * exact.lambda(point[0], point[1]);
        let sides =
            both_sides(&d, &solution, &flux[i], i, &problem.as_pair().expect("a pair").load()[i], pde);
        let [difference, oscillation] = compare(&d, &sides);
        assert!(oscillation < ROUNDING && difference < QUOTIENT, "{difference:e} {oscillation:e}");
        let without =
            both_sides(&d, &solution, &flux[i], i, &problem.as_pair().expect("a pair").load()[i], |x| {
                mu * laplacian(i, x)
            });
        assert!(compare(&d, &without)[0] > 1e3 * QUOTIENT, "without the exact action");
    }
}

/// `|||u|||^2 = |s|_1^2 / M + m |w|_1^2` for `s = mu1 u1 + mu2 u2`, `w = u1 - u2`, for any displacements.
#[test]
fn energy_splits_into_sum_and_gap() {
    let mesh = irregular(6);
    let mut random = Random::new(7);
    for (mu1, mu2) in [(1.0, 3.0), (1.0, 1.0), (1e-3, 50.0)] {
        let problem = ContactProblem::builder().tension(mu1, mu2).build().unwrap();
        let d = PairDiscretization::new(&problem, mesh.clone()).unwrap();
        let square = |v: &[f64]| (0..v.len()).map(|a| v[a] * d.stiffness_row(a, |b| v[b])).sum::<f64>();
        let [u1, u2] =
            [(); 2].map(|()| (0..mesh.points().len()).map(|_| random.between(-1.0, 1.0)).collect::<Vec<_>>());
        let combined =
            |p: f64, q: f64| -> Vec<f64> { u1.iter().zip(&u2).map(|(u1, u2)| p * u1 + q * u2).collect() };
        let (total, reduced) = (mu1 + mu2, mu1 * mu2 / (mu1 + mu2));
        let energy = mu1 * square(&u1) + mu2 * square(&u2);
        let split =
            |reduced: f64| square(&combined(mu1, mu2)) / total + reduced * square(&combined(1.0, -1.0));
        assert!((energy - split(reduced)).abs() < ROUNDING * energy);
        assert!((energy - split(1.01 * reduced)).abs() > SEEN * energy);
    }
}
