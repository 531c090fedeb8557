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

/// Two energies that differ by less than this fraction may do so by the rounding of their sums.
const ENERGY_ROUNDING: f64 = 1e-12;

/// A method whose corrections can raise the energy where the obstacle has cut them off.
pub(super) trait Damped {
    /// The next iterate, by the correction or without it; the one before is kept.
    fn relax(&mut self, is_corrected: bool) -> Found;

    /// By how much the energy is larger than that of the iterate before, as exactly as the step is known.
    fn energy_change(&self) -> f64;

    /// Goes back to the iterate before, and adds the part of the correction that lowers the energy most.
    fn damp(&mut self);

    /// Adds the correction and relaxes; damps it where that has not lowered the energy.
    fn correct(&mut self, energy: f64) -> Found {
        let found = self.relax(true);
        // Energies are equal to rounding long before the answer is reached.
        let falls = || found.energy < energy - ENERGY_ROUNDING * energy.abs() || self.energy_change() <= 0.0;
        if found.cut == 0 || falls() {
            return found;
        }
        self.damp();
        self.relax(false)
    }
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

#[cfg(test)]
mod tests {
    use web_time::Instant;

    use super::*;

    /// Its residual falls by a factor in each cycle; the contact set changes up to a cycle.
    struct Pace {
        factor: f64,
        violation: f64,
        changes: usize,
    }

    impl Cycle for Pace {
        fn cycle(&mut self, _: f64) -> Result<Found, NotFactored> {
            self.violation *= self.factor;
            self.changes = self.changes.saturating_sub(1);
            Ok(Found { violation: self.violation, ..Found::default() })
        }

        fn has_changed(&self) -> bool {
            self.changes > 0
        }
    }

    fn ends(factor: f64, changes: usize) -> (Status, usize) {
        let limits = Limits::new(90, None, Instant::now(), None);
        let first = Found { violation: 1.0, ..Found::default() };
        let mut pace = Pace { factor, violation: 1.0, changes };
        let (status, history) = run(&mut pace, first, 1e-6, 60, &limits).unwrap();
        (status, history.len() - 1)
    }

    #[test]
    fn it_stops_where_the_pace_leads_nowhere() {
        assert_eq!(ends(0.09, 0), (Status::Solved, 6));
        assert_eq!(ends(0.79, 0), (Status::Solved, 59));
        // 0.81^63 is not small enough.
        assert_eq!(ends(0.81, 0), (Status::Stalled, PATIENCE));
        assert_eq!(ends(f64::NAN, 0), (Status::Stalled, PATIENCE));
        // A contact set that changes in the cycle that arrives has one more.
        assert_eq!(ends(0.09, 50), (Status::Solved, 7));
    }
}
