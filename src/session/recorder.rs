//! Turns the events of a program into records: adds lints, applies the user's severities and `allow`
//! comments, and counts everything.

use std::collections::{BTreeMap, HashMap};
use std::ops::ControlFlow;
use std::sync::Arc;

use super::findings::{DedupVerdict, MessageDedup};
use super::totals::SessionTotals;
use crate::comp::{AxisIndex, Compensation, Kind, KindSet, State};
use crate::diagnostic::{Code, Diagnostic, Fix, Levels, Severity, Wording};
use crate::interpreter::{
    BlockMove, Ended, EndedBy, Event, Executed, Note, NoteKind, Observer, limit_to,
};
use crate::lint::{LeftAwayNotice, Linter};
use crate::machine::Machine;
use crate::syntax::Comments;
use crate::syntax::allow::{self, Help};
use crate::text::{Place, Position, Span, lines_of};
use crate::timeline::{
    ChangedBy, End, EndNote, Join, Record, Row, SilencedMessage, Sink, StateView,
};

/// Number of blocks that the summary of an axis names.
const MAX_NAMED: usize = 100;

/// Number of notes kept.
pub(super) const MAX_NOTES: usize = 20_000;

/// Notes by kind, name and place, each once.
#[derive(Default)]
pub(super) struct NoteBook {
    pub(super) notes: BTreeMap<(NoteKind, String, Arc<str>, Position), Place>,
    /// Number of occurrences that are not kept.
    pub(super) more: u64,
}

/// Number of comments kept for the report on unused ones. Further ones take effect in their block
/// only.
const MAX_ALLOWS: usize = 20_000;

/// A code that a comment allows, and whether that had an effect.
pub(super) struct Allow {
    seq: u64,
    place: Place,
    reason: Option<String>,
    used: bool,
}

/// Turns the events of one program into records.
pub(super) struct Recorder<'a> {
    pub(super) machine: &'a Machine,
    pub(super) levels: &'a Levels,
    pub(super) wording: Option<Wording>,
    pub(super) linter: Linter<'a>,
    pub(super) totals: &'a mut SessionTotals,
    pub(super) notes: &'a mut NoteBook,
    pub(super) sink: &'a mut dyn Sink,
    pub(super) program: u32,
    pub(super) file: &'a str,
    pub(super) said: Vec<Diagnostic>,
    /// FC326, until it is reported before everything else.
    pub(super) foreign: Option<Diagnostic>,
    /// Messages so far.
    pub(super) before: MessageDedup,
    pub(super) allows: HashMap<(Arc<str>, u32, Code), Allow>,
    /// Codes allowed by the comments of the block.
    pub(super) here: Vec<Code>,
    pub(super) broken: bool,
    /// Whether a configured kind of an axis is unknown at the moment.
    pub(super) doubtful: bool,
    /// The version of the state that was last judged.
    pub(super) version: u64,
}

impl Observer for Recorder<'_> {
    fn event(&mut self, event: Event<'_>) -> ControlFlow<()> {
        let flow = match &event {
            &Event::Started {
                name,
                compensation,
                possible,
                occurred,
                version,
            } => {
                if let Some(name) = name {
                    self.linter.named(name);
                }
                self.linter.starts(compensation);
                self.doubtful = self.is_doubtful(compensation);
                self.sink.record(&Record::Program {
                    program: self.program,
                    file: self.file,
                    name,
                    state: StateView {
                        machine: self.machine,
                        compensation,
                        possible,
                        listed: occurred,
                        version,
                    },
                })
            }
            Event::Executed(executed) => self.executed(executed),
            Event::Joined(joined) => self.sink.record(&Record::Join(Join {
                program: self.program,
                seq: joined.seq,
                file: &joined.place.file,
                line: joined.place.first_line,
                state: StateView {
                    machine: self.machine,
                    compensation: joined.compensation,
                    possible: joined.possible,
                    listed: joined.occurred,
                    version: joined.version,
                },
            })),
            Event::Ended(ended) => self.ended(ended),
        };
        self.broken |= flow.is_break();
        flow
    }

    fn takes_quiet(&mut self, block: &BlockMove<'_>) -> bool {
        let is_taken = self.doubtful || !self.is_known(block) || self.sink.takes_quiet();
        if !is_taken {
            self.totals.count_block(block);
        }
        is_taken
    }
}

