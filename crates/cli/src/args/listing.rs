//! Diagnostics as `check` and `lists` list them: the selection, and the format.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};

use super::fail_on::{FailOn, FailOnArgs, SeverityArgs};
use super::values;
use crate::output::{Console, DataTarget, Failure, Printed, RecordsFormat};
use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use frictcomp::drive_interface::DriveReport;
use frictcomp::lists::{AxisType, Origin, Parameter};
use frictcomp::machine::AxisReport;
use frictcomp::timeline::{FeedMoves, ReadingsInForce};
use frictcomp_report::results::drives::drive_record;
use frictcomp_report::{Headline, Listing, ListingFormat, ProgramResult, Tally, feed_moves_text};

/// Options for listing diagnostics.
#[derive(Debug, Clone, Args)]
pub(crate) struct ListingArgs {
    /// The format of the messages
    #[arg(long, default_value = "text", value_parser = values::listing_format())]
    pub(crate) format: ListingFormat,
    /// Write the messages to this file
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    fail_on: FailOnArgs,
    /// Print only the messages that count for the exit status, then the verdict
    #[arg(long, short)]
    pub(crate) quiet: bool,
    /// Count the messages by code instead of listing them
    #[arg(long)]
    pub(crate) statistics: bool,
    #[command(flatten)]
    pub(crate) severities: SeverityArgs,
}

/// Returns the format of counts; the formats that are for diagnostics alone are refused.
fn format_of_counts(format: ListingFormat) -> Result<RecordsFormat, Failure> {
    if format.is_for_diagnostics() {
        return Err(Failure::new(
            "`--format github` and `sarif` are for diagnostics, not for statistics",
        )
        .with_help("write `--format text`, `concise`, `json` or `ndjson`"));
    }
    Ok(match format {
        ListingFormat::Json => RecordsFormat::Json,
        ListingFormat::Ndjson => RecordsFormat::Ndjson,
        _ => RecordsFormat::Text,
    })
}

impl ListingArgs {
    /// Returns a console that reports as much as the user asked for.
    pub(crate) fn console(&self, console: Console) -> Result<Console, Failure> {
        if self.quiet {
            console.quiet()
        } else {
            Ok(console)
        }
    }

    /// Begins the list.
    pub(crate) fn lister(&self, target: DataTarget) -> Result<Lister<'_>, Failure> {
        let (format, look) = (self.format, target.look);
        let (writer, counted): (Box<dyn Write + Send>, _) = if self.statistics {
            let format = format_of_counts(self.format)?;
            (Box::new(io::sink()), Some((target, format)))
        } else {
            (target.writer, None)
        };
        Ok(Lister {
            args: self,
            fail_on: self.fail_on.judging(),
            listing: Listing::new(writer, format, look),
            counted,
            counts: BTreeMap::new(),
            uncompensated: BTreeMap::new(),
            unknown: BTreeSet::new(),
            headline: None,
        })
    }
}

/// A list that is being written.
pub(crate) struct Lister<'a> {
    args: &'a ListingArgs,
    fail_on: FailOn,
    listing: Listing<Box<dyn Write + Send>>,
    /// Destination of the counts, in place of the list.
    counted: Option<(DataTarget, RecordsFormat)>,
    counts: BTreeMap<(Code, Severity), u64>,
    /// Feed moves without compensation, by the names of the axes.
    uncompensated: BTreeMap<String, Uncompensated>,
    /// States that are not known.
    unknown: BTreeSet<String>,
    /// The verdict.
    headline: Option<Headline>,
}

/// The feed moves of an axis without compensation, in all programs (R13.12).
#[derive(Debug, Clone, Default)]
pub(crate) struct Uncompensated {
    pub(crate) axis_type: AxisType,
    pub(crate) moves: FeedMoves,
    programs: u64,
}

impl Uncompensated {
    /// Creates the feed moves of one program.
    pub(crate) fn of_program(axis_type: AxisType, moves: FeedMoves) -> Self {
        Self {
            axis_type,
            moves,
            programs: 1,
        }
    }
}

