//! How a run fails.

use thiserror::Error;

/// Why a command did not succeed: one line, and an exit code.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Failure {
    /// Bad input or usage, or results that cannot be written.
    #[error("{0}")]
    Input(String),
    /// It ran, but the result is not certified.
    #[error("{0}")]
    NotCertified(String),
    /// Somebody has ended it.
    #[error("{0}")]
    Interrupted(String),
    /// An internal error.
    #[error("internal error: {0}; please report it, together with the case file")]
    Internal(String),
}

impl Failure {
    pub(super) fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::NotCertified(_) => 1,
            // As shells have it: 128 and the number of the signal.
            Self::Interrupted(_) => 130,
            // As that of a panic.
            Self::Internal(_) => 101,
        }
    }
}
