//! The records of chapter 9.2 as JSON objects, one after another in one buffer.

use frictcomp::comp::KindSet;
use frictcomp::timeline::{Record, StateView, States};
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use super::strings::append_json;
use super::view::View;

/// Text before and after an object.
#[derive(Debug, Clone, Copy)]
pub(super) struct RecordFrame {
    pub(super) before: &'static [u8],
    pub(super) after: &'static [u8],
}

/// The text of [`States`], which stays the same over most blocks.
#[derive(Debug, Serialize, Deserialize)]
struct KeptStates {
    #[serde(skip)]
    version: u64,
    friction: Box<RawValue>,
    #[serde(skip_serializing_if = "Option::is_none")]
    compensation: Option<Box<RawValue>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    possible: Option<Box<RawValue>>,
}

impl KeptStates {
    fn of(state: StateView<'_>, kinds: KindSet) -> Self {
        let mut text = Vec::new();
        append_json(&mut text, &States::of(state, kinds));
        let kept = serde_json::from_slice(&text).expect("the keys are those of the states");
        Self {
            version: state.version,
            ..kept
        }
    }
}

/// Appends records; keeps the text of the last states.
#[derive(Debug)]
pub(super) struct Encoder {
    view: View,
    frame: RecordFrame,
    states: Option<KeptStates>,
}

impl Encoder {
    pub(super) fn new(view: View, frame: RecordFrame) -> Self {
        Self {
            view,
            frame,
            states: None,
        }
    }

    /// Appends the objects of a record, each in its frame.
    pub(super) fn append(&mut self, out: &mut Vec<u8>, record: &Record<'_>) {
        if let Record::Block(row) = record
            && !self.view.shows(row)
        {
            return;
        }
        if let Some(state) = record.state() {
            self.keep(state);
        }
        let states = record.state().and(self.states.as_ref());
        let object = record.with_states(self.view.kinds, states);
        let ends = matches!(record, Record::End(_));
        if !ends {
            self.object(out, &object);
        }
        for said in record.diagnostics() {
            self.object(out, &said);
        }
        if ends {
            self.object(out, &object);
        }
    }

    fn keep(&mut self, state: StateView<'_>) {
        if self
            .states
            .as_ref()
            .is_none_or(|kept| kept.version != state.version)
        {
            self.states = Some(KeptStates::of(state, self.view.kinds));
        }
    }

    fn object(&self, out: &mut Vec<u8>, object: &impl Serialize) {
        out.extend_from_slice(self.frame.before);
        append_json(out, object);
        out.extend_from_slice(self.frame.after);
    }
}
