//! The line on stderr that shows the progress of a long run (R9.27, R9.75).

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use frictcomp_host::{Progress, Watch, Watcher};

/// A run that takes longer than this shows its progress, every [`PAUSE`].
const QUIET: Duration = Duration::from_secs(1);
const PAUSE: Duration = Duration::from_millis(200);

/// The width of the line shown on the terminal. It is overwritten with blanks: not every console
/// of Windows supports a sequence that clears a line.
static SHOWN: AtomicUsize = AtomicUsize::new(0);

/// A terminal on which a long run shows its progress; the line is removed when this is dropped.
#[derive(Debug)]
pub(crate) struct Terminal {
    begun: Instant,
    shown: Mutex<Option<Instant>>,
}

impl Terminal {
    /// Returns the terminal for a run that begins now, if standard error is one.
    pub(crate) fn watched() -> Option<Self> {
        io::stderr().is_terminal().then(|| Self {
            begun: Instant::now(),
            shown: Mutex::new(None),
        })
    }
}

/// Returns the terminal as the watcher of a run that begins now.
pub(crate) fn watch() -> Watch {
    match Terminal::watched() {
        Some(terminal) => Watch::by(Arc::new(terminal)),
        None => Watch::default(),
    }
}

impl Watcher for Terminal {
    fn is_due(&self) -> bool {
        // If another thread is showing its progress, this one need not wait.
        let last = self.shown.try_lock().map(|shown| *shown);
        self.begun.elapsed() > QUIET
            && last.is_ok_and(|last| last.is_none_or(|last| last.elapsed() > PAUSE))
    }

    fn show(&self, progress: &Progress) {
        if let Ok(mut shown) = self.shown.try_lock() {
            let left = progress
                .part()
                .and_then(|it| left(self.begun.elapsed(), it));
            let line = format!("{progress}{}", left.unwrap_or_default());
            let columns = line.chars().count();
            let longer = SHOWN.swap(columns, Ordering::Relaxed).max(columns);
            let _ = write!(io::stderr().lock(), "\r{line:longer$}");
            *shown = Some(Instant::now());
        }
    }
}

/// Returns the estimate of the time that remains of work of which a part is done; none at its begin, which says little.
fn left(elapsed: Duration, part: f64) -> Option<String> {
    const LEAST: f64 = 0.05;
    let left_s = (part >= LEAST).then(|| elapsed.as_secs_f64() * (1.0 - part) / part)?;
    Some(if left_s < 90.0 {
        format!(", about {left_s:.0} s left")
    } else {
        format!(", about {:.0} min left", left_s / 60.0)
    })
}

impl Drop for Terminal {
    fn drop(&mut self) {
        clear();
    }
}

/// Removes the line before something else is written on the terminal.
pub(crate) fn clear() {
    let columns = SHOWN.swap(0, Ordering::Relaxed);
    if columns > 0 {
        let _ = write!(io::stderr().lock(), "\r{:columns$}\r", "");
    }
}

/// A writer to the terminal that may show the line.
pub(crate) struct OverProgress<W>(pub(crate) W);

impl<W: Write> Write for OverProgress<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        clear();
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_is_estimated_from_what_is_done() {
        // R18.28
        let after = |seconds, part| left(Duration::from_secs(seconds), part);
        assert_eq!(after(10, 0.25).as_deref(), Some(", about 30 s left"));
        assert_eq!(after(60, 0.2).as_deref(), Some(", about 4 min left"));
        assert_eq!(after(1, 0.01), None);
    }
}
