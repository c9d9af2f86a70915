//! The ways that wait, in the order of the text, so that a block compares only the first of them (R14.4).

use serde::{Deserialize, Serialize};

use super::path::Path;
use super::stack::CallStack;

/// The ways that wait; the one whose block comes first in the text is the last.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct WaitingPaths(Vec<Path>);

/// The relation of the first waiting way to a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FirstWaiting {
    /// Its block comes before.
    Before,
    /// It waits at the block.
    Here,
    /// Its block comes after, or no way waits.
    After,
}

impl WaitingPaths {
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Path> {
        self.0.iter()
    }

    /// The ways, whose places must stay as they are.
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut Path> {
        self.0.iter_mut()
    }

    /// Takes all ways, the last of the text first.
    pub(crate) fn take_all(&mut self) -> Vec<Path> {
        std::mem::take(&mut self.0)
    }

    /// A way waits, after those that wait at the same block.
    pub(crate) fn push(&mut self, path: Path) {
        let frames = &path.control.frames;
        let is_later = |it: &Path| frames.comes_before(&it.control.frames) == Some(true);
        let place = self.0.partition_point(is_later);
        self.0.insert(place, path);
    }

    /// Compares the first way with the block that would be executed next.
    pub(crate) fn first_from(&self, here: &CallStack) -> FirstWaiting {
        let first = self.0.last();
        match first.map(|path| path.control.frames.comes_before(here)) {
            Some(Some(true)) => FirstWaiting::Before,
            Some(None) => FirstWaiting::Here,
            Some(Some(false)) | None => FirstWaiting::After,
        }
    }

    /// Takes the way whose block comes first in the text. One that may be at any of several labels goes on waiting at the
    /// next of them.
    pub(crate) fn take_first(&mut self) -> Option<Path> {
        let mut first = self.0.pop()?;
        if let Some(labels) = first.track.labels.take() {
            let here = first.control.frames.running().map_or(0, |frame| frame.next);
            let passed = labels.partition_point(|label| *label <= here);
            if let Some(next) = labels.get(passed) {
                let mut later = first.clone();
                if let Some(frame) = later.control.frames.running_mut() {
                    frame.next = *next;
                }
                later.track.labels = Some(labels);
                self.push(later);
            }
        }
        Some(first)
    }
}
