//! Clean-up when a run is stopped from outside: its unfinished files are removed first (R9.31).
//!
//! Signals belong to the process. A host that uses them itself leaves them alone, and a
//! later run removes the files.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, Once, OnceLock, PoisonError};

/// The unfinished files. A signal handler can reach only these.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// The exit status of a process that is stopped, where the host has its files removed.
static STATUS: OnceLock<u8> = OnceLock::new();

/// Removes the unfinished files when the process is stopped, which then ends as it would have.
/// `status` is the exit status on systems without signals.
pub fn clean_up_when_stopped(status: u8) {
    let _ = STATUS.set(status);
}

/// The unfinished files; nothing stops the run while this is held.
pub(crate) struct Unfinished(MutexGuard<'static, BTreeSet<PathBuf>>);

impl Unfinished {
    /// Waits until nothing else changes them.
    pub(crate) fn lock() -> Self {
        static WATCH: Once = Once::new();
        if let Some(status) = STATUS.get() {
            WATCH.call_once(|| system::watch(*status));
        }
        Self::guard()
    }

    fn guard() -> Self {
        Self(UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Adds a file to be removed when the run is stopped.
    pub(crate) fn add(&mut self, path: &Path) {
        self.0.insert(path.to_owned());
    }

    /// Forgets a file that is complete, or deleted.
    pub(crate) fn forget(&mut self, path: &Path) {
        self.0.remove(path);
    }

    #[cfg(any(unix, windows))]
    fn take_away(&mut self) {
        while let Some(path) = self.0.pop_first() {
            // A file that cannot be removed now is removed by the next run.
            let _ = std::fs::remove_file(path);
        }
    }
}

/// Turns exceeding the file size limit into a write error, instead of the end of the run.
pub fn survive_file_size_limit() {
    system::survive_file_size_limit();
}

#[cfg(unix)]
mod system {
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;
    use std::sync::mpsc;

    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    use super::Unfinished;

    const STOPS: [i32; 4] = [SIGINT, SIGTERM, SIGHUP, SIGQUIT];

    pub(crate) fn survive_file_size_limit() {
        // Ignoring the signal loses nothing: the write itself fails.
        let _ = signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
    }

    /// Waits for signals in a thread. Without one, a stopped run leaves its files to the
    /// next one.
    pub(crate) fn watch(_: u8) {
        let (ready, waits) = mpsc::channel();
        let watching = std::thread::Builder::new().spawn(move || {
            let Ok(mut signals) = Signals::new(heeded()) else {
                return;
            };
            let _ = ready.send(());
            for signal in signals.forever() {
                // Held until the process ends, so that no file is created after this.
                let mut unfinished = Unfinished::guard();
                unfinished.take_away();
                let _ = emulate_default_handler(signal);
            }
        });
        if watching.is_ok() {
            let _ = waits.recv();
        }
    }

    /// Returns the signals that stop the run. Those that a parent has set to be ignored, as `nohup` does, stay
    /// ignored; Linux reports them.
    fn heeded() -> Vec<i32> {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let ignored = status
            .lines()
            .find_map(|line| line.strip_prefix("SigIgn:"))
            .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
            .unwrap_or_default();
        let is_ignored = |signal: i32| ignored >> (signal - 1) & 1 == 1;
        STOPS
            .into_iter()
            .filter(|&signal| !is_ignored(signal))
            .collect()
    }
}

#[cfg(windows)]
mod system {
    use super::Unfinished;

    pub(crate) fn survive_file_size_limit() {}

    pub(crate) fn watch(status: u8) {
        // Without a handler a stopped run leaves its files to the next one.
        let _ = ctrlc::set_handler(move || {
            Unfinished::guard().take_away();
            std::process::exit(i32::from(status));
        });
    }
}

#[cfg(not(any(unix, windows)))]
mod system {
    pub(crate) fn survive_file_size_limit() {}

    pub(crate) fn watch(_: u8) {}
}