impl Recorder<'_> {
    fn executed(&mut self, executed: &Executed<'_>) -> ControlFlow<()> {
        if executed.passed
            && !executed
                .diagnostics
                .iter()
                .any(|said| said.severity == Severity::Error)
        {
            // A block search shows only what stops it (R2.96).
            self.linter.block(executed, &mut Vec::new());
            return ControlFlow::Continue(());
        }
        self.totals.count_block(&executed.moves());
        if !executed.notes.is_empty() {
            self.take_notes(executed.notes);
        }
        self.said.clear();
        if !self.is_quiet(executed) {
            self.judge(executed);
        }
        if self.doubtful {
            self.note_unknown_motion(executed);
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
                possible: executed.possible,
                listed: executed.occurred,
                version: executed.version,
            },
            modal: executed.modal,
            uncompensated: self.totals.feed_moves.moved(),
            motion: executed.motion,
            branch: executed.branch,
            diagnostics: &self.said,
            reported: executed.diagnostics,
        }))
    }

    /// Returns whether a block is quiet and moves as earlier ones did: it needs no message, nothing about it has to be
    /// remembered, and no comment in it can allow anything.
    #[inline]
    fn is_quiet(&self, executed: &Executed<'_>) -> bool {
        executed.diagnostics.is_empty()
            && executed.outcomes.is_empty()
            && executed.changes.is_empty()
            && executed.doubted.is_empty()
            && executed.aside.withheld.is_empty()
            && self.is_known(&executed.moves())
    }

    /// Returns whether a block moves axes that have moved before in the state that was judged last, and has no comment.
    #[inline]
    fn is_known(&self, block: &BlockMove<'_>) -> bool {
        block.version == self.version
            && block.comments == Comments::Absent
            && block.remark.is_none()
            && self.linter.knows(block.moves)
    }

    /// Returns the configured kinds of an axis that are unknown.
    fn unknown_of(&self, compensation: &Compensation, axis: AxisIndex) -> KindSet {
        let configured = self.machine.axis(axis).configured;
        compensation.unknown(axis).intersection(configured)
    }

    fn is_doubtful(&self, compensation: &Compensation) -> bool {
        let mut axes = (0..compensation.len()).map(AxisIndex::new);
        axes.any(|axis| !self.unknown_of(compensation, axis).is_empty())
    }

    /// Remembers what is unknown where its axis moves (R2.98).
    #[cold]
    fn note_unknown_motion(&mut self, executed: &Executed<'_>) {
        for axis in executed.motions().map(|motion| motion.axis) {
            let kinds = self.unknown_of(executed.compensation, axis);
            let kinds = kinds.iter().map(|kind| (axis, kind));
            self.totals.unknown.extend(kinds);
        }
    }

    #[inline(never)]
    fn take_notes(&mut self, notes: &[Note]) {
        for note in notes {
            let place = &note.place;
            let key = (
                note.kind,
                note.name.clone(),
                Arc::clone(&place.file),
                place.start(),
            );
            let known = &mut self.notes.notes;
            if known.len() < MAX_NOTES || known.contains_key(&key) {
                known.entry(key).or_insert_with(|| place.clone());
            } else {
                self.notes.more += 1;
            }
        }
    }

    /// Gathers the messages about a block, and counts them.
    #[inline(never)]
    fn judge(&mut self, executed: &Executed<'_>) {
        self.said.extend(self.foreign.take());
        self.said.extend_from_slice(executed.diagnostics);
        self.totals.note_footing(executed.diagnostics);
        let before = self.said.len();
        self.linter.block(executed, &mut self.said);
        self.totals.note_footing(self.said.iter().skip(before));
        if let Some(ways) = executed.branch {
            // FC403 names the ways itself.
            let lints = self.said.iter_mut().skip(before);
            let lints = lints.filter(|said| said.code != Code::Fc403);
            lints.for_each(|said| limit_to(said, ways));
        }
        if let Some(failed) = executed.failed {
            let said = self.said.iter_mut();
            said.for_each(|said| failed.mark(said, executed.seq));
        }
        if self.totals.has_undescribed {
            self.totals.note_undescribed(self.machine, executed);
        }
        self.note_allows(executed);
        for withheld in &executed.aside.withheld {
            if !is_allowed(&mut self.allows, withheld, executed.line) {
                is_allowed(&mut self.allows, withheld, withheld.place.first_line);
            }
        }
        if !self.said.is_empty() {
            self.filter(executed.line);
        }
        self.doubtful = self.is_doubtful(executed.compensation);
        self.version = executed.version;
        for change in executed.changes {
            if change.kind == Kind::Frict {
                self.note_change(executed, change.axis, change.to);
            }
        }
        for diagnostic in &self.said {
            self.totals.count(diagnostic);
        }
    }

    /// Sorts, applies the user's severities and `allow` comments, and keeps each message once per place.
    fn filter(&mut self, line: u32) {
        let (levels, allows, here) = (self.levels, &mut self.allows, &self.here);
        let (before, totals, wording) = (&mut self.before, &mut *self.totals, self.wording);
        let (machine, program) = (self.machine, self.program);
        self.said.sort_by(|one, other| {
            let order = one.place.cmp_start(&other.place);
            order.then(one.code.cmp(&other.code))
        });
        self.said.retain_mut(|diagnostic| {
            if !levels.weigh(diagnostic) {
                return false;
            }
            let may_be = !diagnostic.code.is_controller() && !diagnostic.is_raised();
            let allowed = here.contains(&diagnostic.code) && may_be;
            // It is reported at the motion after the command that it is about.
            let line = match diagnostic.code {
                Code::Fc409 => diagnostic.place.first_line,
                _ => line,
            };
            // Where ways meet, it is about the condition at which they parted.
            let first_line = diagnostic.place.first_line;
            let is_silenced = is_allowed(allows, diagnostic, line)
                || (diagnostic.code == Code::Fc901 && is_allowed(allows, diagnostic, first_line));
            if is_silenced || allowed {
                return false;
            }
            if totals.knows_undescribed(machine, (program, diagnostic)) {
                return false;
            }
            match before.take(diagnostic) {
                DedupVerdict::Say => {
                    SessionTotals::add_assumption(machine, diagnostic);
                    diagnostic.reword(wording);
                    true
                }
                DedupVerdict::Repeated => false,
                DedupVerdict::TooMany => {
                    totals.count(diagnostic);
                    false
                }
            }
        });
    }

    fn note_allows(&mut self, executed: &Executed<'_>) {
        self.here.clear();
        if executed.comments == Comments::Possible && executed.text.contains(allow::MARK) {
            let lines = lines_of(executed.text).zip(executed.line..);
            for (text, line) in lines.filter(|(text, _)| text.contains(allow::MARK)) {
                self.note_allow(executed, text, line);
            }
        }
        if let Some(remark) = executed.remark {
            for (text, line) in remark.lines() {
                self.note_allow(executed, text, line);
            }
        }
    }

    fn note_allow(&mut self, executed: &Executed<'_>, text: &str, line: u32) {
        let place = |span| Place {
            file: Arc::clone(executed.file),
            text: text.into(),
            first_line: line,
            span,
        };
        let allowance = allow::allowed(text);
        if let Some(fault) = allowance.fault {
            let diagnostic = Diagnostic::new(Code::Fc491, place(fault.span), fault.message);
            self.said.push(match fault.help {
                Help::Near(near) => diagnostic.with_near(fault.span.of(text), &near),
                Help::How(how) => diagnostic.with_help(how),
            });
        }
        for code in allowance.codes {
            self.here.push(code);
            let key = (Arc::clone(executed.file), executed.line, code);
            if self.allows.len() >= MAX_ALLOWS || self.allows.contains_key(&key) {
                continue;
            }
            let allow = Allow {
                seq: executed.seq,
                place: place(Span::new(0, text.len())),
                reason: allowance.reason.clone(),
                used: false,
            };
            self.allows.insert(key, allow);
        }
    }

    fn note_change(&mut self, executed: &Executed<'_>, axis: AxisIndex, to: State) {
        let named = &mut self.totals.changed_by[axis.get()];
        let changes = &mut self.totals.changes[axis.get()];
        let block = Some((self.program, executed.seq));
        if std::mem::replace(&mut self.totals.last_changed[axis.get()], block) == block {
            if let Some(last) = named.last_mut().filter(|_| *changes <= MAX_NAMED as u64) {
                last.to = to;
            }
            return;
        }
        *changes += 1;
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

    #[inline(never)]
    fn ended(&mut self, ended: &Ended<'_>) -> ControlFlow<()> {
        self.totals.note_footing(ended.diagnostics);
        self.totals.rests_on = self.totals.rests_on.union(self.linter.rests_on());
        for axis in (0..ended.compensation.len()).map(AxisIndex::new) {
            let kinds = self.unknown_of(ended.compensation, axis);
            let kinds = kinds.iter().map(|kind| (axis, kind));
            self.totals.unknown.extend(kinds);
        }
        let foreign = self.foreign.take();
        let said = foreign.iter().chain(ended.diagnostics);
        let mut notes: Vec<EndNote> = said
            .map(|diagnostic| EndNote {
                seq: ended.seq,
                diagnostic: diagnostic.clone(),
            })
            .collect();
        notes.extend(self.linter.held());
        let mut left = self.linter.end(ended);
        if let Some(failed) = ended.failed {
            let lints = left.iter_mut().map(|left| &mut left.note);
            let said = notes.iter_mut().chain(lints);
            said.for_each(|note| failed.mark(&mut note.diagnostic, note.seq));
        }
        let lints = left.iter().map(|left| &left.note.diagnostic);
        self.totals.note_footing(lints);
        let (levels, allows) = (self.levels, &mut self.allows);
        let mut judge = |note: &mut EndNote| {
            if !levels.weigh(&mut note.diagnostic) {
                return false;
            }
            let line = note.diagnostic.place.first_line;
            !is_allowed(allows, &note.diagnostic, line)
        };
        notes.retain_mut(&mut judge);
        for mut left in left {
            let notice = if judge(&mut left.note) {
                LeftAwayNotice::Said
            } else {
                LeftAwayNotice::Silenced
            };
            self.linter.settle(&left, notice);
            if notice == LeftAwayNotice::Said {
                notes.push(left.note);
            }
        }
        // A run that did not reach program end was not judged there.
        let judged = match ended.by {
            EndedBy::Error => false,
            EndedBy::Budget => ended.endless,
            EndedBy::M30 | EndedBy::M02 | EndedBy::EndOfFile => true,
        };
        let of_end = |code: Code| matches!(code, Code::Fc401 | Code::Fc403 | Code::Fc407);
        allows.retain(|(.., code), _| judged || !of_end(*code));
        let used = allows.iter().filter(|(_, allow)| allow.used);
        let silenced = used.map(|((file, line, code), allow)| SilencedMessage {
            file: file.to_string(),
            line: *line,
            code: *code,
            reason: allow.reason.clone(),
        });
        self.totals.silenced.extend(silenced);
        let mut unused = unused_allows(allows);
        unused.retain_mut(|note| levels.weigh(&mut note.diagnostic));
        notes.append(&mut unused);
        let mut unsaid = 0;
        for (code, times) in ended.unsaid {
            if let Some(severity) = levels.severity(*code) {
                unsaid += times;
                *self.totals.counts.entry(severity).or_default() += times;
            }
        }
        for note in &notes {
            self.totals.count(&note.diagnostic);
        }
        notes.retain(|note| self.before.take_last(&note.diagnostic) == DedupVerdict::Say);
        let mut rest = self.before.rest(unsaid, ended.seq);
        rest.retain_mut(|note| levels.weigh(&mut note.diagnostic));
        for note in &rest {
            self.totals.count(&note.diagnostic);
        }
        notes.append(&mut rest);
        for note in &mut notes {
            SessionTotals::add_assumption(self.machine, &mut note.diagnostic);
            note.diagnostic.reword(self.wording);
        }
        let repeated = self.before.repeats();
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
                possible: ended.possible,
                listed: ended.occurred,
                version: ended.version,
            },
        }))
    }
}

