//! The operator-splitting solver OSQP (Stellato et al., Math. Prog. Comp. 12 (2020) 637).

use osqp::{CscMatrix, Problem, Settings, Solution, Status as OsqpStatus};
use sprs::CsMat;
use web_time::Instant;

use super::{BackendError, QpBackend, QpOptions, QpProblem, QpSolution, Status, TimeLimit};

/// OSQP: `minimise 1/2 x'P x + q'x subject to l <= A x <= u`, dual `<= 0` at an active lower bound: `y` is its negative.
///
/// It takes a warm start, and polishes its answer by its own means when it can. It does not hear an
/// [`Interrupt`](super::Interrupt): its binding has no way in between two iterations.
#[derive(Debug, Clone, Copy, Default)]
pub struct Osqp;

/// The limit of iterations when none is given. It needs hundreds on coarse meshes and thousands on fine ones.
const MAX_ITERATIONS: usize = 100_000;

/// Iterations between adaptations of the step size. OSQP's default depends on the clock, and so would its iterates.
const ADAPT_EVERY: u32 = 50;

/// No upper bound, in OSQP's own number: an infinity makes its duality gap NaN.
const NO_BOUND: f64 = 1e30;

impl QpBackend for Osqp {
    fn name(&self) -> &str {
        "osqp"
    }

    fn solve(&mut self, qp: &QpProblem, options: &QpOptions) -> Result<QpSolution, BackendError> {
        let start = Instant::now();
        let (p, a) = (csc(qp.p_upper()), csc(qp.a()));
        let upper = vec![NO_BOUND; qp.b().len()];
        let mut problem = Problem::new(p, qp.q(), a, qp.b(), &upper, &settings(options))
            .map_err(|error| BackendError { backend: self.name().into(), reason: error.to_string() })?;
        if let Some((x, y)) = &options.warm_start {
            problem.warm_start(x, &y.iter().map(|y| -y).collect::<Vec<_>>());
        }
        let setup_seconds = start.elapsed().as_secs_f64();
        let result = problem.solve();
        let (status, solution) = split(&result);
        // Without an iterate (it believes the problem infeasible), zeros stand for it: the residuals will tell.
        let (x, y) = solution.map_or_else(
            || (vec![0.0; qp.q().len()], vec![0.0; qp.b().len()]),
            |solution| (solution.x().to_vec(), solution.y().iter().map(|y| -y).collect()),
        );
        Ok(QpSolution {
            x,
            y,
            status,
            iterations: result.iter() as usize,
            setup_seconds,
            solve_seconds: start.elapsed().as_secs_f64() - setup_seconds,
        })
    }
}

fn settings(options: &QpOptions) -> Settings {
    let limit = options.max_iterations.unwrap_or(MAX_ITERATIONS).min(i32::MAX as usize);
    Settings::default()
        .verbose(false)
        .eps_abs(options.tolerance)
        .eps_rel(options.tolerance)
        .max_iter(limit as u32)
        .adaptive_rho_interval(Some(ADAPT_EVERY))
        .polish(true)
        .time_limit(options.time_limit.map(TimeLimit::duration))
}

fn csc(matrix: &CsMat<f64>) -> CscMatrix<'_> {
    let (nrows, ncols) = matrix.shape();
    CscMatrix {
        nrows,
        ncols,
        indptr: matrix.indptr().into_raw_storage().to_vec().into(),
        indices: matrix.indices().into(),
        data: matrix.data().into(),
    }
}

fn split<'a>(result: &OsqpStatus<'a>) -> (Status, Option<Solution<'a>>) {
    match result {
        OsqpStatus::Solved(solution) => (Status::Solved, Some(solution.clone())),
        OsqpStatus::SolvedInaccurate(solution) => (Status::Inaccurate, Some(solution.clone())),
        OsqpStatus::MaxIterationsReached(solution) => (Status::IterationLimit, Some(solution.clone())),
        OsqpStatus::TimeLimitReached(solution) => (Status::TimeLimit, Some(solution.clone())),
        OsqpStatus::PrimalInfeasible(_) | OsqpStatus::PrimalInfeasibleInaccurate(_) => {
            (Status::Infeasible, None)
        }
        OsqpStatus::DualInfeasible(_) | OsqpStatus::DualInfeasibleInaccurate(_) => (Status::Unbounded, None),
        _ => (Status::NumericalError, None),
    }
}
