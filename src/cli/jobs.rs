//! Independent pieces of work on all cores, with the results in the order of the pieces.

use std::io::Write;
use std::num::NonZero;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::console::Console;

/// Work that takes longer shows its progress (R9.27).
const QUIET: Duration = Duration::from_secs(1);

/// Does work piece by piece and tells a watching person how far it is.
pub(super) struct Jobs {
    name: &'static str,
    begun: Instant,
    done: AtomicUsize,
    shows: bool,
    shown: Mutex<Option<Instant>>,
}

impl Jobs {
    /// Work under this name.
    pub(super) fn new(name: &'static str) -> Self {
        Self {
            name,
            begun: Instant::now(),
            done: AtomicUsize::new(0),
            shows: Console::shows_progress(),
            shown: Mutex::new(None),
        }
    }

    /// Does each piece once. Which core does it makes no difference to the results.
    pub(super) fn map<T: Sync, R: Send>(
        &self,
        pieces: &[T],
        work: impl Fn(&T) -> R + Sync,
    ) -> Vec<R> {
        let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
        let next = AtomicUsize::new(0);
        let worker = || {
            let mut results = Vec::new();
            while let Some((at, piece)) = {
                let at = next.fetch_add(1, Ordering::Relaxed);
                pieces.get(at).map(|piece| (at, piece))
            } {
                results.push((at, work(piece)));
                self.tick();
            }
            results
        };
        let mut results: Vec<(usize, R)> = std::thread::scope(|scope| {
            let others: Vec<_> = (1..cores.min(pieces.len()))
                .map(|_| scope.spawn(worker))
                .collect();
            let mut results = worker();
            for other in others {
                match other.join() {
                    Ok(theirs) => results.extend(theirs),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
            results
        });
        results.sort_by_key(|&(at, _)| at);
        results.into_iter().map(|(_, result)| result).collect()
    }

    fn tick(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        if !self.shows || self.begun.elapsed() < QUIET {
            return;
        }
        if let Ok(mut shown) = self.shown.try_lock()
            && shown.is_none_or(|last| last.elapsed() > QUIET / 5)
        {
            let name = self.name;
            let _ = write!(std::io::stderr(), "\r{name}: {done} runs done");
            *shown = Some(Instant::now());
        }
    }
}

impl Drop for Jobs {
    fn drop(&mut self) {
        if self.shown.get_mut().is_ok_and(|shown| shown.is_some()) {
            let _ = write!(std::io::stderr(), "\r\x1b[K");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_keep_the_order_of_the_pieces() {
        let pieces: Vec<u64> = (0..100).collect();
        let squares = Jobs::new("squares").map(&pieces, |n| n * n);
        assert_eq!(squares, pieces.iter().map(|n| n * n).collect::<Vec<_>>());
        assert!(Jobs::new("nothing").map(&[0_u8; 0], |n| *n).is_empty());
    }
}
