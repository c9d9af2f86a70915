//! The line on stderr that says how far a long run is (R9.27).

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// A run that takes longer shows its progress, and so often.
const QUIET: Duration = Duration::from_secs(1);
const PAUSE: Duration = Duration::from_millis(200);

/// The progress of a run; the line goes when it is dropped.
pub(super) struct Progress {
    /// When the run began, where somebody watches.
    begun: Option<Instant>,
    shown: Option<Instant>,
}

impl Progress {
    /// For a run that prints nothing before its end.
    pub(super) fn of_silent_run() -> Self {
        Self {
            begun: io::stderr().is_terminal().then(Instant::now),
            shown: None,
        }
    }

    /// For a run that writes to stdout meanwhile: on the same terminal the line would be in its
    /// way.
    pub(super) fn beside_output() -> Self {
        let mut progress = Self::of_silent_run();
        if io::stdout().is_terminal() {
            progress.begun = None;
        }
        progress
    }

    /// Shows how far the run is, when it is time for that.
    pub(super) fn show(&mut self, far: impl FnOnce() -> String) {
        let is_long = self.begun.is_some_and(|begun| begun.elapsed() > QUIET);
        if is_long && self.shown.is_none_or(|last| last.elapsed() > PAUSE) {
            let _ = write!(io::stderr().lock(), "\r{}", far());
            self.shown = Some(Instant::now());
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.shown.is_some() {
            let _ = write!(io::stderr().lock(), "\r\x1b[K");
        }
    }
}
