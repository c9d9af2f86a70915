//! One controller session: programs that run one after the other on one machine.
//!
//! The state that one program leaves is the state that the next one starts with. Events of the
//! interpreter become records here: lints are added, the user's severities and `allow` comments
//! are applied, everything is counted.

use std::collections::{BTreeMap, HashMap};
use std::ops::ControlFlow;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::codes::Code;
use crate::compensation::{Compensation, State};
use crate::diagnostic::{Diagnostic, Levels, Place, Severity};
use crate::interpreter::{Ended, Event, Executed, Interpreter, Options, Outlook, Value};
pub use crate::interpreter::{Finder, Limits, NoFiles, NoteKind, Notes, StopPolicy};
use crate::lint::Linter;
use crate::lists::FrictionList;
use crate::machine::{AxisIndex, Machine, Parameterisation, Setting};
use crate::source::{LineSource, Position, SourceFile, Span};
use crate::syntax::{Kind, KindSet, allow};
use crate::timeline::{
    AxisSummary, ChangedBy, End, EndNote, EndedBy, Record, Repeat, Row, Sink, StateView, Summary,
};

/// How a session runs.
#[derive(Debug, Clone, Default)]
pub struct SessionOptions {
    /// What happens at an error.
    pub stop: StopPolicy,
    /// The levels of blocks that are skipped, bit 1 for `/` and `/1`, up to bit 10 (R2.3).
    pub skip: u16,
    /// Budgets.
    pub limits: Limits,
    /// The user's severities.
    pub levels: Levels,
    /// Values of variables that only the machine knows.
    pub settings: Vec<(String, Setting)>,
    /// Whether notes are taken, for [`Session::notes`].
    pub notes: Notes,
}

/// The text of a program.
pub enum Program<'a> {
    /// Lines that come one after another. Such a program has no flow: no `$` statement, no local
    /// subprogram; see [`crate::source::FlowScan`].
    Lines(&'a mut dyn LineSource),
    /// The whole text, for programs with flow.
    Whole(SourceFile),
}

/// Why a saved state cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum StateError {
    /// It has another schema.
    #[error("the state has schema {found}, this version reads schema 1")]
    Schema {
        /// The schema that it has.
        found: u32,
    },
    /// It belongs to another machine.
    #[error("the state belongs to another machine: {difference}")]
    OtherMachine {
        /// What differs.
        difference: String,
    },
}

/// What outlives the programs of a session (R9.30).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedState {
    /// 1.
    pub schema: u32,
    /// The axes with what the start of the control read: another text is another machine.
    pub machine: Vec<String>,
    /// The state of each axis.
    pub axes: Vec<SavedAxis>,
    /// The `V.S.` variables.
    pub variables: BTreeMap<String, Value>,
}

/// What outlives the programs of a session on one axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedAxis {
    /// The axis.
    pub axis: String,
    /// The kinds that are selected.
    pub selected: KindSet,
    /// The kinds whose state is not known.
    pub unknown: KindSet,
    /// The table size that was reserved at start-up, P-COMP-00062.
    pub max_points: u32,
    /// The value list that was accepted.
    pub friction: Option<FrictionList>,
}

/// How many blocks the summary of an axis names.
const MAX_NAMED: usize = 100;

/// One controller session.
///
/// ```
/// use std::ops::ControlFlow;
/// use frictcomp::machine::Machine;
/// use frictcomp::session::{NoFiles, Program, Session, SessionOptions};
/// use frictcomp::source::SourceFile;
/// use frictcomp::timeline::{Record, Sink};
///
/// struct Count(usize);
/// impl Sink for Count {
///     fn record(&mut self, record: Record<'_>) -> ControlFlow<()> {
///         if let Record::Block(row) = record {
///             self.0 += row.changes.len();
///         }
///         ControlFlow::Continue(())
///     }
/// }
///
/// let mut session = Session::new(Machine::enabled(["X"]), SessionOptions::default());
/// let mut count = Count(0);
/// let program = SourceFile::new("a.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n");
/// let _ = session.program("a.nc", Program::Whole(program), &mut NoFiles, &mut count);
/// assert_eq!(count.0, 1);
/// ```
pub struct Session {
    machine: Arc<Machine>,
    interpreter: Interpreter,
    levels: Levels,
    /// The state that the session began with.
    start: Compensation,
    programs: u32,
    stopped: bool,
    tally: Tally,
    notes: NoteBook,
}

