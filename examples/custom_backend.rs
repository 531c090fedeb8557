//! A QP solver of one's own, plugged in: the method of multipliers, with semismooth Newton steps by conjugate gradients.
//!
//! ```text
//! cargo run --release --example custom_backend
//! ```

use std::time::Instant;

use membrane_contact::action::certify_pair;
use membrane_contact::discretization::PairDiscretization;
use membrane_contact::mesh::{Pattern, rectangle};
use membrane_contact::problem::{ContactProblem, Expression};
use membrane_contact::qp::{BackendError, KktResiduals, QpBackend, QpOptions, QpProblem, QpSolution, Status};
use membrane_contact::solver::{ContactSolver, QpSolver, SolverOptions};

/// `minimise 1/2 x'P x + q'x subject to A x >= b`, by minimising the augmented Lagrangian for fixed multipliers
/// (inner loop) and updating them, `y <- (y + rho (b - A x))^+` (outer loop).
pub struct MethodOfMultipliers {
    /// The penalty `rho`, in the units of the scaled problem.
    pub penalty: f64,
}

/// Newton steps for one set of multipliers: the active rows settle in a few.
const MAX_NEWTON_STEPS: usize = 50;

impl QpBackend for MethodOfMultipliers {
    fn name(&self) -> &str {
        "method-of-multipliers"
    }

    fn solve(&mut self, qp: &QpProblem, options: &QpOptions) -> Result<QpSolution, BackendError> {
        let start = Instant::now();
        let (mut x, mut y) =
            options.warm_start.clone().unwrap_or_else(|| (vec![0.0; qp.q().len()], vec![0.0; qp.b().len()]));
        let limit = options.max_iterations.unwrap_or(100);
        let mut status = Status::IterationLimit;
        let mut iterations = 0;
        while iterations < limit {
            iterations += 1;
            y = self.minimise(qp, &mut x, &y, 0.1 * options.tolerance);
            if KktResiduals::new(qp, &x, &y).worst() <= options.tolerance {
                status = Status::Solved;
                break;
            }
            if options.time_limit.is_some_and(|limit| limit.left_since(start).is_none()) {
                status = Status::TimeLimit;
                break;
            }
        }
        let solve_seconds = start.elapsed().as_secs_f64();
        Ok(QpSolution { x, y, status, iterations, setup_seconds: 0.0, solve_seconds })
    }
}

impl MethodOfMultipliers {
    /// Minimises the augmented Lagrangian of `y` over `x`; returns the new multipliers `(y + rho (b - A x))^+`.
    fn minimise(&self, qp: &QpProblem, x: &mut [f64], y: &[f64], tolerance: f64) -> Vec<f64> {
        let shifted = |x: &[f64]| -> Vec<f64> {
            let ax = qp.a_times(x);
            (0..y.len()).map(|k| (y[k] + self.penalty * (qp.b()[k] - ax[k])).max(0.0)).collect()
        };
        let mut multipliers = shifted(x);
        for _ in 0..MAX_NEWTON_STEPS {
            let (px, aty) = (qp.p_times(x), qp.a_transposed_times(&multipliers));
            let downhill: Vec<f64> = (0..x.len()).map(|i| aty[i] - px[i] - qp.q()[i]).collect();
            if downhill.iter().fold(0.0, |m: f64, r| m.max(r.abs())) <= tolerance {
                break;
            }
            // (P + rho A_S' A_S) step = downhill, where S are the rows with a positive multiplier
            let active: Vec<f64> = multipliers.iter().map(|&y| f64::from(y > 0.0)).collect();
            let hessian = |v: &[f64]| -> Vec<f64> {
                let rows: Vec<f64> =
                    qp.a_times(v).iter().zip(&active).map(|(av, s)| self.penalty * s * av).collect();
                qp.p_times(v).iter().zip(qp.a_transposed_times(&rows)).map(|(pv, ar)| pv + ar).collect()
            };
            let step = conjugate_gradients(hessian, &downhill, 0.1 * tolerance);
            x.iter_mut().zip(step).for_each(|(x, step)| *x += step);
            multipliers = shifted(x);
        }
        multipliers
    }
}

/// Solves `apply(x) = b` for a symmetric positive definite map.
fn conjugate_gradients(apply: impl Fn(&[f64]) -> Vec<f64>, b: &[f64], tolerance: f64) -> Vec<f64> {
    let dot = |u: &[f64], v: &[f64]| u.iter().zip(v).map(|(u, v)| u * v).sum::<f64>();
    let mut x = vec![0.0; b.len()];
    let (mut residual, mut direction) = (b.to_vec(), b.to_vec());
    let mut norm_sq = dot(&residual, &residual);
    for _ in 0..10 * b.len() {
        if norm_sq.sqrt() <= tolerance {
            break;
        }
        let image = apply(&direction);
        let length = norm_sq / dot(&direction, &image);
        for i in 0..x.len() {
            x[i] += length * direction[i];
            residual[i] -= length * image[i];
        }
        let next = dot(&residual, &residual);
        for i in 0..x.len() {
            direction[i] = residual[i] + next / norm_sq * direction[i];
        }
        norm_sq = next;
    }
    x
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let load = Expression::parse("10*sin(pi*x)")?;
    let problem = ContactProblem::builder().tension(1.0, 3.0).load(-15.0, load).height(0.1).build()?;
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [32, 32], Pattern::Right)?;
    let d = PairDiscretization::new(&problem, mesh)?;
    let options = SolverOptions { polish: false, ..SolverOptions::default() };

    let candidate = QpSolver::new(MethodOfMultipliers { penalty: 100.0 }).solve_pair(&d, &options)?;
    let solution = certify_pair(&d, candidate, options.tolerance)?;
    println!(
        "{}: {} outer iterations, energy {:.9}, contact area {:.4}",
        solution.statistics().solver,
        solution.statistics().iterations,
        solution.energy(),
        solution.contact_area()
    );
    Ok(())
}
