//! The page, which hears how far long work is.

use frictcomp_host::{Progress, Watcher};

use crate::border::{is_due, tell};

/// The page as a watcher. It ends work by ending the thread of the engine.
#[derive(Debug)]
pub(crate) struct Page;

impl Watcher for Page {
    fn is_due(&self) -> bool {
        is_due()
    }

    fn show(&self, progress: &Progress) {
        tell(&progress.to_string());
    }
}