/// Notes by kind, name and place, each once.
type NoteBook = BTreeMap<(NoteKind, String, Arc<str>, Position), Place>;

/// What the summary says.
struct Tally {
    blocks: u64,
    counts: BTreeMap<Severity, u64>,
    changed_by: Vec<Vec<ChangedBy>>,
    changes: Vec<u64>,
}

impl Tally {
    fn count(&mut self, diagnostic: &Diagnostic) {
        *self.counts.entry(diagnostic.severity).or_default() += 1;
    }
}

impl Session {
    /// A session right after the start of the control.
    pub fn new(machine: Machine, options: SessionOptions) -> Self {
        let machine = Arc::new(machine);
        let compensation = Compensation::at_startup(&machine);
        let run = Options {
            stop: options.stop,
            skip: options.skip,
            limits: options.limits,
            notes: options.notes,
            ..Options::default()
        };
        let mut interpreter = Interpreter::new(Arc::clone(&machine), compensation.clone(), run);
        for (name, setting) in &options.settings {
            interpreter.set(name, setting);
        }
        let axes = machine.axes.len();
        Self {
            machine,
            interpreter,
            levels: options.levels,
            start: compensation,
            programs: 0,
            stopped: false,
            tally: Tally {
                blocks: 0,
                counts: BTreeMap::new(),
                changed_by: vec![Vec::new(); axes],
                changes: vec![0; axes],
            },
            notes: NoteBook::new(),
        }
    }

    /// A session that goes on where another one ended. Returns also what the control says about
    /// lists that changed since (P-ERR-110641).
    ///
    /// # Errors
    /// A state of another schema or machine.
    pub fn resume(
        mut machine: Machine,
        options: SessionOptions,
        saved: SavedState,
    ) -> Result<(Self, Vec<Diagnostic>), StateError> {
        if saved.schema != 1 {
            return Err(StateError::Schema {
                found: saved.schema,
            });
        }
        let here = fingerprint(&machine);
        if let Some(difference) = difference(&saved.machine, &here) {
            return Err(StateError::OtherMachine { difference });
        }
        let mut said = Vec::new();
        for (axis, saved) in machine.axes.iter_mut().zip(&saved.axes) {
            if let Some(diagnostic) = axis.check_max_points(saved.max_points) {
                said.push(diagnostic);
                axis.max_points = saved.max_points;
                axis.friction = match &saved.friction {
                    Some(list) => Parameterisation::Accepted(list.clone()),
                    None => Parameterisation::Missing,
                };
            }
        }
        let mut session = Self::new(machine, options);
        let mut compensation = session.start.clone();
        for (position, axis) in saved.axes.iter().enumerate().take(compensation.len()) {
            compensation.restore(AxisIndex::new(position), axis.selected, axis.unknown);
        }
        session.interpreter.set_compensation(compensation.clone());
        session.start = compensation;
        for (name, value) in saved.variables {
            session.interpreter.set_shared(&name, value);
        }
        Ok((session, said))
    }

