//! The records of chapter 9.2 as JSON objects, one after another in one buffer.

use frictcomp::interpreter::EndedBy;
use frictcomp::timeline::{Record, Row, States};
use serde::Serialize;

use super::text::headline;
use super::view::View;
use crate::wording::{KeptText, append_json, append_json_text, integer};

/// Text before and after an object.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RecordFrame {
    pub(crate) before: &'static [u8],
    pub(crate) after: &'static [u8],
}

/// Appends records; keeps the text of what stays the same over most blocks.
#[derive(Debug)]
pub(crate) struct Encoder {
    view: View,
    frame: RecordFrame,
    file: KeptText<String>,
    /// The states of a version.
    states: KeptText<u64>,
    /// The end of the last program, which the verdict names.
    ended: Option<EndedBy>,
}

impl Encoder {
    pub(crate) fn new(view: View, frame: RecordFrame) -> Self {
        Self {
            view,
            frame,
            file: KeptText::default(),
            states: KeptText::default(),
            ended: None,
        }
    }

    /// Appends the objects of a record, each in its frame.
    pub(crate) fn append(&mut self, out: &mut Vec<u8>, record: &Record<'_>) {
        if let Record::Block(row) = record {
            if !self.view.shows(row) {
                return;
            }
            if is_plain(row) {
                return self.plain_block(out, row);
            }
        }
        let object = record.with_states(self.view.kinds);
        let end = match record {
            Record::End(end) => Some(end.by),
            _ => None,
        };
        self.ended = end.or(self.ended);
        if end.is_none() {
            self.object(out, &object);
        }
        for said in record.diagnostics() {
            self.object(out, &said);
        }
        if end.is_some() {
            self.object(out, &object);
        }
        if let Record::Summary(summary) = record
            && let Some(verdict) = headline(summary, self.ended)
        {
            out.truncate(out.len() - self.frame.after.len() - b"}".len());
            out.extend_from_slice(br#","headline":"#);
            append_json(out, &verdict);
            out.push(b'}');
            out.extend_from_slice(self.frame.after);
        }
    }

    /// Appends a plain block from its pieces: the same bytes as those of its serialised form.
    fn plain_block(&mut self, out: &mut Vec<u8>, row: &Row<'_>) {
        out.extend_from_slice(self.frame.before);
        out.extend_from_slice(br#"{"record":"block","program":"#);
        integer(out, row.program);
        out.extend_from_slice(br#","seq":"#);
        integer(out, row.seq);
        out.extend_from_slice(self.file.of(row.file, |out| {
            out.extend_from_slice(br#","file":"#);
            append_json_text(out, row.file);
            out.extend_from_slice(br#","line":"#);
        }));
        integer(out, row.line);
        out.extend_from_slice(br#","n":"#);
        match row.number {
            Some(number) => integer(out, number),
            None => out.extend_from_slice(b"null"),
        }
        if let Some(level) = row.level {
            out.extend_from_slice(br#","level":"#);
            integer(out, level);
        }
        out.extend_from_slice(br#","text":"#);
        append_json_text(out, row.text);
        out.extend_from_slice(self.states.of(&row.state.version, |out| {
            out.extend_from_slice(br#","changes":[]"#);
            let start = out.len();
            append_json(out, &States::of(row.state, self.view.kinds));
            out[start] = b',';
        }));
        out.extend_from_slice(self.frame.after);
    }

    fn object(&self, out: &mut Vec<u8>, object: &impl Serialize) {
        out.extend_from_slice(self.frame.before);
        append_json(out, object);
        out.extend_from_slice(self.frame.after);
    }
}

/// Returns whether a block is executed on every way, changes nothing, and has no message.
fn is_plain(row: &Row<'_>) -> bool {
    row.branch.is_none() && row.changes.is_empty() && row.diagnostics.is_empty()
}
