//! A timeline that is being written, other readers of the same records, and `run --quiet` (R9.72).

use std::cell::RefCell;
use std::fmt;
use std::io::{self, Write};
use std::ops::ControlFlow;

use crate::args::FailOn;
use crate::output::DataTarget;
use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use frictcomp::interpreter::EndedBy;
use frictcomp::timeline::{Record, Sink};
use frictcomp_report::html::RunDigest;
use frictcomp_report::{Listing, ListingFormat, Report, headline};

/// A timeline that a run writes, and that is flushed while the run waits for more of a program.
pub(crate) struct SharedReport(RefCell<Box<dyn Report>>);

impl fmt::Debug for SharedReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("SharedReport")
    }
}

impl SharedReport {
    /// Shares a timeline.
    pub(crate) fn new(report: Box<dyn Report>) -> Self {
        Self(RefCell::new(report))
    }

    /// Writes what is ready. A writer that accepts no more fails at the next record.
    pub(crate) fn flush(&self) {
        let _ = self.0.borrow_mut().flush();
    }

    /// Returns the timeline, once nothing else shares it.
    pub(crate) fn into_report(self) -> Box<dyn Report> {
        self.0.into_inner()
    }
}

/// Listeners to the records of a run: the timeline, the digest for a page, and the search for the
/// most severe message.
#[derive(Debug)]
pub(crate) struct Listeners<'a> {
    report: &'a SharedReport,
    digest: Option<&'a mut RunDigest>,
    /// The first of the most severe diagnostics.
    most_severe: Option<(Severity, Code)>,
    has_stopped: bool,
}

impl<'a> Listeners<'a> {
    /// Creates the listeners for a timeline, and possibly a digest.
    pub(crate) fn new(report: &'a SharedReport, digest: Option<&'a mut RunDigest>) -> Self {
        Self {
            report,
            digest,
            most_severe: None,
            has_stopped: false,
        }
    }

    /// Returns the first of the most severe messages.
    pub(crate) fn most_severe(&self) -> Option<Code> {
        self.most_severe.map(|(_, code)| code)
    }

    /// Returns whether an error of the control ended a program on all ways, whatever its severity (R18.1).
    pub(crate) fn has_stopped(&self) -> bool {
        self.has_stopped
    }

    fn weigh<'d>(&mut self, said: impl IntoIterator<Item = &'d Diagnostic>) {
        for diagnostic in said {
            if self
                .most_severe
                .is_none_or(|(most, _)| diagnostic.severity > most)
            {
                self.most_severe = Some((diagnostic.severity, diagnostic.code));
            }
        }
    }
}

impl Sink for Listeners<'_> {
    /// Passes on a record. A timeline reader that has seen enough ends the run, unless there is a digest.
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Block(row) => self.weigh(row.diagnostics),
            Record::End(end) => {
                self.has_stopped |= end.by == EndedBy::Error;
                self.weigh(end.notes.iter().map(|note| &note.diagnostic));
            }
            _ => {}
        }
        let flow = self.report.0.borrow_mut().record(record);
        match &mut self.digest {
            Some(digest) => digest.record(record),
            None => flow,
        }
    }

    fn takes_quiet(&mut self) -> bool {
        self.digest.is_some() || self.report.0.borrow_mut().takes_quiet()
    }
}

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

    fn takes_quiet(&mut self) -> bool {
        false
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
