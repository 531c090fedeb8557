//! Solvers of the reduced discrete problem (3.4).

mod active_set;
mod auto;
mod decoupled;
mod multigrid;
mod polish;
mod qp_solver;

pub use active_set::ActiveSet;
pub use auto::Auto;
pub use multigrid::Multigrid;
pub use polish::PolishReport;
pub use qp_solver::QpSolver;

use std::time::Instant;

use thiserror::Error;

use crate::discretization::Discretization;
use crate::multigrid::cholesky::NotFactored;
use crate::qp::{Answer, BackendError, Status, TimeLimit};
use crate::text::Number;

/// Anything that solves (3.4): a [`QpBackend`](crate::qp::QpBackend) by way of [`QpSolver`], or a method of its own.
pub trait ContactSolver: Send {
    /// The name in summaries and messages.
    fn name(&self) -> &str;

    /// Solves the problem, or stops early and says so in the statistics.
    ///
    /// # Errors
    /// [`SolverError`] when it cannot run at all.
    fn solve(&mut self, d: &Discretization, options: &SolverOptions) -> Result<Candidate, SolverError>;

    /// The solver for one discretization, to be solved more than once: what can be used again is made once. As it is, nothing
    /// is kept.
    fn prepare<'s>(&'s mut self, d: &'s Discretization) -> Box<dyn PreparedSolver + 's> {
        Box::new(Unprepared { solver: self, d })
    }
}

/// A solver together with the one discretization that it solves.
pub trait PreparedSolver {
    /// Solves the problem, likewise.
    ///
    /// # Errors
    /// [`SolverError`] when it cannot run at all.
    fn solve(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError>;
}

/// A solver that keeps nothing.
struct Unprepared<'s, S: ?Sized> {
    solver: &'s mut S,
    d: &'s Discretization,
}

impl<S: ContactSolver + ?Sized> PreparedSolver for Unprepared<'_, S> {
    fn solve(&mut self, options: &SolverOptions) -> Result<Candidate, SolverError> {
        self.solver.solve(self.d, options)
    }
}

/// What is asked of a solver.
#[derive(Debug, Clone)]
pub struct SolverOptions {
    /// Largest residual of the optimality conditions, relative to the data ([`Scales`](crate::discretization::Scales)).
    pub tolerance: f64,
    /// Where to stop at the latest; `None`: the solver's own limit.
    pub max_iterations: Option<usize>,
    /// When to stop at the latest; `None`: no limit. Solvers look at the clock between their steps, of which a factorisation or
    /// the set-up of all levels is one.
    pub time_limit: Option<TimeLimit>,
    /// Whether to make the result exact by solving for its contact set.
    pub polish: bool,
    /// A guess on this mesh to start from, for solvers that can.
    pub warm_start: Option<StartingPoint>,
}

impl Default for SolverOptions {
    fn default() -> Self {
        Self { tolerance: 1e-8, max_iterations: None, time_limit: None, polish: true, warm_start: None }
    }
}

impl SolverOptions {
    /// When to stop a solve that has begun at `start`.
    pub(crate) fn deadline(&self, start: Instant) -> Option<Instant> {
        self.time_limit.and_then(|limit| limit.deadline(start))
    }

    pub(crate) fn check(&self) -> Result<(), SolverError> {
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err(SolverError::Tolerance(self.tolerance));
        }
        Ok(())
    }
}

/// What a solver returns: displacements and multipliers that nobody has checked yet.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// `[u1, u2]` over vertices, boundary values included.
    pub displacement: [Vec<f64>; 2],
    /// `y_a = lambda_a |D_a|` over unknowns. Unit: force.
    pub multiplier: Vec<f64>,
    /// How it was found.
    pub statistics: Statistics,
}

impl Candidate {
    /// The candidate that an answer to [`contact_qp`](crate::qp::contact_qp) stands for: the displacements at the
    /// unknowns get their boundary values, `g_h` and zero.
    ///
    /// # Panics
    /// When `x` has not two entries for each unknown.
    pub fn from_answer(d: &Discretization, Answer { x, y }: Answer, statistics: Statistics) -> Self {
        assert_eq!(x.len(), 2 * d.interior().len(), "an answer has two displacements for each unknown");
        let (x1, x2) = x.split_at(d.interior().len());
        let displacement = [d.extend(x1, |a| d.height()[a]), d.extend(x2, |_| 0.0)];
        Self { displacement, multiplier: y, statistics }
    }
}

