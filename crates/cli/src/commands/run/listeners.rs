//! A timeline that is being written, and other readers of the same records.

use std::cell::RefCell;
use std::fmt;
use std::ops::ControlFlow;

use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use frictcomp::interpreter::EndedBy;
use frictcomp::timeline::{Record, Sink};
use frictcomp_report::Report;
use frictcomp_report::html::RunDigest;

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

    /// Whether an error of the control ended a program on all ways, whatever its severity (R18.1).
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
}
