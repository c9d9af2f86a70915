//! Parallel work on many items, with the results in the order of the items, and the memory that work needs.

use std::collections::VecDeque;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::sync::{Mutex, PoisonError};

use super::error::HostError;

/// Number of results that may wait for their turn, for each worker.
const AHEAD: usize = 16;

/// An item, and the channel for its result.
type WorkItem<T, R> = (T, SyncSender<R>);

/// Returns the number of processors available to this process, for as many workers.
pub fn processors() -> NonZeroUsize {
    std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN)
}

/// Executes each piece of work once, on all processors. The result does not depend on which of them does it. `done` is
/// called with the number of results so far.
pub(super) fn map<T: Sync, R: Send>(
    pieces: &[T],
    work: impl Fn(&T) -> R + Sync,
    mut done: impl FnMut(usize),
) -> Vec<R> {
    let most = NonZeroUsize::new(pieces.len()).unwrap_or(NonZeroUsize::MIN);
    let mut results = Vec::with_capacity(pieces.len());
    in_order(pieces.iter(), processors().min(most), work, |result| {
        results.push(result);
        done(results.len());
        ControlFlow::Continue(())
    });
    results
}

/// Passes each item to one of `workers` threads and the results to `take`, in the order of the items.
/// This thread draws the items, never so fast that more than a bounded number of results
/// wait. `Break` ends the work. If the system starts fewer threads, those do the work; without
/// any, this thread does it.
pub fn in_order<T: Send, R: Send>(
    items: impl Iterator<Item = T>,
    workers: NonZeroUsize,
    work: impl Fn(T) -> R + Sync,
    mut take: impl FnMut(R) -> ControlFlow<()>,
) {
    if workers.get() == 1 {
        // A separate thread would only cost time and, where address space is scarce, memory.
        let _ = items.map(work).try_for_each(take);
        return;
    }
    let (jobs, queue) = mpsc::channel::<WorkItem<T, R>>();
    let queue = Mutex::new(queue);
    let (queue, work) = (&queue, &work);
    std::thread::scope(|scope| {
        let started = (0..workers.get())
            .take_while(|_| is_there_for_a_thread())
            .map_while(|_| {
                let worker = move || {
                    while let Some((item, result)) = next(queue) {
                        // Its receiver no longer exists after a `Break`.
                        let _ = result.send(work(item));
                    }
                };
                std::thread::Builder::new().spawn_scoped(scope, worker).ok()
            })
            .count();
        if started == 0 {
            let mut results = items.map(work);
            let _ = results.try_for_each(take);
            return;
        }
        let mut waiting = VecDeque::new();
        let mut settle = |waiting: &mut VecDeque<Receiver<R>>, most: usize| {
            while waiting.len() > most {
                let result = waiting.pop_front().and_then(|result| result.recv().ok());
                take(result.map_or(ControlFlow::Break(()), ControlFlow::Continue)?)?;
            }
            ControlFlow::Continue(())
        };
        let mut flow = ControlFlow::Continue(());
        for item in items {
            let (sender, result) = mpsc::sync_channel(1);
            waiting.push_back(result);
            if jobs.send((item, sender)).is_err() {
                break;
            }
            flow = settle(&mut waiting, AHEAD * started);
            if flow.is_break() {
                break;
            }
        }
        if flow.is_continue() {
            flow = settle(&mut waiting, 0);
        }
        drop(jobs);
        if flow.is_break() {
            while next(queue).is_some() {}
        }
    });
}

/// Returns the next job; `None` when there are no more.
fn next<T, R>(queue: &Mutex<Receiver<WorkItem<T, R>>>) -> Option<WorkItem<T, R>> {
    let queue = queue.lock().unwrap_or_else(PoisonError::into_inner);
    queue.recv().ok()
}

/// Memory of a circular test in addition to the program itself, with room to spare.
const SIMULATION: usize = 24 << 20;

/// Memory of a thread: address space for its stack and for its own heap, 128 MiB with glibc. Without the heap each of
/// its allocations takes a page.
const THREAD: usize = 136 << 20;

/// Returns whether there is memory for one more thread.
fn is_there_for_a_thread() -> bool {
    available(THREAD).is_ok()
}

/// Checks the memory that a simulation needs, since the system would otherwise end the process during the
/// simulation.
///
/// # Errors
/// There is not enough.
pub fn memory_for_simulation() -> Result<(), HostError> {
    available(SIMULATION)
}

fn available(bytes: usize) -> Result<(), HostError> {
    let mut room: Vec<u8> = Vec::new();
    room.try_reserve_exact(bytes)
        .map_err(|_| HostError::Memory {
            mebibytes: bytes >> 20,
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_the_order_of_the_items() {
        for workers in [1, 2, 7] {
            let workers = NonZeroUsize::new(workers).unwrap();
            let mut taken = Vec::new();
            let uneven = |item: u64| {
                let rounds = if item.is_multiple_of(5) { 20_000 } else { 1 };
                (0..rounds).fold(item, |sum, round| std::hint::black_box(sum + round - round))
            };
            in_order(0..500, workers, uneven, |result| {
                taken.push(result);
                ControlFlow::Continue(())
            });
            assert!(taken.into_iter().eq(0..500));
        }
    }

    #[test]
    fn results_keep_the_order_of_the_pieces() {
        let pieces: Vec<u64> = (0..100).collect();
        let mut counts = Vec::new();
        let squares = map(&pieces, |n| n * n, |done| counts.push(done));
        assert!(squares.into_iter().eq(pieces.iter().map(|n| n * n)));
        assert!(counts.into_iter().eq(1..=100));
        assert!(map(&[0_u8; 0], |n| *n, |_| ()).is_empty());
    }

    #[test]
    fn a_break_ends_the_work() {
        let mut taken = 0;
        let workers = NonZeroUsize::new(2).unwrap();
        in_order(
            0..,
            workers,
            |item: u64| item,
            |item| {
                taken = item;
                if item == 100 {
                    return ControlFlow::Break(());
                }
                ControlFlow::Continue(())
            },
        );
        assert_eq!(taken, 100);
    }

    #[test]
    fn what_is_not_there_is_said() {
        // R2.60
        assert!(available(1 << 10).is_ok());
        let failure = available(usize::MAX / 2).expect_err("more than any machine has");
        assert!(failure.to_string().starts_with("not enough memory"));
    }
}
