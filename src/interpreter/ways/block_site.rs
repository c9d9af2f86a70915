//! A block that a message may have to name later.

use serde::{Deserialize, Serialize};

use crate::text::Place;

/// Words of an executed block that switched a kind, may have switched it, or moved an axis.
#[derive(Debug, Clone, Eq, Serialize, Deserialize)]
pub(crate) struct BlockSite {
    /// The executed block.
    pub(crate) seq: u64,
    pub(crate) place: Place,
}

impl PartialEq for BlockSite {
    /// A block that a loop repeats counts as equal.
    fn eq(&self, other: &Self) -> bool {
        self.place == other.place
    }
}

impl BlockSite {
    /// Returns the block as named by a message in a file: `line 4`, or `sub.nc:4`.
    pub(crate) fn seen_from(&self, file: &str) -> String {
        let (place, line) = (&self.place, self.place.start().line);
        if *place.file == *file {
            format!("line {line}")
        } else {
            format!("{}:{line}", place.file)
        }
    }
}
