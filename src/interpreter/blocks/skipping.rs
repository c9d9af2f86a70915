//! Blocks with a skip mark whose level is not known to be on or off (R2.90).

use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::run::block_context::{BlockContext, Shown};
use crate::interpreter::run::block_scratch::PassedBy;
use crate::interpreter::run::cycles::RepeatedCall;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::outcome::BlockOutcome;
use crate::interpreter::run::region::Region;
use crate::interpreter::values::cause::{skip_level, unknown_value};
use crate::syntax::ast::{Block, Flow, Item};
use crate::syntax::control_part;
use crate::text::Span;

impl Interpreter {
    /// Passes over a block that the control executes or skips: what it could change becomes unknown,
    /// and it may lead elsewhere.
    #[cold]
    pub(in crate::interpreter) fn perhaps_execute(
        &mut self,
        level: u8,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) {
        let cause = skip_level(level);
        self.note_unknown(&cause, at);
        self.perhaps_refused(&cause, at);
        if let Some((flow, span)) = structure(at.block) {
            outcome.step = self.undecided(flow, &cause, span, at);
            return;
        }
        self.open_undecided(&cause, Span::new(0, at.text.trim_end().len()), at);
        let region = self.havoc_block(at, &cause);
        self.perhaps_repeat_cycles(&region, &cause);
        let next = self
            .state
            .control
            .frames
            .running()
            .map_or(0, |frame| frame.next);
        self.note_exits(&region, next.saturating_sub(1)..=next, &cause, None);
    }

    /// Says what the control refuses if it executes the block.
    fn perhaps_refused(&mut self, cause: &str, at: &BlockContext<'_>) {
        let said = self.try_out(cause, at, |run| {
            let mut outcome = BlockOutcome::default();
            for word in &at.block.words {
                if let Err(fault) = run.word(word, at, &mut outcome) {
                    run.scratch.complain(*fault, at);
                }
            }
            // What decides which blocks are executed decides nothing here.
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

    /// Says what the control refuses if it executes the blocks that were passed over (R2.51), once for
    /// each of them. The parameters of called programs are not known: of these only COMP commands are tried.
    pub(in crate::interpreter) fn try_passed(&mut self) {
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

    fn try_block(&mut self, (unit, entry): (usize, EntryIndex), cause: &str) {
        let block = self.programs.parsed(unit, entry);
        if self.is_skipped(&block.block) {
            return;
        }
        let frames = &self.state.control.frames;
        let is_own = frames.program().is_some_and(|own| {
            let section = self.programs.section(own);
            own.unit == unit && (section.start..section.end).contains(&entry)
        });
        let shown = Shown::default();
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

    /// Keeps what the control refuses in a block for the end of the program: until then the dry run may
    /// have executed it.
    fn try_called(&mut self, place: (usize, EntryIndex), cause: &str) {
        let block = self.programs.looked_at(place.0, place.1);
        if self.is_skipped(&block.block) {
            return;
        }
        let shown = Shown::default();
        let at = BlockContext::of_parsed(&block, self.state.control.frames.level(), &shown);
        let said = self.refused_comp(cause, &at);
        self.held.extend(said.into_iter().map(|said| (place, said)));
    }

    /// What was kept for the end of the program of blocks that the dry run did not execute.
    pub(in crate::interpreter) fn take_held(&mut self) -> Vec<Diagnostic> {
        let held = std::mem::take(&mut self.held).into_iter();
        let unread = held.filter(|((unit, entry), _)| !self.programs.was_read(*unit, *entry));
        unread.map(|(_, said)| said).collect()
    }

    fn refused_comp(&mut self, cause: &str, at: &BlockContext<'_>) -> Vec<Diagnostic> {
        self.try_out(cause, at, |run| {
            for item in &at.block.items {
                if let Item::Comp(command) = item {
                    run.comp(command, at);
                }
            }
        })
    }

    /// Does something of a block for what is said of it, and leaves all else as it is.
    fn try_out(
        &mut self,
        cause: &str,
        at: &BlockContext<'_>,
        attempt: impl FnOnce(&mut Self),
    ) -> Vec<Diagnostic> {
        let before = (self.state.control.clone(), self.state.track.clone());
        let scratch = std::mem::take(&mut self.scratch);
        let sides = std::mem::take(&mut self.sides);
        let (called, departing) = (self.pending.len(), self.departing.len());
        attempt(self);
        self.say_unsaid(at);
        self.sides = sides;
        self.pending.truncate(called);
        self.departing.truncate(departing);
        let mut said = std::mem::replace(&mut self.scratch, scratch).diagnostics;
        for said in said.iter_mut().filter(|said| !said.code.is_about_text()) {
            let value = unknown_value(cause);
            let message = &mut said.message;
            *message = format!("{message}; whether the block is executed depends on {value}");
        }
        (self.state.control, self.state.track) = before;
        said
    }

    /// A modal cycle is repeated after the block if the control executes it.
    fn perhaps_repeat_cycles(&mut self, region: &Region, cause: &Arc<str>) {
        for cycle in self.state.control.cycles.known().to_vec() {
            if cycle.after_motion_only && !region.moves() {
                continue;
            }
            match cycle.call {
                RepeatedCall::Program(found) | RepeatedCall::Perhaps(found) => {
                    let section = self.programs.section(found);
                    let blocks = section.start..section.end;
                    self.havoc_region(found.unit, blocks, cause);
                }
                RepeatedCall::External(name) => self.leave_to_machine(&name),
            }
        }
    }
}

/// The statement of a block that opens, divides or closes a control block.
fn structure(block: &Block) -> Option<(&Flow, Span)> {
    let parts = block.items.iter().filter_map(|item| match item {
        Item::Flow(flow, span) => Some((flow, *span)),
        _ => None,
    });
    let mut parts = parts.filter(|_| !block.jumps());
    parts.find(|(flow, _)| !matches!(flow, Flow::Break | Flow::Continue | Flow::Goto(_)))
}
