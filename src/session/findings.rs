//! The messages of programs.
//!
//! Every diagnostic of a program, each once, in the order of the text; the comment that allows it there (R9.24, R12.5), and the fixes
//! that may be made without a review (R9.82). A message in a loop is reported once per place, with the number of its repetitions, and
//! the messages of a file are limited (R2.85). Remarks on a whole program: FC326, it is plainly one of another control (R2.97); the
//! machine is not described (R1.37). Those of many programs are reported one a cause (R17.1).

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::diagnostic::{Advice, Code, Diagnostic, Fix, Safety, Severity};
use crate::machine::Machine;
use crate::syntax::{Foreign, MAX_LINE, allow, foreign, goes_on};
use crate::text::{Place, Position, SourceFile, Span, StartsInOrder, lines_of};
use crate::timeline::{EndNote, Record, Repeat, Sink};

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
    /// Returns the diagnostics, in the order of their places.
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

/// Returns the change of a program that silences a message of it: a comment in its block, or above a block of several
/// lines or one that would have more than 4000 characters. `None` for what cannot be silenced, the numbers of the
/// control, budgets, messages about such comments, about `%` lines, about files as a whole and about comments that hide
/// what follows them, and for a message whose lines are not those of the file.
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

    /// Returns the changes of each file. A comment that silences nothing in one run may be needed in another one that
    /// calls the same program: it goes only if no run needs it.
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

/// Number of messages about such a file: this one and 20 others.
pub(super) const MAX_SAID: usize = 21;

/// Looks at the head of a program.
pub(super) fn look(file: &str, head: &str) -> Option<Diagnostic> {
    let found = foreign(head)?;
    let mut lines = lines_of(head).zip(1..);
    let (line, number) = lines.find(|(line, _)| !line.trim().is_empty())?;
    let place = Place {
        file: file.into(),
        text: line.trim_end().into(),
        first_line: number,
        span: Span::new(0, line.trim_end().len()),
    };
    let Foreign {
        dialect,
        words,
        blocks,
        of,
    } = found;
    let words = words.join("`, `");
    let message = format!(
        "this is a program for {dialect}, not for an ISG control: {blocks} of the first {of} blocks have words such as `{words}`"
    );
    let help = "its other messages are meaningless; leave the program out, or translate it";
    Some(Diagnostic::new(Code::Fc326, place, message).with_help(help))
}

/// Says that no machine is described, and how to mend it for the axes that the programs switch.
/// `None` where one is.
pub fn undescribed(machine: &Machine, switched: &[String]) -> Option<Advice> {
    (!machine.is_described()).then(|| Advice::DescribeMachine(switched.to_vec()))
}

/// Key by which two messages have one cause (R17.3). The message names the kind of compensation.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
struct CauseKey {
    file: Arc<str>,
    first_line: u32,
    span: Span,
    code: Code,
    severity: Severity,
    axis: Option<String>,
    message: String,
}

impl CauseKey {
    fn of(said: &Diagnostic) -> Self {
        if said.code == Code::Fc408 {
            // A missing description of an axis is one cause, whichever block switches it (R18.2).
            return Self {
                file: Arc::default(),
                first_line: 0,
                span: Span::default(),
                code: said.code,
                severity: said.severity,
                axis: said.axis.clone(),
                message: said.help().join("\n"),
            };
        }
        Self {
            file: Arc::clone(&said.place.file),
            first_line: said.place.first_line,
            span: said.place.span,
            code: said.code,
            severity: said.severity,
            axis: said.axis.clone(),
            message: said.uncounted().to_owned(),
        }
    }
}

/// The messages of many programs: those that arise at the same block of a called program are one,
/// with the programs that reach it (R17.1).
///
/// ```
/// use frictcomp::machine::Machine;
/// use frictcomp::session::{Causes, SessionOptions};
/// use frictcomp::interpreter::NoFiles;
/// use frictcomp::text::SourceFile;
///
/// let mut causes = Causes::default();
/// for name in ["a.nc", "b.nc"] {
///     let program = SourceFile::new(name, "N10 Y[COMP ON FRICT]\nN20 M30\n");
///     let (machine, options) = (Machine::enabled(["X"]), SessionOptions::default());
///     causes.add(frictcomp::check(program, machine, options, &mut NoFiles));
/// }
/// // Each has its own block, so these are two.
/// assert_eq!(causes.diagnostics().len(), 2);
/// ```
#[derive(Debug, Clone, Default)]
pub struct Causes {
    said: Vec<Diagnostic>,
    known: HashMap<CauseKey, usize>,
}

