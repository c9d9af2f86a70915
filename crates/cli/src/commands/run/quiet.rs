//! `run --quiet`: the messages that count for the exit status, and the verdict (R9.72).

use std::io::{self, Write};
use std::ops::ControlFlow;

use crate::args::FailOn;
use crate::output::DataTarget;
use frictcomp::diagnostic::Diagnostic;
use frictcomp::interpreter::EndedBy;
use frictcomp::timeline::{Record, Sink};
use frictcomp_report::{Listing, ListingFormat, Report, headline};

/// Lists the diagnostics that give the exit status, then the verdict.
pub(crate) struct Quiet {
    listing: Listing<Box<dyn Write + Send>>,
    fail_on: FailOn,
    /// The end of the last program.
    ended: Option<EndedBy>,
}

impl Quiet {
    /// Creates a list of what is at or above a severity.
    pub(crate) fn new(target: DataTarget, fail_on: FailOn) -> Self {
        Self {
            listing: Listing::new(target.writer, ListingFormat::Text, target.look),
            fail_on,
            ended: None,
        }
    }

    fn say<'a>(&mut self, said: impl IntoIterator<Item = &'a Diagnostic>) -> ControlFlow<()> {
        let counts = said
            .into_iter()
            .filter(|it| self.fail_on.counts(it.severity));
        for diagnostic in counts {
            self.listing.diagnostic(diagnostic)?;
        }
        ControlFlow::Continue(())
    }
}

impl Sink for Quiet {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Machine(said) => self.say([*said]),
            Record::Block(row) => self.say(row.diagnostics),
            Record::End(end) => {
                self.ended = Some(end.by);
                self.say(end.notes.iter().map(|note| &note.diagnostic))
            }
            Record::Summary(summary) => {
                if let Some(headline) = headline(summary, self.ended) {
                    self.listing.headline(&headline);
                }
                ControlFlow::Continue(())
            }
            Record::Session { .. } | Record::Program { .. } | Record::Join(_) => {
                ControlFlow::Continue(())
            }
        }
    }
}

impl Report for Quiet {
    fn flush(&mut self) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn finish(&mut self) -> io::Result<()> {
        self.listing.finish()
    }

    fn is_closed(&self) -> bool {
        self.listing.is_closed()
    }
}
