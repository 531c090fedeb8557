//! Any QP backend as a solver of the contact problem.

mod polish;

use polish::polish;
use web_time::Instant;

use super::repair::Settled;
use super::{Candidate, ContactSolver, SolverError, SolverOptions, Statistics, pair, stack};
use crate::discretization::{PairDiscretization, StackDiscretization};
use crate::multigrid::cholesky::NotFactored;
use crate::qp::{
    Answer, BackendError, Limits, QpBackend, QpOptions, QpProblem, QpSolution, Status, TimeLimit, contact_qp,
    stack_qp,
};

/// Poses (3.4) as a [`QpProblem`], has it solved by a backend, and polishes the answer.
pub struct QpSolver {
    backend: Box<dyn QpBackend>,
}

impl QpSolver {
    /// Wraps a backend.
    pub fn new(backend: impl QpBackend + 'static) -> Self {
        Self { backend: Box::new(backend) }
    }

    /// The backend's answer, in the time that is left since `begin`; what came before it is set-up.
    fn answer(
        &mut self,
        qp: &QpProblem,
        options: &SolverOptions,
        warm_start: Option<(Vec<f64>, Vec<f64>)>,
        begin: Instant,
    ) -> Result<(Answer, Statistics), SolverError> {
        let posing = begin.elapsed().as_secs_f64();
        let options = QpOptions {
            tolerance: options.tolerance,
            max_iterations: options.max_iterations,
            time_limit: options
                .time_limit
                .map(|limit| limit.left_since(begin).unwrap_or(TimeLimit::SHORTEST)),
            interrupt: options.interrupt.clone(),
            warm_start,
        };
        let solution = solve_nondimensional(self.backend.as_mut(), qp, &options)?;
        let statistics = Statistics {
            iterations: solution.iterations,
            setup_seconds: posing + solution.setup_seconds,
            ..Statistics::of(self.backend.name(), solution.status)
        };
        Ok((Answer { x: solution.x, y: solution.y }, statistics))
    }
}

impl ContactSolver for QpSolver {
    fn name(&self) -> &str {
        self.backend.name()
    }

    fn solve_pair(
        &mut self,
        d: &PairDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError> {
        options.check()?;
        let start = Instant::now();
        let qp = contact_qp(d);
        let guess = options.warm_start.as_ref().filter(|guess| guess.fits_pair(d));
        let warm_start =
            guess.map(|guess| (pair::unknowns(d, &guess.displacement), guess.multiplier.clone()));
        let (answer, statistics) = self.answer(&qp, options, warm_start, start)?;
        let candidate = Candidate::from_pair_answer(d, answer, statistics);
        let unknowns = |u: &[Vec<f64>]| pair::unknowns(d, u);
        Ok(polished(&qp, candidate, (options, start), unknowns, |candidate, limits| {
            let touching = pair::active_set::guess(d, &candidate.displacement, &candidate.multiplier);
            pair::active_set::settle(d, touching, limits)
        }))
    }

    fn solve_stack(
        &mut self,
        d: &StackDiscretization,
        options: &SolverOptions,
    ) -> Result<Candidate, SolverError> {
        options.check()?;
        let start = Instant::now();
        let qp = stack_qp(d);
        let guess = options.warm_start.as_ref().filter(|guess| guess.fits_stack(d));
        let warm_start = guess.map(|guess| (d.restrict(&guess.displacement), guess.multiplier.clone()));
        let (answer, statistics) = self.answer(&qp, options, warm_start, start)?;
        let candidate = Candidate::from_stack_answer(d, answer, statistics);
        Ok(polished(
            &qp,
            candidate,
            (options, start),
            |u| d.restrict(u),
            |candidate, limits| {
                let touching = stack::active_set::guess(d, &candidate.displacement, &candidate.multiplier);
                stack::active_set::settle(d, touching, limits)
            },
        ))
    }
}

/// The candidate after a polish, if that is asked for and there is time, and the seconds of the solve. The active set method settles
/// the contact set that the candidate has, within limits.
fn polished(
    qp: &QpProblem,
    mut candidate: Candidate,
    (options, start): (&SolverOptions, Instant),
    unknowns: impl Fn(&[Vec<f64>]) -> Vec<f64>,
    settle: impl FnOnce(&Candidate, &Limits) -> Result<Settled, NotFactored>,
) -> Candidate {
    if let Some(limits) = options.limits_of_polish(start).filter(|_| options.polish) {
        let settled = settle(&candidate, &limits);
        candidate.statistics.polish = polish(qp, &mut candidate, unknowns, settled);
    }
    candidate.statistics.solve_seconds = start.elapsed().as_secs_f64() - candidate.statistics.setup_seconds;
    candidate
}

/// Has the problem solved in units of size 1, so that one tolerance fits every mesh (`q ~ h^2`) and all data.
fn solve_nondimensional(
    backend: &mut dyn QpBackend,
    qp: &QpProblem,
    options: &QpOptions,
) -> Result<QpSolution, BackendError> {
    if qp.q().is_empty() {
        return Ok(without_unknowns());
    }
    let scaled = |values: &[f64], scale: f64| values.iter().map(|value| value * scale).collect::<Vec<_>>();
    let (primal, dual) = (qp.primal_scale(), qp.dual_scale());
    let start = options.warm_start.as_ref();
    let warm_start = start.map(|(x, y)| (scaled(x, primal.recip()), scaled(y, dual.recip())));
    let solution = backend.solve(&qp.nondimensional(), &QpOptions { warm_start, ..options.clone() })?;
    if solution.x.len() != qp.q().len() || solution.y.len() != qp.b().len() {
        let reason = "it returned vectors of the wrong length".into();
        return Err(BackendError { backend: backend.name().into(), reason });
    }
    Ok(QpSolution { x: scaled(&solution.x, primal), y: scaled(&solution.y, dual), ..solution })
}

/// A mesh without interior vertices leaves nothing to solve, which some backends do not understand.
fn without_unknowns() -> QpSolution {
    QpSolution {
        x: vec![],
        y: vec![],
        status: Status::Solved,
        iterations: 0,
        setup_seconds: 0.0,
        solve_seconds: 0.0,
    }
}
