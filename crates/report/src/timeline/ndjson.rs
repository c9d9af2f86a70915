//! One JSON object per line.

use std::io::Write;
use std::ops::ControlFlow;

use frictcomp::timeline::{Record, Sink};

use super::output::{Gathered, Output};
use super::records::{Encoder, RecordFrame};
use super::view::View;

/// Writes records as newline-delimited JSON.
#[derive(Debug)]
pub struct Ndjson<W> {
    output: Output<W>,
    encoder: Encoder,
}

impl<W: Write> Ndjson<W> {
    /// Returns a timeline of JSON lines.
    pub fn new(writer: W, view: View) -> Self {
        let frame = RecordFrame {
            before: b"",
            after: b"\n",
        };
        Self {
            output: Output::new(writer),
            encoder: Encoder::new(view, frame),
        }
    }
}

impl<W: Write> Sink for Ndjson<W> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        self.encoder.append(&mut self.output.bytes, record);
        match record {
            Record::End(_) | Record::Summary(_) => self.output.flush(),
            _ => self.output.settle(),
        }
    }
}

impl<W: Write> Gathered for Ndjson<W> {
    type Writer = W;

    fn output(&self) -> &Output<W> {
        &self.output
    }

    fn output_mut(&mut self) -> &mut Output<W> {
        &mut self.output
    }
}
