//! The desk at which events of a program become records: lints are added, the user's severities
//! and `allow` comments applied, everything is counted.

use std::collections::{BTreeMap, HashMap};
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::codes::Code;
use crate::compensation::State;
use crate::diagnostic::{Diagnostic, Levels, Place, Severity};
use crate::interpreter::{Ended, Event, Executed, NoteKind};
use crate::lint::Linter;
use crate::machine::{AxisIndex, Machine};
use crate::source::{Position, Span};
use crate::syntax::{Comments, Kind, allow};
use crate::timeline::{ChangedBy, End, EndNote, Record, Repeat, Row, Sink, StateView};

/// How many blocks the summary of an axis names.
const MAX_NAMED: usize = 100;

/// Notes by kind, name and place, each once.
pub(super) type NoteBook = BTreeMap<(NoteKind, String, Arc<str>, Position), Place>;

/// What the summary says.
pub(super) struct Tally {
    pub(super) blocks: u64,
    pub(super) counts: BTreeMap<Severity, u64>,
    pub(super) changed_by: Vec<Vec<ChangedBy>>,
    pub(super) changes: Vec<u64>,
}

impl Tally {
    pub(super) fn count(&mut self, diagnostic: &Diagnostic) {
        *self.counts.entry(diagnostic.severity).or_default() += 1;
    }
}

/// A code that a comment allows, and whether that was of use.
pub(super) struct Allow {
    code: Code,
    /// The line of the block that the comment speaks for.
    line: u32,
    seq: u64,
    place: Place,
    used: bool,
}

/// Turns the events of one program into records.
pub(super) struct Desk<'a> {
    pub(super) machine: &'a Machine,
    pub(super) levels: &'a Levels,
    pub(super) linter: Linter<'a>,
    pub(super) tally: &'a mut Tally,
    pub(super) notes: &'a mut NoteBook,
    pub(super) sink: &'a mut dyn Sink,
    pub(super) program: u32,
    pub(super) file: &'a str,
    pub(super) said: Vec<Diagnostic>,
    /// Lints by place: how often they came true.
    pub(super) repeats: HashMap<(Code, Arc<str>, u32, u32), u64>,
    pub(super) allows: Vec<Allow>,
    pub(super) broken: bool,
}

impl Desk<'_> {
    pub(super) fn event(&mut self, event: Event<'_>) -> ControlFlow<()> {
        let flow = match event {
            Event::Started {
                name,
                compensation,
                occurred,
                version,
            } => self.sink.record(&Record::Program {
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
        self.sink.record(&Record::Block(Row {
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
            motion: executed.motion,
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
        if executed.comments == Comments::Possible && executed.text.contains(allow::MARK) {
            let span = Span::new(0, executed.text.len());
            self.note_allow(executed, (executed.text, executed.line), span);
        }
        if let Some(remark) = executed.remark {
            let span = Span::new(0, remark.text.len());
            self.note_allow(executed, (&remark.text, remark.line), span);
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
        self.sink.record(&Record::End(End {
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
