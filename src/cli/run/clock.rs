//! The time that a run may take.

use std::time::Instant;

use super::levels::too_late;
use super::watch::Watch;
use crate::qp::Status;
use crate::study::StudyError;

/// Runs since a moment, to a limit if there is one.
#[derive(Clone, Copy)]
pub(crate) struct Clock {
    start: Instant,
    limit: Option<f64>,
}

impl Clock {
    /// Starts now; `limit` is in seconds.
    pub(crate) fn new(limit: Option<f64>) -> Self {
        Self { start: Instant::now(), limit }
    }

    /// Seconds that are left.
    fn left(&self) -> Option<f64> {
        self.limit.map(|limit| limit - self.start.elapsed().as_secs_f64())
    }

    /// Has the run ended when its time is over, whatever it does then.
    pub(crate) fn watch(&self, watch: &Watch, name: &str) {
        if let Some(left) = self.left() {
            let name = name.to_owned();
            watch.limit(left.max(0.0), move || too_late(&name));
        }
    }

    /// Whether something that takes so many seconds ends in time.
    pub(crate) fn allows(&self, seconds: f64) -> bool {
        self.left().is_none_or(|left| seconds <= left)
    }

    /// What a solver may take that has a limit of its own, or none.
    pub(crate) fn of_solver(&self, own: Option<f64>) -> Option<f64> {
        // To a solver, a limit that is over is none.
        let left = self.left().map(|left| left.max(f64::MIN_POSITIVE));
        [own, left].into_iter().flatten().reduce(f64::min)
    }

    /// Whether a level has failed because the run's time was over.
    pub(crate) fn has_stopped(&self, error: &StudyError) -> bool {
        matches!(error, StudyError::Rejected { rejected, .. } if rejected.statistics.status == Status::TimeLimit)
            && !self.allows(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shorter_limit_holds() {
        let endless = Clock::new(None);
        assert!(endless.allows(1e9) && endless.of_solver(None).is_none());
        assert_eq!(endless.of_solver(Some(5.0)), Some(5.0));
        let clock = Clock::new(Some(100.0));
        assert!(clock.allows(50.0) && !clock.allows(100.0));
        assert_eq!(clock.of_solver(Some(5.0)), Some(5.0));
        assert!(clock.of_solver(Some(500.0)).is_some_and(|left| left <= 100.0));
        let over = Clock::new(Some(1e-12));
        assert!(!over.allows(0.0) && over.of_solver(None).is_some_and(|left| left > 0.0));
    }
}
