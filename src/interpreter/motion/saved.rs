//! The state that the end of a cycle restores (P-CHAN-00210).

use serde::{Deserialize, Serialize};

use crate::interpreter::motion::modal::{GFunctions, Modal};
use crate::language::Group;

/// G functions that separate positions from those of the machine.
const TRANSFORMING: [&str; 2] = ["G41", "G21"];

/// G functions and feeds before a cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Saved {
    functions: GFunctions,
    transformed: [bool; 2],
}

impl Saved {
    /// Makes unknown what differs between two saved states.
    pub(crate) fn join(&mut self, other: &Self) {
        if self == other {
            return;
        }
        for group in Group::ALL {
            self.functions.unknown.insert(group);
        }
        for (mine, theirs) in self.functions.feeds.iter_mut().zip(other.functions.feeds) {
            *mine = mine.filter(|_| *mine == theirs);
        }
        self.functions.lacking.join(other.functions.lacking);
        for (mine, theirs) in self.transformed.iter_mut().zip(other.transformed) {
            *mine |= theirs;
        }
    }
}

impl Modal {
    /// Saves the state that a cycle may change and its end restores.
    pub(crate) fn save(&self) -> Saved {
        Saved {
            functions: self.functions.clone(),
            transformed: TRANSFORMING.map(|name| self.transformed.contains(name)),
        }
    }

    /// The end of a cycle.
    pub(crate) fn restore(&mut self, saved: &Saved) {
        if self.functions.offset != saved.functions.offset {
            self.havoc_positions();
        }
        self.functions = saved.functions.clone();
        for (name, on) in TRANSFORMING.into_iter().zip(saved.transformed) {
            self.transform(name, on);
        }
    }
}
