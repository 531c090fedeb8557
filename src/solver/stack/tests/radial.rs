//! Rotationally symmetric stacks on disks; section 6 of the notes on stacks.

use super::{posed, solve_by};
use crate::action::StackSolution;
use crate::mesh::{Mesh, disk};
use crate::numeric::largest;
use crate::problem::{ContactProblem, Function, Membrane};
use crate::solver::ActiveSet;

/// A membrane that is held at the values of `u(r)` on the unit circle.
fn held(membrane: Membrane, u: impl Fn(f64) -> f64) -> Membrane {
    membrane.height(u(1.0))
}

/// The largest distances of the membranes' displacements from `u(i, r)`, on three meshes.
fn errors(problem: &ContactProblem, u: impl Fn(usize, f64) -> f64) -> ([f64; 3], Mesh, StackSolution) {
    let mut last = None;
    let errors = [8, 16, 32].map(|rings| {
        let mesh = disk([0.0, 0.0], 1.0, rings).unwrap();
        let solution = solve_by(&mut ActiveSet, &posed(problem, &mesh));
        let of_membrane = |(i, found): (usize, &Vec<f64>)| {
            let pairs = mesh.points().iter().zip(found);
            largest(pairs.map(|(&[x, y], found)| (found - u(i, x.hypot(y))).abs()))
        };
        let error = largest((1..).zip(solution.displacement()).map(of_membrane));
        last = Some((mesh, solution));
        error
    });
    let (mesh, solution) = last.unwrap();
    (errors, mesh, solution)
}

fn assert_second_order(errors: [f64; 3]) {
    let rate = (errors[0] / errors[2]).log2() / 2.0;
    assert!((1.6..2.6).contains(&rate), "{errors:?}");
}

/// Away from the circles at which it jumps, an action is that of the continuous problem; and so is the total, but for the
/// cells that they cut.
fn assert_action(
    mesh: &Mesh,
    solution: &StackSolution,
    k: usize,
    lambda: impl Fn(f64) -> f64,
    jumps: &[f64],
) {
    let gap = solution.gap(k).unwrap();
    for (&[x, y], &found) in mesh.points().iter().zip(&gap.lambda) {
        let r = x.hypot(y);
        if r < 0.95 && jumps.iter().all(|jump| (r - jump).abs() > 0.08) {
            assert!((found - lambda(r)).abs() < 0.05 * (1.0 + lambda(0.0)), "gap {k}, r = {r}: {found}");
        }
    }
}

/// S1: constant tension over a floor at zero.
#[test]
fn over_a_floor() {
    let (mu, q, r0) = (2.0, 10.0, 0.4f64);
    let u = move |r: f64| {
        let kappa = q / (4.0 * mu);
        if r <= r0 { 0.0 } else { kappa * (r * r - r0 * r0 - 2.0 * r0 * r0 * (r / r0).ln()) }
    };
    let problem = ContactProblem::obstacle(held(Membrane::new(mu).load(-q), u), 0.0).unwrap();
    let (errors, mesh, solution) = errors(&problem, |_, r| u(r));
    assert_second_order(errors);
    assert_action(&mesh, &solution, 1, |r| if r < r0 { q } else { 0.0 }, &[r0]);
}

/// S5: the tension `1 + r^2` over a floor at zero.
#[test]
fn of_varying_tension_over_a_floor() {
    let (q, r0) = (10.0, 0.4f64);
    let u = move |r: f64| {
        let ratio = (1.0 + r * r) / (1.0 + r0 * r0);
        if r <= r0 { 0.0 } else { 0.5 * q * (-r0 * r0 * (r / r0).ln() + 0.5 * (1.0 + r0 * r0) * ratio.ln()) }
    };
    let tension = Function::from_fn(|x, y| 1.0 + x * x + y * y);
    let problem = ContactProblem::obstacle(held(Membrane::new(tension).load(-q), u), 0.0).unwrap();
    let (errors, mesh, solution) = errors(&problem, |_, r| u(r));
    assert_second_order(errors);
    assert_action(&mesh, &solution, 1, |r| if r < r0 { q } else { 0.0 }, &[r0]);
}

