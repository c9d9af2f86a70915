//! The texts for states that are unknown because ways differ (R14.2), each kept once.

use std::collections::HashMap;
use std::sync::Arc;

use frictcomp::comp::{AxisIndex, Kind, State};
use frictcomp::timeline::StateView;

/// Texts that are kept of a session.
const MAX_TEXTS: usize = 4000;

/// The number of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct WaysIndex(usize);

/// A state, and the possible states if ways differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct StateOnWays {
    /// The state.
    pub(super) state: State,
    /// Possible states in place of `unknown`, in words.
    pub(super) ways: Option<WaysIndex>,
}

/// The texts of a session.
#[derive(Debug, Default)]
pub(super) struct Ways {
    texts: Vec<Arc<str>>,
    numbers: HashMap<Arc<str>, WaysIndex>,
}

impl Ways {
    /// Returns the state of a kind on an axis, as seen from a file.
    pub(super) fn find(
        &mut self,
        view: StateView<'_>,
        (axis, kind): (AxisIndex, Kind),
        file: &str,
    ) -> StateOnWays {
        let possible = view.possible_of(axis, kind);
        StateOnWays {
            state: view.state(axis, kind),
            ways: possible.and_then(|it| self.number(it.in_words(file))),
        }
    }

    fn number(&mut self, text: String) -> Option<WaysIndex> {
        if let Some(number) = self.numbers.get(text.as_str()) {
            return Some(*number);
        }
        if self.texts.len() >= MAX_TEXTS {
            return None;
        }
        let (number, text) = (WaysIndex(self.texts.len()), Arc::from(text));
        self.texts.push(Arc::clone(&text));
        self.numbers.insert(text, number);
        Some(number)
    }

    /// Returns a text.
    pub(super) fn text(&self, number: WaysIndex) -> &str {
        self.texts.get(number.0).map_or("", AsRef::as_ref)
    }
}
