//! The records of chapter 9.2 as JSON objects, one after another in one buffer.

use frictcomp::timeline::{Record, States};
use serde::Serialize;

use super::strings::append_json;
use super::view::View;

/// Text before and after an object.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub(super) before: &'static [u8],
    pub(super) after: &'static [u8],
}

/// Appends records.
#[derive(Debug)]
pub(super) struct Encoder {
    view: View,
    frame: Frame,
}

impl Encoder {
    pub(super) fn new(view: View, frame: Frame) -> Self {
        Self { view, frame }
    }

    /// Appends the objects of a record, each in its frame.
    pub(super) fn append(&mut self, out: &mut Vec<u8>, record: &Record<'_>) {
        if let Record::Block(row) = record
            && !self.view.shows(row)
        {
            return;
        }
        let states = record.state();
        let states = states.map(|state| States::of(state, self.view.kinds));
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

    fn object(&self, out: &mut Vec<u8>, object: &impl Serialize) {
        out.extend_from_slice(self.frame.before);
        append_json(out, object);
        out.extend_from_slice(self.frame.after);
    }
}
