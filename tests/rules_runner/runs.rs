//! Results of programs.

use std::fmt::Write as _;
use std::ops::{ControlFlow, Range};

use frictcomp::comp::{Compensation, Kind};
use frictcomp::diagnostic::Diagnostic;
use frictcomp::timeline::{Record, Sink, StateView};

use crate::support::{Bench, SourceMode};

/// Result of a run: changes and messages by line, and the state that each program leaves.
pub(crate) struct Shown {
    text: String,
    start_up: Compensation,
    /// Whether every executed block is shown.
    with_blocks: bool,
    /// Whether advice and labels are shown.
    with_help: bool,
    is_one_of_several: bool,
    /// The lines that count; of others only messages are shown.
    rows: Range<usize>,
}

impl Shown {
    pub(crate) fn of(
        bench: &Bench,
        (programs, handed): (&[&str], SourceMode),
        parts: &str,
        rows: &Range<usize>,
    ) -> String {
        let mut shown = Self {
            rows: rows.clone(),
            text: String::new(),
            start_up: bench.machine.compensation(),
            with_blocks: parts == "blocks",
            with_help: parts == "help",
            is_one_of_several: programs.len() > 1,
        };
        bench.run_into(&mut bench.session(), (programs, handed), &mut shown);
        shown.text
    }

    fn said(&mut self, said: &Diagnostic) {
        let file = &said.place.file;
        let own = if is_main(file) { file } else { "" };
        writeln!(self.text, "    {}", message(said, own)).expect("text");
        if self.with_help {
            for line in advice(said) {
                writeln!(self.text, "        {line}").expect("text");
            }
        }
    }

    /// Returns the kinds of axes away from the start of the control, with the ways that lead there.
    fn left(&self, view: StateView<'_>) -> String {
        let mut left = Vec::new();
        for (axis, name) in view.axes() {
            for kind in Kind::ALL {
                let state = view.state(axis, kind);
                if state == self.start_up.state(axis, kind) {
                    continue;
                }
                let words = match view.possible_of(axis, kind) {
                    Some(possible) => possible.in_words("a.nc"),
                    None => state.as_str().to_owned(),
                };
                left.push(format!("{} {words}", of_kind(name, kind)));
            }
        }
        if left.is_empty() {
            left.push("as at the start".to_owned());
        }
        left.join("; ")
    }
}

/// Shows a message with its place, which names its file unless that is the own one.
pub(crate) fn message(said: &Diagnostic, own: &str) -> String {
    let place = &said.place;
    let (start, end) = (place.start(), place.end());
    let end = if end.line == start.line {
        end.column.to_string()
    } else {
        end.to_string()
    };
    let file = if &*place.file == own {
        String::new()
    } else {
        format!("{}:", place.file)
    };
    let (code, message) = (said.code, &said.message);
    let severity = if said.severity == code.severity() {
        String::new()
    } else {
        format!(" {}", said.severity)
    };
    format!("{code}{severity} {file}{start}-{end} {message}")
}

/// Returns the advice and the further places of a message.
pub(crate) fn advice(said: &Diagnostic) -> Vec<String> {
    let help = said.help().into_iter().map(|help| format!("help: {help}"));
    let labels = said.labels.iter();
    let labels = labels.map(|label| format!("{}: {}", label.place.start(), label.text));
    help.chain(labels).collect()
}

/// Returns whether it is one of the programs that are run, not one that they call.
pub(crate) fn is_main(file: &str) -> bool {
    matches!(file.as_bytes(), [b'a'..=b'z', b'.', b'n', b'c'])
}

/// Returns an axis, with the kind of compensation where it is not friction.
fn of_kind(axis: &str, kind: Kind) -> String {
    match kind {
        Kind::Frict => axis.to_owned(),
        kind => format!("{axis} {}", kind.as_str()),
    }
}

impl Sink for Shown {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Machine(said) => self.said(said),
            Record::Program { file, .. } if self.is_one_of_several => {
                writeln!(self.text, "{file}").expect("text");
            }
            Record::Block(row) => {
                let changes: Vec<String> = (row.changes.iter())
                    .map(|change| {
                        let axis = of_kind(row.state.name(change.axis), change.kind);
                        format!("{axis} {}", change.to.as_str())
                    })
                    .collect();
                let file = if is_main(row.file) { "" } else { row.file };
                let counts = !file.is_empty() || self.rows.contains(&(row.line as usize - 1));
                let is_shown = self.with_blocks || !changes.is_empty() && counts;
                if is_shown || !row.diagnostics.is_empty() {
                    let line = format!(
                        "{file}{}{}",
                        if file.is_empty() { "" } else { ":" },
                        row.line
                    );
                    let changes = changes.join(", ");
                    writeln!(self.text, "{}", format!("{line:>3}  {changes}").trim_end())
                        .expect("text");
                }
                for said in row.diagnostics {
                    self.said(said);
                }
            }
            Record::End(end) => {
                for note in end.notes {
                    self.said(&note.diagnostic);
                }
                for repeat in end.repeated {
                    let (code, line, times) = (repeat.code, repeat.line, repeat.times);
                    writeln!(self.text, "    {code} in line {line}, {times} times").expect("text");
                }
                let left = self.left(end.state);
                writeln!(self.text, "{}  {left}", end.by.as_str()).expect("text");
            }
            Record::Summary(summary) => {
                for (word, times) in summary.opaque {
                    writeln!(self.text, "passed over: {word}, {times} times").expect("text");
                }
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}
