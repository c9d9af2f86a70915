//! A JSON object for each message, by lines or in one document.

use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::timeline::{DiagnosticRecord, ReadingsInForce};
use serde::Serialize;
use serde_json::Value;

use crate::document::Headline;
use crate::timeline::json;
use crate::wording::append_json;

use super::message_format::MessageFormat;
use super::tally::Tally;

/// Objects with the text that begins, separates and ends them.
#[derive(Debug)]
pub(super) struct Objects {
    opening: &'static [u8],
    /// Text before the next object.
    before: &'static [u8],
    between: &'static [u8],
    after: &'static [u8],
    closing: &'static [u8],
    headline: Option<Headline>,
}

impl Objects {
    /// Creates the form of one document, `{"schema":2,"records":[…]}`.
    pub(super) fn document() -> Self {
        Self {
            opening: json::OPENING,
            before: b"\n",
            between: b",\n",
            after: b"",
            closing: b"\n]}\n",
            headline: None,
        }
    }

    /// Creates the form of one object per line.
    pub(super) fn lines() -> Self {
        Self {
            opening: b"",
            before: b"",
            between: b"",
            after: b"\n",
            closing: b"",
            headline: None,
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
            append_json(out, &DiagnosticRecord::of_machine(message));
        });
    }

    fn record(&mut self, out: &mut Vec<u8>, record: &Value) {
        self.object(out, |out| {
            out.extend_from_slice(record.to_string().as_bytes());
        });
    }

    fn headline(&mut self, _out: &mut Vec<u8>, headline: &Headline) {
        self.headline = Some(headline.clone());
    }

    fn close(&mut self, out: &mut Vec<u8>, tally: &Tally) {
        let headline = self.headline.take();
        let summary = SummaryObject::new(tally, headline.as_ref());
        self.object(out, |out| append_json(out, &summary));
        out.extend_from_slice(self.closing);
    }
}

/// The verdict, the counts, and the readings on which the results rest (R15.3).
#[derive(Serialize)]
struct SummaryObject<'a> {
    record: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    headline: Option<&'a Headline>,
    files: u64,
    errors: u64,
    warnings: u64,
    infos: u64,
    #[serde(skip_serializing_if = "ReadingsInForce::is_empty")]
    rests_on: &'a ReadingsInForce,
}

impl<'a> SummaryObject<'a> {
    fn new(tally: &'a Tally, headline: Option<&'a Headline>) -> Self {
        Self {
            record: "summary",
            headline,
            files: tally.files,
            errors: tally.of(Severity::Error),
            warnings: tally.of(Severity::Warning),
            infos: tally.of(Severity::Info),
            rests_on: &tally.rests_on,
        }
    }
}
