//! Values that expressions read, while they matter (R2.84).

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::location::Location;

/// Number of different values kept as read; with more, everything counts as read.
const MAX_READS: usize = 256;

/// Values read since a loop was examined.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Reads {
    targets: BTreeSet<Location>,
    too_many: bool,
}

impl Reads {
    pub(crate) fn note(&mut self, target: Location) {
        if self.targets.len() < MAX_READS {
            self.targets.insert(target);
        } else {
            self.too_many = true;
        }
    }

    pub(crate) fn has(&self, target: &Location) -> bool {
        self.too_many || self.targets.contains(target)
    }
}