/// The integral of `slope` from `from` to `r`, by Simpson's rule.
fn integral(slope: impl Fn(f64) -> f64, from: f64, r: f64) -> f64 {
    const PARTS: usize = 200;
    let h = (r - from) / PARTS as f64;
    let part = |k: usize| {
        let x = from + h * k as f64;
        h / 6.0 * (slope(x) + 4.0 * slope(x + 0.5 * h) + slope(x + h))
    };
    (0..PARTS).map(part).sum()
}

/// S6: tensions `1 + r^2` and 1, which are not in proportion.
#[test]
fn two_membranes_of_different_profiles() {
    let ([f1, f2], r0) = ([-8.0, 6.0], 0.3f64);
    let together = move |r: f64| -(f1 + f2) / 4.0 * (2.0 + r * r).ln();
    let slope = -(f1 + f2) / 2.0 * r0 / (2.0 + r0 * r0);
    let c1 = r0 * (1.0 + r0 * r0) * slope + f1 * r0 * r0 / 2.0;
    let c2 = r0 * slope + f2 * r0 * r0 / 2.0;
    let u = move |i: usize, r: f64| {
        let rise = move |r: f64| match i {
            1 => (-f1 * r / 2.0 + c1 / r) / (1.0 + r * r),
            _ => -f2 * r / 2.0 + c2 / r,
        };
        if r <= r0 { together(r) } else { together(r0) + integral(rise, r0, r) }
    };
    let tension = Function::from_fn(|x, y| 1.0 + x * x + y * y);
    let problem = ContactProblem::stack()
        .membrane(held(Membrane::new(tension).load(f1), |r| u(1, r)))
        .membrane(held(Membrane::new(1.0).load(f2), |r| u(2, r)))
        .build()
        .unwrap();
    let (errors, mesh, solution) = errors(&problem, u);
    assert_second_order(errors);
    let lambda = move |r: f64| {
        let s = r * r;
        if r < r0 { (f2 * (s * s + 4.0 * s + 2.0) - 2.0 * f1) / (s + 2.0).powi(2) } else { 0.0 }
    };
    assert_action(&mesh, &solution, 1, lambda, &[r0]);
}

/// S4: three membranes in nested disks of contact.
#[test]
fn three_membranes_in_nested_disks() {
    let (mu, f) = ([1.0, 2.0, 3.0], [-20.0, 4.0, 24.0]);
    let (r2, r1) = (0.15f64, 0.3f64);
    // Value and slope of `v` at `r0`, continued with the curvature `k`.
    let continued = |[value, slope]: [f64; 2], k: f64, r0: f64, r: f64| {
        let log = r0 * slope - 0.5 * k * r0 * r0;
        [value + 0.25 * k * (r * r - r0 * r0) + log * (r / r0).ln(), 0.5 * k * r + log / r]
    };
    let k_all = -(f[0] + f[1] + f[2]) / 6.0;
    let k_two = -(f[0] + f[1]) / 3.0;
    let all = move |r: f64| [0.25 * k_all * r * r, 0.5 * k_all * r];
    let two = move |r: f64| continued(all(r2), k_two, r2, r);
    let u = move |i: usize, r: f64| {
        let alone = |from: [f64; 2], r0: f64| continued(from, -f[i - 1] / mu[i - 1], r0, r)[0];
        match i {
            _ if r <= r2 => all(r)[0],
            3 => alone(all(r2), r2),
            _ if r <= r1 => two(r)[0],
            _ => alone(two(r1), r1),
        }
    };
    let stack = (1..=3).fold(ContactProblem::stack(), |stack, i| {
        stack.membrane(held(Membrane::new(mu[i - 1]).load(f[i - 1]), |r| u(i, r)))
    });
    let (errors, mesh, solution) = errors(&stack.build().unwrap(), u);
    assert_second_order(errors);
    let first = |r: f64| {
        if r < r2 {
            64.0 / 3.0
        } else if r < r1 {
            44.0 / 3.0
        } else {
            0.0
        }
    };
    assert_action(&mesh, &solution, 1, first, &[r2, r1]);
    assert_action(&mesh, &solution, 2, |r| if r < r2 { 20.0 } else { 0.0 }, &[r2]);
}
