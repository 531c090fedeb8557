//! Cycles until the answer is there, or no more is to be had: the same for a membrane and for stacks.

use super::cholesky::NotFactored;
use super::sweep::Found;
use crate::qp::{Limits, Status};

/// Cycles over which the pace is measured: one that would not reach the tolerance in as many cycles as there may be has arrived at
/// rounding, or at nothing.
const PATIENCE: usize = 3;

/// What makes an iterate better.
pub(super) trait Cycle {
    /// Makes the next iterate, from one of this energy.
    fn cycle(&mut self, energy: f64) -> Result<Found, NotFactored>;

    /// Whether the contact set has changed with the last iterate.
    fn has_changed(&self) -> bool;
}

/// Until the weighted residual is within the tolerance and the contact set stays. `most` is the number of cycles within which the
/// pace has to lead there. Returns what has been found after each cycle, and `first` before all.
pub(super) fn run(
    method: &mut impl Cycle,
    first: Found,
    tolerance: f64,
    most: usize,
    limits: &Limits,
) -> Result<(Status, Vec<Found>), NotFactored> {
    let mut history = vec![first];
    let status = loop {
        let cycles = history.len() - 1;
        let found = history[cycles];
        // Vertices at the rim that are undecided within rounding may change for ever: one more cycle is for them.
        let stays = cycles == 0 || !method.has_changed() || history[cycles - 1].violation <= tolerance;
        if found.violation <= tolerance && stays {
            break Status::Solved;
        }
        if let Some(limit) = limits.reached(cycles) {
            break limit;
        }
        if cycles >= PATIENCE
            && is_hopeless(history[cycles - PATIENCE].violation, found.violation, tolerance, most)
        {
            break Status::Stalled;
        }
        history.push(method.cycle(found.energy)?);
    };
    Ok((status, history))
}

/// Whether a residual that has fallen from one size to another in [`PATIENCE`] cycles would not be within the tolerance after `most`
/// at that pace.
fn is_hopeless(before: f64, after: f64, tolerance: f64, most: usize) -> bool {
    let paces = (most / PATIENCE) as i32;
    !(after * (after / before).powi(paces) <= tolerance)
}
