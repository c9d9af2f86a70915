//! The unknown values that messages of a program were about (R2.95).

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::rows;
use crate::text::Place;

/// Unknown values that are remembered; beyond them a message may be said again.
const MAX_ROOTS: usize = 1000;

/// The unknown values that messages of the program were about, by what makes them unknown.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct MentionedUnknowns {
    #[serde(with = "rows")]
    roots: BTreeMap<Unknown, Root>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Root {
    /// The block where the value first occurred.
    place: Place,
    /// Names that messages called unknown because of it, with the line of the first.
    named: BTreeMap<String, (Arc<str>, u32)>,
}

impl MentionedUnknowns {
    /// Remembers where a value first occurred.
    pub(crate) fn enter(&mut self, cause: &Unknown, place: impl FnOnce() -> Place) {
        if self.roots.len() < MAX_ROOTS && !self.roots.contains_key(cause) {
            let root = Root {
                place: place(),
                named: BTreeMap::new(),
            };
            self.roots.insert(cause.clone(), root);
        }
    }

    /// The block where a value first occurred.
    pub(crate) fn origin(&self, cause: &Unknown) -> Option<&Place> {
        self.roots.get(cause).map(|root| &root.place)
    }

    /// Whether a message names anything that no message about the same value in another block has named.
    /// A message that a loop repeats at its own place is counted, not withheld (R2.85).
    pub(crate) fn is_new(
        &mut self,
        cause: &Unknown,
        named: impl IntoIterator<Item = String>,
        place: &Place,
    ) -> bool {
        let Some(root) = self.roots.get_mut(cause) else {
            return true;
        };
        let here = (place.file.clone(), place.first_line);
        let mut is_new = false;
        for name in named {
            is_new |= *root.named.entry(name).or_insert_with(|| here.clone()) == here;
        }
        is_new
    }
}