    /// The state of the moment.
    pub fn state(&self) -> StateView<'_> {
        StateView {
            machine: &self.machine,
            compensation: self.interpreter.compensation(),
            listed: self.interpreter.occurred(),
            version: self.interpreter.version(),
        }
    }

    /// What the programs needed from the machine, or what was passed over: names with their places,
    /// sorted, each once. Empty unless [`SessionOptions::notes`] asks for them.
    pub fn notes(&self, kind: NoteKind) -> impl Iterator<Item = (&str, &Place)> {
        self.notes
            .iter()
            .filter(move |((of, ..), _)| *of == kind)
            .map(|((_, name, ..), place)| (name.as_str(), place))
    }

    /// The interpreter, for positions and modal state.
    pub fn interpreter(&self) -> &Interpreter {
        &self.interpreter
    }

    /// Says what the session starts with, and what the control says about its lists.
    pub fn begin(&mut self, lists: &[Diagnostic], sink: &mut dyn Sink) -> ControlFlow<()> {
        sink.record(Record::Session {
            state: self.state(),
        })?;
        for diagnostic in lists {
            self.tally.count(diagnostic);
            sink.record(Record::Machine(diagnostic))?;
        }
        ControlFlow::Continue(())
    }

    /// Runs one program. `Break` when the sink wants no more.
    pub fn program(
        &mut self,
        file: &str,
        program: Program<'_>,
        finder: &mut dyn Finder,
        sink: &mut dyn Sink,
    ) -> ControlFlow<(), EndedBy> {
        self.programs += 1;
        let machine = Arc::clone(&self.machine);
        let mut desk = Desk {
            machine: &machine,
            levels: &self.levels,
            linter: Linter::new(&machine, self.interpreter.compensation(), &self.start),
            tally: &mut self.tally,
            notes: &mut self.notes,
            sink,
            program: self.programs,
            file,
            said: Vec::new(),
            repeats: HashMap::new(),
            allows: Vec::new(),
            broken: false,
        };
        let mut listen = |event: Event<'_>| desk.event(event);
        let outlook = match program {
            Program::Lines(lines) => self.interpreter.stream(file, lines, finder, &mut listen),
            Program::Whole(source) => self.interpreter.program(source, finder, &mut listen),
        };
        match outlook {
            Outlook::Ended(by) if !desk.broken => {
                self.stopped |= matches!(by, EndedBy::Error | EndedBy::Budget);
                ControlFlow::Continue(by)
            }
            _ => ControlFlow::Break(()),
        }
    }

    /// Whether an error stopped the session, so that no further program may run (R9.20).
    pub fn is_stopped(&self) -> bool {
        self.stopped
    }

    /// How many diagnostics were said at a severity.
    pub fn count(&self, severity: Severity) -> u64 {
        self.tally
            .counts
            .get(&severity)
            .copied()
            .unwrap_or_default()
    }

    /// Says the summary.
    pub fn finish(&mut self, sink: &mut dyn Sink) -> ControlFlow<()> {
        let state = self.state();
        let axes = state.axes().map(|(axis, _)| AxisSummary {
            axis,
            start: self.start.state(axis, Kind::Frict),
            end: state.state(axis, Kind::Frict),
            changed_by: self.tally.changed_by[axis.get()].clone(),
            changes: self.tally.changes[axis.get()],
        });
        sink.record(Record::Summary(&Summary {
            programs: self.programs,
            blocks: self.tally.blocks,
            counts: self.tally.counts.clone(),
            opaque: self.interpreter.opaque(),
            axes: axes.collect(),
            state,
        }))
    }

    /// What the next session starts with.
    pub fn save(&self) -> SavedState {
        let compensation = self.interpreter.compensation();
        let axes = self
            .machine
            .axes
            .iter()
            .enumerate()
            .map(|(position, axis)| {
                let index = AxisIndex::new(position);
                SavedAxis {
                    axis: axis.name.clone(),
                    selected: compensation.selected(index),
                    unknown: compensation.unknown(index),
                    max_points: axis.max_points,
                    friction: match &axis.friction {
                        Parameterisation::Accepted(list) => Some(list.clone()),
                        _ => None,
                    },
                }
            });
        SavedState {
            schema: 1,
            machine: fingerprint(&self.machine),
            axes: axes.collect(),
            variables: self.interpreter.shared_variables(),
        }
    }
}

/// One line an axis with what only a start of the control reads. Value lists may be loaded anew
/// while the control runs and are no part of it.
fn fingerprint(machine: &Machine) -> Vec<String> {
    let words = |kinds: KindSet| {
        let words: Vec<&str> = kinds.iter().map(Kind::keyword).collect();
        if words.is_empty() {
            "none".to_owned()
        } else {
            words.join("|")
        }
    };
    machine
        .axes
        .iter()
        .map(|axis| {
            let number = axis
                .number
                .map_or("-".to_owned(), |number| number.to_string());
            format!(
                "axis {} number {number} type {:?} configured {} manual {}",
                axis.name,
                axis.axis_type,
                words(axis.configured),
                words(axis.manual)
            )
        })
        .collect()
}

fn difference(saved: &[String], here: &[String]) -> Option<String> {
    if saved.len() != here.len() {
        return Some(format!(
            "it has {} axes, this machine has {}",
            saved.len(),
            here.len()
        ));
    }
    saved
        .iter()
        .zip(here)
        .find(|(saved, here)| saved != here)
        .map(|(saved, here)| format!("it has `{saved}`, this machine has `{here}`"))
}

