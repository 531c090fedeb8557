//! Why the data do not make a problem.

use thiserror::Error;

use crate::text::Number;

/// Why the data do not make a problem.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// A tension out of range.
    #[error("tension mu{membrane} is {}: give a positive, finite number", Number(*value))]
    Tension {
        /// Which, counted from 1 at the top.
        membrane: usize,
        /// The value given.
        value: f64,
    },
    /// A constant load out of range.
    #[error("load f{membrane} is {}: give a finite number", Number(*value))]
    Load {
        /// Which, counted from 1 at the top.
        membrane: usize,
        /// The value given.
        value: f64,
    },
    /// A constant height out of range.
    #[error(
        "height g is {}: give a number >= 0, so that membrane 1 is fixed above membrane 2 (or exchange the membranes)",
        Number(*value)
    )]
    Height {
        /// The value given.
        value: f64,
    },
    /// A foundation out of range.
    #[error("foundation c{membrane} is {}: give a finite number >= 0", Number(*value))]
    Foundation {
        /// Which, counted from 1 at the top.
        membrane: usize,
        /// The value given.
        value: f64,
    },
    /// A height, a line load or an obstacle that is no finite number.
    #[error("{datum} is {}: give a finite number", Number(*value))]
    NotFinite {
        /// Of which membrane, counted from 1 at the top; `None` for an obstacle.
        membrane: Option<usize>,
        /// Which datum.
        datum: String,
        /// The value given.
        value: f64,
    },
    /// No membrane.
    #[error("there is no membrane: add at least one")]
    NoMembrane,
}
