//! The interior-point solver Clarabel (Goulart, Chen, arXiv 2405.12762).

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use sprs::CsMat;
use web_time::Instant;

use super::{BackendError, QpBackend, QpOptions, QpProblem, QpSolution, Status, TimeLimit};

/// Clarabel: `minimise 1/2 x'P x + q'x subject to A x + s = b, s in a cone`, dual `z`. Our `A x >= b` is its
/// `-A x + s = -b, s >= 0`, with `z = y`.
///
/// It cannot use a warm start.
#[derive(Debug, Clone, Copy, Default)]
pub struct Clarabel;

/// The largest product of slack and multiplier is up to fifty times their mean: the mean is asked to be this fraction of
/// the tolerance.
const MEAN_PRODUCT: f64 = 0.01;

/// The limit of iterations when none is given. It needs 10 to 30; more than this means that it does not converge.
const MAX_ITERATIONS: u32 = 200;

impl QpBackend for Clarabel {
    fn name(&self) -> &str {
        "clarabel"
    }

    fn solve(&mut self, qp: &QpProblem, options: &QpOptions) -> Result<QpSolution, BackendError> {
        let start = Instant::now();
        let p = csc(qp.p_upper(), 1.0);
        let a = csc(qp.a(), -1.0);
        let b: Vec<f64> = qp.b().iter().map(|b| -b).collect();
        let cone = [SupportedConeT::NonnegativeConeT(b.len())];
        let mut solver = DefaultSolver::new(&p, qp.q(), &a, &b, &cone, settings(options, b.len()))
            .map_err(|error| BackendError { backend: self.name().into(), reason: error.to_string() })?;
        if let Some(interrupt) = options.interrupt.clone() {
            solver.set_termination_callback(move |_: &_| interrupt.is_wanted());
        }
        let setup_seconds = start.elapsed().as_secs_f64();
        solver.solve();
        let solution = solver.solution;
        Ok(QpSolution {
            x: solution.x,
            y: solution.z,
            status: status(solution.status),
            iterations: solution.iterations as usize,
            setup_seconds,
            solve_seconds: start.elapsed().as_secs_f64() - setup_seconds,
        })
    }
}

/// The duality gap is the sum of the products of slacks and multipliers; a bound of it relative to the objective, as is
/// the default, would grow with the number of unknowns in that sum and bound no single product.
fn settings(options: &QpOptions, constraints: usize) -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        max_iter: options.max_iterations.map_or(MAX_ITERATIONS, |limit| limit.try_into().unwrap_or(u32::MAX)),
        time_limit: options.time_limit.map_or(f64::INFINITY, TimeLimit::seconds),
        tol_gap_abs: options.tolerance * (MEAN_PRODUCT * constraints as f64).max(1.0),
        tol_gap_rel: 0.0,
        tol_feas: options.tolerance,
        ..DefaultSettings::default()
    }
}

fn csc(matrix: &CsMat<f64>, sign: f64) -> CscMatrix<f64> {
    let (rows, columns) = matrix.shape();
    let values = matrix.data().iter().map(|value| sign * value).collect();
    CscMatrix::new(
        rows,
        columns,
        matrix.indptr().into_raw_storage().to_vec(),
        matrix.indices().to_vec(),
        values,
    )
}

fn status(status: SolverStatus) -> Status {
    match status {
        SolverStatus::Solved => Status::Solved,
        SolverStatus::AlmostSolved => Status::Inaccurate,
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => Status::Infeasible,
        SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => Status::Unbounded,
        SolverStatus::MaxIterations => Status::IterationLimit,
        SolverStatus::MaxTime => Status::TimeLimit,
        SolverStatus::CallbackTerminated => Status::Interrupted,
        SolverStatus::InsufficientProgress => Status::Stalled,
        SolverStatus::NumericalError | SolverStatus::Unsolved => Status::NumericalError,
    }
}