/// Returns FC490 for comments that silenced nothing.
fn unused_allows(allows: &HashMap<(Arc<str>, u32, Code), Allow>) -> Vec<EndNote> {
    let unused = allows.iter().filter(|(_, allow)| !allow.used);
    let mut notes: Vec<EndNote> = unused
        .map(|((.., code), allow)| {
            let message = if code.is_controller() {
                format!("`allow {code}` has no effect: errors of the control cannot be silenced")
            } else {
                format!("`allow {code}` silences nothing here")
            };
            EndNote {
                seq: allow.seq,
                diagnostic: without_comment(
                    Diagnostic::new(Code::Fc490, allow.place.clone(), message)
                        .with_help("remove the comment"),
                ),
            }
        })
        .collect();
    notes.sort_by(|a, b| {
        let order = |note: &EndNote| (note.seq, note.diagnostic.place.first_line);
        let words = || a.diagnostic.message.cmp(&b.diagnostic.message);
        order(a).cmp(&order(b)).then_with(words)
    });
    notes
}

/// Returns the diagnostic on a comment that silences nothing, with the change that removes it.
fn without_comment(diagnostic: Diagnostic) -> Diagnostic {
    let mut place = diagnostic.place.clone();
    match allow::lone_comment(&place.text) {
        Some(span) => {
            place.span = span;
            diagnostic.with_fix(Fix::safe(place, ""))
        }
        None => diagnostic,
    }
}

/// Returns whether a comment allows a diagnostic about the block that starts on a line.
fn is_allowed(
    allows: &mut HashMap<(Arc<str>, u32, Code), Allow>,
    diagnostic: &Diagnostic,
    line: u32,
) -> bool {
    if allows.is_empty() || diagnostic.code.is_controller() || diagnostic.is_raised() {
        return false;
    }
    let key = (Arc::clone(&diagnostic.place.file), line, diagnostic.code);
    match allows.get_mut(&key) {
        Some(allow) => {
            allow.used = true;
            true
        }
        None => false,
    }
}