/// A guess of displacements and multipliers: of a nearby problem, or of a coarser mesh, prolonged.
#[derive(Debug, Clone)]
pub struct StartingPoint {
    /// `[u1, u2]` over vertices.
    pub displacement: [Vec<f64>; 2],
    /// `y_a = lambda_a |D_a|` over unknowns.
    pub multiplier: Vec<f64>,
}

impl From<Candidate> for StartingPoint {
    fn from(candidate: Candidate) -> Self {
        Self { displacement: candidate.displacement, multiplier: candidate.multiplier }
    }
}

impl StartingPoint {
    /// Whether it has the lengths of this discretization.
    pub(crate) fn fits(&self, d: &Discretization) -> bool {
        self.displacement.iter().all(|u| u.len() == d.mesh().points().len())
            && self.multiplier.len() == d.interior().len()
    }
}

/// How a candidate was found.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct Statistics {
    /// The solver's name.
    pub solver: String,
    /// Why it stopped, in its own view.
    pub status: Status,
    /// Iterations made: on the finest level, where there are several.
    pub iterations: usize,
    /// Iterations on each level, from the coarsest to the finest; empty for a solver that knows no levels.
    pub level_iterations: Vec<usize>,
    /// The energies `1/2 w'K w - b'w` of the gap after each iteration on the finest level, for the method that lowers them in
    /// every one; empty for others.
    pub energies: Vec<f64>,
    /// Which solver was chosen and why, when that was left open.
    pub choice: Option<String>,
    /// What was tried before and stalled, in this order. Its seconds are among those below.
    #[cfg_attr(feature = "files", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub stalled: Vec<Stalled>,
    /// Seconds spent before the first iteration. Not kept with the rest: they are another number in each run.
    #[cfg_attr(feature = "files", serde(skip))]
    pub setup_seconds: f64,
    /// Seconds spent iterating, the polish included. Likewise.
    #[cfg_attr(feature = "files", serde(skip))]
    pub solve_seconds: f64,
    /// What the polish did; `None` when it was not asked for or has nothing to do.
    pub polish: Option<PolishReport>,
}

impl Statistics {
    /// Of a solver that has not done anything yet.
    pub(crate) fn of(solver: &str) -> Self {
        Self {
            solver: solver.into(),
            status: Status::Solved,
            iterations: 0,
            level_iterations: Vec::new(),
            energies: Vec::new(),
            choice: None,
            stalled: Vec::new(),
            setup_seconds: 0.0,
            solve_seconds: 0.0,
            polish: None,
        }
    }

    /// When this is what was found after another method had stalled: its seconds count as well.
    fn after(self, method: String, stalled: Self) -> Self {
        let mut all = stalled.stalled;
        all.push(Stalled { method, iterations: stalled.iterations });
        all.extend(self.stalled);
        Self {
            stalled: all,
            setup_seconds: stalled.setup_seconds + self.setup_seconds,
            solve_seconds: stalled.solve_seconds + self.solve_seconds,
            ..self
        }
    }
}

/// A method that has made no more progress.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct Stalled {
    /// The method, and the levels on which it ran.
    pub method: String,
    /// Iterations made, on the finest level where there are several.
    pub iterations: usize,
}

impl From<NotFactored> for SolverError {
    fn from(_: NotFactored) -> Self {
        Self::NotFactored
    }
}

/// A solver cannot run.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SolverError {
    /// The quadratic programming backend cannot.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// A linear system cannot be factored.
    #[error(
        "the stiffness matrix cannot be factored: memory is short, or the mesh has triangles that are too thin"
    )]
    NotFactored,
    /// The tolerance is out of range.
    #[error("the tolerance is {}: give a number between 0 and 1", Number(*_0))]
    Tolerance(f64),
}