impl Causes {
    /// Adds the messages of one program; returns their positions among [`diagnostics`](Self::diagnostics).
    pub fn add(&mut self, findings: Findings) -> Vec<usize> {
        let said = findings.into_diagnostics();
        said.map(|said| self.say(said)).collect()
    }

    /// Adds one message, for example about a list; returns its position.
    pub fn say(&mut self, said: Diagnostic) -> usize {
        let next = self.said.len();
        let at = *self.known.entry(CauseKey::of(&said)).or_insert(next);
        let Some(known) = self.said.get_mut(at) else {
            self.said.push(said);
            return at;
        };
        if known.place != said.place {
            return at;
        }
        known.reached_from.append(&said.reached_from);
        if said.times > known.times {
            (known.times, known.message) = (said.times, said.message);
        }
        // The changes that remain serve all the programs.
        known.fixes.retain(|fix| said.fixes.contains(fix));
        at
    }

    /// Returns the messages, in the order in which they were said first.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.said
    }
}

/// Different messages of one code at one place; further ones count with the last.
const MAX_AT_A_PLACE: usize = 16;

/// Decision on a message: written or left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DedupVerdict {
    /// Message that is new.
    Say,
    /// Message that was reported at this place before.
    Repeated,
    /// Message beyond the limit of its file, which is only counted.
    TooMany,
}

type SayingKey = (Code, Arc<str>, Position);

/// A message that was reported.
struct Saying {
    /// A hash of its text.
    hash: u64,
    times: u64,
    /// Text, from the second time on.
    message: String,
}

/// Messages of one file.
#[derive(Default)]
struct PerFile {
    said: usize,
    /// Number of messages left out, and the place of the first of them.
    more: u64,
    place: Option<Place>,
}

/// Messages of a program so far.
pub(super) struct MessageDedup {
    /// Limit of messages of a file.
    most: usize,
    places: HashMap<SayingKey, Vec<Saying>>,
    files: HashMap<Arc<str>, PerFile>,
    starts: StartsInOrder,
}

impl MessageDedup {
    /// Creates an empty filter with a limit of messages for each file.
    pub(super) fn at_most(most: usize) -> Self {
        Self {
            most,
            places: HashMap::new(),
            files: HashMap::new(),
            starts: StartsInOrder::default(),
        }
    }

    /// Takes a message about an executed block; best in the order of their places.
    pub(super) fn take(&mut self, diagnostic: &Diagnostic) -> DedupVerdict {
        let place = &diagnostic.place;
        let start = self.starts.start(place);
        let mut hasher = DefaultHasher::new();
        diagnostic.message.hash(&mut hasher);
        let hash = hasher.finish();
        let key = (diagnostic.code, place.file.clone(), start);
        let sayings = self.places.get_mut(&key);
        if let Some(sayings) = sayings {
            let full = sayings.len() >= MAX_AT_A_PLACE;
            let known = sayings.iter().position(|saying| saying.hash == hash);
            let known = known.or(full.then(|| sayings.len() - 1));
            if let Some(saying) = known.and_then(|known| sayings.get_mut(known)) {
                if saying.times == 1 {
                    saying.message.clone_from(&diagnostic.message);
                }
                saying.times += 1;
                return DedupVerdict::Repeated;
            }
        }
        if !self.has_room(place) {
            return DedupVerdict::TooMany;
        }
        self.places.entry(key).or_default().push(Saying {
            hash,
            times: 1,
            message: String::new(),
        });
        DedupVerdict::Say
    }

    /// Takes a message at the end, where none is repeated.
    pub(super) fn take_last(&mut self, diagnostic: &Diagnostic) -> DedupVerdict {
        if self.has_room(&diagnostic.place) {
            DedupVerdict::Say
        } else {
            DedupVerdict::TooMany
        }
    }

