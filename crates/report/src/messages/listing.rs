//! Diagnostics without a timeline, as `check` and `lists` print them (R9.25).

use std::io::{self, Write};
use std::ops::ControlFlow;

use crate::document::Headline;
use crate::timeline::Output;
use crate::wording::Look;
use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::timeline::ReadingsInForce;

use super::format::ListingFormat;
use super::message_format::MessageFormat;
use super::tally::{ProgramResult, Tally};

/// Writes diagnostics one after another, then their totals.
#[derive(Debug)]
pub struct Listing<W> {
    output: Output<W>,
    format: Box<dyn MessageFormat + Send>,
    tally: Tally,
}

impl<W: Write> Listing<W> {
    /// Returns a list in a format; `look` matters for text only.
    pub fn new(writer: W, format: ListingFormat, look: Look) -> Self {
        let mut output = Output::new(writer);
        let mut format = format.begin(look);
        format.open(&mut output.bytes);
        Self {
            output,
            format,
            tally: Tally::default(),
        }
    }

    /// Counts an examined file.
    pub fn file(&mut self) {
        self.tally.files += 1;
    }

    /// Counts a program with its result, and the axes that it leaves or may leave away from their start-up states, each with
    /// the result that this alone gives.
    pub fn program<'a>(
        &mut self,
        name: &str,
        result: ProgramResult,
        axes: impl IntoIterator<Item = (ProgramResult, &'a str)>,
    ) {
        for (result, axis) in axes {
            let axes = self.tally.axes.entry(result).or_default();
            axes.insert(axis.to_owned());
        }
        self.format.program(name);
        self.tally.files += 1;
        *self.tally.programs.entry(result).or_default() += 1;
    }

    /// Takes the verdict on everything (R18.20).
    pub fn headline(&mut self, headline: &Headline) {
        self.format.headline(&mut self.output.bytes, headline);
    }

    /// Counts diagnostics that are not written (R2.85).
    pub fn count(&mut self, severity: Severity, more: u64) {
        if more > 0 {
            *self.tally.counts.entry(severity).or_default() += more;
        }
    }

    /// Adds readings on which the results rest (R15.3).
    pub fn rests_on(&mut self, readings: ReadingsInForce) {
        self.tally.rests_on.extend(readings);
    }

    /// Returns the counts so far.
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// Writes one diagnostic. `Break` when the writer takes no more.
    pub fn diagnostic(&mut self, diagnostic: &Diagnostic) -> ControlFlow<()> {
        self.tally.count(diagnostic.severity);
        self.format.message(&mut self.output.bytes, diagnostic);
        self.output.settle()
    }

    /// Writes a record of another kind, in the formats that have records.
    pub fn record(&mut self, record: &serde_json::Value) {
        self.format.record(&mut self.output.bytes, record);
    }

    /// Writes the end of the list.
    ///
    /// # Errors
    /// The first error of the writer, except a closed pipe.
    pub fn finish(&mut self) -> io::Result<()> {
        self.format.close(&mut self.output.bytes, &self.tally);
        self.output.finish()
    }

    /// Returns whether the reader closed the pipe.
    pub fn is_closed(&self) -> bool {
        self.output.is_closed()
    }
}
