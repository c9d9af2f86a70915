//! The three runs side by side (R11.4).

use serde::Serialize;

/// A value for each of the three runs.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct PerRun<T> {
    /// Value with compensation as the program switches it.
    pub programmed: T,
    /// Value with all compensation on.
    pub all_on: T,
    /// Value with all compensation off.
    pub all_off: T,
}

impl<T> PerRun<T> {
    pub(super) fn each_mut(&mut self) -> [&mut T; 3] {
        [&mut self.programmed, &mut self.all_on, &mut self.all_off]
    }

    pub(super) fn from_each([programmed, all_on, all_off]: [T; 3]) -> Self {
        Self {
            programmed,
            all_on,
            all_off,
        }
    }
}
