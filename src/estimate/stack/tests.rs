//! The bound of stacks against solutions that are known, and against finer ones.

mod never_below;
mod parts;

use crate::action::{StackSolution, certify_stack};
use crate::discretization::StackDiscretization;
use crate::estimate::ErrorBound;
use crate::fem::{DEGREE_4, gradient};
use crate::mesh::Mesh;
use crate::problem::ContactProblem;
use crate::solver::{ActiveSet, ContactSolver, SolverOptions};

/// What is asked of the solver.
const TOLERANCE: f64 = 1e-9;

fn posed(problem: &ContactProblem, mesh: &Mesh) -> StackDiscretization {
    StackDiscretization::new(problem, mesh.clone()).unwrap()
}

fn solve(d: &StackDiscretization) -> StackSolution {
    let options = SolverOptions { tolerance: TOLERANCE, ..SolverOptions::default() };
    certify_stack(d, ActiveSet.solve_stack(d, &options).unwrap(), TOLERANCE).unwrap()
}

fn bound(d: &StackDiscretization, solution: &StackSolution) -> ErrorBound {
    ErrorBound::of_stack(d, solution).unwrap()
}

/// `(sum_i int mu_i |grad u_i - grad u_ih|^2)^(1/2)` for exact slopes, by a rule on each triangle divided `depth` times.
fn energy_error(
    mesh: &Mesh,
    solution: &StackSolution,
    tension: impl Fn(usize, [f64; 2]) -> f64,
    slope: impl Fn(usize, [f64; 2]) -> [f64; 2],
    depth: usize,
) -> f64 {
    let mut sum = 0.0;
    for (i, u) in (1..).zip(solution.displacement()) {
        for (k, triangle) in mesh.triangles().iter().enumerate() {
            let of_discrete = gradient(mesh.corners(k), triangle.map(|a| u[a]));
            let integrand = |x: [f64; 2]| {
                let exact = slope(i, x);
                tension(i, x) * ((exact[0] - of_discrete[0]).powi(2) + (exact[1] - of_discrete[1]).powi(2))
            };
            sum += integral(mesh.corners(k), &integrand, depth);
        }
    }
    sum.sqrt()
}

fn integral(corners: [[f64; 2]; 3], f: &impl Fn([f64; 2]) -> f64, depth: usize) -> f64 {
    let [a, b, c] = corners;
    let middle = |p: [f64; 2], q: [f64; 2]| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
    if depth > 0 {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        let parts = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
        return parts.into_iter().map(|part| integral(part, f, depth - 1)).sum();
    }
    let area = 0.5 * crate::geometry::twice_signed_area(corners);
    let at =
        |point: &[f64; 3]| [0, 1].map(|axis| point[0] * a[axis] + point[1] * b[axis] + point[2] * c[axis]);
    area * DEGREE_4
        .points
        .iter()
        .zip(DEGREE_4.weights)
        .map(|(point, weight)| weight * f(at(point)))
        .sum::<f64>()
}
