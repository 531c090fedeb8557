//! The certificate of a stack, and its certified solution.

mod forces;
mod lines;
mod projection;
mod residuals;
mod solution;

pub use solution::{GapSolution, StackSolution};

use super::certificate::{Reason, Rejected};
use crate::discretization::StackDiscretization;
use crate::solver::Candidate;
use projection::Projection;

/// Checks a candidate against `K_i`, `F_i`, heights and obstacles and hands it out as a solution when every residual, beyond
/// what rounding of the terms explains, is at most `tolerance`; see [`certify_pair`](super::certify_pair).
///
/// What is handed out is in its cones and complementary to the last bit: in each gap, at each vertex, the layers are apart and
/// without action, or they touch. In place of Proposition 12, the independent check is the *block balance*: at every vertex, the
/// forces on membranes that touch each other, but nothing that holds them, add up to zero.
///
/// # Errors
/// As [`certify_pair`](super::certify_pair).
pub fn certify_stack(
    d: &StackDiscretization,
    candidate: Candidate,
    tolerance: f64,
) -> Result<StackSolution, Box<Rejected>> {
    let Candidate { displacement, multiplier, statistics } = candidate;
    let lengths_fit = displacement.len() == d.membranes()
        && displacement.iter().all(|u| u.len() == d.mesh().points().len())
        && multiplier.len() == d.rows().len();
    if !lengths_fit {
        return Err(Box::new(Rejected { reason: Reason::Lengths, residuals: None, statistics }));
    }
    let residuals = residuals::residuals(d, &displacement, &multiplier);
    if let Some(reason) = Reason::of(&residuals, tolerance) {
        return Err(Box::new(Rejected { reason, residuals: Some(residuals), statistics }));
    }
    let projection = Projection::new(d, displacement, &multiplier);
    Ok(StackSolution::new(d, projection, residuals, statistics))
}