    /// Counts a message against the limit of its file.
    fn has_room(&mut self, place: &Place) -> bool {
        let file = match self.files.get_mut(&place.file) {
            Some(file) => file,
            None => self.files.entry(place.file.clone()).or_default(),
        };
        if file.said < self.most {
            file.said += 1;
            return true;
        }
        file.more += 1;
        if file.place.is_none() {
            file.place = Some(place.clone());
        }
        false
    }

    /// Returns the messages that applied more often than they were said, in the order of their places.
    pub(super) fn repeats(&self) -> Vec<Repeat> {
        let mut repeated = Vec::new();
        for ((code, file, start), sayings) in &self.places {
            for saying in sayings.iter().filter(|saying| saying.times > 1) {
                repeated.push(Repeat {
                    code: *code,
                    file: file.to_string(),
                    line: start.line,
                    times: saying.times,
                    start: *start,
                    message: saying.message.clone(),
                });
            }
        }
        repeated.sort_by(|a, b| {
            let order = (&a.file, a.line, a.code).cmp(&(&b.file, b.line, b.code));
            let places = (a.start.line, a.start.column).cmp(&(b.start.line, b.start.column));
            order.then(places).then_with(|| a.message.cmp(&b.message))
        });
        repeated
    }

    /// Returns FC905 for each file with more messages; `unsaid` messages about the program's own file were counted
    /// before they came here.
    pub(super) fn rest(&mut self, unsaid: u64, seq: u64) -> Vec<EndNote> {
        let mut full: Vec<(&Arc<str>, &mut PerFile)> = self
            .files
            .iter_mut()
            .filter(|(_, file)| file.place.is_some())
            .collect();
        full.sort_by_key(|(name, _)| Arc::clone(name));
        if let Some((_, first)) = full.first_mut() {
            first.more = first.more.saturating_add(unsaid);
        }
        let most = self.most;
        let notes = full.into_iter().filter_map(|(_, file)| {
            let more = file.more;
            let messages = if more == 1 { "message" } else { "messages" };
            let message = format!(
                "{most} messages about this file are shown; {more} more {messages}, from here on, are only counted"
            );
            Some(EndNote {
                seq,
                diagnostic: Diagnostic::new(Code::Fc905, file.place.clone()?, message)
                    .with_help("correct what is shown and run again"),
            })
        });
        notes.collect()
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

    #[test]
    fn all_axes_are_proposed_in_one_list() {
        // R1.37
        let axes = ["X".to_owned(), "Y".to_owned()];
        let said = undescribed(&Machine::unconfigured(), &axes).map(|said| said.to_string());
        assert!(said.is_some_and(|said| said.ends_with("friction compensation of X, Y")));
        let said = undescribed(&Machine::unconfigured(), &[]).map(|said| said.to_string());
        assert!(said.is_some_and(|said| said.ends_with("assume friction compensation")));
        assert_eq!(undescribed(&Machine::enabled(["X"]), &axes), None);
    }

    #[test]
    fn equal_messages_at_one_place_are_one() {
        // R17.1, R17.3
        let file = SourceFile::new("sub.nc", "N1 X\nN2 Y");
        let said = |start, message: &str, program: &str| {
            let place = file.place(Span::new(start, start + 1));
            let mut said = Diagnostic::new(Code::Fc401, place, message);
            said.reached_from.add(&Arc::from(program));
            said
        };
        let mut causes = Causes::default();
        causes.say(said(3, "x", "a.nc"));
        causes.say(said(3, "y", "a.nc"));
        causes.say(said(3, "x", "b.nc"));
        causes.say(said(0, "x", "b.nc"));
        let mut warned = said(3, "x", "c.nc");
        warned.severity = Severity::Info;
        causes.say(warned);
        let lines: Vec<_> = causes.diagnostics().iter().map(Diagnostic::line).collect();
        assert_eq!(
            lines,
            [
                "x (reached from 2 programs: a.nc, b.nc)",
                "y (reached from a.nc)",
                "x (reached from b.nc)",
                "x (reached from c.nc)"
            ]
        );
    }
}
