//! Progress on long work, when a terminal is there to show it.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// How often the spinner turns.
const TICK: Duration = Duration::from_millis(120);

/// A line on the terminal that says what is going on and for how long; nothing when standard error is not a terminal.
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    pub(crate) fn new(quiet: bool) -> Self {
        let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(None, target);
        let style = ProgressStyle::with_template("{spinner} {msg} ({elapsed})");
        bar.set_style(style.expect("the template is valid"));
        bar.enable_steady_tick(TICK);
        Self { bar }
    }

    /// Shows a bar of so many steps from now on.
    pub(crate) fn steps(&self, count: usize) {
        let style = ProgressStyle::with_template("{spinner} [{bar:20}] {msg} ({elapsed})");
        self.bar.set_style(style.expect("the template is valid"));
        self.bar.set_length(count as u64);
    }

    /// One step is done.
    pub(crate) fn step(&self) {
        self.bar.inc(1);
    }

    /// Shows the current stage.
    pub(crate) fn stage(&self, what: impl Into<String>) {
        self.bar.reset_elapsed();
        self.bar.set_message(what.into());
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
