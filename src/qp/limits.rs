//! When an iteration stops although it has not arrived.

use std::fmt;
use std::sync::Arc;

use web_time::Instant;

use super::status::Status;
use super::time_limit::TimeLimit;

/// What a solver asks between its steps: whether to stop now. Clones ask the same.
///
/// ```
/// use std::sync::Arc;
/// use std::sync::atomic::{AtomicBool, Ordering};
/// use membrane_contact::prelude::*;
/// use membrane_contact::qp::Interrupt;
///
/// let enough = Arc::new(AtomicBool::new(false));
/// let asked = Arc::clone(&enough);
/// let interrupt = Interrupt::new(move || asked.load(Ordering::Relaxed));
/// let options = SolverOptions { interrupt: Some(interrupt), ..SolverOptions::default() };
/// // From another thread, while a solver runs with these options:
/// enough.store(true, Ordering::Relaxed);
/// ```
#[derive(Clone)]
pub struct Interrupt(Arc<dyn Fn() -> bool + Send + Sync>);

impl Interrupt {
    /// Stops when `is_wanted` says so. It is asked on any thread, between two steps of the solver, and has to answer at once.
    pub fn new(is_wanted: impl Fn() -> bool + Send + Sync + 'static) -> Self {
        Self(Arc::new(is_wanted))
    }

    /// Asks.
    pub fn is_wanted(&self) -> bool {
        (self.0)()
    }
}

impl fmt::Debug for Interrupt {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("Interrupt")
    }
}

/// When an iteration stops although it has not arrived.
#[derive(Debug, Clone)]
pub(crate) struct Limits {
    iterations: usize,
    deadline: Option<Instant>,
    interrupt: Option<Interrupt>,
}

impl Limits {
    /// Those of a solve that has begun at `start`.
    pub(crate) fn new(
        iterations: usize,
        time_limit: Option<TimeLimit>,
        start: Instant,
        interrupt: Option<Interrupt>,
    ) -> Self {
        Self { iterations, deadline: time_limit.and_then(|limit| limit.deadline(start)), interrupt }
    }

    /// The same with another limit of iterations.
    pub(crate) fn with_iterations(&self, iterations: usize) -> Self {
        Self { iterations, ..self.clone() }
    }

    /// What is left of them after so many iterations.
    pub(crate) fn after(&self, iterations: usize) -> Self {
        self.with_iterations(self.iterations.saturating_sub(iterations))
    }

    /// Why not to go on after so many iterations.
    pub(crate) fn reached(&self, iterations: usize) -> Option<Status> {
        if iterations >= self.iterations {
            Some(Status::IterationLimit)
        } else if self.interrupt.as_ref().is_some_and(Interrupt::is_wanted) {
            Some(Status::Interrupted)
        } else if self.deadline.is_some_and(|deadline| Instant::now() > deadline) {
            Some(Status::TimeLimit)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn each_limit_is_told_from_the_others() {
        let now = Instant::now();
        let long_ago = now - Duration::from_secs(1);
        let soon = Some(TimeLimit::from_seconds(0.5).unwrap());
        let interrupt = |wanted: bool| Some(Interrupt::new(move || wanted));
        let limits = |start, wanted| Limits::new(3, soon, start, interrupt(wanted));
        assert_eq!(Limits::new(3, None, long_ago, None).reached(2), None);
        assert_eq!(limits(now, false).reached(2), None);
        assert_eq!(limits(now, false).reached(3), Some(Status::IterationLimit));
        assert_eq!(limits(long_ago, false).reached(2), Some(Status::TimeLimit));
        assert_eq!(limits(long_ago, true).reached(2), Some(Status::Interrupted));
        assert_eq!(limits(now, false).with_iterations(1).reached(2), Some(Status::IterationLimit));
    }
}
