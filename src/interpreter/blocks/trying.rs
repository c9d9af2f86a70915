//! Blocks that the control may execute, but the dry run does not: reports what the control would refuse
//! there (R2.51, R2.52).

use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::run::block_context::{BlockContext, ShownBlockLines};
use crate::interpreter::run::block_scratch::PassedBy;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::outcome::BlockOutcome;
use crate::interpreter::values::cause::Unknown;
use crate::syntax::ast::Item;
use crate::syntax::control_part;

impl Interpreter {
    /// Reports what the control refuses if it executes the block.
    pub(crate) fn perhaps_refused(&mut self, cause: &Unknown, at: &BlockContext<'_>) {
        let said = self.try_out(cause, at, |run| {
            let mut outcome = BlockOutcome::default();
            for word in &at.block.words {
                if let Err(fault) = run.word(word, at, &mut outcome) {
                    run.scratch.complain(*fault, at);
                }
            }
            // Statements that decide which blocks are executed have no effect here.
            let decides = |item: &Item| {
                matches!(item, Item::Flow(..)) || control_part(at.block, item).is_some()
            };
            for item in at.block.items.iter().filter(|item| !decides(item)) {
                if let Err(fault) = run.item(item, at, &mut outcome) {
                    run.scratch.complain(*fault, at);
                }
            }
        });
        self.scratch.of_some_ways.extend(said);
    }

    /// Reports what the control refuses if it executes the blocks that were passed over (R2.51), once for
    /// each of them. The parameters of called programs are not known, so only their COMP commands are tried.
    pub(crate) fn try_passed(&mut self) {
        let passed = std::mem::take(&mut self.scratch.passed);
        if !self.options.follows_ways() {
            return;
        }
        for passed in passed {
            let unit = self.programs.unit_mut(passed.unit);
            for entry in unit.take_untried(passed.blocks).into_iter().flatten() {
                let place = (passed.unit, entry);
                let was_read = self.programs.was_read(passed.unit, entry);
                match passed.by {
                    PassedBy::Way | PassedBy::Call if was_read => {}
                    PassedBy::Way | PassedBy::Branch => self.try_block(place, &passed.cause),
                    PassedBy::Call => self.try_called(place, &passed.cause),
                }
            }
        }
    }

    fn try_block(&mut self, (unit, entry): (usize, EntryIndex), cause: &Unknown) {
        let block = self.programs.parsed(unit, entry);
        if self.is_skipped(&block.block) {
            return;
        }
        let frames = &self.state.control.frames;
        let is_own = frames.program().is_some_and(|own| {
            let section = self.programs.section(own);
            own.unit == unit && (section.start..section.end).contains(&entry)
        });
        let shown = ShownBlockLines::default();
        let at = BlockContext::of_parsed(&block, frames.level(), &shown);
        if is_own {
            self.perhaps_refused(cause, &at);
        } else {
            let said = self.refused_comp(cause, &at);
            self.scratch.of_some_ways.extend(said);
        }
        let own = self.scratch.diagnostics.len();
        self.take_faults(&at, false);
        let faults = self.scratch.diagnostics.drain(own..);
        self.scratch.of_some_ways.extend(faults);
    }

    /// Keeps the refusals in a block until the end of the program: the dry run may have executed it by
    /// then.
    fn try_called(&mut self, place: (usize, EntryIndex), cause: &Unknown) {
        let block = self.programs.looked_at(place.0, place.1);
        if self.is_skipped(&block.block) {
            return;
        }
        let shown = ShownBlockLines::default();
        let at = BlockContext::of_parsed(&block, self.state.control.frames.level(), &shown);
        let said = self.refused_comp(cause, &at);
        self.held.extend(said.into_iter().map(|said| (place, said)));
    }

    /// Takes the refusals kept for the end of the program that are in blocks that the dry run did not execute.
    pub(crate) fn take_held(&mut self) -> Vec<Diagnostic> {
        let held = std::mem::take(&mut self.held).into_iter();
        let unread = held.filter(|((unit, entry), _)| !self.programs.was_read(*unit, *entry));
        unread.map(|(_, said)| said).collect()
    }

    /// Returns the refusals of the COMP commands of a block, including those of its macros, whose other words
    /// depend on unknown values.
    fn refused_comp(&mut self, cause: &Unknown, at: &BlockContext<'_>) -> Vec<Diagnostic> {
        let items = at.block.items.iter();
        let (macros, commands): (Vec<_>, Vec<_>) = items
            .filter(|item| matches!(item, Item::Comp(_) | Item::MacroUse(_)))
            .partition(|item| matches!(item, Item::MacroUse(_)));
        let mut attempt = |items: Vec<&Item>| {
            self.try_out(cause, at, |run| {
                for item in items {
                    let _ = run.item(item, at, &mut BlockOutcome::default());
                }
            })
        };
        let mut said = attempt(commands);
        if !macros.is_empty() {
            let refused = |said: &Diagnostic| said.code == Code::PErr70495;
            said.extend(attempt(macros).into_iter().filter(refused));
        }
        said
    }

    /// Tries part of a block for its messages only, and leaves everything else unchanged.
    fn try_out(
        &mut self,
        cause: &Unknown,
        at: &BlockContext<'_>,
        attempt: impl FnOnce(&mut Self),
    ) -> Vec<Diagnostic> {
        let before = (self.state.control.clone(), self.state.track.clone());
        let scratch = std::mem::take(&mut self.scratch);
        let sides = std::mem::take(&mut self.sides);
        let (called, departing) = (self.pending.len(), self.departing.len());
        let ended = self.state.ended.len();
        attempt(self);
        self.say_unsaid(at);
        self.sides = sides;
        self.pending.truncate(called);
        self.departing.truncate(departing);
        self.state.ended.truncate(ended);
        let mut said = std::mem::replace(&mut self.scratch, scratch).diagnostics;
        for said in said.iter_mut().filter(|said| !said.code.is_about_text()) {
            let value = cause.seen_from(at.file);
            let message = &mut said.message;
            *message = format!("{message}; whether the block is executed depends on {value}");
        }
        (self.state.control, self.state.track) = before;
        said
    }
}
