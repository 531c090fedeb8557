//! The time that a solve may take.

use std::time::Duration;

use thiserror::Error;
use web_time::Instant;

use crate::text::Number;

/// A limit of time that can be kept: longer than nothing, and no longer than a [`Duration`].
///
/// ```
/// use membrane_contact::qp::TimeLimit;
///
/// assert_eq!(TimeLimit::from_seconds(1.5)?.seconds(), 1.5);
/// assert!(TimeLimit::from_seconds(0.0).is_err() && TimeLimit::from_seconds(1e300).is_err());
/// # Ok::<(), membrane_contact::qp::TimeLimitError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct TimeLimit(Duration);

/// A number of seconds is no limit of time.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{} is out of range: choose seconds above 0, at most 1e19, or leave it out for no limit", Number(*_0))]
pub struct TimeLimitError(pub f64);

impl TimeLimit {
    /// The shortest: to a backend, a limit of zero may mean that there is none.
    pub const SHORTEST: Self = Self(Duration::from_nanos(1));

    /// A limit of so many seconds; what is shorter than a nanosecond is one.
    ///
    /// # Errors
    /// [`TimeLimitError`] for zero, negative numbers, NaN, infinity, and what is longer than a [`Duration`].
    pub fn from_seconds(seconds: f64) -> Result<Self, TimeLimitError> {
        match Duration::try_from_secs_f64(seconds) {
            Ok(duration) if seconds > 0.0 => Ok(Self(duration).max(Self::SHORTEST)),
            _ => Err(TimeLimitError(seconds)),
        }
    }

    /// The seconds.
    pub fn seconds(self) -> f64 {
        self.0.as_secs_f64()
    }

    /// The same as a [`Duration`], which is never zero.
    pub fn duration(self) -> Duration {
        self.0
    }

    /// What is left of it for work that has begun at `start`; `None` when it is over.
    pub fn left_since(self, start: Instant) -> Option<Self> {
        self.0.checked_sub(start.elapsed()).filter(|left| !left.is_zero()).map(Self)
    }

    /// The moment at which work that has begun at `start` has to end; `None` when that is beyond what the clock can say, and
    /// so beyond any run.
    pub fn deadline(self, start: Instant) -> Option<Instant> {
        start.checked_add(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_duration_is_no_limit() {
        for seconds in [0.0, -0.0, -1.0, -1e-300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e20, 1e300] {
            let error = TimeLimit::from_seconds(seconds).unwrap_err().to_string();
            assert!(error.starts_with(&Number(seconds).to_string()) && error.contains("above 0"), "{error}");
        }
        for seconds in [1e-300, f64::MIN_POSITIVE, 1e-9, 1.0, 3e7, 1e19] {
            let limit = TimeLimit::from_seconds(seconds).unwrap_or_else(|error| panic!("{error}"));
            assert!(!limit.duration().is_zero(), "{seconds}");
            assert!((limit.seconds() - seconds).abs() <= 1e-9 + 1e-15 * seconds, "{seconds}");
        }
    }

    #[test]
    fn a_limit_beyond_the_clock_has_no_deadline_and_one_that_is_over_leaves_nothing() {
        let now = Instant::now();
        let limit = |seconds| TimeLimit::from_seconds(seconds).unwrap();
        assert_eq!(limit(1e19).deadline(now), None);
        assert_eq!(limit(2.0).deadline(now), Some(now + Duration::from_secs(2)));
        let before = now - Duration::from_millis(10);
        assert_eq!(limit(1e-9).left_since(before), None);
        let left = limit(60.0).left_since(before).unwrap();
        assert!(left < limit(60.0) && left > limit(30.0), "{left:?}");
        assert!(limit(1e19).left_since(before).is_some());
    }
}
