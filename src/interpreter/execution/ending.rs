//! The end of a program.

use std::borrow::Cow;
use std::sync::Arc;

use crate::diagnostic::{Code, Collected, Diagnostic};
use crate::interpreter::run::at::{At, Shown};
use crate::interpreter::run::event::{Ended, EndedBy, Event, Observer};
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::options::{RunOutcome, StopPolicy};
use crate::interpreter::run::stopping::{ended_by, is_harmless};
use crate::syntax::RawBlock;
use crate::syntax::ast::Block;
use crate::text::{Place, Span};

impl Interpreter {
    /// Whether what is wrong with the main program keeps it from running.
    pub(in crate::interpreter) fn is_refused(&self) -> bool {
        !self.refused().is_empty() && self.options.stop == StopPolicy::FirstError
    }

    /// Ends a program that does not run.
    pub(in crate::interpreter) fn refuse(&mut self, observer: &mut dyn Observer) -> RunOutcome {
        let refused = self.refused();
        self.ended(ended_by(&refused.said), &refused, observer)
    }

    /// What keeps the main program from running at all.
    pub(in crate::interpreter) fn refused(&self) -> Collected {
        let main = self.programs.units().first();
        main.map_or(Collected::default(), |unit| unit.index.refused.clone())
    }

    /// Ends a program whose text is in memory.
    pub(in crate::interpreter) fn close(
        &mut self,
        outcome: RunOutcome,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        let RunOutcome::Ended(by) = outcome else {
            return outcome;
        };
        let mut notes = self.refused();
        notes.extend(self.work.over.take());
        if by == EndedBy::EndOfFile && !self.state.frames.is_empty() {
            notes.extend(self.missing_end());
        }
        if self.options.stop == StopPolicy::CheckAll {
            self.check_all_unexecuted(&mut notes);
        }
        self.ended(by, &notes, observer)
    }

    /// FC310 at the last executed block; a program without any block needs no M30 (R2.8).
    pub(in crate::interpreter) fn missing_end(&self) -> Option<Diagnostic> {
        let last = self.state.last.as_ref()?;
        let place = Place {
            file: last.file.clone(),
            text: last.text.as_str().into(),
            first_line: last.line,
            span: Span::new(0, last.text.len()),
        };
        let message = "the program ends here without M30 or M02";
        Some(Diagnostic::new(Code::Fc310, place, message).with_help("end it with `M30`"))
    }

    pub(in crate::interpreter) fn ended(
        &mut self,
        by: EndedBy,
        notes: &Collected,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        let mut notes = Cow::Borrowed(notes);
        if let Some(open) = self.open_description()
            && matches!(by, EndedBy::M30 | EndedBy::M02 | EndedBy::EndOfFile)
        {
            notes.to_mut().push(open);
        }
        let beside = self.beside_blocks();
        if !beside.is_empty() {
            notes.to_mut().append(&beside);
        }
        let mut changes = std::mem::take(&mut self.work.changes);
        changes.extend(self.state.compensation.program_end());
        if !changes.is_empty() {
            self.version += 1;
        }
        self.state.frames.clear();
        self.release_couplings();
        self.state.couplings.end_following();
        // The observer wants no more, or it does not: the program has ended either way.
        let _ = observer.event(Event::Ended(Ended {
            seq: self.state.seq,
            by,
            endless: std::mem::take(&mut self.work.endless),
            at: self.work.end.take().as_ref(),
            changes: &changes,
            diagnostics: &notes.said,
            unsaid: &notes.unsaid,
            compensation: &self.state.compensation,
            occurred: &self.state.occurred,
            version: self.version,
        }));
        RunOutcome::Ended(by)
    }

    /// Blocks that no run of the program reached, for their syntax.
    pub(in crate::interpreter) fn check_all_unexecuted(&mut self, notes: &mut Collected) {
        let Some(unit) = self.programs.units().first() else {
            return;
        };
        for other in unit.index.other_mains() {
            notes.push(other);
        }
        let file = unit.index.source.name().clone();
        let mut unread_up_to = 0;
        for place in 0..unit.index.entries.len() {
            let entry = Span::new(place, place).start;
            if unit.executed[place] {
                // Branches that `#IF` left out are not read at all (R2.73).
                let decided = !unit.undecided.contains(&entry);
                let end = unit.index.interpreted_to(entry).filter(|_| decided);
                unread_up_to = unread_up_to.max(end.unwrap_or_default());
                continue;
            }
            if entry < unread_up_to {
                continue;
            }
            let mut block = Block::default();
            let Some(mut reader) = unit.index.reader(entry) else {
                continue;
            };
            // What is skipped is passed over on the way, too.
            if let Some(raw) = reader.next(&mut block)
                && !self.is_skipped(&block)
            {
                self.check_unexecuted(&file, &raw, &block, notes);
            }
        }
    }

    pub(in crate::interpreter) fn check_unexecuted(
        &self,
        file: &Arc<str>,
        raw: &RawBlock<'_>,
        block: &Block,
        notes: &mut Collected,
    ) {
        let shown = Shown::default();
        let at = At::of_raw(file, raw, block, &shown);
        notes.extend(
            block
                .faults
                .iter()
                .filter(|fault| !is_harmless(&self.machine.harmless, fault, raw.text))
                .map(|fault| at.diagnostic(fault.clone())),
        );
    }
}
