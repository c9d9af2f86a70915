//! Threads with work queues, so that the client never waits.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use crossbeam_channel::{Sender, unbounded};

/// A thread that does one piece of work after the other.
pub(super) struct Worker<J> {
    jobs: Sender<J>,
}

impl<J: Send + 'static> Worker<J> {
    /// Starts a thread that ends with its owner.
    ///
    /// # Errors
    /// The system cannot start a thread.
    pub(super) fn new(name: &str, work: impl FnMut(J) + Send + 'static) -> io::Result<Self> {
        let (jobs, queue) = unbounded();
        let run = move || queue.into_iter().for_each(work);
        thread::Builder::new().name(name.to_owned()).spawn(run)?;
        Ok(Self { jobs })
    }

    /// Adds a piece of work.
    pub(super) fn send(&self, job: J) {
        // The queue is closed only where its thread has ended, which nothing outlives.
        let _ = self.jobs.send(job);
    }
}

/// Flag that a piece of work is no longer needed.
#[derive(Debug, Clone, Default)]
pub(super) struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Sets the flag.
    pub(super) fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Returns whether the work is no longer needed.
    pub(super) fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
