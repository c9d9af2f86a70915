//! A JSON object for each message, by lines or in one document.

use serde_json::Value;

use crate::json;
use crate::records::{append_diagnostic, append_rests_on};
use crate::strings::integer;
use frictcomp::diagnostic::{Diagnostic, Severity};

use super::message_format::MessageFormat;
use super::tally::Tally;

/// Objects between what begins, separates and ends them.
#[derive(Debug)]
pub(super) struct Objects {
    opening: &'static [u8],
    /// Text before the next object.
    before: &'static [u8],
    between: &'static [u8],
    after: &'static [u8],
    closing: &'static [u8],
}

impl Objects {
    /// One document, `{"schema":2,"records":[…]}`.
    pub(super) fn document() -> Self {
        Self {
            opening: json::OPENING,
            before: b"\n",
            between: b",\n",
            after: b"",
            closing: b"\n]}\n",
        }
    }

    /// An object a line.
    pub(super) fn lines() -> Self {
        Self {
            opening: b"",
            before: b"",
            between: b"",
            after: b"\n",
            closing: b"",
        }
    }

    fn object(&mut self, out: &mut Vec<u8>, append: impl FnOnce(&mut Vec<u8>)) {
        out.extend_from_slice(self.before);
        append(out);
        out.extend_from_slice(self.after);
        self.before = self.between;
    }
}

impl MessageFormat for Objects {
    fn open(&mut self, out: &mut Vec<u8>) {
        out.extend_from_slice(self.opening);
    }

    fn message(&mut self, out: &mut Vec<u8>, message: &Diagnostic) {
        self.object(out, |out| {
            out.extend_from_slice(b"{\"record\":\"diagnostic\"");
            append_diagnostic(out, message);
            out.push(b'}');
        });
    }

    fn record(&mut self, out: &mut Vec<u8>, record: &Value) {
        self.object(out, |out| {
            out.extend_from_slice(record.to_string().as_bytes());
        });
    }

    fn close(&mut self, out: &mut Vec<u8>, tally: &Tally) {
        self.object(out, |out| append_tally(out, tally));
        out.extend_from_slice(self.closing);
    }
}

fn append_tally(out: &mut Vec<u8>, tally: &Tally) {
    out.extend_from_slice(b"{\"record\":\"summary\",\"files\":");
    integer(out, tally.files);
    out.extend_from_slice(b",\"errors\":");
    integer(out, tally.of(Severity::Error));
    out.extend_from_slice(b",\"warnings\":");
    integer(out, tally.of(Severity::Warning));
    out.extend_from_slice(b",\"infos\":");
    integer(out, tally.of(Severity::Info));
    append_rests_on(out, &tally.rests_on);
    out.push(b'}');
}
