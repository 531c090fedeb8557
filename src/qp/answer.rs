//! An answer to the quadratic program, of whatever solver.

/// A point and its multipliers, from elsewhere: finite numbers in the right number, and no more is known of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The point. Shape: `variables`.
    pub x: Vec<f64>,
    /// The multipliers of `A x >= b`. Shape: `constraints`.
    pub y: Vec<f64>,
}
