//! Why a solver stopped.

/// Why a solver stopped, in its own view. Whether the result is accepted is decided by residuals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Status {
    /// It reached the tolerance.
    Solved,
    /// It reached a looser tolerance.
    Inaccurate,
    /// It reached the limit of iterations.
    IterationLimit,
    /// It reached the limit of time.
    TimeLimit,
    /// It was asked to stop.
    Interrupted,
    /// It made no more progress.
    Stalled,
    /// It holds that no point satisfies the constraints.
    Infeasible,
    /// It holds that the objective has no lower bound.
    Unbounded,
    /// Its arithmetic broke down.
    NumericalError,
    /// It came from elsewhere and has not said.
    Unknown,
}

impl Status {
    /// The name in `summary.json`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Solved => "solved",
            Self::Inaccurate => "inaccurate",
            Self::IterationLimit => "iteration_limit",
            Self::TimeLimit => "time_limit",
            Self::Interrupted => "interrupted",
            Self::Stalled => "stalled",
            Self::Infeasible => "infeasible",
            Self::Unbounded => "unbounded",
            Self::NumericalError => "numerical_error",
            Self::Unknown => "unknown",
        }
    }
}
