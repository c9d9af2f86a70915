//! The records of a session as one JSON document.

use std::io::Write;
use std::ops::ControlFlow;

use frictcomp::timeline::{Record, Sink};

use super::output::{Gathered, Output};
use super::records::{Encoder, RecordFrame};
use super::view::View;

/// Text before the first record.
pub(crate) const OPENING: &[u8] = b"{\"schema\":2,\"records\":[";

/// Writes records as one document, `{"schema":2,"records":[…]}`, one record per line.
#[derive(Debug)]
pub struct Json<W> {
    output: Output<W>,
    encoder: Encoder,
    /// Offset of the records in the first chunk; `None` once one was written.
    start: Option<usize>,
}

impl<W: Write> Json<W> {
    /// A timeline in one document.
    pub fn new(writer: W, view: View) -> Self {
        let frame = RecordFrame {
            before: b",\n",
            after: b"",
        };
        let mut output = Output::new(writer);
        output.bytes.extend_from_slice(OPENING);
        Self {
            start: Some(OPENING.len()),
            output,
            encoder: Encoder::new(view, frame),
        }
    }
}

impl<W: Write> Sink for Json<W> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        self.encoder.append(&mut self.output.bytes, record);
        if let Some(start) = self.start
            && self.output.bytes.len() > start
        {
            // The first record has no comma before it.
            self.output.bytes.remove(start);
            self.start = None;
        }
        match record {
            Record::End(_) | Record::Summary(_) => self.output.flush(),
            _ => self.output.settle(),
        }
    }
}

impl<W: Write> Gathered for Json<W> {
    type Writer = W;

    fn output(&self) -> &Output<W> {
        &self.output
    }

    fn output_mut(&mut self) -> &mut Output<W> {
        &mut self.output
    }

    /// The opening waits for the first record.
    fn may_go_out(&self) -> bool {
        self.start.is_none()
    }

    fn close(&mut self) {
        self.output.bytes.extend_from_slice(b"\n]}\n");
    }
}
