//! Long work, which Python can interrupt.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use frictcomp_host::{Progress, Watcher};
use pyo3::prelude::*;

use crate::failure::Failure;

/// Longest time before an interrupt is noticed.
const PATIENCE: Duration = Duration::from_millis(50);

/// The stack size of the thread: as large as that of a program's main thread elsewhere.
const STACK: usize = 8 << 20;

/// Flag that the work was cancelled.
#[derive(Debug, Clone, Default)]
pub(crate) struct Stop(Arc<AtomicBool>);

impl Stop {
    /// `Break` if it was cancelled.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Refuses to go on with work that was cancelled.
    pub(crate) fn refuse(&self) -> Result<(), Failure> {
        match self.flow() {
            ControlFlow::Break(()) => Err(Failure::new("the work was cancelled")),
            ControlFlow::Continue(()) => Ok(()),
        }
    }

    fn want(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Watcher for Stop {
    fn is_due(&self) -> bool {
        false
    }

    fn show(&self, _: &Progress) {}

    fn is_stopped(&self) -> bool {
        self.flow().is_break()
    }
}

/// Does work on a separate thread while other Python threads run. Signals are handled
/// meanwhile: if a handler raises, as that of Ctrl+C does, its exception is raised at once, and
/// the work ends as soon as it checks `Stop`.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Stop) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let stop = Stop::default();
    let (sender, results) = mpsc::sync_channel(1);
    let results = Mutex::new(results);
    let wait = || {
        let results = results.lock().unwrap_or_else(PoisonError::into_inner);
        results.recv_timeout(PATIENCE)
    };
    let of_worker = stop.clone();
    let worker = thread::Builder::new().stack_size(STACK).spawn(move || {
        // After an interrupt, the result is not awaited any more.
        let _ = sender.send(work(&of_worker));
    });
    let worker = worker.map_err(|error| {
        Failure::new(format!("no thread can be started: {error}")).into_error(py)
    })?;
    loop {
        match py.detach(wait) {
            Ok(result) => return result.map_err(|failure| failure.into_error(py)),
            Err(RecvTimeoutError::Timeout) => {
                if let Err(interrupt) = py.check_signals() {
                    stop.want();
                    return Err(interrupt);
                }
            }
            Err(RecvTimeoutError::Disconnected) => match worker.join() {
                Err(panic) => std::panic::resume_unwind(panic),
                Ok(()) => unreachable!("the work sends its result before it ends"),
            },
        }
    }
}
