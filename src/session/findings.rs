//! Every diagnostic of a program, each once, in the order of the text.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::text::Position;
use crate::timeline::{Record, Repeat, Sink};

/// Key that is equal for equal diagnostics.
type FindingKey = (Arc<str>, Position, Position, Code, String);

/// Diagnostics of a dry run: a sink that keeps each one once, however often a loop repeats it.
#[derive(Debug, Clone, Default)]
pub struct Findings {
    diagnostics: BTreeMap<FindingKey, Diagnostic>,
    /// The main program that runs.
    program: Option<Arc<str>>,
    /// Number of diagnostics by severity.
    said: BTreeMap<Severity, u64>,
}

impl Findings {
    /// The diagnostics, in the order of their places.
    pub fn diagnostics(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.values()
    }

    /// Takes out the diagnostics, in the order of their places.
    pub(super) fn into_diagnostics(self) -> impl Iterator<Item = Diagnostic> {
        self.diagnostics.into_values()
    }

    /// Returns the number of messages of each severity that a session counted beyond the limit of a
    /// file (R2.85).
    pub fn unsaid(&self, counts: &BTreeMap<Severity, u64>) -> BTreeMap<Severity, u64> {
        let unsaid = |(severity, count): (&Severity, &u64)| {
            let said = self.said.get(severity).copied().unwrap_or_default();
            (*severity, count.saturating_sub(said))
        };
        counts.iter().map(unsaid).collect()
    }

    fn add(&mut self, diagnostic: &Diagnostic) {
        *self.said.entry(diagnostic.severity).or_default() += 1;
        let place = &diagnostic.place;
        let key = (
            place.file.clone(),
            place.start(),
            place.end(),
            diagnostic.code,
            diagnostic.message.clone(),
        );
        let program = self.program.as_ref().filter(|file| **file != place.file);
        self.diagnostics.entry(key).or_insert_with(|| {
            let mut diagnostic = diagnostic.clone();
            if let Some(program) = program {
                diagnostic.reached_from.add(program);
            }
            diagnostic
        });
    }

    /// Adds to a message that is shown once how often it occurred.
    fn count(&mut self, repeat: &Repeat) {
        let from = (
            Arc::from(repeat.file.as_str()),
            repeat.start,
            repeat.start,
            Code::ALL[0],
            String::new(),
        );
        let here = self.diagnostics.range_mut(from..);
        let here = here
            .take_while(|((file, start, ..), _)| **file == *repeat.file && *start == repeat.start);
        for ((_, _, _, code, message), said) in here {
            if *code == repeat.code && *message == repeat.message {
                said.count(repeat.times);
            }
        }
    }
}

impl Sink for Findings {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Block(row) => row.diagnostics.iter().for_each(|said| self.add(said)),
            Record::End(end) => {
                end.notes.iter().for_each(|note| self.add(&note.diagnostic));
                end.repeated.iter().for_each(|repeat| self.count(repeat));
            }
            // Messages about the lists are listed once per machine, not once per program.
            Record::Machine(said) => *self.said.entry(said.severity).or_default() += 1,
            Record::Program { file, .. } => self.program = Some(Arc::from(*file)),
            Record::Session { .. } | Record::Join(_) | Record::Summary(_) => {}
        }
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::{SourceFile, Span};

    #[test]
    fn a_diagnostic_is_kept_once_and_in_the_order_of_the_text() {
        let file = SourceFile::new("a.nc", "N1 X\nN2 Y");
        let at = |start| Diagnostic::new(Code::Fc402, file.place(Span::new(start, start + 1)), "x");
        let mut findings = Findings::default();
        for start in [5, 3, 5, 0, 3] {
            findings.add(&at(start));
        }
        let starts: Vec<String> = findings
            .diagnostics()
            .map(|diagnostic| diagnostic.place.start().to_string())
            .collect();
        assert_eq!(starts, ["1:1", "1:4", "2:1"]);
    }
}