/// A code that a comment allows, and whether that was of use.
struct Allow {
    code: Code,
    /// The line of the block that the comment speaks for.
    line: u32,
    seq: u64,
    place: Place,
    used: bool,
}

/// Turns the events of one program into records.
struct Desk<'a> {
    machine: &'a Machine,
    levels: &'a Levels,
    linter: Linter<'a>,
    tally: &'a mut Tally,
    notes: &'a mut NoteBook,
    sink: &'a mut dyn Sink,
    program: u32,
    file: &'a str,
    said: Vec<Diagnostic>,
    /// Lints by place: how often they came true.
    repeats: HashMap<(Code, Arc<str>, u32, u32), u64>,
    allows: Vec<Allow>,
    broken: bool,
}

impl Desk<'_> {
    fn event(&mut self, event: Event<'_>) -> ControlFlow<()> {
        let flow = match event {
            Event::Started {
                name,
                compensation,
                occurred,
                version,
            } => self.sink.record(Record::Program {
                program: self.program,
                file: self.file,
                name,
                state: StateView {
                    machine: self.machine,
                    compensation,
                    listed: occurred,
                    version,
                },
            }),
            Event::Executed(executed) => self.executed(&executed),
            Event::Ended(ended) => self.ended(&ended),
        };
        self.broken |= flow.is_break();
        flow
    }

    fn executed(&mut self, executed: &Executed<'_>) -> ControlFlow<()> {
        self.tally.blocks += 1;
        for note in executed.notes {
            let place = &note.place;
            let key = (
                note.kind,
                note.name.clone(),
                Arc::clone(&place.file),
                place.start(),
            );
            self.notes.entry(key).or_insert_with(|| place.clone());
        }
        self.said.clear();
        self.said.extend_from_slice(executed.diagnostics);
        self.linter.block(executed, &mut self.said);
        self.note_allows(executed);
        if !self.said.is_empty() {
            self.filter(executed.line);
        }
        for change in executed.changes {
            if change.kind == Kind::Frict {
                self.note_change(executed, change.axis, change.to);
            }
        }
        for diagnostic in &self.said {
            self.tally.count(diagnostic);
        }
        self.sink.record(Record::Block(Row {
            program: self.program,
            seq: executed.seq,
            file: executed.file,
            line: executed.line,
            number: executed.number,
            level: executed.level,
            text: executed.text,
            changes: executed.changes,
            state: StateView {
                machine: self.machine,
                compensation: executed.compensation,
                listed: executed.occurred,
                version: executed.version,
            },
            modal: executed.modal,
            diagnostics: &self.said,
        }))
    }

    /// Applies the user's severities and `allow` comments, keeps lints once a place, and sorts.
    fn filter(&mut self, line: u32) {
        let (levels, allows, repeats) = (self.levels, &mut self.allows, &mut self.repeats);
        self.said.retain_mut(|diagnostic| {
            let Some(severity) = levels.severity(diagnostic.code) else {
                return false;
            };
            diagnostic.severity = severity;
            if is_allowed(allows, diagnostic, line) {
                return false;
            }
            if !is_lint(diagnostic.code) {
                return true;
            }
            let place = &diagnostic.place;
            let key = (
                diagnostic.code,
                place.file.clone(),
                place.first_line,
                place.span.start,
            );
            let times = repeats.entry(key).or_default();
            *times += 1;
            *times == 1
        });
        self.said
            .sort_by_key(|diagnostic| (diagnostic.place.span.start, diagnostic.code));
    }

    fn note_allows(&mut self, executed: &Executed<'_>) {
        let commented = memchr::memchr2(b';', b'(', executed.text.as_bytes()).is_some();
        if commented && executed.text.contains(allow::MARK) {
            let span = Span::new(0, executed.text.len());
            self.note_allow(executed, (executed.text, executed.line), span);
        }
        if let Some((text, line)) = executed.remark {
            let span = Span::new(0, text.len());
            self.note_allow(executed, (text, line), span);
        }
    }

    fn note_allow(&mut self, executed: &Executed<'_>, (text, line): (&str, u32), span: Span) {
        for code in allow::allowed(text) {
            let known = self.allows.iter().any(|allow| {
                allow.code == code
                    && allow.line == executed.line
                    && allow.place.file == *executed.file
            });
            if !known {
                self.allows.push(Allow {
                    code,
                    line: executed.line,
                    seq: executed.seq,
                    place: Place {
                        file: Arc::clone(executed.file),
                        text: text.into(),
                        first_line: line,
                        span,
                    },
                    used: false,
                });
            }
        }
    }

    fn note_change(&mut self, executed: &Executed<'_>, axis: AxisIndex, to: State) {
        self.tally.changes[axis.get()] += 1;
        let named = &mut self.tally.changed_by[axis.get()];
        if named.len() < MAX_NAMED {
            named.push(ChangedBy {
                program: self.program,
                file: executed.file.to_string(),
                line: executed.line,
                number: executed.number,
                to,
            });
        }
    }

    fn ended(&mut self, ended: &Ended<'_>) -> ControlFlow<()> {
        let mut notes: Vec<EndNote> = ended
            .diagnostics
            .iter()
            .map(|diagnostic| EndNote {
                seq: ended.seq,
                diagnostic: diagnostic.clone(),
            })
            .collect();
        self.linter.end(ended.by, ended.compensation, &mut notes);
        let (levels, allows) = (self.levels, &mut self.allows);
        let mut judge = |note: &mut EndNote| {
            let Some(severity) = levels.severity(note.diagnostic.code) else {
                return false;
            };
            note.diagnostic.severity = severity;
            let line = note.diagnostic.place.first_line;
            !is_allowed(allows, &note.diagnostic, line)
        };
        notes.retain_mut(&mut judge);
        let mut unused = unused_allows(allows);
        unused.retain_mut(|note| match levels.severity(note.diagnostic.code) {
            Some(severity) => {
                note.diagnostic.severity = severity;
                true
            }
            None => false,
        });
        notes.append(&mut unused);
        for note in &notes {
            self.tally.count(&note.diagnostic);
        }
        let mut repeated: Vec<Repeat> = self
            .repeats
            .iter()
            .filter(|(_, times)| **times > 1)
            .map(|((code, file, line, _), times)| Repeat {
                code: *code,
                file: file.to_string(),
                line: *line,
                times: *times,
            })
            .collect();
        repeated.sort_by(|a, b| (&a.file, a.line, a.code).cmp(&(&b.file, b.line, b.code)));
        self.sink.record(Record::End(End {
            program: self.program,
            seq: ended.seq,
            by: ended.by,
            notes: &notes,
            repeated: &repeated,
            changes: ended.changes,
            state: StateView {
                machine: self.machine,
                compensation: ended.compensation,
                listed: ended.occurred,
                version: ended.version,
            },
        }))
    }
}

