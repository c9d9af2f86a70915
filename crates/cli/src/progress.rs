//! The line on stderr that says how far a long run is (R9.27, R9.75).

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use frictcomp_host::{Progress, Watch, Watcher};

/// A run that takes longer shows its progress, and so often.
const QUIET: Duration = Duration::from_secs(1);
const PAUSE: Duration = Duration::from_millis(200);

/// The columns of the line that stands on the terminal. It is overwritten with blanks: not every console
/// of Windows knows a sequence that clears a line.
static SHOWN: AtomicUsize = AtomicUsize::new(0);

/// A terminal on which a long run shows its progress; the line goes when this is dropped.
#[derive(Debug)]
pub(super) struct Terminal {
    begun: Instant,
    shown: Mutex<Option<Instant>>,
}

impl Terminal {
    /// The terminal of a run that begins now, where standard error is one.
    pub(super) fn watched() -> Option<Self> {
        io::stderr().is_terminal().then(|| Self {
            begun: Instant::now(),
            shown: Mutex::new(None),
        })
    }
}

/// The terminal as the watcher of a run that begins now.
pub(super) fn watch() -> Watch {
    match Terminal::watched() {
        Some(terminal) => Watch::by(Arc::new(terminal)),
        None => Watch::default(),
    }
}

impl Watcher for Terminal {
    fn is_due(&self) -> bool {
        // While another thread shows its progress, this one need not wait.
        let last = self.shown.try_lock().map(|shown| *shown);
        self.begun.elapsed() > QUIET
            && last.is_ok_and(|last| last.is_none_or(|last| last.elapsed() > PAUSE))
    }

    fn show(&self, progress: &Progress) {
        if let Ok(mut shown) = self.shown.try_lock() {
            let line = progress.to_string();
            let columns = line.chars().count();
            let longer = SHOWN.swap(columns, Ordering::Relaxed).max(columns);
            let _ = write!(io::stderr().lock(), "\r{line:longer$}");
            *shown = Some(Instant::now());
        }
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        clear();
    }
}

/// Takes the line away before something else is written on the terminal.
pub(super) fn clear() {
    let columns = SHOWN.swap(0, Ordering::Relaxed);
    if columns > 0 {
        let _ = write!(io::stderr().lock(), "\r{:columns$}\r", "");
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
