//! The time that a run may take.

use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Instant;

use super::watch::Watch;
use crate::cli::failure::Failure;
use crate::qp::{Status, TimeLimit};
use crate::study::StudyError;

/// Runs since a moment, to a limit if there is one.
#[derive(Clone, Copy)]
pub(crate) struct Clock {
    start: Instant,
    limit: Option<TimeLimit>,
}

impl Clock {
    /// Starts now.
    pub(crate) fn new(limit: Option<TimeLimit>) -> Self {
        Self { start: Instant::now(), limit }
    }

    /// Has the run ended by `give_up` when its time is over, whatever it does then.
    pub(crate) fn watch(&self, watch: &Watch, give_up: impl Fn() -> Failure + Send + Sync + 'static) {
        if let Some(left) = self.left() {
            watch.limit(left, give_up);
        }
    }

    /// What is left of the limit, as a limit: of one that is over, next to nothing.
    fn left(&self) -> Option<TimeLimit> {
        self.limit.map(|limit| limit.left_since(self.start).unwrap_or(TimeLimit::SHORTEST))
    }

    /// Whether something that takes so many seconds ends in time.
    pub(crate) fn allows(&self, seconds: f64) -> bool {
        self.limit.is_none_or(|limit| self.start.elapsed().as_secs_f64() + seconds <= limit.seconds())
    }

    /// Ends the run by `give_up` when its time is over: also where the watch has not come to it yet.
    pub(crate) fn check(&self, give_up: impl Fn() -> Failure) -> Result<(), Failure> {
        if self.allows(0.0) { Ok(()) } else { Err(give_up()) }
    }

    /// What a solver may take that has a limit of its own, or none.
    pub(crate) fn of_solver(&self, own: Option<TimeLimit>) -> Option<TimeLimit> {
        [own, self.left()].into_iter().flatten().min()
    }

    /// Whether a level has failed because the run's time was over.
    pub(crate) fn has_stopped(&self, error: &StudyError) -> bool {
        matches!(error, StudyError::Rejected { rejected, .. } if rejected.statistics.status == Status::TimeLimit)
            && !self.allows(0.0)
    }

    /// Begins work beside the run, unless the time is over.
    pub(crate) fn begin<T: Send + 'static>(&self, work: impl FnOnce() -> T + Send + 'static) -> Begun<T> {
        let result = self.allows(0.0).then(|| {
            let (done, result) = mpsc::channel();
            thread::spawn(move || {
                // Nobody waits any longer for what comes too late.
                let _ = done.send(work());
            });
            result
        });
        Begun { clock: *self, result }
    }
}

/// Work that has begun, or for which there was no time.
pub(crate) struct Begun<T> {
    clock: Clock,
    result: Option<Receiver<T>>,
}

impl<T> Begun<T> {
    /// What the work makes, or nothing when the time is over before: then it is not waited for, and ends with the program.
    pub(crate) fn in_time(self) -> Option<T> {
        let result = self.result?;
        let made = match self.clock.left() {
            None => result.recv().map_err(|_| RecvTimeoutError::Disconnected),
            Some(left) => result.recv_timeout(left.duration()),
        };
        match made {
            Ok(made) => Some(made),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => panic!("a thread beside the run is gone"),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    fn limit(seconds: f64) -> Option<TimeLimit> {
        Some(TimeLimit::from_seconds(seconds).expect("a limit"))
    }

    #[test]
    fn the_shorter_limit_holds() {
        let endless = Clock::new(None);
        assert!(endless.allows(1e9) && endless.of_solver(None).is_none());
        assert_eq!(endless.of_solver(limit(5.0)), limit(5.0));
        let clock = Clock::new(limit(100.0));
        assert!(clock.allows(50.0) && !clock.allows(100.0));
        assert_eq!(clock.of_solver(limit(5.0)), limit(5.0));
        assert!(clock.of_solver(limit(500.0)) <= limit(100.0));
        assert!(Clock::new(limit(1e19)).allows(1e9));
        let over = Clock::new(limit(1e-12));
        assert!(!over.allows(0.0) && over.of_solver(None).is_some());
    }

    #[test]
    fn what_comes_too_late_is_not_waited_for() {
        let made = |clock: Clock, milliseconds| {
            clock.begin(move || thread::sleep(Duration::from_millis(milliseconds))).in_time()
        };
        assert_eq!(made(Clock::new(None), 1), Some(()));
        assert_eq!(made(Clock::new(limit(60.0)), 1), Some(()));
        assert_eq!(made(Clock::new(limit(0.01)), 3_600_000), None);
        assert_eq!(made(Clock::new(limit(1e-9)), 0), None, "nothing is begun");
        assert_eq!(made(Clock::new(limit(1e19)), 1), Some(()));
    }

    #[test]
    fn work_goes_on_beside_the_run() {
        let (say, heard) = mpsc::channel();
        let begun = Clock::new(None).begin(move || heard.recv());
        say.send("done").unwrap();
        assert_eq!(begun.in_time(), Some(Ok("done")));
    }
}
