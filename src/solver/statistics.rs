//! How a candidate was found.

use crate::qp::Status;

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
    /// What was tried before and stalled, in this order, also when an earlier solve of the same prepared solver has tried it. Its
    /// seconds are among those below if they were spent in this solve.
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
    /// Of a solver that has stopped for this reason, before anything else is known of it.
    pub(crate) fn of(solver: &str, status: Status) -> Self {
        Self {
            solver: solver.into(),
            status,
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
    pub(super) fn after(self, method: String, stalled: Self) -> Self {
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

/// What the polish did.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct PolishReport {
    /// Whether the polished result replaced the solver's.
    pub kept: bool,
    /// How often the contact set was repaired.
    pub repairs: usize,
    /// Whether the last contact set needed no repair.
    pub settled: bool,
    /// The largest relative KKT residual of the solver's answer.
    pub residual_before: f64,
    /// The largest relative KKT residual of the polished one.
    pub residual_after: f64,
}

impl PolishReport {
    /// Of a polish that ended in this way; it is kept where the residual, before and after, has become smaller.
    pub(super) fn new(repairs: usize, status: Status, [residual_before, residual_after]: [f64; 2]) -> Self {
        Self {
            kept: residual_after < residual_before,
            repairs,
            settled: status == Status::Solved,
            residual_before,
            residual_after,
        }
    }
}
