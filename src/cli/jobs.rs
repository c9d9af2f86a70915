//! Independent pieces of work on all cores, with the results in the order of the pieces.

use std::num::NonZero;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::progress::Progress;

/// Does work piece by piece and tells a watching person how far it is.
pub(super) struct Jobs {
    name: &'static str,
    done: AtomicUsize,
    progress: Mutex<Progress>,
}

impl Jobs {
    /// Work under this name.
    pub(super) fn new(name: &'static str) -> Self {
        Self {
            name,
            done: AtomicUsize::new(0),
            progress: Mutex::new(Progress::new()),
        }
    }

    /// Does each piece once. Which core does it makes no difference to the results.
    pub(super) fn map<T: Sync, R: Send>(
        &self,
        pieces: &[T],
        work: impl Fn(&T) -> R + Sync,
    ) -> Vec<R> {
        self.done.store(0, Ordering::Relaxed);
        let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
        let next = AtomicUsize::new(0);
        let worker = || {
            let mut results = Vec::new();
            while let Some((at, piece)) = {
                let at = next.fetch_add(1, Ordering::Relaxed);
                pieces.get(at).map(|piece| (at, piece))
            } {
                results.push((at, work(piece)));
                self.tick(pieces.len());
            }
            results
        };
        let mut results: Vec<(usize, R)> = std::thread::scope(|scope| {
            // Where the system starts no more threads, those that there are do the work.
            let others: Vec<_> = (1..cores.min(pieces.len()))
                .map_while(|_| std::thread::Builder::new().spawn_scoped(scope, worker).ok())
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

    fn tick(&self, all: usize) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        // Who comes while another core shows it need not wait.
        if let Ok(mut progress) = self.progress.try_lock() {
            progress.show(|| format!("{}: {done} of {all} runs", self.name));
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
