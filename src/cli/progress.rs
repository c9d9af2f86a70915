//! The line on stderr that says how far a long run is (R9.27, R9.75).

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A run that takes longer shows its progress, and so often.
const QUIET: Duration = Duration::from_secs(1);
const PAUSE: Duration = Duration::from_millis(200);

/// Whether the line stands on the terminal.
static IS_SHOWN: AtomicBool = AtomicBool::new(false);

/// The progress of a run; the line goes when it is dropped.
#[derive(Debug)]
pub(super) struct Progress {
    /// When the run began, where somebody watches.
    begun: Option<Instant>,
    shown: Option<Instant>,
}

impl Progress {
    /// The progress of a run that begins now.
    pub(super) fn new() -> Self {
        Self {
            begun: io::stderr().is_terminal().then(Instant::now),
            shown: None,
        }
    }

    /// Whether somebody watches.
    pub(super) fn is_watched(&self) -> bool {
        self.begun.is_some()
    }

    /// Shows how far the run is, when it is time for that.
    pub(super) fn show(&mut self, far: impl FnOnce() -> String) {
        let is_long = self.begun.is_some_and(|begun| begun.elapsed() > QUIET);
        if is_long && self.shown.is_none_or(|last| last.elapsed() > PAUSE) {
            let _ = write!(io::stderr().lock(), "\r{}\x1b[K", far());
            IS_SHOWN.store(true, Ordering::Relaxed);
            self.shown = Some(Instant::now());
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        clear();
    }
}

/// Takes the line away before something else is written on the terminal.
pub(super) fn clear() {
    if IS_SHOWN.swap(false, Ordering::Relaxed) {
        let _ = write!(io::stderr().lock(), "\r\x1b[K");
    }
}

/// A writer to the terminal on which the line may stand.
pub(super) struct OverProgress<W>(pub(super) W);

impl<W: Write> Write for OverProgress<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        clear();
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
