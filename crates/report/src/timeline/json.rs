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
}

impl<W: Write> Json<W> {
    /// Returns a timeline in one document.
    pub fn new(writer: W, view: View) -> Self {
        let frame = RecordFrame {
            before: b",\n",
            after: b"",
        };
        let mut output = Output::new(writer);
        output.bytes.extend_from_slice(OPENING);
        // The opening waits for the first record.
        output.open = Some(0);
        Self {
            output,
            encoder: Encoder::new(view, frame),
        }
    }
}

impl<W: Write> Sink for Json<W> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        self.encoder.append(&mut self.output.bytes, record);
        if self.output.open.is_some() && self.output.bytes.len() > OPENING.len() {
            // The first record has no comma before it.
            self.output.bytes.remove(OPENING.len());
            self.output.open = None;
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

    fn close(&mut self) {
        self.output.bytes.extend_from_slice(b"\n]}\n");
    }
}
