//! Every diagnostic of a program, each once, in the order of the text; the comment that allows it there (R9.24, R12.5), and
//! the fixes that may be made without a review (R9.82).

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::diagnostic::{Code, Diagnostic, Fix, Safety, Severity};
use crate::syntax::{MAX_LINE, allow, goes_on};
use crate::text::{Position, SourceFile, Span};
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

    fn takes_quiet(&mut self) -> bool {
        false
    }
}

/// The change of a program that silences a message of it: a comment in its block, or above a block
/// of several lines or one that would have more than 4000 characters. `None` for what cannot be silenced, the numbers of the control, budgets,
/// messages about such comments, about `%` lines, about files as a whole and about comments that hide what follows them,
/// and for a message whose lines are not those of the file.
pub fn allow_here(said: &Diagnostic, program: &SourceFile) -> Option<Fix> {
    let is_comment = matches!(said.code, Code::Fc414 | Code::Fc490 | Code::Fc491);
    let is_of_file = matches!(said.code, Code::Fc103 | Code::Fc104 | Code::Fc105);
    if said.code.is_controller() || said.code.is_budget() || is_comment || is_of_file {
        return None;
    }
    let (text, lines) = (program.text(), program.lines());
    let meant = program.find(&said.place)?;
    let of = |line: u32| lines.line_span(text, line);
    let goes_on = |line: u32| goes_on(of(line).of(text));
    let last = lines
        .first()
        .saturating_add(u32::try_from(lines.lines()).ok()?)
        - 1;
    let (mut first, mut end) = (lines.line(meant.start), lines.line(meant.end));
    while first > lines.first() && goes_on(first - 1) {
        first -= 1;
    }
    while end < last && goes_on(end) {
        end += 1;
    }
    if of(first).of(text).trim_start().starts_with('%') {
        return None;
    }
    let block = of(first).of(text);
    let inside = (first == end).then(|| allow::insertion(block, said.code));
    let inside = inside.filter(|(_, comment)| block.len() + comment.len() <= MAX_LINE);
    let (offset, comment) = inside.unwrap_or_else(|| (0, allow::line_above(said.code)));
    let at = of(first).start as usize + offset;
    Some(Fix::safe(program.place(Span::new(at, at)), comment))
}

/// The safe changes that one run proposes, and the files that it saw: a sink.
#[derive(Debug, Clone, Default)]
pub struct ProposedFixes {
    files: BTreeSet<Arc<str>>,
    /// The file of the last block.
    last: Option<Arc<str>>,
    fixes: HashMap<Fix, Code>,
}

impl ProposedFixes {
    fn see(&mut self, file: &str) {
        if self.last.as_deref() != Some(file) {
            let file: Arc<str> = file.into();
            self.files.insert(Arc::clone(&file));
            self.last = Some(file);
        }
    }

    /// Takes the first safe change of a message; the others would do the same in another way.
    fn take(&mut self, said: &Diagnostic) {
        let mut safe = said.fixes.iter().filter(|it| it.safety == Safety::Safe);
        if let Some(fix) = safe.next() {
            self.files.insert(Arc::clone(&fix.place.file));
            self.fixes.insert(fix.clone(), said.code);
        }
    }
}

impl Sink for ProposedFixes {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if let Record::Block(row) = record {
            self.see(row.file);
        }
        for said in record.diagnostics() {
            self.take(said.diagnostic());
        }
        ControlFlow::Continue(())
    }
}

/// The safe changes that apply to all runs of some programs, file by file.
#[derive(Debug, Clone, Default)]
pub struct SafeFixes {
    files: BTreeMap<Arc<str>, FileFixes>,
}

#[derive(Debug, Clone, Default)]
struct FileFixes {
    /// Number of runs that executed the file.
    runs: usize,
    /// Each change, its code, and how many runs propose it.
    proposed: HashMap<Fix, (Code, usize)>,
}

impl SafeFixes {
    /// Adds the changes that one run proposes.
    pub fn add(&mut self, run: ProposedFixes) {
        for file in run.files {
            self.files.entry(file).or_default().runs += 1;
        }
        for (fix, code) in run.fixes {
            let file = self.files.entry(Arc::clone(&fix.place.file)).or_default();
            file.proposed.entry(fix).or_insert((code, 0)).1 += 1;
        }
    }

    /// The changes of each file. A comment that silences nothing in one run may be needed in
    /// another one that calls the same program: it goes only if no run needs it.
    pub fn of_files(self) -> impl Iterator<Item = (Arc<str>, Vec<Fix>)> {
        let files = self.files.into_iter().map(|(name, file)| {
            let holds = |(code, runs): (Code, usize)| code != Code::Fc490 || runs == file.runs;
            let proposed = file.proposed.into_iter();
            let fixes = proposed.filter_map(|(fix, by)| holds(by).then_some(fix));
            (name, fixes.collect::<Vec<_>>())
        });
        files.filter(|(_, fixes)| !fixes.is_empty())
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
