//! The progress reports to the page during long work.

#![allow(unsafe_code, reason = "the functions of the page are foreign")]

use frictcomp_host::{Progress, Watcher};

#[cfg(target_family = "wasm")]
unsafe extern "C" {
    /// Reports the progress of a run to the page: executed blocks, and the line of the main program.
    safe fn progress(blocks: f64, line: u32);

    /// Returns 1 if it is time to report the progress of other work, at most a few times a second.
    safe fn due() -> u32;

    /// Reports progress to the page, in so many bytes of text at an address.
    safe fn told(at: *const u8, length: usize);
}

/// Reports no progress: there is no watcher.
#[cfg(not(target_family = "wasm"))]
fn progress(_: f64, _: u32) {}

/// Returns 0: there is no watcher.
#[cfg(not(target_family = "wasm"))]
fn due() -> u32 {
    0
}

/// Reports nothing: there is no watcher.
#[cfg(not(target_family = "wasm"))]
fn told(_: *const u8, _: usize) {}

/// The page as a watcher. It ends work by ending the thread of the engine.
#[derive(Debug)]
pub(crate) struct Page;

impl Watcher for Page {
    fn is_due(&self) -> bool {
        due() == 1
    }

    fn show(&self, progress: &Progress) {
        let words = progress.to_string();
        told(words.as_ptr(), words.len());
    }
}

/// Reports the progress of a run to the page.
pub(crate) fn show_progress(blocks: u32, line: u32) {
    progress(f64::from(blocks), line);
}