/// FC490 for comments that silenced nothing.
fn unused_allows(allows: &[Allow]) -> Vec<EndNote> {
    allows
        .iter()
        .filter(|allow| !allow.used)
        .map(|allow| {
            let code = allow.code;
            let message = if code.is_controller() {
                format!("`allow {code}` has no effect: errors of the control cannot be silenced")
            } else {
                format!("`allow {code}` silences nothing here")
            };
            EndNote {
                seq: allow.seq,
                diagnostic: Diagnostic::new(Code::Fc490, allow.place.clone(), message)
                    .with_help("remove the comment"),
            }
        })
        .collect()
}

/// Whether a comment allows a diagnostic about the block that starts on a line.
fn is_allowed(allows: &mut [Allow], diagnostic: &Diagnostic, line: u32) -> bool {
    if diagnostic.code.is_controller() {
        return false;
    }
    let allow = allows.iter_mut().find(|allow| {
        allow.code == diagnostic.code
            && allow.line == line
            && allow.place.file == diagnostic.place.file
    });
    match allow {
        Some(allow) => {
            allow.used = true;
            true
        }
        None => false,
    }
}

/// FC401 to FC406 are said once a place.
fn is_lint(code: Code) -> bool {
    matches!(
        code,
        Code::Fc401 | Code::Fc402 | Code::Fc403 | Code::Fc404 | Code::Fc405 | Code::Fc406
    )
}
