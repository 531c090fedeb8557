//! A certified solution together with the bound of its error.

use thiserror::Error;
use web_time::Instant;

use super::prolongation::Fields;
use crate::action::{ContactSolution, Rejected, certify};
use crate::discretization::Discretization;
use crate::estimate::{ContactBounds, ErrorBound, MeasureError, NoBound};
use crate::problem::{ContactProblem, Domain};
use crate::solver::{Candidate, ContactSolver, SolverError, SolverOptions};

/// Where the tolerance that follows the discretisation starts.
const LOOSEST: f64 = 1e-3;

/// And where it ends: below, residuals are rounding.
const TIGHTEST: f64 = 1e-12;

/// What the solver leaves may be this fraction of the discretisation error.
const FRACTION: f64 = 0.02;

/// How accurately to solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// To this largest relative residual.
    Fixed(f64),
    /// Until what the solver leaves of the error bound is a small fraction of what the mesh leaves.
    Auto,
}

impl Tolerance {
    /// The number, where there must be one: for [`Tolerance::Auto`] that of [`SolverOptions::default`].
    pub fn or_default(self) -> f64 {
        match self {
            Self::Fixed(tolerance) => tolerance,
            Self::Auto => SolverOptions::default().tolerance,
        }
    }

    /// The largest residual that it accepts.
    pub(super) fn loosest(self) -> f64 {
        match self {
            Self::Fixed(tolerance) => tolerance,
            Self::Auto => LOOSEST,
        }
    }
}

/// A certified solution and how far it is from the exact one.
#[derive(Debug, Clone)]
pub struct Bounded {
    /// The solution.
    pub solution: ContactSolution,
    /// The bound of its energy error, or why there is none.
    pub bound: Result<ErrorBound, NoBound>,
    /// The tolerance within which it is certified.
    pub tolerance: f64,
    /// Seconds that the bound took.
    pub bound_seconds: f64,
}

/// There is no certified solution with a bound.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AccuracyError {
    /// The solver cannot run.
    #[error(transparent)]
    Solver(#[from] SolverError),
    /// Its result is not certified.
    #[error("{0}")]
    Rejected(Box<Rejected>, f64),
    /// The error cannot be bounded.
    #[error(transparent)]
    Measure(#[from] MeasureError),
}

/// Solves `d`, the discretization of `problem`, certifies the result and bounds its error. `options.tolerance` is not used, and
/// the time limit is that of all solves together.
///
/// # Errors
/// [`AccuracyError`]; a rejected result comes with the tolerance that it misses.
pub fn solve_bounded(
    problem: &ContactProblem,
    domain: Option<&Domain>,
    d: &Discretization,
    solver: &mut dyn ContactSolver,
    options: &SolverOptions,
    tolerance: Tolerance,
) -> Result<Bounded, AccuracyError> {
    let bounds = ContactBounds::new(problem, domain, d);
    let bounded = |candidate: Candidate, tolerance: f64| {
        let solution = certify(d, candidate, tolerance)
            .map_err(|rejected| AccuracyError::Rejected(rejected, tolerance))?;
        Ok(Bounded::new(&bounds, solution, tolerance)?)
    };
    if let Tolerance::Fixed(tolerance) = tolerance {
        // Not prepared: what the solver has made for itself is gone before the bound needs memory.
        let candidate = solver.solve(d, &SolverOptions { tolerance, ..options.clone() })?;
        return bounded(candidate, tolerance);
    }
    let start = Instant::now();
    let mut solver = solver.prepare(d);
    let mut at = |tolerance: f64, options: &SolverOptions| {
        bounded(solver.solve(&SolverOptions { tolerance, ..options.clone() })?, tolerance)
    };
    let mut best = at(LOOSEST, options)?;
    // What cannot be had more accurately, or not in time, is certified as it is.
    while let Some(tighter) = best.tighter() {
        let time_limit = options.time_limit.map(|limit| limit.left_since(start));
        if time_limit == Some(None) {
            break;
        }
        let time_limit = time_limit.flatten();
        let warm_start = Some(Fields::from(&best.solution).into_start(d));
        match at(tighter, &SolverOptions { warm_start, time_limit, ..options.clone() }) {
            Ok(better) => best = better,
            Err(AccuracyError::Rejected(..)) => break,
            Err(error) => return Err(error),
        }
    }
    Ok(best)
}

impl Bounded {
    /// Bounds the error of a solution that is certified within `tolerance`.
    pub(super) fn new(
        bounds: &ContactBounds,
        solution: ContactSolution,
        tolerance: f64,
    ) -> Result<Self, MeasureError> {
        let start = Instant::now();
        let bound = bounds.of_solution(&solution)?;
        Ok(Self { solution, bound, tolerance, bound_seconds: start.elapsed().as_secs_f64() })
    }

    /// The tolerance with which the solver would leave a small fraction; `None` when it leaves no more already. Without a bound,
    /// nobody knows what it leaves: then it is the default one.
    fn tighter(&self) -> Option<f64> {
        let Ok(ErrorBound { parts, .. }) = &self.bound else {
            let default = SolverOptions::default().tolerance;
            return (self.tolerance > default).then_some(default);
        };
        let allowed = FRACTION * parts.discretization();
        if parts.algebraic <= allowed || self.tolerance <= TIGHTEST {
            return None;
        }
        // What the solver leaves is about proportional to the tolerance.
        let proportional = 0.5 * self.tolerance * allowed / parts.algebraic;
        Some(proportional.clamp(TIGHTEST, 0.1 * self.tolerance))
    }
}

#[cfg(all(test, feature = "clarabel"))]
mod tests {
    use super::*;
    use crate::mesh::{Pattern, rectangle};
    use crate::qp::Clarabel;
    use crate::solver::{Multigrid, QpSolver};

    fn solve(solver: &mut dyn ContactSolver, tolerance: Tolerance) -> Bounded {
        let problem =
            ContactProblem::builder().tension(1.0, 3.0).load(-15.0, 10.0).height(0.1).build().unwrap();
        let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [64, 64], Pattern::Right).unwrap();
        let d = Discretization::new(&problem, mesh.clone()).unwrap();
        let options = SolverOptions { polish: false, ..SolverOptions::default() };
        solve_bounded(&problem, None, &d, solver, &options, tolerance).unwrap()
    }

    #[test]
    fn the_solver_stops_where_its_error_is_a_small_fraction() {
        let solvers: [Box<dyn ContactSolver>; 2] = [Box::new(Multigrid), Box::new(QpSolver::new(Clarabel))];
        for mut solver in solvers {
            let auto = solve(&mut *solver, Tolerance::Auto);
            let bound = auto.bound.as_ref().unwrap();
            let fraction = bound.parts.algebraic / bound.parts.discretization();
            assert!(fraction <= FRACTION, "{}: {fraction}", solver.name());
            assert!(
                auto.tolerance > 1e-8,
                "{}: no more accurate than needed: {:e}",
                solver.name(),
                auto.tolerance
            );
            let tight = solve(&mut *solver, Tolerance::Fixed(1e-10));
            assert!(
                (bound.total / tight.bound.unwrap().total - 1.0).abs() < 2.0 * FRACTION,
                "the same bound"
            );
        }
        // The negative test: as loose as it starts, the solver leaves more than that.
        let loose = solve(&mut QpSolver::new(Clarabel), Tolerance::Fixed(LOOSEST));
        assert!(loose.tighter().is_some_and(|tolerance| tolerance < LOOSEST));
    }
}