impl Lister<'_> {
    /// Counts a file that was examined.
    pub(crate) fn file(&mut self) {
        self.listing.file();
    }

    /// Counts a program with its result, and the axes that it leaves or may leave away from their start-up states, each with
    /// the result that this alone gives.
    pub(crate) fn program<'a>(
        &mut self,
        name: &str,
        result: ProgramResult,
        axes: impl IntoIterator<Item = (ProgramResult, &'a str)>,
    ) {
        self.listing.program(name, result, axes);
    }

    /// Writes the verdict as the last line of a text (R18.20).
    pub(crate) fn headline(&mut self, headline: Headline) {
        self.listing.headline(&headline);
        self.headline = Some(headline);
    }

    /// Lists a diagnostic. `Break` when the writer accepts no more.
    pub(crate) fn diagnostic(&mut self, said: &Diagnostic) -> ControlFlow<()> {
        if self.args.quiet && !self.fail_on.counts(said.severity) {
            return ControlFlow::Continue(());
        }
        *self.counts.entry((said.code, said.severity)).or_default() += 1;
        self.listing.diagnostic(said)
    }

    /// Adds the feed moves of an axis in a program.
    pub(crate) fn feed_moves(&mut self, axis: String, of_program: &Uncompensated) {
        let axis = self.uncompensated.entry(axis).or_default();
        axis.axis_type = of_program.axis_type;
        axis.moves.append(&of_program.moves);
        axis.programs += of_program.programs;
    }

    /// Takes states that are not known.
    pub(crate) fn unknown(&mut self, states: BTreeSet<String>) {
        self.unknown.extend(states);
    }

    /// Adds readings on which the results depend (R15.3).
    pub(crate) fn rests_on(&mut self, readings: ReadingsInForce) {
        self.listing.rests_on(readings);
    }

    /// Returns the remark on unknown states, where they count for the exit status.
    pub(crate) fn unknown_remark(&self) -> Option<String> {
        self.fail_on.unknown_remark(&self.unknown)
    }

    /// Counts diagnostics that are too many to be listed (R2.85).
    pub(crate) fn count(&mut self, severity: Severity, more: u64) {
        if !self.args.quiet || self.fail_on.counts(severity) {
            self.listing.count(severity, more);
        }
    }

    /// Lists effective parameters, where the format has records.
    pub(crate) fn parameters(&mut self, reports: &[AxisReport]) {
        for report in reports {
            for row in &report.parameters {
                self.listing.record(&parameter(report, row));
            }
        }
    }

    /// Lists what is known about drives, where the format has records.
    pub(crate) fn drives(&mut self, reports: &[DriveReport]) {
        for report in reports {
            self.listing.record(&drive_record(report));
        }
    }

    /// Writes a record of another kind, where the format has records.
    pub(crate) fn record(&mut self, record: &Value) {
        self.listing.record(record);
    }

    /// Writes the end of the list.
    pub(crate) fn finish(&mut self) -> Result<Printed, Failure> {
        self.listing.finish().map_err(Failure::output)?;
        if let Some((target, format)) = &mut self.counted {
            let counts = &self.counts;
            let rows = counts
                .iter()
                .map(|((code, severity), count)| row(*code, *severity, *count));
            let costs = self.uncompensated.iter();
            let costs = costs.filter_map(|(axis, of)| cost(axis, of));
            let headline = self.headline.iter().map(|it| format!("{it}\n"));
            let text: String = rows.chain(costs).chain(headline).collect();
            let values = counts.iter();
            let values = values.map(|((code, severity), count)| record(*code, *severity, *count));
            let costs = self.uncompensated.iter();
            let costs = costs.map(|(axis, of)| cost_record(axis, of));
            let values: Vec<Value> = values.chain(costs).collect();
            return target.text(&format.records(&text, &values));
        }
        Ok(if self.listing.is_closed() {
            Printed::Unread
        } else {
            Printed::Read
        })
    }

    /// Returns the totals of the list.
    pub(crate) fn tally(&self) -> &Tally {
        self.listing.tally()
    }

    /// Returns the exit status that the list gives.
    pub(crate) fn status(&self) -> u8 {
        let status = self.fail_on.status(&self.tally().counts);
        status.max(self.fail_on.unknown_status(&self.unknown))
    }

    /// Returns the hint to more about the messages, once (R9.79).
    pub(crate) fn hint(&self) -> Option<String> {
        let codes = self.counts.keys();
        let most_severe =
            codes.max_by_key(|(code, severity)| (*severity, std::cmp::Reverse(*code)));
        most_severe.map(|(code, _)| explain(*code))
    }
}

/// Returns the hint to the page of a code (R9.79).
pub(crate) fn explain(code: Code) -> String {
    format!("`frictcomp explain {code}` says more about {code}")
}

fn row(code: Code, severity: Severity, count: u64) -> String {
    let (word, title) = (severity.as_str(), code.title());
    format!("{count:>7}  {word:<7}  {:<12}  {title}\n", code.as_str())
}

fn parameter(report: &AxisReport, row: &Parameter) -> Value {
    let (file, line) = match &row.origin {
        Origin::File { file, line } | Origin::Enabled { file, line } => {
            (Some(&**file), Some(*line))
        }
        Origin::Default | Origin::Assumed => (None, None),
    };
    json!({
        "record": "parameter",
        "axis": report.axis,
        "number": row.number,
        "key": row.key,
        "value": row.value,
        "unit": row.unit,
        "origin": match &row.origin {
            Origin::Default => "default",
            Origin::Assumed | Origin::Enabled { .. } => "assumed",
            Origin::File { .. } => "file",
        },
        "file": file,
        "line": line,
    })
}

fn record(code: Code, severity: Severity, count: u64) -> Value {
    json!({
        "record": "statistic",
        "code": code.as_str(),
        "severity": severity.as_str(),
        "count": count,
        "title": code.title(),
    })
}

/// Returns the moves of an axis without compensation in the programs.
fn cost(axis: &str, of: &Uncompensated) -> Option<String> {
    let text = feed_moves_text(&of.moves, of.axis_type)?;
    let plural = if of.programs == 1 { "" } else { "s" };
    Some(format!(
        "{axis}{text}, in {} program{plural}\n",
        of.programs
    ))
}

fn cost_record(axis: &str, of: &Uncompensated) -> Value {
    let mut record = json!({ "record": "uncompensated", "axis": axis, "programs": of.programs });
    if let (Value::Object(record), Value::Object(moves)) = (&mut record, json!(of.moves)) {
        record.extend(moves);
    }
    record
}

/// Returns the remark on files that are not programs.
pub(crate) fn passed_over(files: usize) -> String {
    match files {
        0 => String::new(),
        1 => "; 1 other file passed over".to_owned(),
        several => format!("; {several} other files passed over"),
    }
}

/// Returns the totals in one line.
pub(crate) fn total(tally: &Tally) -> String {
    let count = |number: u64, noun: &str| {
        let plural = if number == 1 { "" } else { "s" };
        format!("{number} {noun}{plural}")
    };
    format!(
        "{} checked: {}, {}, {}",
        count(tally.files, "file"),
        count(tally.of(Severity::Error), "error"),
        count(tally.of(Severity::Warning), "warning"),
        count(tally.of(Severity::Info), "info"),
    )
}
